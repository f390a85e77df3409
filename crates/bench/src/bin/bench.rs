//! `cargo xtask bench`: measures what the firmware costs. `--help` says more.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, ensure};
use clap::Parser;
use robot_bench::{
    filters::OURS,
    functions::{self, FunctionCost},
    image_size::ImageSize,
    measure::Detail,
    motion::{Motion, Wheels},
    report::Report,
    scenarios,
    work::{Board, Plan, Results},
};
use robot_replay::Trial;

/// The folder of recordings, seen from the repository's root.
const RECORDINGS: &str = "../shared/data/broad";
/// The folder in [`RECORDINGS`] that is taken if the user names none.
const AT_200_HZ: &str = "hz200";

/// Measure what the firmware costs: the shipped image on the emulated board, and its attitude filter beside others,
/// counted on an emulated Cortex-M4F over recorded motion. The exit code is 1 if a limit is exceeded.
#[derive(Parser)]
#[command(
    name = "bench",
    bin_name = "cargo xtask bench",
    after_help = "Examples:
  cargo xtask bench                       everything, on all recordings
  cargo xtask bench --quick               the filters alone, on one recording
  cargo xtask bench --quick --functions   where the estimator's instructions go"
)]
struct Args {
    /// The shipped image. `cargo xtask` passes the one it builds.
    #[arg(long, value_name = "ELF", required_unless_present = "quick")]
    elf: Option<PathBuf>,
    /// Folder of the filters' programs for the board. `cargo xtask` passes it.
    #[arg(long, value_name = "DIR")]
    programs: PathBuf,
    /// Folder of recorded trials [default: $ROBOT_DATA, else ../shared/data/broad; without recordings, a computed
    /// motion].
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Use only recordings whose name contains this.
    #[arg(long, value_name = "PART")]
    trial: Option<String>,
    /// Measure the filters only, over one recording.
    #[arg(long)]
    quick: bool,
    /// List also the estimator's instructions and flash by function.
    #[arg(long)]
    functions: bool,
    /// Folder for `bench.json`.
    #[arg(long, value_name = "DIR", default_value = "target/bench")]
    out: PathBuf,
}

fn main() -> ExitCode {
    run(&Args::parse()).unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}

fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let plan = args.plan()?;
    let results = plan.run()?;
    let board = plan.board.as_ref();
    let image = board
        .map(|board| ImageSize::read(&board.image))
        .transpose()?;
    let names = plan.motions.iter().map(|motion| motion.name().to_owned());
    let report = Report::new(image, &results, names.collect());
    for group in &report.groups {
        println!("{group}");
    }
    println!("filters fed with: {}", report.motions.join(", "));
    if args.functions {
        print_functions(&plan.programs, results)?;
    }
    fs::create_dir_all(&args.out)?;
    let json = args.out.join("bench.json");
    fs::write(&json, report.to_json())
        .with_context(|| format!("cannot write {}", json.display()))?;
    println!("wrote {}", json.display());
    for (group, row) in report.broken() {
        let columns = row.broken.join(", ");
        println!("over its limit: {}, {} ({columns})", group.title, row.name);
    }
    Ok(if report.ok {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

impl Args {
    fn plan(&self) -> anyhow::Result<Plan> {
        let image = self.elf.clone().filter(|_| !self.quick);
        Ok(Plan {
            board: image.map(board).transpose()?,
            programs: self.programs.clone(),
            motions: self.motions()?,
            detail: if self.functions {
                Detail::Blocks
            } else {
                Detail::Totals
            },
        })
    }

    /// Returns the recordings and one motion with wheels.
    fn motions(&self) -> anyhow::Result<Vec<Motion>> {
        let mut motions = Vec::new();
        for header in self.headers()? {
            motions.push(Motion::Recorded(Trial::read(&header)?));
        }
        if motions.is_empty() {
            eprintln!("no recordings (see --data): a computed motion stands in");
            motions.push(Motion::computed(Wheels::Silent));
        }
        motions.push(Motion::computed(Wheels::Turning));
        Ok(motions)
    }

    fn headers(&self) -> anyhow::Result<Vec<PathBuf>> {
        let variable = env::var_os("ROBOT_DATA").map(PathBuf::from);
        let said = self.data.clone().or(variable);
        let mut folder = said.unwrap_or_else(|| repository().join(RECORDINGS));
        if self.data.is_none() {
            if !folder.is_dir() {
                return Ok(Vec::new());
            }
            let at_200_hz = folder.join(AT_200_HZ);
            folder = Some(at_200_hz)
                .filter(|inner| inner.is_dir())
                .unwrap_or(folder);
        }
        let mut headers = robot_replay::trial_files(&folder)?;
        let part = self.trial.as_deref().unwrap_or_default();
        headers.retain(|header| {
            header
                .file_stem()
                .is_some_and(|name| name.to_string_lossy().contains(part))
        });
        ensure!(
            !headers.is_empty(),
            "no recording in {} has {part:?} in its name",
            folder.display()
        );
        if self.quick {
            headers.truncate(1);
        }
        Ok(headers)
    }
}

fn board(image: PathBuf) -> anyhow::Result<Board> {
    let scenarios = scenarios::NAMES.iter();
    let scenarios = scenarios.map(|name| scenarios::read(&repository(), name));
    Ok(Board {
        image,
        scenarios: scenarios.collect::<Result<_, _>>()?,
    })
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Prints what each function of our estimator costs over all its motions.
fn print_functions(programs: &Path, results: Results) -> anyhow::Result<()> {
    let ours = results
        .filters
        .into_iter()
        .filter(|result| result.entry.is_ours());
    let runs: Vec<_> = ours.flat_map(|result| result.runs).collect();
    println!(
        "instructions of a mean update with magnetometer, of one between, of the costliest; bytes of flash"
    );
    for share in functions::shares(&OURS.elf(programs), &runs)? {
        let FunctionCost {
            name,
            update,
            between,
            worst,
            flash_bytes,
        } = share;
        if update.max(between) >= 0.5 || worst > 0 || flash_bytes >= 32 {
            println!("{update:>8.1} {between:>8.1} {worst:>6} {flash_bytes:>6}  {name}");
        }
    }
    Ok(())
}
