//! VQF of the crate `uf-ahrs`, with its own settings and the magnetometer at 50 Hz.

#![no_std]
#![no_main]

use core::time::Duration;

use nalgebra::{UnitQuaternion, Vector3};
use robot_estimator_bench::{
    board::{self, Filter, NewSampleDetector, Samples},
    mailbox::Input,
};
use uf_ahrs::{Vqf, VqfParams};

struct UfVqf {
    filter: Vqf,
    orientation: UnitQuaternion<f32>,
    fresh: NewSampleDetector,
}

impl Filter for UfVqf {
    type Taken = Samples;

    fn take(&mut self, input: &Input) -> Samples {
        self.fresh.samples(input)
    }

    fn step(&mut self, taken: &Samples) {
        let Some(imu) = taken.imu else { return };
        self.filter
            .update2(imu.gyro_rps.into(), imu.accel_mps2.into());
        if let Some(mag_ut) = taken.mag_ut {
            self.filter.magnetometer_update(Vector3::from(mag_ut));
        }
        self.orientation = self.filter.heading_orientation();
    }

    fn q_wxyz(&self) -> [f32; 4] {
        let q = self.orientation;
        board::north_to_east([q.w, q.i, q.j, q.k])
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let (imu, mag) = (Duration::from_millis(5), Duration::from_millis(20));
    board::run(UfVqf {
        filter: Vqf::new_with_sensor_rates(imu, imu, mag, VqfParams::default()),
        orientation: UnitQuaternion::identity(),
        fresh: NewSampleDetector::default(),
    })
}
