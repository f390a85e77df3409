//! Tells the robot's state from damaged bytes whose CRC fits by chance.

use robot_app::link::{Sticks, Uplink};

/// A stick at its end is at 1; some transmitters go to 1.3.
const STICK: f32 = 1.5;
/// The sensor's ranges are 24 g and 2000 degrees/s.
const ACCEL_MPS2: f32 = 1_000.0;
const GYRO_RPS: f32 = 100.0;
/// Three years.
const TIME_S: f32 = 1e8;

/// Returns false for values that no robot sends. NaN is one.
pub(super) fn is_plausible(state: &Uplink) -> bool {
    let Sticks { lx, rx, ly, l2, ry } = state.sticks;
    let all_within = |values: &[f32], limit: f32| values.iter().all(|value| value.abs() <= limit);
    (0.0..TIME_S).contains(&state.time_s)
        && all_within(&state.accel_mps2, ACCEL_MPS2)
        && all_within(&state.gyro_rps, GYRO_RPS)
        && all_within(&[lx, rx, ly, l2, ry], STICK)
        && is_attitude(&state.q_xyzw)
}

/// A unit quaternion, or all zeros before there is an attitude.
fn is_attitude(q_xyzw: &[f32; 4]) -> bool {
    let square: f32 = q_xyzw.iter().map(|value| value * value).sum();
    square == 0.0 || (0.9..=1.1).contains(&square.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_no_robot_sends_are_told_apart() {
        let sent = Uplink {
            time_s: 3_600.0,
            accel_mps2: [0.0, 0.0, 9.8],
            q_xyzw: [0.0, 0.0, 0.6, 0.8],
            sticks: Sticks {
                ry: -1.25,
                ..Sticks::default()
            },
            ..Uplink::default()
        };
        assert!(is_plausible(&sent));
        assert!(
            is_plausible(&Uplink::default()),
            "before the first attitude"
        );
        let wrong: [fn(&mut Uplink); 7] = [
            |state| state.time_s = f32::NAN,
            |state| state.time_s = -1.0,
            |state| state.sticks.lx = 1.6,
            |state| state.sticks.l2 = f32::NAN,
            |state| state.q_xyzw = [0.0, 0.0, 0.6, 1.1],
            |state| state.accel_mps2[1] = f32::INFINITY,
            |state| state.gyro_rps[2] = 1e9,
        ];
        for (number, damage) in wrong.iter().enumerate() {
            let mut state = sent;
            damage(&mut state);
            assert!(!is_plausible(&state), "{number}");
        }
    }
}
