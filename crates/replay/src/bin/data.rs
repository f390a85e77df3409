//! `cargo xtask data`: prepares the public recordings for tests and `cargo xtask replay`.

use std::{path::PathBuf, process::ExitCode};

use anyhow::ensure;
use clap::Parser;
use robot_replay::broad::{self, TWELVE};

/// Prepare the recorded motion that tests and `cargo xtask replay` use. Without --from, say where to get it.
#[derive(Parser)]
#[command(name = "data", bin_name = "cargo xtask data", after_help = EXAMPLES)]
struct Args {
    /// Folder with a copy of the dataset. It has `data_mat` in it.
    #[arg(long, value_name = "FOLDER")]
    from: Option<PathBuf>,
    /// Folder for the prepared trials. They are written to its subfolder `hz200`.
    #[arg(long, value_name = "FOLDER", default_value = "target/broad")]
    out: PathBuf,
    /// Prepare only trials whose name contains this.
    #[arg(
        long,
        value_name = "SUBSTRING",
        default_value = "",
        hide_default_value = true
    )]
    trial: String,
}

const EXAMPLES: &str = "\
Example:
  git clone --depth 1 https://github.com/dlaidig/broad ../broad
  cargo xtask data --from ../broad
  export ROBOT_DATA=$PWD/target/broad
  cargo xtask replay";

const WHERE_FROM: &str = "\
The recorded motion is BROAD, the Berlin Robust Orientation Estimation Assessment Dataset: 39 trials of an IMU and a
magnetometer moved by hand, with the attitude that cameras saw (D. Laidig, M. Caruso, A. Cereatti, T. Seel, Data 6 (7),
2021, doi 10.3390/data6070072). Licence: Creative Commons Attribution 4.0. It is not part of this repository.

1. Download it, some hundred megabytes (or only the MATLAB files named below, from data_mat):
     git clone --depth 1 https://github.com/dlaidig/broad ../broad
2. Prepare the twelve trials that the tests use: joined columns at 200 Hz in single precision.
     cargo xtask data --from ../broad
3. Say where they are:
     export ROBOT_DATA=$PWD/target/broad

The twelve trials:";

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> anyhow::Result<()> {
    let wanted = || TWELVE.iter().filter(|name| name.contains(&args.trial));
    ensure!(
        wanted().count() > 0,
        "none of the twelve trials has `{}` in its name",
        args.trial
    );
    let Some(from) = &args.from else {
        println!("{WHERE_FROM}");
        wanted().for_each(|name| println!("  {name}.mat"));
        return Ok(());
    };
    let folder = args.out.join("hz200");
    for name in wanted() {
        broad::prepare(name, from, &folder)?;
        println!("{}", folder.join(name).with_extension("json").display());
    }
    broad::write_notice(&args.out)?;
    let out = std::path::absolute(&args.out)?;
    println!("next: set ROBOT_DATA to {}", out.display());
    Ok(())
}
