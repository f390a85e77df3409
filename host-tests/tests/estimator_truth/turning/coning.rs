//! Coning motion: no net rotation, but every gyro axis measures a rate all the time.

use robot_test_support::{Rotation, Vector};
use std::f64::consts::TAU;

use crate::{figures::Figures, motion::Motion, run::Run, sensors::Sensors};

/// Tilted by `half_angle_rad` about a level axis that rotates at `rate_rps`.
fn attitude(half_angle_rad: f64, rate_rps: f64, t: f64) -> Rotation {
    let (sin, cos) = (rate_rps * t).sin_cos();
    Rotation::by([half_angle_rad * cos, half_angle_rad * sin, 0.0])
}

/// Body rate of that motion: 2 q⁻¹ q̇, worked out by hand.
fn rate_dps(half_angle_rad: f64, rate_rps: f64, t: f64) -> Vector {
    let (sin, cos) = (rate_rps * t).sin_cos();
    let (sin_a, cos_a) = half_angle_rad.sin_cos();
    [
        -rate_rps * sin_a * sin,
        rate_rps * sin_a * cos,
        -rate_rps * (1.0 - cos_a),
    ]
    .map(f64::to_degrees)
}

fn coning(half_angle_deg: f64, hz: f64) -> Motion {
    let (half_angle_rad, rate_rps) = (half_angle_deg.to_radians(), TAU * hz);
    Motion::at_rest()
        .starting(attitude(half_angle_rad, rate_rps, 0.0))
        .turning(move |t| rate_dps(half_angle_rad, rate_rps, t))
}

/// Checks the simulation itself: its integrated attitude is the closed form of the motion.
#[test]
fn the_simulated_world_follows_the_closed_form() {
    for (half_angle_deg, hz) in [(2.0, 10.0), (30.0, 1.0)] {
        let mut world = crate::world::World::new(coning(half_angle_deg, hz), Sensors::ideal());
        world.advance_to(60_000_000);
        let truth = attitude(f64::to_radians(half_angle_deg), TAU * hz, 60.0);
        let off_deg = truth.inverse().then_in_body(world.attitude()).angle_deg();
        assert!(off_deg < 5e-3, "{half_angle_deg}° at {hz} Hz: {off_deg}°");
    }
}

/// Without a magnetometer only the gyro holds the heading. Adding the mean rates of 5 ms intervals as vectors loses ½
/// a² Ω (ΩT)²/6 (a: half angle, Ω: rate of the cone), 0.3° to 2° in a minute here. With the cross product of
/// neighbouring intervals (Bortz 1971, Savage 1998) it is a tenth of a degree. The tilt is off by half a sample's
/// rotation at first, up to 0.4°.
#[test]
fn coning_does_not_rotate_the_estimate() {
    let mut figures = Figures::default();
    for (half_angle_deg, hz) in [
        (2.0, 5.0),
        (5.0, 5.0),
        (10.0, 2.0),
        (30.0, 1.0),
        (60.0, 0.5),
    ] {
        let mut run = Run::new(coning(half_angle_deg, hz), Sensors::ideal().without_mag());
        run.skip(0.5);
        let settling = run.worst(10.0);
        let worst = run.worst(60.0);
        let name = format!("coning {half_angle_deg}° at {hz} Hz");
        figures.at_most(
            &format!("{name}, heading drift in °"),
            settling.heading_drift_deg + worst.heading_drift_deg,
            0.1,
        );
        figures.at_most(
            &format!("{name}, inclination in °"),
            worst.inclination_deg,
            0.1,
        );
    }
    figures.done();
}
