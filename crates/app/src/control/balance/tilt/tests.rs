use super::*;

/// A body that is turned by yaw, then pitch, then roll about its own axes.
fn turned(yaw: f32, pitch: f32, roll: f32) -> Quaternion {
    let about = |axis: Vector3, angle: f32| {
        Quaternion::from_rotation(vector::scale(axis, angle * 0.5))
            .after(Quaternion::from_rotation(vector::scale(axis, angle * 0.5)))
    };
    about([0.0, 0.0, 1.0], yaw)
        .after(about([0.0, 1.0, 0.0], pitch))
        .after(about([1.0, 0.0, 0.0], roll))
}

#[test]
fn pitch_and_roll_are_those_of_single_turns() {
    for angle in [-2.5_f32, -1.2, -0.1, 0.0, 0.4, 1.5, 3.0] {
        let tilt = Tilt::new(turned(0.7, angle, 0.0), [0.0; 3]);
        assert!((tilt.pitch_rad - angle).abs() < 1e-4, "{angle} {tilt:?}");
        assert!(tilt.roll_rad.abs() < 1e-5);
    }
    for angle in [-1.2_f32, -0.1, 0.4, 1.5] {
        let tilt = Tilt::new(turned(0.7, 0.0, angle), [0.0; 3]);
        assert!((tilt.roll_rad - angle).abs() < 1e-3, "{angle} {tilt:?}");
        assert!(tilt.pitch_rad.abs() < 1e-3);
    }
}

/// The rates are those of the angles while the body turns on.
#[test]
fn rates_are_those_of_the_angles() {
    const STEP_S: f32 = 1e-2;
    for (yaw, pitch, roll) in [(0.0, 0.3, 0.2), (1.0, -0.5, 0.4), (2.0, 0.1, -0.6)] {
        let rate_rps = [0.4, -0.7, 1.1];
        let here = turned(yaw, pitch, roll);
        let step = |seconds| {
            let turn = Quaternion::from_rotation(vector::scale(rate_rps, seconds));
            Tilt::new(here.after(turn), rate_rps)
        };
        let (before, after) = (step(-STEP_S), step(STEP_S));
        let now = Tilt::new(here, rate_rps);
        let slope = |a: f32, b: f32| (b - a) / (2.0 * STEP_S);
        let pitch_rps = slope(before.pitch_rad, after.pitch_rad);
        let roll_rps = slope(before.roll_rad, after.roll_rad);
        assert!((now.pitch_rps - pitch_rps).abs() < 1e-3, "{now:?}");
        assert!((now.roll_rps - roll_rps).abs() < 1e-3, "{now:?}");
    }
}

/// A robot that leans right while it turns left does not pitch, although its lateral gyro feels a part of the turn.
#[test]
fn a_turn_of_a_leaning_robot_is_no_pitch() {
    let leaning = turned(0.0, 0.0, 0.1);
    let up = Tilt::new(leaning, [0.0; 3]).up;
    let tilt = Tilt::new(leaning, vector::scale(up, 8.0));
    assert!(tilt.pitch_rps.abs() < 1e-3 && tilt.roll_rps.abs() < 1e-3);
    assert!((tilt.yaw_rps - 8.0).abs() < 1e-3);
}
