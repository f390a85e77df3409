//! Comes back after the plug was pulled.

use std::{
    sync::atomic::Ordering,
    thread,
    time::{Duration, Instant},
};

use super::{ControllerError, Ending, ServoController, torque::Torque};

/// Time between two looks for the port.
const LOOK_EVERY: Duration = Duration::from_millis(200);

impl ServoController {
    /// Waits for a lost port, opens it, and checks the servos again. They have held their last goals meanwhile, unless they had no
    /// power: such a servo has no torque, and gets it back with [`enable_torque`](Self::enable_torque), which moves nothing. With
    /// [`Ending::Release`] torque goes off at once.
    pub fn reconnect(&mut self, at_most: Duration) -> Result<(), ControllerError> {
        let until = Instant::now() + at_most;
        while let Err(last) = self.bus.reopen() {
            if self.stop.load(Ordering::Relaxed) {
                return Err(ControllerError::Stopped);
            }
            if Instant::now() >= until {
                return Err(ControllerError::NotBack {
                    port: self.bus.port().to_owned(),
                    seconds: at_most.as_secs(),
                    last: Box::new(last),
                });
            }
            thread::sleep(LOOK_EVERY);
        }
        for joint in &mut self.joints {
            // Whatever fails here, the next reading looks for the joint's torque.
            joint.is_missing = true;
        }
        self.check_servos()?;
        if self.has_torque() && self.ending == Ending::Release {
            return self.release();
        }
        for place in 0..self.joints.len() {
            if self
                .joints
                .get(place)
                .is_some_and(|joint| joint.torque == Torque::On)
            {
                self.look_for_torque(place)?;
            }
        }
        Ok(())
    }
}
