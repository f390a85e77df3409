//! `cargo xtask replay`: runs the firmware's estimator over recorded trials.

mod batch;
mod csv;
mod data_folder;
mod outcome;
mod report;
mod summary;
mod table;

use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, bail, ensure};
use clap::Parser;
use robot_replay::{Mode, trial_files};

use outcome::Task;

/// Run the firmware's estimator over recorded trials. It writes a CSV of the 1 kHz attitude for each trial, a table of
/// errors and a report with plots.
///
/// A trial is NAME.json with NAME.f32.gz beside it, sampled at any rate: see the README.md of the recordings. The
/// estimator gets what it would get in the firmware: the IMU at 200 Hz, the magnetometer at 50 Hz, each sample once.
#[derive(Parser)]
#[command(name = "replay", bin_name = "cargo xtask replay", after_help = EXAMPLES)]
struct Args {
    /// Folder of trials, or a folder with one such folder in it [default: $ROBOT_DATA, else ../shared/data/broad].
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Folder for NAME.csv (t,qw,qx,qy,qz), summary.json and report.html.
    #[arg(long, value_name = "DIR", default_value = "target/replay")]
    out: PathBuf,
    /// Use the magnetometer (9d) or not (6d).
    #[arg(long, value_enum, default_value = "9d")]
    mode: Mode,
    /// Add an offset to every gyro sample, to see whether it is found.
    #[arg(long, value_name = "X,Y,Z", value_parser = offset, default_value = "0,0,0", allow_hyphen_values = true)]
    gyro_offset_dps: [f32; 3],
    /// Run only trials whose name contains this.
    #[arg(long, value_name = "SUBSTRING")]
    trial: Option<String>,
}

const EXAMPLES: &str = "\
Examples:
  cargo xtask replay
  cargo xtask replay --data broad/hz200 --out target/6d --mode 6d
  cargo xtask replay --trial fast_rotation --gyro-offset-dps 2.5,-2.5,2.5
  python3 broad/score.py broad/hz200 target/replay --at est    # the same figures from the data's own script";

fn offset(text: &str) -> anyhow::Result<[f32; 3]> {
    let numbers: Result<Vec<f32>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    let Ok(offset) = <[f32; 3]>::try_from(numbers?) else {
        bail!("expected three numbers with commas between");
    };
    ensure!(
        offset.iter().all(|axis| axis.is_finite()),
        "not a finite number"
    );
    Ok(offset)
}

fn main() -> ExitCode {
    match replay(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn replay(args: &Args) -> anyhow::Result<()> {
    let data = data_folder::find(args.data.as_deref())?;
    let files = chosen(trial_files(&data)?, args.trial.as_deref())?;
    fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot create the folder {}", args.out.display()))?;
    let task = Task {
        mode: args.mode,
        gyro_offset_dps: args.gyro_offset_dps,
        out: args.out.clone(),
    };
    let outcomes = batch::run(&task, &files)?;
    print!("{}", table::table(&task, &outcomes));
    let summary = summary::json(&task, &data, &outcomes)?;
    write(&args.out.join("summary.json"), &summary)?;
    let report = args.out.join("report.html");
    write(&report, &report::page(&task, &outcomes))?;
    println!("plots: {}", report.display());
    Ok(())
}

fn chosen(files: Vec<PathBuf>, part: Option<&str>) -> anyhow::Result<Vec<PathBuf>> {
    let Some(part) = part else { return Ok(files) };
    let name = |path: &PathBuf| {
        path.file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    let names: Vec<String> = files.iter().map(name).collect();
    let chosen: Vec<PathBuf> = files
        .into_iter()
        .filter(|file| name(file).contains(part))
        .collect();
    if chosen.is_empty() {
        bail!(
            "no trial has `{part}` in its name; there are:\n  {}",
            names.join("\n  ")
        );
    }
    Ok(chosen)
}

fn write(path: &Path, text: &str) -> anyhow::Result<()> {
    fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offset_is_three_finite_numbers() {
        assert_eq!(offset("2.5, -1,0").unwrap(), [2.5, -1.0, 0.0]);
        for wrong in ["1,2", "1,2,3,4", "1,x,3", "", "1,2,NaN"] {
            assert!(offset(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn an_unknown_trial_is_answered_with_the_known_ones() {
        let files = vec![
            PathBuf::from("a/02_slow.json"),
            PathBuf::from("a/07_fast.json"),
        ];
        assert_eq!(
            chosen(files.clone(), Some("fast")).unwrap(),
            [files[1].clone()]
        );
        let error = chosen(files, Some("medium")).unwrap_err().to_string();
        assert!(
            error.contains("02_slow") && error.contains("07_fast"),
            "{error}"
        );
    }
}
