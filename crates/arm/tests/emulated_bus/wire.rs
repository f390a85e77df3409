//! The emulated bus as a line of the driver.

use std::{
    sync::{Arc, Mutex, MutexGuard},
    time::Duration,
};

use robot_arm::{
    bus::{ServoBus, Wire, WireError},
    calibration::Calibration,
    controller::ServoController,
};
use robot_servo_model::{Bus, Servo, Version, View, VirtualWire};

/// A bus that the test reaches beside the driver.
#[derive(Clone)]
pub struct Emulated {
    wire: Arc<Mutex<VirtualWire>>,
    is_unplugged: Arc<Mutex<bool>>,
}

impl Emulated {
    pub fn new(servos: Vec<Servo>, seed: u64) -> Self {
        Self {
            wire: Arc::new(Mutex::new(VirtualWire::new(Bus::new(servos, seed)))),
            is_unplugged: Arc::default(),
        }
    }

    /// Six servos with ids 1 to 6 and no return delay, as calibrated arms have them, at angles of their own.
    pub fn arm(seed: u64) -> Self {
        let servo = |id: u8| {
            let angle = 1800.0 + 70.0 * f64::from(id);
            Servo::new(Version::Volts12, angle)
                .with_id(id)
                .with_return_delay(0)
        };
        Self::new((1..=6).map(servo).collect(), seed)
    }

    pub fn wire(&self) -> MutexGuard<'_, VirtualWire> {
        self.wire.lock().unwrap()
    }

    pub fn view(&self) -> Vec<View> {
        self.wire().bus().view()
    }

    /// Pulls the plug of the adapter, or puts it back.
    pub fn unplug(&self, is_unplugged: bool) {
        *self.is_unplugged.lock().unwrap() = is_unplugged;
    }

    pub fn bus(&self) -> ServoBus {
        ServoBus::new(Box::new(self.clone()), 1_000_000)
    }

    pub fn controller(&self) -> ServoController {
        ServoController::new(self.bus(), Calibration::so101()).unwrap()
    }

    fn check(&self) -> Result<(), WireError> {
        match *self.is_unplugged.lock().unwrap() {
            false => Ok(()),
            true => Err(WireError::Lost {
                port: self.name().to_owned(),
                source: std::io::ErrorKind::BrokenPipe.into(),
            }),
        }
    }
}

impl Wire for Emulated {
    fn name(&self) -> &str {
        "emulated"
    }

    fn now(&self) -> Duration {
        Duration::from_nanos(self.wire().now_ns())
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), WireError> {
        self.check()?;
        self.wire().write(bytes);
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Duration) -> Result<usize, WireError> {
        self.check()?;
        let mut wire = self.wire();
        let Some((first, others)) = buffer.split_first_mut() else {
            return Ok(0);
        };
        let deadline = u64::try_from(deadline.as_nanos()).unwrap();
        if wire.read(std::slice::from_mut(first), deadline) == 0 {
            return Ok(0);
        }
        let now = wire.now_ns();
        Ok(1 + wire.read(others, now))
    }

    fn set_baud(&mut self, bps: u32) -> Result<(), WireError> {
        self.wire().set_baud(bps);
        Ok(())
    }

    fn reopen(&mut self) -> Result<(), WireError> {
        self.check()
    }
}
