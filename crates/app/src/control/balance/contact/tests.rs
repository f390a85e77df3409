use super::*;
use crate::{
    control::balance::{tilt::Tilt, virtual_leg::LegForce},
    domain::robots::FIVEBAR,
    math::Quaternion,
};

const TICK_S: f32 = 0.001;

/// Upright on legs that carry their share of this specific force, while the body pitches at this rate.
fn measured(up_mps2: f32, pitch_rps: f32) -> Measured {
    let rest = Measured::at_rest();
    let force = LegForce {
        push_n: 0.5 * FIVEBAR.balance.mass.carried_kg * up_mps2,
        lean_nm: 0.0,
    };
    Measured {
        tilt: Tilt::new(Quaternion::IDENTITY, [0.0, pitch_rps, 0.0]),
        up_mps2,
        hip_nm: rest
            .legs
            .each_ref()
            .map(|leg| virtual_leg::hip_torques_nm(leg, force)),
        ..rest
    }
}

/// Whether the robot counts as flying at the end of 25 ms, during which its IMU feels 1.0 m/s² and its pitch gains this.
fn flies(pitch_rpss: f32) -> bool {
    let mass = &FIVEBAR.balance.mass;
    let mut contact = Contact::standing(mass, &measured(GRAVITY_MPS2, 0.0));
    for tick in 0..25 {
        let now = Measured {
            up_mps2: 1.0,
            ..measured(GRAVITY_MPS2, pitch_rpss * TICK_S * tick as f32)
        };
        contact.step(mass, &now, [0.0; 2], TICK_S);
    }
    contact.airborne()
}

#[test]
fn a_struck_body_does_not_fly_though_its_imu_falls() {
    let mass = &FIVEBAR.balance.mass;
    assert!(flies(0.0));
    assert!(!flies((GRAVITY_MPS2 - 1.0) / mass.imu_ahead_m));
}

/// What turns at a steady rate is drawn towards its centre: an IMU 0.1 m above feels 0.1·8² = 6.4 m/s² less than the centre.
#[test]
fn a_body_that_turns_steadily_feels_less_above_its_centre() {
    let mass = MassModel {
        imu_over_m: 0.1,
        ..FIVEBAR.balance.mass
    };
    for pitch_rps in [8.0, -8.0] {
        let turning = measured(5.0, pitch_rps);
        let mut contact = Contact::standing(&mass, &turning);
        let centre_mps2 = contact.carried_up_mps2(&mass, &turning, TICK_S);
        assert!((centre_mps2 - 11.4).abs() < 1e-4, "{centre_mps2}");
    }
}
