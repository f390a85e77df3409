//! A bus on a pseudo-terminal, in real time: what programs take for a serial port with servos behind it.
//!
//! A thread keeps the bus at the time of the clock. Bytes of the program go onto the wire when they arrive here, one after the
//! other at the baud rate that the program has set, and no byte of a servo can be read before its last bit has passed. The host's
//! scheduler can only make them later.

use std::{
    fs, io,
    os::unix::fs::symlink,
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use robot_pseudo_terminal::Terminal;
use thiserror::Error;

use crate::bus::Bus;

/// Baud rate until a program sets another.
const DEFAULT_BAUD: u32 = 1_000_000;
/// Bytes taken from the program in one look.
const READ: u64 = 4096;
/// Bytes that wait for the program; more are lost, as in an adapter.
const WAITING: usize = 64 * 1024;
/// How long it sleeps while no program has the port open.
const IDLE: Duration = Duration::from_millis(2);
/// Bytes that are due within this time are passed on together.
const TOGETHER_NS: u64 = 100_000;

/// Why a port cannot be made.
#[derive(Debug, Error)]
pub enum PortError {
    /// The system has no pseudo-terminal for us.
    #[error("no pseudo-terminal: {0}; is /dev/pts mounted?")]
    Terminal(#[source] io::Error),
    /// Something else is where the link should be.
    #[error("{} is there already and is no link of an earlier run: choose another name, or remove it", .0.display())]
    Occupied(PathBuf),
    /// The link cannot be made.
    #[error("{}: {source}: choose a name in a folder that you can write to", .path.display())]
    Link {
        /// Where it should be.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

/// A serial port with a bus behind it, until it is dropped.
pub struct Port {
    device: PathBuf,
    link: Option<PathBuf>,
    bus: Arc<Mutex<Bus>>,
    stop: Arc<AtomicBool>,
    stall_ns: Arc<AtomicU64>,
    served: Option<JoinHandle<()>>,
}

impl Port {
    /// Opens a pseudo-terminal and starts to serve it. The bus's time goes on from where it is.
    ///
    /// # Errors
    /// The system has no pseudo-terminal.
    pub fn open(bus: Bus) -> Result<Self, PortError> {
        let terminal = Terminal::open().map_err(PortError::Terminal)?;
        terminal
            .set_baud(DEFAULT_BAUD)
            .map_err(PortError::Terminal)?;
        let device = terminal.path().to_owned();
        let bus = Arc::new(Mutex::new(bus));
        let stop = Arc::new(AtomicBool::new(false));
        let stall_ns = Arc::new(AtomicU64::new(0));
        let mut server = Server {
            terminal,
            bus: Arc::clone(&bus),
            stop: Arc::clone(&stop),
            stall_ns: Arc::clone(&stall_ns),
            arrived: Vec::new(),
            waiting: Vec::new(),
        };
        let served = thread::spawn(move || server.run());
        Ok(Self {
            device,
            link: None,
            bus,
            stop,
            stall_ns,
            served: Some(served),
        })
    }

    /// As [`open`](Self::open), with a symbolic link at `link`, so that the port has the same name in every run. The link goes with
    /// the port; one that is left of an earlier run is replaced.
    ///
    /// # Errors
    /// The system has no pseudo-terminal, or the link cannot be made.
    pub fn open_at(bus: Bus, link: &Path) -> Result<Self, PortError> {
        let mut port = Self::open(bus)?;
        let failed = |source| PortError::Link {
            path: link.to_owned(),
            source,
        };
        match fs::symlink_metadata(link) {
            Ok(there) if there.is_symlink() => fs::remove_file(link).map_err(failed)?,
            Ok(_) => return Err(PortError::Occupied(link.to_owned())),
            Err(_) => {}
        }
        symlink(&port.device, link).map_err(failed)?;
        port.link = Some(link.to_owned());
        Ok(port)
    }

    /// Path that a program opens.
    pub fn path(&self) -> &Path {
        self.link.as_deref().unwrap_or(&self.device)
    }

    /// The longest time for which the computer had something else to do than the port. Answers were late by that much.
    pub fn longest_stall(&self) -> Duration {
        Duration::from_nanos(self.stall_ns.load(Ordering::Relaxed))
    }

    /// The bus, to start faults and look at servos. The port stands still as long as it is held.
    pub fn bus(&self) -> MutexGuard<'_, Bus> {
        self.bus.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Port {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(served) = self.served.take() {
            // A thread that panicked has said so; there is nothing else to do about it here.
            let _ = served.join();
        }
        if let Some(link) = &self.link {
            // Somebody may have removed it, which is what this wants.
            let _ = fs::remove_file(link);
        }
    }
}

struct Server {
    terminal: Terminal,
    bus: Arc<Mutex<Bus>>,
    stop: Arc<AtomicBool>,
    stall_ns: Arc<AtomicU64>,
    arrived: Vec<u8>,
    waiting: Vec<u8>,
}

impl Server {
    fn run(&mut self) {
        wake_in_time();
        let start = Instant::now();
        let start_ns = self.lock().now_ns();
        let clock_ns = || start_ns + start.elapsed().as_nanos() as u64;
        let mut wanted_ns = start_ns;
        while !self.stop.load(Ordering::Relaxed) {
            let now_ns = clock_ns();
            let late_ns = now_ns.saturating_sub(wanted_ns);
            self.stall_ns.fetch_max(late_ns, Ordering::Relaxed);
            let next_ns = match self.serve(now_ns) {
                Ok(next_ns) => next_ns,
                Err(error) => {
                    eprintln!("{}: {error}", self.terminal.path().display());
                    return;
                }
            };
            // Faults and views change what is due, so it never sleeps for long.
            let due_ns = next_ns.unwrap_or(u64::MAX);
            let sleep = Duration::from_nanos(due_ns.saturating_sub(clock_ns())).min(IDLE);
            if next_ns.is_some() {
                // What went wrong here goes wrong again when it reads, and is said there.
                let _ = self.terminal.wait(sleep);
            } else {
                thread::sleep(sleep);
            }
            wanted_ns = due_ns.clamp(now_ns, now_ns + IDLE.as_nanos() as u64);
        }
    }

    fn lock(&self) -> MutexGuard<'_, Bus> {
        self.bus.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Passes on what is due by `now_ns`. Returns when something is due next, or `None` if no program has the port open.
    fn serve(&mut self, now_ns: u64) -> io::Result<Option<u64>> {
        let is_open = self.terminal.is_open()?;
        self.arrived.clear();
        self.terminal.read(&mut self.arrived, READ)?;
        let baud = self.terminal.baud()?;
        let mut bus = self.bus.lock().unwrap_or_else(PoisonError::into_inner);
        bus.advance(now_ns);
        bus.set_host_baud(baud);
        bus.send(&self.arrived);
        while let Some((_, byte)) = bus.take_heard() {
            if self.waiting.len() < WAITING {
                self.waiting.push(byte);
            }
        }
        let together_ns = bus.quiet_ns().min(now_ns + TOGETHER_NS);
        let next_ns = bus.next_change_ns().unwrap_or(u64::MAX).max(together_ns);
        drop(bus);
        if !is_open {
            self.waiting.clear();
            return Ok(None);
        }
        let written = self.terminal.write(&self.waiting)?;
        self.waiting.drain(..written);
        Ok(Some(next_ns))
    }
}

/// Asks the system not to put off the end of a sleep to save power: by default that takes 50 µs, five bytes.
fn wake_in_time() {
    // Without it bytes come later, which no program may rely on.
    #[cfg(target_os = "linux")]
    let _ = rustix::thread::set_current_timer_slack(std::num::NonZeroU64::new(1));
}
