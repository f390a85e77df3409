//! What the control loop does when the mounting of the sensors changes.

use robot_app::{
    control::UserController,
    diagnostics::DiagnosticsSnapshot,
    domain::{
        BusId, CanFrame, FlashRequest, ImuState, LogicBus, MagState, Orientation, ParamStatus,
        PcCommand, RemoteUpdate, RobotConfig, StandardId, StateEstimate, SystemHealth,
    },
    safety::WatchdogPeriod,
    tick::{ControlInputs, ControlLoop},
};

const UP: [f32; 3] = [0.0, 0.0, 9.81];
/// The specific force of a robot that lies on its nose.
const BACK: [f32; 3] = [-9.81, 0.0, 0.0];
/// Horizontal part along the nose, µT.
const FIELD_UT: [f32; 3] = [22.0, 0.0, -42.0];

struct Robot {
    control: ControlLoop,
    diagnostics: DiagnosticsSnapshot,
    imu: ImuState,
    mag: MagState,
    estimate: StateEstimate,
    now_us: u64,
}

impl Robot {
    fn new(mag: Option<Orientation>) -> Self {
        let mut config = RobotConfig::default();
        config.mounting.mag = mag;
        Self {
            control: ControlLoop::new(config, UserController::default()),
            diagnostics: DiagnosticsSnapshot::default(),
            imu: ImuState::default(),
            mag: MagState::default(),
            estimate: StateEstimate::default(),
            now_us: 1_000_000,
        }
    }

    /// A tick every millisecond, an IMU sample every 5 ms, a field sample every 20 ms.
    fn run(&mut self, ms: u32, accel_mps2: [f32; 3]) {
        for _ in 0..ms {
            self.now_us += 1_000;
            if self.now_us.is_multiple_of(5_000) {
                self.imu.accel_mps2 = accel_mps2;
                self.imu.ts_us = self.now_us - 500;
            }
            if self.now_us.is_multiple_of(20_000) {
                self.mag.mag_ut = FIELD_UT;
                self.mag.ts_us = self.now_us - 4_000;
            }
            self.tick();
        }
    }

    fn tick(&mut self) {
        let outputs = self.control.tick(
            &ControlInputs {
                remote: &RemoteUpdate::default(),
                imu: &self.imu,
                mag: &self.mag,
                logic: &LogicBus::default(),
                pc: &PcCommand::default(),
                health: &SystemHealth::default(),
                params: &ParamStatus::default(),
                flash_request: FlashRequest::None,
                watchdog: WatchdogPeriod::Short,
            },
            self.now_us,
            &mut self.diagnostics,
        );
        self.estimate = *outputs.estimate;
    }

    fn set(&mut self, index: u8, number: f32) {
        let [a, b, c, d] = number.to_le_bytes();
        let id = StandardId::new(0x7A0).unwrap();
        let frame = CanFrame::new(id, [0x20, 8, index, 0, a, b, c, d]);
        self.control
            .on_can_frame(BusId::Can1, &frame, self.now_us, &self.diagnostics);
    }

    fn pitch_deg(&self) -> f32 {
        self.estimate.rpy_rad[1].to_degrees()
    }

    fn yaw_deg(&self) -> f32 {
        self.estimate.rpy_rad[2].to_degrees()
    }
}

/// 13 is x-right-z-down, another mounting than before.
#[test]
fn another_mounting_restarts_the_attitude() {
    let mut robot = Robot::new(None);
    robot.run(1_000, UP);
    assert!(robot.estimate.valid && robot.pitch_deg().abs() < 1.0);
    // The same value again changes nothing.
    robot.set(0, 0.0);
    robot.run(5, UP);
    assert!(robot.estimate.valid);
    robot.set(0, 13.0);
    robot.run(1, UP);
    assert!(!robot.estimate.valid, "at once");
    // Samples on their way have the old axes.
    robot.run(20, UP);
    robot.run(480, BACK);
    assert!(!robot.estimate.valid, "settling");
    robot.run(100, BACK);
    assert!(robot.estimate.valid);
    assert!(
        (robot.pitch_deg() - 90.0).abs() < 1.0,
        "{}",
        robot.pitch_deg()
    );
}

/// The field points along the nose. A robot that uses it knows that it faces north, 90° from east.
#[test]
fn the_heading_uses_a_magnetometer_with_a_known_mounting() {
    let mut robot = Robot::new(Some(Orientation::XForwardZUp));
    robot.run(2_000, UP);
    assert!((robot.yaw_deg() - 90.0).abs() < 3.0, "{}", robot.yaw_deg());
    robot.set(1, 24.0);
    robot.run(2_000, UP);
    assert!(robot.estimate.valid);
    assert!(robot.yaw_deg().abs() < 1.0, "unset: {}", robot.yaw_deg());
    robot.set(1, 0.0);
    robot.run(2_000, UP);
    assert!((robot.yaw_deg() - 90.0).abs() < 3.0, "{}", robot.yaw_deg());
    let mut robot = Robot::new(None);
    robot.run(2_000, UP);
    assert!(robot.estimate.valid);
    assert!(
        robot.yaw_deg().abs() < 1.0,
        "as delivered: {}",
        robot.yaw_deg()
    );
}
