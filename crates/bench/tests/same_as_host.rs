//! The emulated Cortex-M4F computes what this machine computes: the same sources and samples give the same attitude to
//! the bit. Both round sums, products and quotients of single precision correctly, and nothing else is used.

mod programs;

use robot_app::{
    domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelFeedback, WheelOdomConfig},
    estimation::InsEstimator,
};
use robot_bench::{
    filters::OURS,
    motion::{Motion, Wheels},
    program::Program,
};

#[test]
fn board_and_host_agree_on_the_attitude() {
    let mut program = Program::boot(&OURS.elf(&programs::folder())).expect("the program boots");
    let mut estimator = InsEstimator::new(WheelOdomConfig::default());
    let mut estimate = StateEstimate::default();
    for (t_us, _, input) in Motion::computed(Wheels::Turning).ticks() {
        let now_us = u64::from(input.now_us);
        let wheel = |rpm| WheelFeedback {
            rpm,
            age_us: input.wheel_age_us,
            ts_us: now_us - u64::from(input.wheel_age_us),
            ..WheelFeedback::default()
        };
        let imu = ImuState {
            gyro_dps: input.gyro_rps.map(f32::to_degrees),
            accel_mps2: input.accel_mps2,
            ts_us: input.imu_ts_us.into(),
            ..ImuState::default()
        };
        let mag = MagState {
            mag_ut: input.mag_ut,
            ts_us: input.mag_ts_us.into(),
        };
        let motor = MotorFeedback {
            wheels: input.wheel_rpm.map(wheel),
            ts_us: now_us,
            ..MotorFeedback::default()
        };
        estimator.step(&imu, &mag, &motor, now_us, &mut estimate);
        let board = program.tick(&input).expect("the program runs").q_wxyz;
        let bits = |q: [f32; 4]| q.map(f32::to_bits);
        assert_eq!(bits(board), bits(estimate.q_wxyz), "at {t_us} µs");
    }
}
