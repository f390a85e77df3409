//! Poses in which the robot is released.

use super::{
    FreeBody, Start, Vec2, Vec3,
    model::{Model, SIDES},
    motion::Motion,
    parts::Leg,
};
use nalgebra::UnitQuaternion;

/// Upright with the tyres at a height above level ground, centre of mass above the axles, legs at the middle of their range.
pub(super) fn upright(model: &Model, height_m: f64) -> Motion {
    let length_m = (model.leg_m[0] + model.leg_m[1]) / 2.0;
    let hips = balanced_hips(model, length_m);
    let axle = model.bar.at(hips).axle;
    Motion {
        position: Vec3::new(-axle.x, 0.0, height_m + model.disc.radius_m - axle.y),
        attitude: UnitQuaternion::identity(),
        velocity: Vec3::zeros(),
        rate: Vec3::zeros(),
        hip_rad: [hips; SIDES],
        hip_rps: Default::default(),
        wheel_rad: [0.0; SIDES],
        wheel_rps: [0.0; SIDES],
    }
}

/// Hip angles of a leg of the given length that put the axle below the centre of mass of a level body.
fn balanced_hips(model: &Model, length_m: f64) -> [f64; 2] {
    let mut forward_m = 0.0;
    let mut hips = [0.0; 2];
    // The legs weigh little, so that the axle's place settles at once.
    for _ in 0..20 {
        let down_m = (length_m * length_m - forward_m * forward_m)
            .max(0.0)
            .sqrt();
        match model.bar.hips_for(Vec2::new(forward_m, -down_m)) {
            Some(found) => hips = found,
            None => break,
        }
        forward_m = com_forward_m(model, hips);
    }
    hips
}

/// Centre of mass of everything, along x of the body.
fn com_forward_m(model: &Model, hips: [f64; 2]) -> f64 {
    let mut mass_kg = model.body_kg;
    let mut moment = model.body_kg * model.body_com.x;
    for side in 0..SIDES {
        for part in &Leg::at(model, side, hips).parts {
            mass_kg += part.mass_kg;
            moment += part.mass_kg * part.place.x;
        }
    }
    moment / mass_kg
}

/// Puts the robot into its pose at the start.
pub(super) fn place(body: &mut FreeBody, start: Start) {
    match start {
        Start::Dropped { height_m } => body.motion = upright(&body.model, height_m),
        _ => body.motion = upright(&body.model, 0.0),
    }
}
