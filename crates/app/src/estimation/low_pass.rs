//! Second-order Butterworth low-pass of several channels.

use core::f32::consts::SQRT_2;

/// Starts as the running mean of its first time constant, then filters.
///
/// Bilinear form with two trapezoidal integrators: unlike the textbook difference equation it keeps its zero-frequency
/// gain in single precision even when the time constant is hundreds of samples long.
#[derive(Clone, Debug)]
pub(super) struct LowPass<const N: usize> {
    gains: Gains,
    channels: [Channel; N],
    mean_samples: u16,
    seen: u16,
}

#[derive(Clone, Copy, Debug)]
struct Gains {
    a1: f32,
    a2: f32,
    a3: f32,
}

/// `smooth` is the output; `slope` the second integrator.
#[derive(Clone, Copy, Debug, Default)]
struct Channel {
    slope: f32,
    smooth: f32,
    output: f32,
}

impl<const N: usize> LowPass<N> {
    /// `time_constant_s` as in the VQF paper: cut-off at √2/(2π·τ); at least 2.4 samples long.
    pub fn new(time_constant_s: f32, sample_s: f32) -> Self {
        // tan(x) by its series, to 3e-5 of itself for x ≤ 0.3.
        let x = SQRT_2 / time_constant_s * sample_s / 2.0;
        let x2 = x * x;
        let g = x * (1.0 + x2 / 3.0 * (1.0 + x2 * 0.4));
        let a1 = 1.0 / (1.0 + g * (g + SQRT_2));
        Self {
            gains: Gains {
                a1,
                a2: g * a1,
                a3: g * g * a1,
            },
            channels: [Channel::default(); N],
            mean_samples: (time_constant_s / sample_s) as u16,
            seen: 0,
        }
    }

    pub fn reset(&mut self) {
        self.seen = 0;
        self.channels = [Channel::default(); N];
    }

    pub fn feed(&mut self, input: [f32; N]) -> [f32; N] {
        if self.seen < self.mean_samples {
            self.seen = self.seen.saturating_add(1);
            let share = 1.0 / f32::from(self.seen);
            for (channel, value) in self.channels.iter_mut().zip(input) {
                channel.average(value, share);
            }
        } else {
            let gains = self.gains;
            for (channel, value) in self.channels.iter_mut().zip(input) {
                channel.filter(value, gains);
            }
        }
        self.output()
    }

    pub fn output(&self) -> [f32; N] {
        self.channels.map(|channel| channel.output)
    }
}

impl Channel {
    fn average(&mut self, value: f32, share: f32) {
        self.output += share * (value - self.output);
        self.smooth = self.output;
    }

    fn filter(&mut self, value: f32, gains: Gains) {
        let difference = value - self.smooth;
        let slope = gains.a1 * self.slope + gains.a2 * difference;
        self.output = self.smooth + gains.a2 * self.slope + gains.a3 * difference;
        self.slope = 2.0 * slope - self.slope;
        self.smooth = 2.0 * self.output - self.smooth;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Step response of the analogue second-order Butterworth filter, computed in double precision.
    #[test]
    fn a_step_is_followed_like_the_analogue_filter() {
        let (tau, sample_s) = (3.0, 0.005);
        let mut filter = LowPass::<1>::new(tau, sample_s);
        for _ in 0..2_000 {
            filter.feed([9.0]);
        }
        let corner = f64::from(SQRT_2 / tau);
        for step in 1..=6_000 {
            let [got] = filter.feed([10.0]);
            let s = corner * f64::from(step) * f64::from(sample_s) / f64::from(SQRT_2);
            let expected = 10.0 - (-s).exp() * (s.cos() + s.sin());
            assert!(
                (f64::from(got) - expected).abs() < 2e-3,
                "{step}: {got} {expected}"
            );
        }
        assert!((filter.output()[0] - 10.0).abs() < 1e-4);
    }

    #[test]
    fn the_first_samples_are_averaged() {
        let mut filter = LowPass::<1>::new(0.5, 0.005);
        assert_eq!(filter.feed([4.0]), [4.0]);
        assert_eq!(filter.feed([6.0]), [5.0]);
    }
}
