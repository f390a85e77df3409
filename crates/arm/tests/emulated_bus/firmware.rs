//! An arm with two firmwares. The emulated servos have one, so that an answer is changed on its way.

use std::time::Duration;

use robot_arm::{
    bus::{ServoBus, Wire, WireError},
    calibration::Calibration,
    controller::{Mismatch, ServoController, Warning},
};

use crate::wire::Emulated;

/// Servo 2 says that its firmware is 3.9.
struct OldFirmware {
    line: Emulated,
    asks_for_firmware: bool,
}

impl OldFirmware {
    fn change(answers: &mut [u8]) {
        let starts = answers
            .windows(3)
            .position(|bytes| bytes == [0xFF, 0xFF, 2]);
        let Some(answer) = starts.map(|start| &mut answers[start..]) else {
            return;
        };
        // Header, id, length, status, major, minor.
        answer[6] = 9;
        let last = usize::from(answer[3]) + 3;
        let sum: u32 = answer[2..last].iter().map(|byte| u32::from(*byte)).sum();
        answer[last] = 255 - (sum % 256) as u8;
    }
}

impl Wire for OldFirmware {
    fn name(&self) -> &str {
        self.line.name()
    }

    fn now(&self) -> Duration {
        self.line.now()
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), WireError> {
        // A sync read from the register 0 on.
        self.asks_for_firmware = bytes[4..6] == [0x82, 0];
        self.line.send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Duration) -> Result<usize, WireError> {
        let mut count = self.line.receive(buffer, deadline)?;
        if self.asks_for_firmware && count > 0 {
            // All answers are waited for, to change one in their middle.
            let until = self.line.now() + Duration::from_millis(2);
            while self.line.now() < until {
                count += self.line.receive(&mut buffer[count..], until)?;
            }
            Self::change(&mut buffer[..count]);
        }
        Ok(count)
    }

    fn set_baud(&mut self, bps: u32) -> Result<(), WireError> {
        self.line.set_baud(bps)
    }

    fn reopen(&mut self) -> Result<(), WireError> {
        self.line.reopen()
    }
}

/// lerobot #1010: servos of one arm have firmware 3.9 and 3.10. They work, and it is said.
#[test]
fn different_firmware_is_a_warning() {
    let line = OldFirmware {
        line: Emulated::arm(60),
        asks_for_firmware: false,
    };
    let bus = ServoBus::new(Box::new(line), 1_000_000);
    let mut arm = ServoController::new(bus, Calibration::so101()).unwrap();
    let versions = "3.10, 3.9".to_owned();
    let wanted = Warning::Mismatch(Mismatch::Firmware { versions });
    assert_eq!(arm.take_warnings(), [wanted]);
    assert_eq!(arm.read_servo_positions().unwrap().len(), 6);
}
