//! A body on legs that balance it.

use super::*;

/// A filter that has rested, level and without a gyro bias.
fn rested() -> AttitudeFilter {
    let mut filter = AttitudeFilter::new();
    for _ in 0..4_000 {
        assert!(feed(&mut filter, 0.0, 0.0));
    }
    filter
}

/// A sample of a body that pitches at `pitch_rps`, and whose force tells of this pitch.
fn feed(filter: &mut AttitudeFilter, pitch_rps: f32, pitch_rad: f32) -> bool {
    let (sin, cos) = pitch_rad.sin_cos();
    let force_mps2 = [-GRAVITY_MPS2 * sin, 0.0, GRAVITY_MPS2 * cos];
    filter.feed_imu([0.0, pitch_rps, 0.0], force_mps2, NEVER, DT_S as f32)
}

/// Legs pitch a body at 0.25 °/s, which on the ground could only be a gyro bias.
#[test]
fn a_body_on_legs_that_turns_slowly_has_no_gyro_bias() {
    let bias_dps = |footing| {
        let mut filter = rested();
        filter.set_footing(footing);
        let rate_rps = 0.25 * DEG;
        for sample in 0..1_200 {
            feed(
                &mut filter,
                rate_rps,
                rate_rps * sample as f32 * DT_S as f32,
            );
        }
        let [_, y_rps, _] = filter.bias_rps();
        y_rps.to_degrees()
    };
    let [any, legs, standing] = [Footing::Any, Footing::Legs, Footing::StandingLegs].map(bias_dps);
    assert!(any > 0.1, "{any}");
    assert!(
        legs.abs() < 0.02 && standing.abs() < 0.02,
        "{legs} {standing}"
    );
}

/// An accelerometer with an offset feels another horizon when the body stands up than when it sat.
#[test]
fn standing_wheels_show_most_of_the_horizon_in_two_seconds() {
    let pitch_rad = |footing| {
        let mut filter = rested();
        filter.set_footing(footing);
        for _ in 0..400 {
            feed(&mut filter, 0.0, 0.02);
        }
        let [_, pitch_rad, _] = filter.orientation(0.0).roll_pitch_yaw();
        pitch_rad
    };
    let [legs, standing] = [Footing::Legs, Footing::StandingLegs].map(pitch_rad);
    assert!((0.012..0.021).contains(&standing), "{standing}");
    assert!(legs < 0.4 * standing, "{legs}");
}

/// Standing up and rolling leave an error of velocity. It is that of the legs and the wheels, not of the horizon.
#[test]
fn wheels_that_come_to_stand_show_no_other_horizon() {
    let mut filter = rested();
    filter.set_footing(Footing::Legs);
    for _ in 0..400 {
        let force_mps2 = [0.15, 0.0, GRAVITY_MPS2];
        assert!(filter.feed_imu([0.0; 3], force_mps2, NEVER, DT_S as f32));
    }
    let pitch_rad = |filter: &AttitudeFilter| {
        let [_, pitch_rad, _] = filter.orientation(0.0).roll_pitch_yaw();
        pitch_rad
    };
    let rolling_rad = pitch_rad(&filter);
    filter.set_footing(Footing::StandingLegs);
    let most_rad = (0..120).fold(0.0_f32, |most_rad, _| {
        feed(&mut filter, 0.0, 0.0);
        most_rad.max(pitch_rad(&filter).abs())
    });
    assert!(
        most_rad < rolling_rad.abs() + 0.001,
        "{most_rad} {rolling_rad}"
    );
}
