//! Random numbers that are the same in every run and on every machine.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use crate::Vector;

/// A seeded generator (PCG XSL 128/64).
#[derive(Clone, Debug)]
pub struct Random(Pcg64);

impl Random {
    /// The same seed gives the same numbers.
    pub fn new(seed: u64) -> Self {
        const STREAM: u128 = 0xA02B_DBF7_BB3C_0A7A_C28F_A16A_64AB_F96E;
        let mut generator = Pcg64::new(u128::from(seed), STREAM);
        // Neighbouring seeds start with nearly equal states; a few steps spread them.
        generator.advance(1 << 40);
        Self(generator)
    }

    /// Any 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0.random()
    }

    /// Any byte.
    pub fn byte(&mut self) -> u8 {
        self.0.random()
    }

    /// Uniform in 0 … 1, without 1.
    pub fn unit(&mut self) -> f64 {
        self.0.random()
    }

    /// Uniform in `low` … `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in 0 … `count` − 1.
    pub fn below(&mut self, count: usize) -> usize {
        self.0.random_range(0..count)
    }

    /// Normal with mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// A vector whose parts are normal with mean 0 and this standard deviation.
    pub fn vector(&mut self, deviation: f64) -> Vector {
        std::array::from_fn(|_| deviation * self.normal())
    }
}
