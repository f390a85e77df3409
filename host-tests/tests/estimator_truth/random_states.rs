//! A million random inputs, such as no motion gives: no sensor value breaks the state.

use robot_app::{
    domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig},
    estimation::InsEstimator,
};
use robot_test_support::{Random, Rotation, Vector, scale};

use crate::run::assert_valid_state;

const STATES: u32 = 1_000_000;
/// Number of states of one kind.
const STATES_A_KIND: u32 = 500;

/// What the sensors show, drawn again for each sample.
#[derive(Clone, Copy)]
struct Kind {
    rate_dps: f64,
    accel_mps2: f64,
    field_ut: f64,
    /// Share of gravity in the force, in a random direction.
    gravity: f64,
    max_gap_us: u64,
}

fn kind(noise: &mut Random) -> Kind {
    let one_of = |noise: &mut Random, choices: [f64; 4]| choices[noise.below(4)];
    Kind {
        rate_dps: one_of(noise, [0.0, 5.0, 300.0, 2_000.0]),
        accel_mps2: one_of(noise, [0.0, 0.01, 10.0, 117.0]),
        field_ut: one_of(noise, [0.0, 1e-3, 50.0, 2_500.0]),
        gravity: one_of(noise, [0.0, 1.0, 1.0, 1.0]),
        max_gap_us: [1_000, 5_000, 20_000, 99_000][noise.below(4)],
    }
}

fn in_cube(noise: &mut Random, end: f64) -> Vector {
    std::array::from_fn(|_| match noise.below(8) {
        0 => end,
        1 => -end,
        2 => 0.0,
        _ => noise.between(-end, end),
    })
}

fn any_attitude(noise: &mut Random) -> Rotation {
    let wxyz = std::array::from_fn(|_| noise.normal());
    Rotation::from_wxyz(wxyz)
}

#[test]
fn a_million_random_inputs_keep_the_state_valid() {
    let mut noise = Random::new(20_000);
    let mut estimator = InsEstimator::new(WheelOdomConfig::default());
    let mut motor = MotorFeedback::default();
    let mut estimate = StateEstimate::default();
    let mut now_us = 1_000_000;
    let mut current = kind(&mut noise);
    for number in 0..STATES {
        if number % STATES_A_KIND == 0 {
            current = kind(&mut noise);
        }
        now_us += 1 + noise.bits() % current.max_gap_us;
        let attitude = any_attitude(&mut noise);
        let gravity = attitude.turn([0.0, 0.0, 9.8 * current.gravity]);
        let push = in_cube(&mut noise, current.accel_mps2);
        let field = attitude.turn(scale([0.0, 0.4, -0.9], current.field_ut));
        let imu = ImuState {
            gyro_dps: in_cube(&mut noise, current.rate_dps).map(|rate| rate as f32),
            accel_mps2: std::array::from_fn(|axis| (gravity[axis] + push[axis]) as f32),
            saturated: noise.below(20) == 0,
            gyro_clipped_ms: std::array::from_fn(|_| noise.below(6).saturating_sub(4) as u8),
            ts_us: now_us,
            ..ImuState::default()
        };
        let mag = MagState {
            mag_ut: field.map(|part| part as f32),
            ts_us: now_us - noise.bits() % 10_000,
        };
        for wheel in &mut motor.wheels {
            wheel.rpm = noise.between(-9_000.0, 9_000.0) as i16;
            wheel.age_us = noise.below(100_000) as u32;
        }
        estimator.step(&imu, &mag, &motor, now_us, &mut estimate);
        assert_valid_state(&estimate, now_us);
    }
}
