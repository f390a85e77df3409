//! `StateEstimate::valid` changes as its documentation says, to the tick.

use robot_app::{
    domain::{ImuState, MagState, MotorFeedback, StateEstimate, WheelOdomConfig},
    estimation::InsEstimator,
};

/// The figures of that documentation.
const MAX_SAMPLE_AGE_US: u64 = 25_000;
const SAMPLES_IN_A_ROW: u32 = 100;
const MAX_SAMPLE_GAP_US: u64 = 100_000;
const MAX_TICK_US: u64 = 20_000;
/// After a gap a rest of 0.6 s shows the tilt.
const SAMPLES_TO_FIND_TILT: u32 = 120;

const SAMPLE_US: u64 = 5_000;

struct Robot {
    estimator: InsEstimator,
    estimate: StateEstimate,
    imu: ImuState,
    now_us: u64,
}

impl Robot {
    fn new() -> Self {
        Self {
            estimator: InsEstimator::new(WheelOdomConfig::default()),
            estimate: StateEstimate::default(),
            imu: ImuState {
                accel_mps2: [0.0, 0.0, 9.8],
                ..ImuState::default()
            },
            now_us: 1_000_000,
        }
    }

    fn settled() -> Self {
        let mut robot = Self::new();
        assert_eq!(robot.samples_until_valid(), SAMPLES_IN_A_ROW);
        robot
    }

    fn tick_at(&mut self, now_us: u64) -> bool {
        self.now_us = now_us;
        self.estimator.step(
            &self.imu,
            &MagState::default(),
            &MotorFeedback::default(),
            now_us,
            &mut self.estimate,
        );
        self.estimate.valid
    }

    /// A good sample and the tick that sees it, `gap_us` after the last tick.
    fn sample_after(&mut self, gap_us: u64) -> bool {
        self.imu.ts_us = self.now_us + gap_us;
        self.tick_at(self.now_us + gap_us)
    }

    /// Ticks of 1 ms without a new sample.
    fn ticks_without_sample(&mut self, until_us: u64) -> bool {
        let mut valid = self.estimate.valid;
        while self.now_us < until_us {
            valid = self.tick_at(until_us.min(self.now_us + 1_000));
        }
        valid
    }

    /// Number of good samples in a row until the estimate is valid, including that one.
    fn samples_until_valid(&mut self) -> u32 {
        for count in 1..10 * SAMPLES_IN_A_ROW {
            if self.sample_after(SAMPLE_US) {
                return count;
            }
        }
        panic!("never valid again: {:?}", self.estimate);
    }
}

/// The sample of the tick that broke the row may be the first of the next.
fn assert_counts_again(robot: &mut Robot, row: u32) {
    let needed = robot.samples_until_valid();
    assert!(needed == row || needed == row - 1, "{needed} samples");
}

#[test]
fn it_is_false_before_the_first_sample() {
    let mut robot = Robot::new();
    for _ in 0..2_000 {
        let next_us = robot.now_us + 1_000;
        assert!(!robot.tick_at(next_us));
    }
    assert_eq!(robot.samples_until_valid(), SAMPLES_IN_A_ROW);
}

#[test]
fn a_sample_is_valid_for_25_ms_and_the_next_one_again() {
    let mut robot = Robot::settled();
    let last_us = robot.now_us;
    assert!(robot.ticks_without_sample(last_us + MAX_SAMPLE_AGE_US));
    assert!(!robot.tick_at(last_us + MAX_SAMPLE_AGE_US + 1));
    assert!(robot.sample_after(SAMPLE_US));
}

#[test]
fn a_gap_of_more_than_100_ms_ends_it() {
    for (gap_us, needed) in [
        (MAX_SAMPLE_GAP_US, 1),
        (MAX_SAMPLE_GAP_US + 1, SAMPLES_TO_FIND_TILT),
        (3_000_000, SAMPLES_TO_FIND_TILT),
    ] {
        let mut robot = Robot::settled();
        let last_us = robot.now_us;
        assert!(!robot.ticks_without_sample(last_us + gap_us - SAMPLE_US));
        assert_eq!(robot.samples_until_valid(), needed, "after {gap_us} µs");
    }
}

#[test]
fn impossible_values_end_it() {
    let spoils: [fn(&mut ImuState, f32); 3] = [
        |imu, value| imu.gyro_dps[1] = value,
        |imu, value| imu.accel_mps2[2] = value,
        |imu, value| imu.gyro_bias_dps[0] = value,
    ];
    for spoil in spoils {
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9, -1e9] {
            let mut robot = Robot::settled();
            let good = robot.imu;
            spoil(&mut robot.imu, value);
            assert!(!robot.sample_after(SAMPLE_US), "{value} counted");
            robot.imu = good;
            assert_eq!(robot.samples_until_valid(), SAMPLES_IN_A_ROW);
        }
    }
}

#[test]
fn samples_from_the_past_end_it() {
    let mut robot = Robot::settled();
    robot.imu.ts_us -= 1;
    let next_us = robot.now_us + SAMPLE_US;
    assert!(!robot.tick_at(next_us));
    assert_counts_again(&mut robot, SAMPLES_TO_FIND_TILT);
}

#[test]
fn ticks_that_run_back_stand_or_jump_end_it() {
    let jumps: [fn(u64) -> u64; 5] = [
        |now_us| now_us - 1,
        |now_us| now_us - 500_000,
        |now_us| now_us,
        |now_us| now_us + MAX_TICK_US + 1,
        |now_us| now_us + 10_000_000,
    ];
    for jump in jumps {
        let mut robot = Robot::settled();
        let now_us = jump(robot.now_us);
        let sample_us = robot.imu.ts_us;
        robot.imu.ts_us = robot.imu.ts_us.max(now_us);
        assert!(!robot.tick_at(now_us), "counted after a jump to {now_us}");
        let gap = robot.imu.ts_us - sample_us > MAX_SAMPLE_GAP_US;
        robot.now_us = robot.now_us.max(robot.imu.ts_us);
        assert_counts_again(
            &mut robot,
            if gap {
                SAMPLES_TO_FIND_TILT
            } else {
                SAMPLES_IN_A_ROW
            },
        );
    }
    let mut robot = Robot::settled();
    assert!(robot.sample_after(MAX_TICK_US), "20 ms are allowed");
}

/// A bias of more than 1 °/s, or a tilt error of more than 30°: the attitude jumps.
#[test]
fn a_rest_that_shows_a_wrong_attitude_ends_it() {
    let proofs: [fn(&mut ImuState); 3] = [
        |imu| imu.gyro_dps = [0.0, 1.2, 0.0],
        |imu| imu.accel_mps2 = [0.0, 5.4, 8.2],
        |imu| imu.accel_mps2 = [0.0, 0.0, -9.8],
    ];
    for proof in proofs {
        let mut robot = Robot::settled();
        proof(&mut robot.imu);
        let fell = (0..1_000).any(|_| !robot.sample_after(SAMPLE_US));
        assert!(fell, "{:?} taken for motion", robot.imu);
        assert_counts_again(&mut robot, SAMPLES_IN_A_ROW);
        // It stays valid after that.
        assert!((0..2_000).all(|_| robot.sample_after(SAMPLE_US)));
    }
}

/// While it is false the other fields hold the last good attitude.
#[test]
fn while_it_is_false_the_attitude_stays() {
    let mut robot = Robot::settled();
    let before = robot.estimate.q_wxyz;
    let until_us = robot.now_us + 5_000_000;
    assert!(!robot.ticks_without_sample(until_us));
    let after = robot.estimate.q_wxyz;
    let change = before.iter().zip(after).map(|(a, b)| (a - b).abs());
    assert!(change.fold(0.0, f32::max) < 1e-3, "{before:?} {after:?}");
}

/// Heading and wheels do not affect it.
#[test]
fn it_does_not_depend_on_magnetometer_and_wheels() {
    let mut robot = Robot::settled();
    for _ in 0..1_000 {
        assert!(robot.sample_after(SAMPLE_US));
    }
}
