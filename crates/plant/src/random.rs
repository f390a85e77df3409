//! Seeded random numbers. Each device has a stream of its own, so that one more draw leaves the other devices as they were.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

/// The device that draws. The discriminant is the generator's stream.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stream {
    Accel = 1,
    Gyro = 2,
    Magnetometer = 3,
    RadioLine = 4,
    LeftMotor = 5,
    RightMotor = 6,
    SpiGarbage = 7,
    RadioLosses = 8,
    Flash = 9,
    LinkDown = 10,
    LinkUp = 11,
    LinkFlood = 12,
    PcExtremes = 13,
    Plates = 14,
}

/// PCG XSL 128/64: the same seed and stream give the same numbers on every machine.
#[derive(Clone, Debug)]
pub(crate) struct Random(Pcg64);

impl Random {
    pub(crate) fn new(seed: u64, stream: Stream) -> Self {
        let mut generator = Pcg64::new(u128::from(seed), stream as u128);
        // Neighbouring seeds start with nearly equal states; a few steps spread them.
        generator.advance(1 << 40);
        Self(generator)
    }

    pub(crate) fn byte(&mut self) -> u8 {
        self.0.random()
    }

    pub(crate) fn word(&mut self) -> u32 {
        self.0.random()
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0.random()
    }

    /// Uniform in [−half, half).
    pub(crate) fn symmetric(&mut self, half: f64) -> f64 {
        (2.0 * self.unit() - 1.0) * half
    }

    /// Uniform in 0 … `below` − 1.
    pub(crate) fn below(&mut self, below: u32) -> u32 {
        self.0.random_range(0..below)
    }

    /// Standard normal.
    pub(crate) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }
}
