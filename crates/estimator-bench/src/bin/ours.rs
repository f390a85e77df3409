//! The estimator of the robot, called as the control tick calls it.

#![no_std]
#![no_main]

use robot_app::{
    domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelFeedback, WheelOdomConfig},
    estimation::InsEstimator,
};
use robot_estimator_bench::{
    board::{self, Filter},
    mailbox::Input,
};

struct Ours {
    estimator: InsEstimator,
    estimate: StateEstimate,
}

struct Tick {
    imu: ImuState,
    mag: MagState,
    motor: MotorFeedback,
    now_us: u64,
}

impl Filter for Ours {
    type Taken = Tick;

    fn take(&mut self, input: &Input) -> Tick {
        let now_us = u64::from(input.now_us);
        let wheel = |rpm| WheelFeedback {
            rpm,
            age_us: input.wheel_age_us,
            ts_us: now_us.saturating_sub(input.wheel_age_us.into()),
            ..WheelFeedback::default()
        };
        Tick {
            imu: ImuState {
                gyro_dps: input.gyro_rps.map(f32::to_degrees),
                accel_mps2: input.accel_mps2,
                ts_us: input.imu_ts_us.into(),
                ..ImuState::default()
            },
            mag: MagState {
                mag_ut: input.mag_ut,
                ts_us: input.mag_ts_us.into(),
            },
            motor: MotorFeedback {
                wheels: input.wheel_rpm.map(wheel),
                ts_us: now_us,
                ..MotorFeedback::default()
            },
            now_us,
        }
    }

    fn step(&mut self, tick: &Tick) {
        let Tick {
            imu,
            mag,
            motor,
            now_us,
        } = tick;
        self.estimator
            .step(imu, mag, motor, *now_us, &mut self.estimate);
    }

    fn q_wxyz(&self) -> [f32; 4] {
        self.estimate.q_wxyz
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    board::run(Ours {
        estimator: InsEstimator::new(WheelOdomConfig::default()),
        estimate: StateEstimate::default(),
    })
}
