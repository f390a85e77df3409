//! Mechanics against hand calculation.

mod course;
mod flight;
mod ground;
mod legs;

use super::*;
use std::path::Path;

const DT_S: f64 = 250e-6;
const G: f64 = STANDARD_GRAVITY_MPS2;

fn robot() -> Robot {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/fivebar.toml");
    Robot::read(&file).unwrap_or_else(|error| panic!("{error}"))
}

fn free(start: Start) -> FreeBody {
    FreeBody::new(
        &robot(),
        &FreeSetup {
            start,
            ..FreeSetup::default()
        },
    )
}

fn run(body: &mut FreeBody, seconds: f64, inputs: impl Fn(&FreeBody) -> FreeInputs) {
    for _ in 0..(seconds / DT_S).round() as usize {
        let inputs = inputs(body);
        body.step(&inputs, DT_S);
    }
}

/// Friction of motors without supply.
const LIMP: FreeInputs = FreeInputs {
    wheel_nm: [0.0; 2],
    joint_nm: [0.0; 4],
    wheel_dry_nm: 0.1,
    wheel_viscous_nm_per_rps: 0.0,
    joint_dry_nm: 0.15,
    joint_viscous_nm_per_rps: 0.0,
    push: None,
    grip: 1.0,
};
/// Hips that nothing turns.
const LOCKED: FreeInputs = FreeInputs {
    wheel_dry_nm: 0.0,
    joint_dry_nm: 200.0,
    ..LIMP
};

/// A robot that does not fall over within a test, since its body hardly turns.
fn cart(terrain: Terrain, ground_friction: f64) -> FreeBody {
    let mut robot = robot();
    robot.body.inertia_kgm2 = [1e7; 3];
    let setup = FreeSetup {
        start: Start::Standing,
        terrain,
        variation: Variation {
            ground_friction,
            ..Variation::default()
        },
        ..FreeSetup::default()
    };
    let mut cart = FreeBody::new(&robot, &setup);
    run(&mut cart, 0.3, |_| LOCKED);
    cart
}

/// Height of the axle on level ground: the tyre gives 0.8 mm.
fn radius_m(cart: &FreeBody) -> f64 {
    cart.model.disc.radius_m - 0.8e-3
}
