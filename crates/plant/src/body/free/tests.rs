//! Mechanics against hand calculation.

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
