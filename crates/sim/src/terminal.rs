//! A run on the terminal: the firmware's log, a progress bar, then the verdict.

use std::{
    io::IsTerminal,
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use robot_plant::{
    time::{self, Ps},
    world::CanBusId,
};

use super::{
    budgets::{self, Budget},
    expectation::Verdict,
    job::Outcome,
    runner::Observer,
    signals::{SignalTable, Values},
};
use crate::{can_port::CanDevice, machine::LogLine};

/// The least severe level that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum LogLevel {
    Trace,
    Debug,
    Info,
    Warn,
    Error,
    Off,
}

impl LogLevel {
    /// Lines without a known level (`println!`) are always worth showing.
    fn of(line: &LogLine) -> Self {
        match line.level.to_ascii_lowercase().as_str() {
            "trace" => Self::Trace,
            "debug" => Self::Debug,
            "info" => Self::Info,
            "warn" => Self::Warn,
            _ => Self::Error,
        }
    }

    fn colour(self) -> Paint {
        match self {
            Self::Trace => Paint::Dim,
            Self::Debug => Paint::Blue,
            Self::Info => Paint::Green,
            Self::Warn => Paint::Yellow,
            Self::Error | Self::Off => Paint::Red,
        }
    }
}

#[derive(Clone, Copy)]
enum Paint {
    Bold,
    Dim,
    Red,
    Green,
    Yellow,
    Blue,
}

fn painted(text: &str, paint: Paint, colours: bool) -> String {
    let code = match paint {
        Paint::Bold => 1,
        Paint::Dim => 2,
        Paint::Red => 31,
        Paint::Green => 32,
        Paint::Yellow => 33,
        Paint::Blue => 34,
    };
    if colours {
        format!("\x1b[{code}m{text}\x1b[0m")
    } else {
        text.to_owned()
    }
}

/// Prints the log as it arrives, and updates the bar.
pub struct Terminal {
    bar: ProgressBar,
    level: LogLevel,
    colours: bool,
    realtime: bool,
    interrupted: Arc<AtomicBool>,
    started: Instant,
}

impl Terminal {
    /// A run of `length`, which ends early once `interrupted` is true.
    pub fn new(length: Ps, level: LogLevel, realtime: bool, interrupted: Arc<AtomicBool>) -> Self {
        let bar = ProgressBar::with_draw_target(
            Some(length / time::MS),
            ProgressDrawTarget::stderr_with_hz(10),
        );
        let template = "{bar:40} {msg}";
        bar.set_style(
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()),
        );
        Self {
            bar,
            level,
            colours: std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none(),
            realtime,
            interrupted,
            started: Instant::now(),
        }
    }

    fn keep_pace(&self, at: Ps) {
        let due = Duration::from_secs_f64(time::to_seconds(at));
        if let Some(ahead) = due.checked_sub(self.started.elapsed()) {
            thread::sleep(ahead);
        }
    }

    /// Removes the bar and prints verdict, budgets, failures and files.
    pub fn conclude(&self, outcome: &Outcome) {
        self.bar.finish_and_clear();
        let summary = &outcome.summary;
        println!();
        self.print_budgets(outcome);
        for error in &summary.board_errors {
            let text = format!(
                "board error at {:.4} s ({}×): {}",
                error.at, error.count, error.message
            );
            println!("{}", painted(&text, Paint::Red, self.colours));
        }
        for error in &summary.allowed_board_errors {
            println!("allowed board error ({}×): {}", error.count, error.message);
        }
        for doubt in &summary.suspicions {
            let text = format!(
                "suspicious at {:.4} s ({}×): {}",
                doubt.at, doubt.count, doubt.message
            );
            println!("{}", painted(&text, Paint::Yellow, self.colours));
        }
        if let Some(why) = &summary.stopped {
            let text = format!("stopped at {:.4} s: {why}", summary.sim_seconds);
            println!("{}", painted(&text, Paint::Red, self.colours));
        }
        if self.ends_run() {
            println!(
                "ended by Ctrl-C at {:.3} s: {} expectations look past that and are not judged",
                summary.sim_seconds, outcome.result.left_out
            );
        }
        for verdict in &outcome.result.verdicts {
            self.print_failure(verdict);
        }
        if let Some(error) = &summary.attitude_error {
            println!(
                "attitude error (RMSE, {} samples): total {:.2}°, heading {:.2}°, inclination {:.2}°",
                error.samples,
                error.total_rmse_deg,
                error.heading_rmse_deg,
                error.inclination_rmse_deg
            );
        }
        for (bus, port) in &outcome.result.ports {
            println!(
                "{}: {} frames to the PC, {} dropped as it did not read; {} from it, {} refused as the bus was busy, {} malformed",
                bus_name(*bus),
                port.to_pc,
                port.dropped,
                port.from_pc,
                port.refused,
                port.malformed
            );
        }
        if let Some(link) = &outcome.result.link {
            println!(
                "PC link: {} bytes to the PC, {} dropped as it did not read; {} from it",
                link.to_pc, link.dropped, link.from_pc
            );
        }
        for file in &outcome.files {
            println!("wrote {}", file.display());
        }
        self.print_verdict(outcome);
    }

    fn print_budgets(&self, outcome: &Outcome) {
        let mut rows = outcome.summary.budgets.clone();
        if !self.realtime {
            rows.push(budgets::speed_budget(outcome.summary.wall.realtime_factor));
        }
        for Budget {
            name,
            limit,
            measured,
            ok,
        } in rows
        {
            let mark = if ok {
                painted("ok  ", Paint::Green, self.colours)
            } else {
                painted("over", Paint::Yellow, self.colours)
            };
            println!("  {mark}  {name:<20} {measured:>20}   (budget {limit})");
        }
    }

    fn print_failure(&self, verdict: &Verdict) {
        let Some(why) = &verdict.failure else { return };
        let window = if verdict.window.start == verdict.window.end {
            format!("at {} s", time::to_seconds(verdict.window.start))
        } else {
            format!(
                "from {} to {} s",
                time::to_seconds(verdict.window.start),
                time::to_seconds(verdict.window.end)
            )
        };
        let text = format!(
            "failed: {} {} {window}: {why}",
            verdict.signal, verdict.expected
        );
        println!("{}", painted(&text, Paint::Red, self.colours));
        if let Some(because) = &verdict.because {
            println!("        expected because {because}");
        }
    }

    fn print_verdict(&self, outcome: &Outcome) {
        let summary = &outcome.summary;
        let held = summary.expectations - summary.failed_expectations.len();
        let text = format!(
            "{}: {} of {} expectations held in {} s simulated ({:.1} s, {:.1} × real time): {}",
            summary.scenario,
            held,
            summary.expectations,
            summary.sim_seconds,
            summary.wall.wall_seconds,
            summary.wall.realtime_factor,
            if summary.ok { "PASS" } else { "FAIL" },
        );
        println!("{}", painted(&text, Paint::Bold, self.colours));
    }
}

fn bus_name(bus: CanBusId) -> &'static str {
    match bus {
        CanBusId::Can1 => "CAN1",
        CanBusId::Can2 => "CAN2",
    }
}

impl Observer for Terminal {
    fn can_port(&mut self, bus: CanBusId, device: &CanDevice) {
        let bus = bus_name(bus);
        let tools = match device {
            CanDevice::Terminal(_) => {
                format!("robotctl status --can {device}, slcand, or any slcan tool, 1 Mbit/s (S8)")
            }
            CanDevice::Gateway(..) => format!("13 bytes a frame; robotctl status --can {device}"),
        };
        let text = format!("{bus} on {device}: {tools}");
        self.bar.suspend(|| println!("{text}"));
    }

    fn link_port(&mut self, device: &Path) {
        let device = device.display();
        let text = format!(
            "PC link on {device}: robotctl status --link {device}, or any program, 460800 8N1"
        );
        self.bar.suspend(|| println!("{text}"));
    }

    fn ends_run(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    fn sample(&mut self, at: Ps, _: &SignalTable, _: &Values) {
        if self.realtime {
            self.keep_pace(at);
        }
        if at.is_multiple_of(20 * time::MS) {
            let simulated = time::to_seconds(at);
            let factor = simulated / self.started.elapsed().as_secs_f64().max(1e-9);
            self.bar.set_position(at / time::MS);
            self.bar
                .set_message(format!("{simulated:.2} s  {factor:.1} × real time"));
        }
    }

    fn log(&mut self, line: &LogLine) {
        let level = LogLevel::of(line);
        if level < self.level {
            return;
        }
        let tag = painted(
            &format!("{:<5}", line.level.to_uppercase()),
            level.colour(),
            self.colours,
        );
        let text = format!("{:>11.6} {tag} {}", time::to_seconds(line.at), line.text);
        self.bar.suspend(|| println!("{text}"));
    }
}
