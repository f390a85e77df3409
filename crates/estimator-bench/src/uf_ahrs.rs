//! The filters of the crate `uf-ahrs` that take all sensors in one step.

use nalgebra::Vector3;
use uf_ahrs::Ahrs;

use crate::{
    board::{self, Filter, NewSampleDetector, Samples},
    mailbox::Input,
};

/// Passes the latest field to each step: these filters have no other way to fuse a slower magnetometer.
pub struct AllInOne<F> {
    filter: F,
    mag_ut: Vector3<f32>,
    fresh: NewSampleDetector,
}

impl<F> AllInOne<F> {
    pub fn new(filter: F) -> Self {
        Self {
            filter,
            mag_ut: Vector3::zeros(),
            fresh: NewSampleDetector::default(),
        }
    }
}

impl<F: Ahrs> Filter for AllInOne<F> {
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
