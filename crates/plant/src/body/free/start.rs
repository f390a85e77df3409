//! Poses in which the robot is released.

use super::{
    FreeBody, FreeInputs, Start, Vec2, Vec3,
    model::{Model, SIDES},
    motion::Motion,
    parts::{Leg, lift},
};
use crate::physics::physics_step_s;
use nalgebra::UnitQuaternion;
use robot_description::LINK_RADIUS_M;
use std::f64::consts::{FRAC_PI_2, PI};

/// Pitch from which the robot sinks onto its front edge.
const SITTING_RAD: f64 = 0.3;
/// Pitch from which a robot that fell forward or backward comes to rest.
const TIPPED_RAD: f64 = 1.2;
/// Height above the ground from which it sinks.
const RELEASED_FROM_M: f64 = 1e-3;
/// Rest is taken for reached when no speed, in m/s and rad/s, exceeded this in a tenth of a second, or after five seconds.
const STILL: f64 = 1e-3;
const STILL_STEPS: u32 = 400;
const MOST_STEPS: u32 = 20_000;

/// Upright with the tyres at a height above level ground and the centre of mass above the axles.
pub(super) fn upright(model: &Model, height_m: f64, length_m: f64) -> Motion {
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
    let model = body.model;
    let middle_m = (model.leg_m[0] + model.leg_m[1]) / 2.0;
    // Limp legs fold under the robot's weight. On its side they do not, and on folded ones it would roll onto its top.
    let on_side = matches!(start, Start::Left | Start::Right);
    let length_m = if on_side { middle_m } else { model.leg_m[0] };
    body.motion = upright(&model, 0.0, length_m);
    let (roll, pitch) = match start {
        Start::Standing => {
            body.motion = upright(&model, 0.0, middle_m);
            return;
        }
        Start::Dropped { height_m } => {
            body.motion = upright(&model, height_m, middle_m);
            return;
        }
        Start::Folded => return,
        Start::Sitting => (0.0, SITTING_RAD),
        Start::Front => (0.0, TIPPED_RAD),
        Start::Back => (0.0, -TIPPED_RAD),
        Start::Left => (-side_rad(body), 0.0),
        Start::Right => (side_rad(body), 0.0),
        Start::UpsideDown => (PI, 0.0),
    };
    body.motion.attitude = UnitQuaternion::from_euler_angles(roll, pitch, 0.0);
    body.motion.position = Vec3::new(0.0, 0.0, -lowest_m(body) + RELEASED_FROM_M);
    come_to_rest(body);
}

/// Roll at which the robot rests on its side: the first hollow of its potential energy past 60°, or 90° where there is none.
fn side_rad(body: &mut FreeBody) -> f64 {
    let mut height_m = |roll_rad: f64| {
        body.motion.attitude = UnitQuaternion::from_euler_angles(roll_rad, 0.0, 0.0);
        body.com_m()[2] - body.motion.position.z - lowest_m(body)
    };
    let rolls = (0..150).map(|step| PI / 3.0 + 0.01 * f64::from(step));
    let mut rows = rolls.map(|roll_rad| (roll_rad, height_m(roll_rad)));
    let Some(mut last) = rows.next() else {
        return FRAC_PI_2;
    };
    let mut sinking = false;
    for row in rows {
        if sinking && row.1 > last.1 {
            return last.0;
        }
        sinking = row.1 < last.1;
        last = row;
    }
    FRAC_PI_2
}

/// Height of the lowest point against the body's origin.
fn lowest_m(body: &FreeBody) -> f64 {
    let model = &body.model;
    let up = body.motion.to_body(Vec3::z());
    let mut lowest_m = f64::INFINITY;
    let mut take = |place: Vec3, radius_m: f64| {
        lowest_m = lowest_m.min(place.dot(&up) - radius_m);
    };
    for bumper in model.bumpers {
        take(bumper.place, bumper.radius_m);
    }
    for leg in body.legs() {
        take(leg.wheel().place, model.disc.radius_m);
        for knee in leg.linkage.knee {
            take(
                Vec3::new(0.0, leg.parts[0].place.y, 0.0) + lift(knee),
                LINK_RADIUS_M,
            );
        }
    }
    lowest_m
}

/// Lets the robot sink on the friction of its motors until it lies still, and takes it back to the start of the course.
fn come_to_rest(body: &mut FreeBody) {
    let friction = FreeInputs {
        joint_dry_nm: 0.15,
        joint_viscous_nm_per_rps: 0.1,
        wheel_dry_nm: 0.02,
        wheel_viscous_nm_per_rps: 0.05,
        ..FreeInputs::default()
    };
    let mut still_for = 0;
    for _ in 0..MOST_STEPS {
        body.step(&friction, physics_step_s());
        still_for = if body.motion.fastest() < STILL {
            still_for + 1
        } else {
            0
        };
        if still_for == STILL_STEPS {
            break;
        }
    }
    let position = &mut body.motion.position;
    (position.x, position.y) = (0.0, 0.0);
    body.motion.stop();
}
