//! How hard a robot that is too fast brakes.

use crate::math::scalar;

/// Largest speed error in m/s that counts.
const MOST_MPS: f32 = 2.15;
/// All of it counts up to a braking lean of this less the span, in rad, and from this lean on only the least share. Legs that
/// lean further do not hold the hips up.
const BRAKING_RAD: f32 = 0.81;
const SPAN_RAD: f32 = 0.21;
const LEAST: f32 = 0.55;
/// Time in s over which the present rate of lean counts.
const AHEAD_S: f32 = 0.063;
/// Where wheels have slipped by more than this, up to so much more, in m/s, there is less grip: the lean is smaller by this in rad
/// for each m/s.
const GRIPS_MPS: f32 = 0.2;
const MOST_SLIP_MPS: f32 = 0.54;
const LESS_RAD_PER_MPS: f32 = 0.73;

/// The part that counts of the error of speed in m/s of a robot that leans by so much beyond its reference, and whose wheels have
/// slipped by so much of late.
pub fn counted_mps(off_mps: f32, lean_rad: f32, lean_rps: f32, slipped_mps: f32) -> f32 {
    let soon_rad = lean_rad + AHEAD_S * lean_rps;
    let braking_rad = if off_mps > 0.0 { -soon_rad } else { soon_rad };
    let slipped_mps = scalar::clamp(slipped_mps - GRIPS_MPS, 0.0, MOST_SLIP_MPS);
    let most_rad = BRAKING_RAD - LESS_RAD_PER_MPS * slipped_mps;
    let share = scalar::clamp((most_rad - braking_rad) / SPAN_RAD, LEAST, 1.0);
    scalar::clamp(off_mps, -MOST_MPS * share, MOST_MPS * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_that_leans_back_brakes_no_harder() {
        for forward in [1.0, -1.0] {
            let counted =
                |lean_rad: f32| forward * counted_mps(forward * 3.0, forward * lean_rad, 0.0, 0.0);
            assert_eq!(counted(0.3), MOST_MPS);
            assert_eq!(counted(-0.4), MOST_MPS);
            assert!(counted(0.5 * SPAN_RAD - BRAKING_RAD) < MOST_MPS);
            assert_eq!(counted(-BRAKING_RAD), LEAST * MOST_MPS);
        }
        assert_eq!(counted_mps(0.2, -0.5, 0.0, 0.0), 0.2);
    }

    #[test]
    fn a_robot_that_is_about_to_lean_back_brakes_no_harder() {
        for forward in [1.0, -1.0] {
            let counted = |lean_rps: f32| {
                forward * counted_mps(forward * 3.0, forward * -0.5, forward * lean_rps, 0.0)
            };
            assert_eq!(counted(0.0), MOST_MPS);
            assert_eq!(counted(3.0), MOST_MPS);
            assert!(counted(-4.0) < MOST_MPS);
        }
    }

    #[test]
    fn on_little_grip_it_brakes_with_less_lean() {
        let counted = |slipped_mps| counted_mps(3.0, -0.5, 0.0, slipped_mps);
        assert_eq!(counted(0.1), MOST_MPS);
        assert_eq!(counted(0.8), LEAST * MOST_MPS);
    }
}
