//! The PC link on a pseudo-terminal, as a USB-to-serial adapter at the 4-pin UART2.

use std::{
    io,
    path::Path,
    thread,
    time::{Duration, Instant},
};

use robot_plant::{time::Ps, world::World};
use robot_pseudo_terminal::Terminal;

use super::lockstep::Lockstep;

/// Limit of bytes that wait for a program that reads too slowly, 90 ms of a full line.
const WAITING: usize = 4 * 1024;
/// A program in lockstep that takes longer for its answer hangs, and the board goes on without it.
const PATIENCE: Duration = Duration::from_secs(10);
/// The least time that a served millisecond takes without a program in lockstep: nobody has missed the run before he comes.
const IDLE: Duration = Duration::from_millis(1);
/// Whether such a program is still there is looked at this often.
const LOOK_AGAIN: Duration = Duration::from_millis(100);

/// Bytes between the board and the PC since power-on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct LinkStats {
    pub to_pc: u64,
    pub from_pc: u64,
    /// Bytes received while the program on the PC did not read.
    pub dropped: u64,
}

/// The PC's end of the link. The speed that a program sets does not matter: the line has that of the link.
pub struct LinkPort {
    terminal: Terminal,
    /// Bytes of the PC that the adapter has not accepted yet.
    arrived: Vec<u8>,
    waiting: Vec<u8>,
    stats: LinkStats,
    lockstep: Option<Lockstep>,
}

impl LinkPort {
    /// Creates the device. `lockstep` lets the board wait for the program's answer to each state, once the program has sent
    /// a command: then neither the program's speed nor the emulator's makes a difference.
    pub fn open(lockstep: bool) -> io::Result<Self> {
        Ok(Self {
            terminal: Terminal::open()?,
            arrived: Vec::new(),
            waiting: Vec::new(),
            stats: LinkStats::default(),
            lockstep: lockstep.then(Lockstep::default),
        })
    }

    /// The device that a program opens.
    pub fn path(&self) -> &Path {
        self.terminal.path()
    }

    pub fn stats(&self) -> LinkStats {
        self.stats
    }

    /// Takes as many bytes of the PC as the adapter accepts, and passes on what the board sent. It never waits, except in
    /// lockstep. What the board sends while no program has the device open is lost, as with a real one.
    pub fn serve(&mut self, world: &mut World, now: Ps) -> io::Result<()> {
        self.exchange(world, now)?;
        if self.lockstep.as_ref().is_some_and(|it| !it.is_in_step()) {
            thread::sleep(IDLE);
        }
        let until = Instant::now() + PATIENCE;
        while self.lockstep.as_ref().is_some_and(Lockstep::waits) {
            if !self.terminal.is_open()? || Instant::now() > until {
                self.lockstep.iter_mut().for_each(Lockstep::give_up);
                break;
            }
            self.terminal.wait(LOOK_AGAIN)?;
            self.exchange(world, now)?;
        }
        Ok(())
    }

    fn exchange(&mut self, world: &mut World, now: Ps) -> io::Result<()> {
        let adapter = world.serial_adapter();
        if !adapter.plugged() {
            adapter.set_plugged(true);
        }
        let room = adapter.room() as u64;
        self.terminal.read(&mut self.arrived, room)?;
        adapter.send(&self.arrived, now);
        if let Some(lockstep) = &mut self.lockstep {
            self.arrived
                .iter()
                .for_each(|byte| lockstep.program_sends(*byte));
        }
        self.arrived.clear();
        self.stats.from_pc = adapter.sent();
        let read = self.terminal.is_open()?;
        while let Some((_, byte)) = adapter.take() {
            if let Some(lockstep) = &mut self.lockstep {
                lockstep.board_sends(byte);
            }
            if read && self.waiting.len() < WAITING {
                self.waiting.push(byte);
            } else if read {
                self.stats.dropped += 1;
            }
        }
        if !read {
            self.waiting.clear();
            return Ok(());
        }
        let written = self.terminal.write(&self.waiting)?;
        self.waiting.drain(..written);
        self.stats.to_pc += written as u64;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
