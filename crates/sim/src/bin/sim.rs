//! Boots a firmware image in the emulated C board and runs a scenario (`cargo xtask sim`).

use std::{
    path::PathBuf,
    process::{self, ExitCode},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use anyhow::{Context, bail};
use clap::Parser;
use robot_plant::{recording, time, world::CanBusId};
use robot_sim::{
    faults,
    gateway::GatewayAddress,
    image_robot,
    job::Job,
    machine::RegisterPatch,
    pc::PcAccess,
    run_signals::RunSignals,
    scenario::Scenario,
    signals::SignalTable,
    simulation::Simulation,
    terminal::{LogLevel, Terminal},
    viewer,
};

/// Boot the firmware in an emulated RoboMaster C board wired to a simulated robot.
#[derive(Parser)]
#[command(name = "sim", after_help = EXAMPLES)]
struct Args {
    /// Scenario to run; default: a robot stands up, balances, drives and is pushed. With a PC a drive on a stand, after which
    /// the robot is disarmed; with --imu a quiet stand.
    scenario: Option<PathBuf>,
    /// Firmware image to boot.
    #[arg(long, required_unless_present = "list_faults")]
    elf: Option<PathBuf>,
    /// Robot to simulate: a name in robots/, or a file. `cargo xtask sim` builds the image for it too. Default: the one that the
    /// image is for.
    #[arg(long, value_name = "NAME|FILE")]
    robot: Option<String>,
    /// Run for so long, instead of the scenario's own length. Ctrl-C ends it earlier, with a report.
    #[arg(long, value_name = "N")]
    seconds: Option<f64>,
    /// Folder for report.html, summary.json and run.mcap.
    #[arg(long, default_value = "target/sim")]
    out: PathBuf,
    /// Afterwards show the robot in the browser: its viewer is in report.html. Without a desktop, say where that is.
    #[arg(long)]
    view: bool,
    /// Play a recorded trial (.json beside its .f32.gz) through the sensor models.
    #[arg(long, value_name = "TRIAL.json")]
    imu: Option<PathBuf>,
    /// Keep the robot's settings in FILE from run to run: its parameter flash, read if it exists, written at the end.
    #[arg(long, value_name = "FILE")]
    flash: Option<PathBuf>,
    /// CAN1 as a LAWICEL (slcan) adapter on a pseudo-terminal; implies --realtime, and the run is not reproducible.
    #[arg(long, value_enum, value_name = "pty")]
    can1: Option<CanConnection>,
    /// CAN2 likewise.
    #[arg(long, value_enum, value_name = "pty")]
    can2: Option<CanConnection>,
    /// The PC link (4-pin UART2) on a pseudo-terminal, as a USB-to-serial adapter. Likewise.
    #[arg(long, value_enum, value_name = "pty")]
    link: Option<LinkConnection>,
    /// The board waits for the program's answer to each state, and the program for the board: as fast as both can, and the
    /// speed of neither matters. The program is `policy run --lockstep`.
    #[arg(long, requires = "link")]
    lockstep: bool,
    /// Both buses behind a Waveshare CAN-TO-ETH: CAN1 at PORT, CAN2 at the next one; 0: any free ports. As with --can1,
    /// it implies --realtime.
    #[arg(long, value_name = "tcp:PORT|udp:PORT", conflicts_with_all = ["can1", "can2"])]
    gateway: Option<GatewayAddress>,
    /// Start as `probe-rs run` does by default, with reset and hard fault caught; the robot must do all it does without.
    #[arg(long)]
    probe: bool,
    /// Not faster than real time.
    #[arg(long)]
    realtime: bool,
    /// Least severe firmware log shown.
    #[arg(long, value_enum, default_value = "debug")]
    log: LogLevel,
    /// Seed of all simulated noise, instead of the scenario's own.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Print the faults a scenario can start and end.
    #[arg(long)]
    list_faults: bool,
    /// Print the signals a scenario can expect something of.
    #[arg(long)]
    list_signals: bool,
    /// Override bits in every write to a register: one wrong line of board.rs (hexadecimal; for tests).
    #[arg(long, value_name = "ADDR:MASK:VALUE", value_parser = parse_patch)]
    patch: Vec<RegisterPatch>,
}

/// Where the frames of a bus go in addition to the simulated robot.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum CanConnection {
    /// A pseudo-terminal.
    Pty,
}

/// Where the PC's end of the link is.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum LinkConnection {
    /// A pseudo-terminal.
    Pty,
}

impl Args {
    /// Whether programs on this computer take part.
    fn has_pc(&self) -> bool {
        self.can1.is_some() || self.can2.is_some() || self.link.is_some() || self.gateway.is_some()
    }
}

const EXAMPLES: &str = "Examples:
  cargo xtask sim --view                               # shows the robot in the browser afterwards
  cargo xtask sim scenarios/remote-loss.toml
  cargo xtask sim --robot teams/ours.toml              # your robot, with an image for it
  cargo xtask sim --can1 pty --seconds 3600            # then: robotctl status --can /dev/pts/N
  cargo xtask sim --gateway tcp:20001 --seconds 3600   # then: robotctl status --can tcp:127.0.0.1:20001
  cargo xtask sim scenarios/pc-pilot.toml --link pty --seconds 600
                                                       # then: robotctl drive --link /dev/pts/N";

const BALANCE: &str = include_str!("../../../../scenarios/balance.toml");

/// What a PC finds without a scenario: a robot that ends disarmed.
const DRIVE: &str = include_str!("../../../../scenarios/drive.toml");

/// What `--imu` runs without a scenario: nobody touches the radio, and the robot has saved that the magnetometer sits as
/// the IMU does (docs/mounting.md).
const REPLAY: &str = "name = \"replay\"\nseconds = 10\nplant = \"stand\"\n[[flash.record]]\ngroup = 8\nvalues = [0, 0]\n";

fn main() -> anyhow::Result<ExitCode> {
    let args = Args::parse();
    if args.list_faults {
        for fault in faults::all() {
            println!("{:<20} {}", fault.name, fault.what);
        }
        return Ok(ExitCode::SUCCESS);
    }
    let job = job(&args)?;
    if args.list_signals {
        return list_signals(&job);
    }
    let realtime = args.realtime || job.pc.is_offered() && !args.lockstep;
    if realtime && !args.realtime {
        println!("a PC takes part: real time, and not reproducible");
    }
    let interrupted = catch_interrupt()?;
    let mut terminal = Terminal::new(job.scenario.length, args.log, realtime, interrupted);
    let outcome = job.run_into(&args.out, &mut terminal)?;
    terminal.conclude(&outcome);
    if let (true, Some(report)) = (args.view, outcome.files.first()) {
        viewer::show(report);
    }
    Ok(if outcome.summary.ok {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// From now on, the first Ctrl-C only sets this flag, and the second one ends the program.
fn catch_interrupt() -> anyhow::Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    let caught = flag.clone();
    ctrlc::set_handler(move || {
        if caught.swap(true, Ordering::Relaxed) {
            process::exit(130);
        }
    })
    .context("cannot catch Ctrl-C")?;
    Ok(flag)
}

impl Args {
    fn pc(&self) -> PcAccess {
        let buses = [(self.can1, CanBusId::Can1), (self.can2, CanBusId::Can2)];
        let outside = buses.into_iter().filter(|(place, _)| place.is_some());
        PcAccess {
            can_on_pty: outside.map(|(_, bus)| bus).collect(),
            gateway: self.gateway,
            link_on_pty: self.link.is_some(),
            lockstep: self.lockstep,
        }
    }
}

fn job(args: &Args) -> anyhow::Result<Job> {
    let elf = args.elf.clone().context("--elf names no image")?;
    if !elf.is_file() {
        bail!(
            "there is no image at {}; `cargo xtask sim` builds it",
            elf.display()
        );
    }
    let mut scenario = match (&args.scenario, &args.imu) {
        (Some(path), _) => Scenario::read(path)?,
        (None, None) if args.has_pc() => Scenario::parse(DRIVE, "scenarios/drive.toml")?,
        (None, None) => Scenario::parse(BALANCE, "scenarios/balance.toml")?,
        (None, Some(trial)) => {
            let mut scenario = Scenario::parse(REPLAY, "replay")?;
            scenario.length = recording::run_length(trial)?;
            scenario
        }
    };
    if let Some(seconds) = args.seconds {
        if !(seconds > 0.0 && seconds.is_finite()) {
            bail!("--seconds {seconds}: write a length above 0");
        }
        let left_out = scenario.cut_to(time::from_seconds(seconds));
        if left_out > 0 {
            println!(
                "--seconds {seconds}: {left_out} expectations look past that and are not judged"
            );
        }
    }
    scenario.seed = args.seed.unwrap_or(scenario.seed);
    image_robot::agree(&mut scenario, &elf, args.robot.as_deref())?;
    Ok(Job {
        elf,
        scenario,
        imu_trial: args.imu.clone(),
        patches: args.patch.clone(),
        probe: args.probe,
        pc: args.pc(),
        flash_file: args.flash.clone(),
    })
}

fn list_signals(job: &Job) -> anyhow::Result<ExitCode> {
    let mut machine = job.machine()?;
    let world = machine.world_names();
    let table = SignalTable::new(&world, machine.diag_names(), RunSignals::names());
    for name in table.names() {
        println!("{name}");
    }
    Ok(ExitCode::SUCCESS)
}

fn parse_patch(text: &str) -> anyhow::Result<RegisterPatch> {
    let number = |part: &str| {
        let digits = part.trim_start_matches("0x").replace('_', "");
        u32::from_str_radix(&digits, 16).with_context(|| part.to_owned())
    };
    match text.split(':').collect::<Vec<_>>()[..] {
        [address, mask, value] => Ok(RegisterPatch {
            address: number(address)?,
            mask: number(mask)?,
            value: number(value)?,
        }),
        _ => bail!("write ADDR:MASK:VALUE in hexadecimal"),
    }
}
