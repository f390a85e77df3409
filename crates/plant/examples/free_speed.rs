//! Prints what one step of the free robot costs, in processor time.

use robot_plant::free::{FreeBody, FreeInputs, FreeSetup, Start, Terrain};
use std::{fs, path::Path};

fn cpu_us() -> f64 {
    let text = fs::read_to_string("/proc/self/schedstat").unwrap_or_default();
    let first = text.split(' ').next().and_then(|it| it.parse::<f64>().ok());
    first.unwrap_or(0.0) / 1e3
}

fn main() -> Result<(), robot_description::RobotError> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/fivebar.toml");
    let robot = robot_description::Robot::read(&file)?;
    let plates = Terrain::Plates {
        start_m: -2.0,
        count: 20,
        length_m: 0.2,
        height_m: 0.02,
        tilt_rad: 0.05,
        seed: 1,
    };
    for (name, start, terrain) in [
        ("in flight", Start::Dropped { height_m: 1e4 }, Terrain::Flat),
        ("on wheels, legs stiff", Start::Standing, Terrain::Flat),
        ("on wheels, on plates", Start::Standing, plates),
        ("sitting", Start::Sitting, Terrain::Flat),
    ] {
        let setup = FreeSetup {
            start,
            terrain,
            ..FreeSetup::default()
        };
        let mut body = FreeBody::new(&robot, &setup);
        let inputs = FreeInputs {
            joint_dry_nm: 20.0,
            wheel_dry_nm: 0.1,
            ..FreeInputs::default()
        };
        let (steps, before) = (100_000, cpu_us());
        for _ in 0..steps {
            body.step(&inputs, 250e-6);
        }
        let each = (cpu_us() - before) / f64::from(steps);
        println!("{name}: {each:.2} µs a step, {:.0} s/s", 250.0 / each);
    }
    Ok(())
}
