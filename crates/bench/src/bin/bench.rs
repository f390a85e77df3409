//! The bench: see `--help`.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::Context;
use clap::Parser;
use robot_bench::{
    filters::OURS,
    functions,
    image_size::ImageSize,
    measure::Detail,
    motion::{Motion, Wheels},
    program::Blocks,
    report::Report,
    scenarios,
    work::{Plan, Results},
};

/// What the firmware costs: the shipped image on the emulated board, and its attitude filter beside others, counted on
/// an emulated Cortex-M4F over recorded motion. Exit code 1 if a limit is broken.
#[derive(Parser)]
#[command(
    name = "cargo xtask bench",
    after_help = "Examples:
  cargo xtask bench                       everything, on all recordings
  cargo xtask bench --quick               the filters alone, on one recording
  cargo xtask bench --quick --functions   where the estimator's instructions go"
)]
struct Args {
    /// The shipped image.
    #[arg(long, value_name = "ELF", required_unless_present = "quick")]
    elf: Option<PathBuf>,
    /// Folder of the filters' programs for the board.
    #[arg(long, value_name = "DIR")]
    programs: PathBuf,
    /// Folder of recorded trials [default: $ROBOT_DATA, else ../shared/data/broad/hz200; without any a computed motion
    /// stands in].
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Only the recordings with this in their name.
    #[arg(long, value_name = "PART")]
    trial: Option<String>,
    /// The filters alone, over one recording.
    #[arg(long)]
    quick: bool,
    /// Also list which functions an update with magnetometer spends its instructions in.
    #[arg(long)]
    functions: bool,
    /// Where `bench.json` goes.
    #[arg(long, value_name = "DIR", default_value = "target/bench")]
    out: PathBuf,
}

fn main() -> anyhow::Result<ExitCode> {
    let args = Args::parse();
    let plan = args.plan()?;
    let results = plan.run()?;
    let image = plan.image.as_deref().map(ImageSize::read).transpose()?;
    let names = plan.motions.iter().map(|motion| motion.name.clone());
    let report = Report::new(image, &results, names.collect());
    for group in &report.groups {
        println!("{group}");
    }
    println!("filters fed with: {}", report.motions.join(", "));
    if args.functions {
        print_functions(&plan.programs, &results)?;
    }
    fs::create_dir_all(&args.out)?;
    let json = args.out.join("bench.json");
    fs::write(&json, report.to_json())
        .with_context(|| format!("cannot write {}", json.display()))?;
    println!("wrote {}", json.display());
    Ok(if report.ok {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

impl Args {
    fn plan(&self) -> anyhow::Result<Plan> {
        let image = self.elf.clone().filter(|_| !self.quick);
        let names: &[&str] = if image.is_some() {
            &scenarios::NAMES
        } else {
            &[]
        };
        let scenarios = names
            .iter()
            .map(|name| scenarios::read(&repository(), name));
        Ok(Plan {
            scenarios: scenarios.collect::<Result<_, _>>()?,
            image,
            programs: self.programs.clone(),
            motions: self.motions()?,
            detail: if self.functions {
                Detail::Blocks
            } else {
                Detail::Totals
            },
        })
    }

    /// Recordings, and one motion with wheels.
    fn motions(&self) -> anyhow::Result<Vec<Motion>> {
        let mut motions = Vec::new();
        for header in self.headers()? {
            if self.quick && !motions.is_empty() {
                break;
            }
            motions.push(Motion::read(&header)?);
        }
        if motions.is_empty() {
            eprintln!("no recordings (see --data): a computed motion stands in");
            motions.push(Motion::computed(Wheels::Silent));
        }
        motions.push(Motion::computed(Wheels::Turning));
        Ok(motions)
    }

    fn headers(&self) -> anyhow::Result<Vec<PathBuf>> {
        let given = self
            .data
            .clone()
            .or_else(|| env::var_os("ROBOT_DATA").map(PathBuf::from));
        let folder = given.unwrap_or_else(|| repository().join("../shared/data/broad/hz200"));
        let part = self.trial.as_deref().unwrap_or_default();
        let mut headers = Vec::new();
        for entry in fs::read_dir(&folder).into_iter().flatten() {
            let path = entry?.path();
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            if path.extension().is_some_and(|e| e == "json") && name.contains(part) {
                headers.push(path);
            }
        }
        headers.sort();
        Ok(headers)
    }
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn print_functions(programs: &Path, results: &Results) -> anyhow::Result<()> {
    let ours = results
        .filters
        .iter()
        .filter(|result| result.entry.is_ours());
    let mut sum = Blocks::new();
    let mut updates = 0;
    for run in ours.flat_map(|result| &result.runs) {
        updates += run.costs.update_with_mag.len();
        for (block, runs) in &run.blocks {
            *sum.entry(*block).or_default() += runs;
        }
    }
    println!("\ninstructions of an update with magnetometer, by function < caller");
    for (name, count) in functions::instructions(&OURS.elf(programs), &sum)? {
        let each = count as f64 / updates as f64;
        if each >= 1.0 {
            println!("{each:>10.1}  {name}");
        }
    }
    Ok(())
}
