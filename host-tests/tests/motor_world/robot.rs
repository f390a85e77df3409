//! The control tick with all its motors in the simulated world. Radio and IMU are healthy.

use robot_app::{
    control::UserController,
    diagnostics::DiagnosticsSnapshot,
    domain::{
        BusId, CanFrame, ChassisCommand, DriveMode, FlashRequest, ImuState, JointCommand,
        JointFeedback, JointState, LogicBus, MagState, OperatorState, ParamStatus, PcCommand,
        RemoteDiagnostics, RemoteState, RemoteUpdate, RobotConfig, StandardId, SystemHealth,
    },
    motor::layout::{MotorLayout, ROBOT_LAYOUT, RS00_LAYOUT},
    safety::{ArmingState, FlashGrant, WatchdogPeriod},
    tick::{ControlInputs, ControlLoop},
};
use robot_plant::{
    robots::{self, JointMotor},
    time::{MS, Ps, US},
    world::{World, WorldConfig},
};
use robot_test_support::CanWires;

pub struct Robot {
    pub command: ChassisCommand,
    pub enabled: bool,
    pub e_stop: bool,
    /// The flash operation that the parameter store requests.
    pub flash_request: FlashRequest,
    flash: FlashGrant,
    world: World,
    now: Ps,
    control: ControlLoop<UserController>,
    diagnostics: DiagnosticsSnapshot,
    sent: Vec<(BusId, CanFrame)>,
}

impl Robot {
    pub fn new(joints: JointMotor) -> Self {
        let layout: &'static MotorLayout = match joints {
            JointMotor::Dm4310 => &ROBOT_LAYOUT,
            JointMotor::Rs00 => &RS00_LAYOUT,
        };
        let mut config = RobotConfig::default();
        config.joint_ctrl.rs00_timeout_set = 1;
        let world = World::new(WorldConfig {
            robot: robots::with_joints(joints),
            seed: 3,
            ..WorldConfig::default()
        })
        .expect("no recording to load");
        Self {
            command: ChassisCommand::default(),
            enabled: false,
            e_stop: false,
            flash_request: FlashRequest::None,
            flash: FlashGrant::default(),
            world,
            now: 0,
            control: ControlLoop::with_layout(layout, config, UserController::default()),
            diagnostics: DiagnosticsSnapshot::default(),
            sent: Vec::new(),
        }
    }

    /// Set up, armed and enabled with the command `Off`.
    pub fn armed(joints: JointMotor) -> Self {
        let mut robot = Self::new(joints);
        robot.run(1.5);
        robot.enabled = true;
        robot.run(0.1);
        assert!(robot.is_armed(), "{:?}", robot.diagnostics.arming.blockers);
        assert_eq!(robot.states(), [JointState::Enabled; 4]);
        robot
    }

    pub fn run(&mut self, seconds: f64) {
        self.run_watching(seconds, |_| ());
    }

    /// Looks at the robot after each tick.
    pub fn run_watching(&mut self, seconds: f64, mut look: impl FnMut(&Self)) {
        let ticks = (seconds * 1_000.0).round() as u32;
        for _ in 0..ticks {
            self.tick();
            look(self);
        }
    }

    /// Runs the world without frames from the board; `look` gets the milliseconds passed.
    pub fn run_without_board(&mut self, ticks: u64, mut look: impl FnMut(&Self, u64)) {
        for ms in 1..=ticks {
            self.now += MS;
            self.world.advance(self.now);
            look(self, ms);
        }
    }

    /// Stops the whole board for a flash erase. Frames that the motors send meanwhile are lost.
    pub fn stall(&mut self, ms: u64) {
        self.run_without_board(ms, |_, _| ());
        self.world.take_frames(self.now, |_, _| ());
    }

    /// Reports the stall to the tick, as the firmware does.
    pub fn report_stall(&mut self, ms: u32) {
        let now_us = self.now_us();
        self.control.after_stall(ms * 1_000, now_us);
    }

    pub fn fault(&mut self, name: &str, active: bool) {
        self.world.set_fault(name, active).expect("a known fault");
    }

    /// The same command for every joint.
    pub fn command_joints(&mut self, command: JointCommand) {
        self.command.joints = [command; 4];
    }

    pub fn is_armed(&self) -> bool {
        self.diagnostics.arming.state == ArmingState::Armed
    }

    pub fn flash(&self) -> FlashGrant {
        self.flash
    }

    pub fn diagnostics(&self) -> &DiagnosticsSnapshot {
        &self.diagnostics
    }

    pub fn joint(&self, joint: usize) -> &JointFeedback {
        &self.diagnostics.sensors.motor.joints[joint]
    }

    pub fn states(&self) -> [JointState; 4] {
        self.diagnostics
            .sensors
            .motor
            .joints
            .map(|joint| joint.state)
    }

    /// Frames of the last tick.
    pub fn sent(&self) -> &[(BusId, CanFrame)] {
        &self.sent
    }

    pub fn signal(&self, name: &str) -> f64 {
        self.world.signal(name).expect(name)
    }

    /// Value of the signal `name` for each joint, such as `can.joint.{}.enabled`.
    pub fn joint_signals(&self, name: &str) -> [f64; 4] {
        std::array::from_fn(|joint| self.signal(&name.replace("{}", &joint.to_string())))
    }

    fn now_us(&self) -> u64 {
        self.now / US
    }

    fn tick(&mut self) {
        self.now += MS;
        self.world.advance(self.now);
        self.receive();
        let now_us = self.now_us();
        let remote = self.remote(now_us);
        let imu = ImuState {
            accel_mps2: [0.0, 0.0, 9.81],
            temperature_c: 40.0,
            ts_us: now_us,
            ..ImuState::default()
        };
        let mag = MagState {
            mag_ut: [0.0, 20.0, -45.0],
            ts_us: now_us,
        };
        let logic = LogicBus {
            cmd: self.command,
            cmd_valid: true,
            ts_us: now_us,
            ..LogicBus::default()
        };
        let health = SystemHealth {
            imu_calibrated: true,
            battery_v: 24.0,
            ..SystemHealth::default()
        };
        let inputs = ControlInputs {
            remote: &remote,
            imu: &imu,
            mag: &mag,
            logic: &logic,
            pc: &PcCommand::default(),
            health: &health,
            params: &ParamStatus::default(),
            flash_request: self.flash_request,
            watchdog: WatchdogPeriod::Short,
        };
        let outputs = self.control.tick(&inputs, now_us, &mut self.diagnostics);
        self.sent = outputs.frames.to_vec();
        self.flash = outputs.flash;
        for (bus, frame) in &self.sent {
            self.world.deliver(*bus, frame, self.now);
        }
    }

    fn remote(&self, now_us: u64) -> RemoteUpdate {
        RemoteUpdate {
            state: RemoteState {
                ts_us: now_us,
                ..RemoteState::default()
            },
            operator: OperatorState {
                enabled: self.enabled,
                disabled: !self.enabled,
                e_stop: self.e_stop,
                mode: DriveMode::Custom,
                ts_us: now_us,
                ..OperatorState::default()
            },
            diagnostics: RemoteDiagnostics {
                quality: 1.0,
                frames: 1,
                frame_ts_us: now_us,
                good_ts_us: now_us,
                ..RemoteDiagnostics::default()
            },
            ..RemoteUpdate::default()
        }
    }

    /// Sends a frame of another node on CAN2.
    pub fn receive_unknown_frame(&mut self, id: u16, data: [u8; 8]) {
        let id = StandardId::new(id).expect("11 bits");
        self.world
            .deliver(BusId::Can2, &CanFrame::new(id, data), self.now);
    }

    fn receive(&mut self) {
        let now_us = self.now_us();
        self.world.take_frames(self.now, |bus, frame| {
            self.control
                .on_can_frame(bus, frame, now_us, &self.diagnostics);
        });
    }
}
