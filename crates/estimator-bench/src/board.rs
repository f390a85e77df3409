//! The loop around a filter.

use core::{f32::consts::FRAC_1_SQRT_2, hint::black_box, panic::PanicInfo};

use cortex_m::asm::{bkpt, udf};
// Its linker script is asked for by the workspace's settings for the board.
use defmt as _;

use crate::mailbox::{Input, MAILBOX};

/// An attitude filter under test.
pub trait Filter {
    /// What the filter is fed with.
    type Taken;

    /// Brings the input into the filter's own types; not counted.
    fn take(&mut self, input: &Input) -> Self::Taken;

    /// One tick of 1 ms; this is what counts.
    fn step(&mut self, taken: &Self::Taken);

    /// Body → ENU after the last step, w first; not counted.
    fn q_wxyz(&self) -> [f32; 4];
}

/// Serves the mailbox for ever.
pub fn run<F: Filter>(mut filter: F) -> ! {
    // The compiler sees nobody write the input, and must not conclude that it stays zero.
    let mailbox = black_box(&MAILBOX);
    link_memory_functions();
    loop {
        bkpt();
        let taken = filter.take(&mailbox.input());
        counted(&mut filter, &taken);
        mailbox.answer(filter.q_wxyz());
    }
}

/// The compiler's functions that copy and clear memory are in every image, also in one without a filter: each program has
/// them, so that none counts as a part of its filter.
#[inline(never)]
fn link_memory_functions() {
    let mut words = black_box([1_u32; 64]);
    let mut doubles = black_box([1_u64; 64]);
    let copy = black_box(words);
    words.fill(0);
    doubles.fill(0);
    black_box((&words, &doubles, &copy));
}

#[inline(never)]
fn counted<F: Filter>(filter: &mut F, taken: &F::Taken) {
    filter.step(taken);
}

/// New samples of one tick, for filters that know no time.
#[derive(Clone, Copy, Default)]
pub struct Samples {
    pub imu: Option<ImuSample>,
    pub mag_ut: Option<[f32; 3]>,
}

#[derive(Clone, Copy)]
pub struct ImuSample {
    pub gyro_rps: [f32; 3],
    pub accel_mps2: [f32; 3],
}

/// Tells new samples from old ones.
#[derive(Default)]
pub struct Fresh {
    imu_ts_us: u32,
    mag_ts_us: u32,
}

impl Fresh {
    pub fn samples(&mut self, input: &Input) -> Samples {
        let new_imu = input.imu_ts_us != self.imu_ts_us;
        let new_mag = input.mag_ts_us != self.mag_ts_us;
        self.imu_ts_us = input.imu_ts_us;
        self.mag_ts_us = input.mag_ts_us;
        Samples {
            imu: new_imu.then_some(ImuSample {
                gyro_rps: input.gyro_rps,
                accel_mps2: input.accel_mps2,
            }),
            mag_ut: new_mag.then_some(input.mag_ut),
        }
    }
}

/// Attitude in a world whose x axis points north → in ENU.
pub fn north_to_east([w, x, y, z]: [f32; 4]) -> [f32; 4] {
    [w - z, x - y, x + y, w + z].map(|part| part * FRAC_1_SQRT_2)
}

#[panic_handler]
fn panicked(_: &PanicInfo<'_>) -> ! {
    udf()
}
