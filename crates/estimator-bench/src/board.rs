//! The loop that runs a filter on the board.

use core::{f32::consts::FRAC_1_SQRT_2, hint::black_box, panic::PanicInfo};

use cortex_m::asm::{bkpt, udf};
// The workspace's settings for the board name its linker script.
use defmt as _;

use crate::mailbox::{Input, MAILBOX};

/// An attitude filter under test.
pub trait Filter {
    /// Input of the filter.
    type Taken;

    /// Converts the input into the filter's own types. This does not count.
    fn take(&mut self, input: &Input) -> Self::Taken;

    /// Does one tick of 1 ms. Only this counts.
    fn step(&mut self, taken: &Self::Taken);

    /// Returns the attitude from body to ENU after the last step, w first. This does not count.
    fn q_wxyz(&self) -> [f32; 4];
}

/// Serves the mailbox in an endless loop.
pub fn run<F: Filter>(mut filter: F) -> ! {
    // The host writes the input, which the compiler cannot see. It must not conclude that the input stays zero.
    let mailbox = black_box(&MAILBOX);
    link_memory_functions();
    loop {
        bkpt();
        let taken = filter.take(&mailbox.input());
        counted(&mut filter, &taken);
        mailbox.answer(filter.q_wxyz());
    }
}

/// The compiler's functions that copy and clear memory. Each program has them, also the one without a filter, so that
/// they do not count as a part of any filter.
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

/// The new samples of one tick, for filters that take no time stamps.
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

/// Distinguishes new samples from old ones.
#[derive(Default)]
pub struct NewSampleDetector {
    imu_ts_us: u32,
    mag_ts_us: u32,
}

impl NewSampleDetector {
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

/// Converts an attitude in a world whose x axis points north into ENU.
pub fn north_to_east([w, x, y, z]: [f32; 4]) -> [f32; 4] {
    [w - z, x - y, x + y, w + z].map(|part| part * FRAC_1_SQRT_2)
}

#[panic_handler]
fn panicked(_: &PanicInfo<'_>) -> ! {
    udf()
}
