//! `robot gains`: the gains of the balance controller, and what the loop does with them.

mod over_length;
mod page;
mod study;
mod text;

use std::{fs, path::PathBuf, process::ExitCode};

use anyhow::Context;

use crate::robot_file::RobotFile;
use study::Study;

#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    file: RobotFile,
    /// Folder for the page with the plots.
    #[arg(long, value_name = "DIR", default_value = "target/robot")]
    out: PathBuf,
    /// Print everything as one JSON object instead of tables.
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
The gains are in the image without this command: it shows them, with poles, margins and responses (docs/balance.md).
The exit code is 0 if the loop holds over all leg lengths, also with 5 ms more delay.

Example:
  cargo xtask robot gains fivebar
  cargo xtask robot gains robots/ours.toml --json > gains.json";

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let robot = args.file.read()?;
    let study = Study::new(&robot)?;
    fs::create_dir_all(&args.out).with_context(|| args.out.display().to_string())?;
    let path = args.out.join(format!("{}-gains.html", robot.name));
    fs::write(&path, page::html(&study)?).with_context(|| path.display().to_string())?;
    if args.json {
        println!("{:#}", study.json());
    } else {
        print!("{}", text::tables(&study));
        println!("\nplots: {}", path.display());
    }
    Ok(ExitCode::SUCCESS)
}
