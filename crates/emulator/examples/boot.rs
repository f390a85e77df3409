//! Boots an image on the bare emulated board and prints its log: `cargo run --example boot -- ELF SECONDS`.

use std::path::Path;

use robot_emulator::machine::Machine;
use robot_plant::{
    time::{self, MS},
    world::{PlantKind, RadioKind, World, WorldConfig},
};

fn main() -> anyhow::Result<()> {
    let mut args = std::env::args().skip(1);
    let (Some(elf), Some(seconds)) = (args.next(), args.next()) else {
        anyhow::bail!("usage: boot ELF SECONDS")
    };
    let world = World::new(WorldConfig {
        plant: PlantKind::Stand,
        radio: RadioKind::Sbus,
        seed: 1,
        imu_trial: None,
    })?;
    let mut machine = Machine::new(Path::new(&elf), world)?;
    let end = time::from_seconds(seconds.parse()?);
    let (mut at, mut stopped) = (0, Ok(()));
    while at < end && stopped.is_ok() {
        at = (at + 100 * MS).min(end);
        stopped = machine.run_until(at);
        for line in machine.take_log() {
            println!(
                "{:12.6} {:5} {}",
                time::to_seconds(line.at),
                line.level,
                line.text
            );
        }
    }
    for error in machine.board_errors() {
        println!(
            "{:12.6} board {} ({}x)",
            time::to_seconds(error.at),
            error.message,
            error.count
        );
    }
    println!("{:#?}", machine.stats());
    Ok(stopped?)
}
