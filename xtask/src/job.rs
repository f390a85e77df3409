//! Builds that run side by side, shown as one status line instead of interleaved output.

mod missing_dependency;

use std::{
    fs::{self, File},
    io::{IsTerminal, Write, stderr},
    path::PathBuf,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use anyhow::{Context, anyhow};

use crate::workspace;

/// How long a build may be silent on a terminal that cannot redraw a line.
const PLAIN_STATUS_EVERY: Duration = Duration::from_secs(20);
const POLL_EVERY: Duration = Duration::from_millis(100);
/// A build shorter than this was up to date and is not worth a line.
const WORTH_A_LINE: Duration = Duration::from_secs(2);
const LOG_TAIL_LINES: usize = 60;

pub struct Job {
    pub name: String,
    pub command: Command,
}

struct Running {
    name: String,
    child: Child,
    log: PathBuf,
    started: Instant,
}

/// Runs all jobs to their end. If one fails, the others are stopped. The message says what the job lacks or, where that
/// is not known, shows the end of its output.
pub fn run_all(jobs: Vec<Job>) -> anyhow::Result<()> {
    let mut running = Vec::new();
    for job in jobs {
        running.push(start(job)?);
    }
    let mut status = Status::new();
    while !running.is_empty() {
        let mut unfinished = Vec::new();
        let mut failed = None;
        for mut job in running {
            match job.child.try_wait()? {
                None => unfinished.push(job),
                Some(exit) if exit.success() => status.finished(&job),
                Some(_) => failed = Some(job),
            }
        }
        running = unfinished;
        if let Some(failed) = failed {
            status.clear();
            end(&mut running);
            return Err(failure(&failed)?);
        }
        status.show(&running);
        thread::sleep(POLL_EVERY);
    }
    status.clear();
    Ok(())
}

fn end(running: &mut [Running]) {
    for job in running {
        // It may have ended by itself meanwhile.
        job.child.kill().ok();
        job.child.wait().ok();
    }
}

fn failure(job: &Running) -> anyhow::Result<anyhow::Error> {
    let output = fs::read_to_string(&job.log)?;
    let (name, log) = (&job.name, job.log.display());
    Ok(if let Some(advice) = missing_dependency::advice(&output) {
        anyhow!("building {name} failed: {advice}\n(whole output: {log})")
    } else {
        eprintln!("{}", tail(&output));
        anyhow!("building {name} failed (whole output: {log})")
    })
}

fn start(mut job: Job) -> anyhow::Result<Running> {
    fs::create_dir_all(workspace::log_dir()).context("cannot create the folder for logs")?;
    let log = workspace::log_dir().join(format!("{}.log", job.name));
    let output = File::create(&log).with_context(|| format!("cannot write {}", log.display()))?;
    let child = job
        .command
        .stdin(Stdio::null())
        .stdout(output.try_clone()?)
        .stderr(output)
        .spawn()
        .with_context(|| format!("cannot start the build of the {}", job.name))?;
    Ok(Running {
        name: job.name,
        child,
        log,
        started: Instant::now(),
    })
}

fn tail(output: &str) -> String {
    let lines: Vec<_> = output.lines().collect();
    let from = lines.len().saturating_sub(LOG_TAIL_LINES);
    lines.get(from..).unwrap_or_default().join("\n")
}

/// Shows the status: one redrawn line on a terminal, a line now and then elsewhere.
struct Status {
    redraws: bool,
    last_shown: Instant,
}

impl Status {
    fn new() -> Self {
        Self {
            redraws: stderr().is_terminal(),
            last_shown: Instant::now(),
        }
    }

    fn show(&mut self, running: &[Running]) {
        let due = self.redraws || self.last_shown.elapsed() >= PLAIN_STATUS_EVERY;
        if running.is_empty() || !due {
            return;
        }
        self.last_shown = Instant::now();
        let parts: Vec<_> = running
            .iter()
            .map(|job| format!("{} ({} s)", job.name, job.started.elapsed().as_secs()))
            .collect();
        self.clear();
        eprint!("building {}", parts.join(", "));
        if !self.redraws {
            eprintln!();
        }
        stderr().flush().ok();
    }

    fn finished(&mut self, job: &Running) {
        let took = job.started.elapsed();
        if took >= WORTH_A_LINE {
            self.clear();
            eprintln!("built {} in {} s", job.name, took.as_secs());
        }
    }

    fn clear(&self) {
        if self.redraws {
            eprint!("\r\x1b[2K");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(name: &str, program: &str, arguments: &[&str]) -> Job {
        let mut command = Command::new(program);
        command.args(arguments);
        Job {
            name: name.to_owned(),
            command,
        }
    }

    /// Returns a program of this system that does not end by itself.
    const ENDLESS: (&str, &[&str]) = if cfg!(windows) {
        ("ping", &["-t", "localhost"])
    } else {
        ("sleep", &["1000"])
    };

    #[test]
    fn a_failed_job_stops_the_others_and_is_named() {
        let jobs = vec![
            job("test-endless", ENDLESS.0, ENDLESS.1),
            job("test-broken", "rustc", &["no-such-file.rs"]),
        ];
        let error = run_all(jobs).expect_err("rustc fails");
        assert!(error.to_string().contains("test-broken"), "{error}");
    }
}
