//! The PC link on a pseudo-terminal, as a USB-to-serial adapter at the 4-pin UART2.

use std::{io, path::Path};

use robot_plant::{time::Ps, world::World};

use super::terminal::Terminal;

/// Limit of bytes that wait for a program that reads too slowly, 90 ms of a full line.
const WAITING: usize = 4 * 1024;

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
}

impl LinkPort {
    pub fn open() -> io::Result<Self> {
        Ok(Self {
            terminal: Terminal::open()?,
            arrived: Vec::new(),
            waiting: Vec::new(),
            stats: LinkStats::default(),
        })
    }

    /// The device that a program opens.
    pub fn path(&self) -> &Path {
        self.terminal.path()
    }

    pub fn stats(&self) -> LinkStats {
        self.stats
    }

    /// Takes as many bytes of the PC as the adapter accepts, and passes on what the board sent. It never waits. What the
    /// board sends while no program has the device open is lost, as with a real one.
    pub fn serve(&mut self, world: &mut World, now: Ps) -> io::Result<()> {
        let adapter = world.serial_adapter();
        if !adapter.plugged() {
            adapter.set_plugged(true);
        }
        let room = adapter.room() as u64;
        self.terminal.read(&mut self.arrived, room)?;
        adapter.send(&self.arrived, now);
        self.arrived.clear();
        self.stats.from_pc = adapter.sent();
        let read = self.terminal.is_open()?;
        while let Some((_, byte)) = adapter.take() {
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
