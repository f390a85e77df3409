//! Second-order Butterworth low-pass in place of the dies' digital filters, which are not documented.

/// A biquad by the bilinear transform, with an exact 3 dB point, for three axes.
#[derive(Clone, Debug)]
pub(super) struct LowPass {
    b: [f64; 3],
    a: [f64; 2],
    state: [[f64; 2]; 3],
    settled: bool,
}

impl LowPass {
    /// `cutoff_hz` is the −3 dB frequency, below half of `rate_hz`.
    pub(super) fn new(cutoff_hz: f64, rate_hz: f64) -> Self {
        let k = (std::f64::consts::PI * cutoff_hz / rate_hz).tan();
        let norm = 1.0 / (1.0 + std::f64::consts::SQRT_2 * k + k * k);
        let b0 = k * k * norm;
        Self {
            b: [b0, 2.0 * b0, b0],
            a: [
                2.0 * (k * k - 1.0) * norm,
                (1.0 - std::f64::consts::SQRT_2 * k + k * k) * norm,
            ],
            state: [[0.0; 2]; 3],
            settled: false,
        }
    }

    pub(super) fn step(&mut self, input: [f64; 3]) -> [f64; 3] {
        if !self.settled {
            self.settle(input);
        }
        let mut output = [0.0; 3];
        for ((x, y), state) in input.iter().zip(&mut output).zip(&mut self.state) {
            *y = self.b[0] * x + state[0];
            state[0] = self.b[1] * x - self.a[0] * *y + state[1];
            state[1] = self.b[2] * x - self.a[1] * *y;
        }
        output
    }

    /// Starts at the steady state of the first input, so that a filter switched on does not ramp up from zero.
    fn settle(&mut self, input: [f64; 3]) {
        for (x, state) in input.iter().zip(&mut self.state) {
            state[1] = (self.b[2] - self.a[1]) * x;
            state[0] = (self.b[1] - self.a[0]) * x + state[1];
        }
        self.settled = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gain_at(frequency_hz: f64, cutoff_hz: f64) -> f64 {
        let rate_hz = 4_000.0;
        let mut filter = LowPass::new(cutoff_hz, rate_hz);
        let mut peak: f64 = 0.0;
        for n in 0..8_000 {
            let phase = std::f64::consts::TAU * frequency_hz * f64::from(n) / rate_hz;
            let output = filter.step([phase.sin(), 0.0, 0.0])[0];
            if n > 4_000 {
                peak = peak.max(output.abs());
            }
        }
        peak
    }

    #[test]
    fn gain_is_3_db_down_at_the_cutoff_and_24_db_down_two_octaves_above() {
        assert!((gain_at(47.0, 47.0) - 0.7079).abs() < 0.005);
        // Butterworth: 1 / sqrt(1 + 4^4) = 0.0624, a little less through frequency warping.
        let far = gain_at(188.0, 47.0);
        assert!((0.055..0.064).contains(&far), "{far}");
    }

    #[test]
    fn constant_input_passes_from_the_first_sample() {
        let mut filter = LowPass::new(75.0, 4_000.0);
        for _ in 0..100 {
            assert!((filter.step([9.81, -1.0, 0.0])[0] - 9.81).abs() < 1e-9);
        }
    }
}
