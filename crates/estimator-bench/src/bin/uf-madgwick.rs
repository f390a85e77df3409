//! Madgwick's filter of the crate `uf-ahrs`, with its own settings. Each step takes the latest field: it knows no other way to fuse
//! a slower magnetometer.

#![no_std]
#![no_main]

use core::time::Duration;

use estimator_bench::{
    board::{self, Filter, Fresh, Samples},
    mailbox::Input,
};
use nalgebra::Vector3;
use uf_ahrs::{Ahrs, Madgwick, MadgwickParams};

struct UfMadgwick {
    filter: Madgwick,
    mag_ut: Vector3<f32>,
    fresh: Fresh,
}

impl Filter for UfMadgwick {
    type Taken = Samples;

    fn take(&mut self, input: &Input) -> Samples {
        self.fresh.samples(input)
    }

    fn step(&mut self, taken: &Samples) {
        let Some(imu) = taken.imu else { return };
        if let Some(mag_ut) = taken.mag_ut {
            self.mag_ut = mag_ut.into();
        }
        self.filter
            .update(imu.gyro_rps.into(), imu.accel_mps2.into(), self.mag_ut);
    }

    fn q_wxyz(&self) -> [f32; 4] {
        let q = self.filter.orientation();
        board::north_to_east([q.w, q.i, q.j, q.k])
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    board::run(UfMadgwick {
        filter: Madgwick::new(Duration::from_millis(5), MadgwickParams::default()),
        mag_ut: Vector3::zeros(),
        fresh: Fresh::default(),
    })
}
