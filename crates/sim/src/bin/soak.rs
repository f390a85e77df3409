//! Keeps the firmware busy for hours under faults from a seed (`cargo xtask soak`).

use std::{path::PathBuf, process::ExitCode, time::Instant};

use anyhow::{Context, bail};
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use robot_plant::time;
use robot_sim::{
    image_robot,
    soak::{Outcome, Soak},
};

/// Boot the firmware in the emulated board, drive it for hours with random pilot input, faults and frames from a seed,
/// and check invariants at every instant.
#[derive(Parser)]
#[command(name = "soak")]
struct Args {
    /// Firmware image to boot.
    #[arg(long)]
    elf: PathBuf,
    /// Robot to simulate, as in `cargo xtask sim`. Default: the one that the image is for.
    #[arg(long, value_name = "NAME|FILE")]
    robot: Option<String>,
    /// Simulated hours.
    #[arg(long, value_name = "N", default_value_t = 2.0)]
    hours: f64,
    /// Seed of everything that happens.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Folder for the scenario that reproduces a violation.
    #[arg(long, default_value = "target/soak")]
    out: PathBuf,
}

fn main() -> anyhow::Result<ExitCode> {
    let args = Args::parse();
    if !(args.hours > 0.0 && args.hours <= 1_000.0) {
        bail!(
            "--hours {}: write a number above 0, at most 1000",
            args.hours
        );
    }
    let soak = Soak {
        elf: args.elf.clone(),
        robot: image_robot::of_image(&args.elf, args.robot.as_deref())?,
        length: time::from_seconds(args.hours * 3_600.0),
        seed: args.seed,
    };
    let started = Instant::now();
    let bar = bar(soak.length)?;
    let outcome = soak.run(|now| bar.set_position(now / time::SECOND))?;
    bar.finish_and_clear();
    summary(&outcome, started.elapsed().as_secs_f64());
    let Some(failure) = &outcome.failure else {
        println!("seed {}: every invariant held", args.seed);
        return Ok(ExitCode::SUCCESS);
    };
    std::fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot make {}", args.out.display()))?;
    let file = args.out.join(format!("seed-{}.toml", args.seed));
    std::fs::write(&file, &failure.scenario)
        .with_context(|| format!("cannot write {}", file.display()))?;
    println!("seed {}: VIOLATION {failure}", args.seed);
    println!("its last events: cargo xtask sim {}", file.display());
    println!(
        "exactly again:  cargo xtask soak --seed {} --hours {}",
        args.seed, args.hours
    );
    Ok(ExitCode::FAILURE)
}

fn bar(length: time::Ps) -> anyhow::Result<ProgressBar> {
    let style = ProgressStyle::with_template(
        "{bar:40} {pos}/{len} s simulated, {elapsed} gone, {eta} to go",
    )?;
    Ok(ProgressBar::new(length / time::SECOND).with_style(style))
}

fn summary(outcome: &Outcome, wall_s: f64) {
    let ran_s = time::to_seconds(outcome.ran);
    let tally = &outcome.tally;
    for (what, value) in [
        (
            "simulated",
            format!("{ran_s:.0} s, {:.1} × real time", ran_s / wall_s),
        ),
        ("faults", tally.faults.to_string()),
        ("tuning frames", tally.frames.to_string()),
        ("armings", tally.armings.to_string()),
        ("stops checked", tally.stops.to_string()),
        ("resets", tally.resets.to_string()),
        ("settings changed", tally.settings.changes.to_string()),
        ("restored at a boot", tally.settings.restored.to_string()),
        ("lost as reported", tally.settings.reported_lost.to_string()),
        ("flash words", tally.flash_words.to_string()),
        ("flash erases", tally.flash_erases.to_string()),
        ("most current", format!("{:.0} mA", tally.most_current_ma)),
        (
            "most joint torque",
            format!("{:.2} N·m", tally.most_torque_nm),
        ),
    ] {
        println!("{what:<18} {value:>24}");
    }
}
