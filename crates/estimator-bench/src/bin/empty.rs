//! A program without a filter. Its size is subtracted from that of the others.

#![no_std]
#![no_main]

use robot_estimator_bench::{
    board::{self, Filter, NewSampleDetector, Samples},
    mailbox::Input,
};

#[derive(Default)]
struct Empty {
    fresh: NewSampleDetector,
    last: Samples,
}

impl Filter for Empty {
    type Taken = Samples;

    fn take(&mut self, input: &Input) -> Samples {
        self.fresh.samples(input)
    }

    fn step(&mut self, taken: &Samples) {
        self.last = *taken;
    }

    fn q_wxyz(&self) -> [f32; 4] {
        let [x, y, z] = self.last.mag_ut.unwrap_or_default();
        [self.last.imu.map_or(1.0, |imu| imu.gyro_rps[0]), x, y, z]
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    board::run(Empty::default())
}
