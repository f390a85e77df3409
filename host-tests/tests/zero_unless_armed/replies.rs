//! Replies of the joints on their way to the board, and their possible interpretations.

use crate::wire::{Make, Motion};

/// Replies arrive one tick later.
pub struct Replies {
    make: Make,
    under_way: Vec<(u16, [u8; 8])>,
    /// For each joint, the last reply that is certainly a report, and the later ones that may be reports.
    believable: [Vec<Motion>; 4],
    faults: [bool; 4],
}

impl Replies {
    pub fn new(make: Make) -> Self {
        Self {
            make,
            under_way: Vec::new(),
            believable: Default::default(),
            faults: [false; 4],
        }
    }

    pub fn extend(&mut self, reply: Option<(u16, [u8; 8])>) {
        self.under_way.extend(reply);
    }

    pub fn take(&mut self) -> Vec<(u16, [u8; 8])> {
        std::mem::take(&mut self.under_way)
    }

    /// Takes every frame on the joints' bus, whatever its sender.
    pub fn note(&mut self, id: u16, data: &[u8]) {
        let Ok(data) = <[u8; 8]>::try_from(data) else {
            return;
        };
        for joint in 0..4 {
            let number = joint as u8 + 1;
            let (mine, status) = match self.make {
                Make::Dm4310 => (
                    id == 0x10 + u16::from(number) && data[0] & 0x0F == number,
                    data[0] >> 4,
                ),
                Make::Rs00 => (id == 0xF0 + u16::from(number) && data[0] == number, 2),
            };
            if !mine {
                continue;
            }
            let may_be_register = data[1] == 0 && (data[2] == 0x33 || data[2] == 0x55);
            if status < 2 && !may_be_register {
                self.believable[joint].clear();
            }
            self.believable[joint].push(self.make.motion(data));
            // This is enough to hold the last certain report of a motor that replies in each tick.
            if self.believable[joint].len() > 400 {
                self.believable[joint].remove(0);
            }
            self.faults[joint] = (8..=14).contains(&status);
        }
    }

    pub fn believable(&self, joint: usize) -> &[Motion] {
        &self.believable[joint]
    }

    /// Whether the last reply of a DM4310 reported a fault.
    pub fn has_reported_fault(&self) -> bool {
        self.faults.contains(&true)
    }
}
