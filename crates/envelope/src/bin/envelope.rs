//! `cargo xtask envelope`: what the balancing robot survives.

use std::{path::PathBuf, process::ExitCode, sync::Arc, time::Instant};

use anyhow::ensure;
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use robot_description::{Robot, path_of};
use robot_envelope::{Report, Robots, TASKS, Task, parts, survey, table, write};
use robot_host_loop::layout_of;

/// Let many robots, each different from its file, stand, drive, fall and get up, and tell how many succeed.
///
/// The whole firmware logic runs on this machine in a simulated world, without the emulated chip. The exit code is 0
/// only if the wanted rates hold.
#[derive(Parser)]
#[command(name = "envelope", bin_name = "cargo xtask envelope", after_help = EXAMPLES)]
struct Args {
    /// Number of robots for each task.
    #[arg(long, value_name = "N", default_value_t = 20)]
    seeds: u64,
    /// The first of them; they are counted from 0.
    #[arg(long, value_name = "N", default_value_t = 0)]
    first: u64,
    /// Only the task of this name, or all whose names begin with it.
    #[arg(
        long,
        value_name = "NAME",
        default_value = "",
        hide_default_value = true
    )]
    task: String,
    /// Folder for envelope.json and envelope.html.
    #[arg(long, value_name = "DIR", default_value = "target/envelope")]
    out: PathBuf,
    /// Name of a file in robots/, or a path. One other than the robots here needs ROBOT set to the same.
    #[arg(long, value_name = "FILE|NAME", default_value = "fivebar")]
    robot: String,
    /// Robots as in their file, which differ only in the noise of their sensors.
    #[arg(long)]
    same: bool,
    /// List the tasks.
    #[arg(long)]
    list: bool,
}

const EXAMPLES: &str = "\
Examples:
  cargo xtask envelope
  cargo xtask envelope --seeds 1000 --task push --out target/pushes
  cargo xtask envelope --list";

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> anyhow::Result<bool> {
    let exact = TASKS.iter().any(|task| task.name == args.task);
    let wanted = |task: &&Task| {
        if exact {
            task.name == args.task
        } else {
            task.name.starts_with(&args.task)
        }
    };
    let tasks: Vec<&Task> = TASKS.iter().filter(wanted).collect();
    ensure!(
        !tasks.is_empty(),
        "no task's name begins with `{}`; --list lists them",
        args.task
    );
    if args.list {
        for task in tasks {
            println!("{:<21} {}", task.name, task.what);
        }
        return Ok(true);
    }
    let robot = Robot::read(&path_of(&args.robot))?;
    let name = robot.name.clone();
    ensure!(
        layout_of(&robot).is_some(),
        "this program has no controller for the robot `{name}` as its file says: its gains are made when it is built. \
         `ROBOT={robot} cargo xtask envelope --robot {robot}` builds it with them",
        robot = args.robot
    );
    let robots = Robots {
        robot: Arc::new(robot),
        vary: !args.same,
    };
    let begun = Instant::now();
    let bar = ProgressBar::new(parts(&tasks, args.seeds, true));
    bar.set_style(ProgressStyle::with_template(
        "{elapsed_precise} {bar:40} {pos}/{len} runs, {eta} left",
    )?);
    let seeds = args.first..args.first.saturating_add(args.seeds);
    let surveys = survey(&tasks, &robots, seeds, true, &|| bar.inc(1));
    bar.finish_and_clear();
    let report = Report::new(&name, args.seeds, &tasks, &surveys);
    print!("{}", table(&report));
    write(&args.out, &report, &tasks, &surveys)?;
    println!(
        "{} and {} after {:.0} s",
        args.out.join("envelope.json").display(),
        args.out.join("envelope.html").display(),
        begun.elapsed().as_secs_f64()
    );
    Ok(report.holds())
}
