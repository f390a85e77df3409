//! Detects that the robot has fallen over, or is falling.

use super::debounce::Debounce;
use crate::{
    domain::{SafetyConfig, StateEstimate},
    math::scalar::sin_cos_small,
};

/// A knock tilts the estimate for a moment.
const HOLD_US: u32 = 50_000;
/// The smallest limit that settings allow is 0.1 rad; this is sin² of half of that, rounded down. A robot within it, as
/// nearly always, needs no closer look.
const UPRIGHT: f32 = 0.002_49;

#[derive(Clone, Debug, Default)]
pub(super) struct FallDetector {
    tilted: Debounce,
}

impl FallDetector {
    /// Returns whether the robot has fallen. An invalid estimate never says so.
    pub fn fallen(&mut self, estimate: &StateEstimate, config: &SafetyConfig, dt_us: u32) -> bool {
        self.beyond(estimate, config.max_tilt_rad, HOLD_US, dt_us)
    }

    /// The same for a robot that balances. It comes earlier, so that no torque is left at the impact.
    pub fn topples(&mut self, estimate: &StateEstimate, config: &SafetyConfig, dt_us: u32) -> bool {
        self.beyond(
            estimate,
            config.max_balance_tilt_rad,
            config.balance_tilt_us,
            dt_us,
        )
    }

    fn beyond(&mut self, estimate: &StateEstimate, max_rad: f32, hold_us: u32, dt_us: u32) -> bool {
        let upright = within(estimate, max_rad);
        self.tilted.held(estimate.valid && !upright, dt_us, hold_us)
    }
}

/// Whether the body's z axis is within `max_tilt_rad` of vertical: x² + y² of the quaternion is sin² of half that
/// angle. False for NaN.
fn within(estimate: &StateEstimate, max_tilt_rad: f32) -> bool {
    let [_, x, y, _] = estimate.q_wxyz;
    let sin_half_squared = x * x + y * y;
    if sin_half_squared <= UPRIGHT {
        return true;
    }
    // Half the limit is computed as twice a quarter, so the series stays in its range up to a limit of π.
    let (sin, cos) = sin_cos_small(max_tilt_rad / 4.0);
    let sin_half = 2.0 * sin * cos;
    sin_half_squared <= sin_half * sin_half
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tilted_by(tilt_rad: f32, heading_rad: f32) -> StateEstimate {
        let (half_tilt, half_heading) = (tilt_rad / 2.0, heading_rad / 2.0);
        // A heading about z follows a tilt about y.
        let (tilt_sin, tilt_cos) = half_tilt.sin_cos();
        let (heading_sin, heading_cos) = half_heading.sin_cos();
        StateEstimate {
            q_wxyz: [
                heading_cos * tilt_cos,
                -heading_sin * tilt_sin,
                heading_cos * tilt_sin,
                heading_sin * tilt_cos,
            ],
            valid: true,
            ..StateEstimate::default()
        }
    }

    /// Calls the detector every 10 ms.
    fn falls_after_ms(estimate: &StateEstimate, max_tilt_rad: f32) -> Option<u32> {
        let config = SafetyConfig {
            max_tilt_rad,
            ..SafetyConfig::default()
        };
        let mut watch = FallDetector::default();
        (10..1_000)
            .step_by(10)
            .find(|_| watch.fallen(estimate, &config, 10_000))
    }

    #[test]
    fn the_tilt_limit_is_independent_of_heading() {
        for heading_rad in [-3.0, -1.0, 0.0, 0.5, 2.0] {
            for limit_rad in [0.2, 0.9, 1.6, 3.0] {
                let at = |tilt_rad| falls_after_ms(&tilted_by(tilt_rad, heading_rad), limit_rad);
                assert_eq!(at(limit_rad - 0.01), None, "{limit_rad}");
                assert_eq!(at(limit_rad + 0.01), Some(50), "{limit_rad}");
                assert_eq!(at(-limit_rad - 0.01), Some(50), "{limit_rad}");
            }
        }
    }

    #[test]
    fn nan_counts_as_fallen_and_an_invalid_estimate_does_not() {
        let mut estimate = tilted_by(2.0, 0.0);
        estimate.valid = false;
        assert_eq!(falls_after_ms(&estimate, 0.9), None);
        let nan = StateEstimate {
            q_wxyz: [f32::NAN; 4],
            valid: true,
            ..StateEstimate::default()
        };
        assert_eq!(falls_after_ms(&nan, 0.9), Some(50));
    }

    #[test]
    fn a_knock_does_not_count_as_a_fall() {
        let (config, mut watch) = (SafetyConfig::default(), FallDetector::default());
        for _ in 0..20 {
            let knock = tilted_by(2.0, 0.0);
            assert!((0..4).all(|_| !watch.fallen(&knock, &config, 10_000)));
            assert!(!watch.fallen(&tilted_by(0.0, 0.0), &config, 10_000));
        }
    }
}
