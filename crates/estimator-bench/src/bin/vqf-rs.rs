//! VQF of the crate `vqf-rs`, in single precision, with its own settings and the magnetometer at 50 Hz.

#![no_std]
#![no_main]

use robot_estimator_bench::{
    board::{self, Filter, NewSampleDetector, Samples},
    mailbox::Input,
};
use vqf_rs::{Quaternion, VQF};

struct VqfRs {
    filter: VQF,
    orientation: Quaternion,
    fresh: NewSampleDetector,
}

impl Filter for VqfRs {
    type Taken = Samples;

    fn take(&mut self, input: &Input) -> Samples {
        self.fresh.samples(input)
    }

    fn step(&mut self, taken: &Samples) {
        let Some(imu) = taken.imu else { return };
        self.filter
            .update(imu.gyro_rps, imu.accel_mps2, taken.mag_ut);
        self.orientation = self.filter.quat_9d();
    }

    fn q_wxyz(&self) -> [f32; 4] {
        let Quaternion(w, x, y, z) = self.orientation;
        [w, x, y, z]
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    board::run(VqfRs {
        filter: VQF::new(0.005, None, Some(0.02), None),
        orientation: Quaternion(1.0, 0.0, 0.0, 0.0),
        fresh: NewSampleDetector::default(),
    })
}
