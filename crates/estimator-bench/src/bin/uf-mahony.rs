//! Mahony's filter of the crate `uf-ahrs`, with its own settings.

#![no_std]
#![no_main]

use core::time::Duration;

use estimator_bench::{
    board::{self, Filter, Fresh, Samples},
    mailbox::Input,
};
use nalgebra::Vector3;
use uf_ahrs::{Ahrs, Mahony, MahonyParams};

struct UfMahony {
    filter: Mahony,
    fresh: Fresh,
}

impl Filter for UfMahony {
    type Taken = Samples;

    fn take(&mut self, input: &Input) -> Samples {
        self.fresh.samples(input)
    }

    fn step(&mut self, taken: &Samples) {
        let Some(imu) = taken.imu else { return };
        let (gyro, accel) = (Vector3::from(imu.gyro_rps), Vector3::from(imu.accel_mps2));
        match taken.mag_ut {
            Some(mag) => self.filter.update(gyro, accel, Vector3::from(mag)),
            None => self.filter.update_imu(gyro, accel),
        };
    }

    fn q_wxyz(&self) -> [f32; 4] {
        let q = self.filter.orientation();
        [q.w, q.i, q.j, q.k]
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    board::run(UfMahony {
        filter: Mahony::new(Duration::from_millis(5), MahonyParams::default()),
        fresh: Fresh::default(),
    })
}
