//! A board and a program that wait for each other: each state of the robot is answered by a command.

use robot_plant::link_frames::{DOWN_LEN, Scanner, UP_LEN};

/// Follows both directions of the link.
#[derive(Default)]
pub struct Lockstep {
    states: Scanner<UP_LEN>,
    commands: Scanner<DOWN_LEN>,
    /// The program has sent a command, and has not hung or left since.
    is_in_step: bool,
    /// A state has no answer yet.
    is_owed: bool,
}

impl Lockstep {
    /// Takes a byte of the board.
    pub fn board_sends(&mut self, byte: u8) {
        self.is_owed |= self.states.take(byte).is_some();
    }

    /// Takes a byte of the program.
    pub fn program_sends(&mut self, byte: u8) {
        if self.commands.take(byte).is_some() {
            self.is_in_step = true;
            self.is_owed = false;
        }
    }

    /// Returns whether the board waits for the program.
    pub fn waits(&self) -> bool {
        self.is_in_step && self.is_owed
    }

    /// Returns whether a program takes part.
    pub fn is_in_step(&self) -> bool {
        self.is_in_step
    }

    /// Goes on without the program, until it sends a command again.
    pub fn give_up(&mut self) {
        self.is_in_step = false;
    }
}
