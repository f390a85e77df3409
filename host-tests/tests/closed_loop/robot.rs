//! The whole app without a chip. Every wire of the simulated world leads to the app's own decoders.

use robot_app::{
    control::UserController,
    diagnostics::DiagnosticsSnapshot,
    domain::{
        ChassisCommand, FlashRequest, ImuState, LogicBus, MagState, ParamStatus, PcCommand,
        RemoteUpdate, RobotConfig, SafetyConfig, SystemHealth,
    },
    input::{RemoteFormat, RemoteMapping, RemoteReceiver},
    logic::{LogicInputs, LogicStage, UserLogic},
    safety::{ArmingState, WatchdogPeriod},
    tick::{ControlInputs, ControlLoop},
};
use robot_plant::{
    time::{MS, Ps, US},
    world::{PlantKind, RadioKind, RemoteInput, WireEvent, World, WorldConfig},
};
use robot_test_support::CanWires;

use crate::sensors::Sensors;

pub struct Robot {
    world: World,
    now: Ps,
    receiver: RemoteReceiver,
    sensors: Sensors,
    logic_stage: LogicStage,
    control: ControlLoop<UserController>,
    remote: RemoteUpdate,
    imu: ImuState,
    mag: MagState,
    logic: LogicBus,
    health: SystemHealth,
    diagnostics: DiagnosticsSnapshot,
    wheel_currents_ma: [f64; 2],
    /// Direct command of a user's logic, which bypasses the controller.
    pub direct: Option<ChassisCommand>,
    /// What the PC sends every 10 ms.
    pub pc: Option<PcCommand>,
    /// What came last.
    pc_command: PcCommand,
    /// Every byte sent on CAN so far, folded into one number.
    pub sent_digest: u64,
}

impl Robot {
    /// A robot that is powered on and has its sensors brought up. Its time is slightly above zero.
    pub fn new(plant: PlantKind, radio: RadioKind) -> Self {
        let world = WorldConfig {
            plant,
            radio,
            ..WorldConfig::default()
        };
        Self::in_world(world, RobotConfig::default())
    }

    pub fn in_world(world: WorldConfig, config: RobotConfig) -> Self {
        let format = match world.radio {
            RadioKind::Sbus => RemoteFormat::Sbus,
            RadioKind::Dbus => RemoteFormat::Dbus,
        };
        let world = World::new(WorldConfig {
            seed: 7,
            imu_trial: None,
            ..world
        })
        .expect("no recording to load");
        let mut robot = Self {
            world,
            now: 0,
            receiver: RemoteReceiver::new(format, RemoteMapping::default()),
            sensors: Sensors::new(),
            logic_stage: LogicStage::new(UserLogic),
            control: ControlLoop::new(config, UserController::default()),
            remote: RemoteUpdate::default(),
            imu: ImuState::default(),
            mag: MagState::default(),
            logic: LogicBus::default(),
            health: SystemHealth::default(),
            diagnostics: DiagnosticsSnapshot::default(),
            wheel_currents_ma: [0.0; 2],
            direct: None,
            pc: None,
            pc_command: PcCommand::default(),
            sent_digest: 0,
        };
        robot.sensors.set_mounting(&config.mounting);
        let up = robot.sensors.bring_up(&mut robot.world, robot.now);
        robot.now = up.next_multiple_of(20 * MS);
        robot
    }

    pub fn remote(&mut self, input: RemoteInput) {
        self.world.set_remote(input);
    }

    pub fn fault(&mut self, name: &str, active: bool) {
        self.world.set_fault(name, active).expect("a known fault");
    }

    pub fn seconds(&self) -> f64 {
        self.now as f64 / (1_000.0 * MS as f64)
    }

    /// Runs until `seconds` after power-on and calls `look` after each tick.
    pub fn run_until(&mut self, seconds: f64, mut look: impl FnMut(&Self)) {
        while self.seconds() < seconds {
            self.tick();
            look(self);
        }
    }

    pub fn armed(&self) -> bool {
        self.diagnostics.arming.state == ArmingState::Armed
    }

    pub fn diagnostics(&self) -> &DiagnosticsSnapshot {
        &self.diagnostics
    }

    /// The currents read from the wire, in the motors' own direction.
    pub fn wheel_currents_ma(&self) -> [f64; 2] {
        self.wheel_currents_ma
    }

    pub fn signal(&self, name: &str) -> f64 {
        self.world.signal(name).expect(name)
    }

    pub fn attitude_error_deg(&self) -> [f64; 3] {
        let q = self.diagnostics.estimate.q_wxyz.map(f64::from);
        self.world.attitude_error_deg(q).expect("truth has no gaps")
    }

    fn now_us(&self) -> u64 {
        self.now / US
    }

    fn tick(&mut self) {
        self.now += MS;
        self.world.advance(self.now);
        self.receive_radio();
        self.receive_can();
        if self.now.is_multiple_of(5 * MS) {
            self.read_imu();
        }
        self.serve_mag();
        if self.now.is_multiple_of(240 * MS) {
            self.health.battery_v = self.signal("truth.battery_v") as f32;
        }
        if self.now.is_multiple_of(10 * MS) {
            let inputs = LogicInputs {
                config: &SafetyConfig::default(),
                remote: &self.remote,
                sensors: &self.diagnostics.sensors,
                estimate: &self.diagnostics.estimate,
                armed: self.armed(),
                battery_v: self.diagnostics.battery_v,
            };
            self.logic = self.logic_stage.step(&inputs, self.now / US);
            if let Some(command) = self.direct {
                self.logic.cmd = command;
                self.logic.cmd_valid = true;
            }
        }
        self.receive_from_pc();
        self.control_tick();
    }

    fn receive_from_pc(&mut self) {
        if let Some(command) = self.pc
            && self.now.is_multiple_of(10 * MS)
        {
            let now_us = self.now_us();
            self.pc_command = PcCommand {
                ts_us: now_us,
                changed_us: now_us,
                ..command
            };
        }
    }

    fn receive_radio(&mut self) {
        let mut bytes = Vec::new();
        let mut last_us = self.now_us();
        while let Some(character) = self.world.radio_char(self.now) {
            bytes.push(character.byte);
            last_us = (character.start + 120 * US) / US;
        }
        let remote = &mut self.remote;
        self.receiver
            .feed(&bytes, last_us, |update| *remote = update);
    }

    fn receive_can(&mut self) {
        let now_us = self.now_us();
        self.world.take_frames(self.now, |bus, frame| {
            self.control
                .on_can_frame(bus, frame, now_us, &self.diagnostics);
        });
    }

    fn control_tick(&mut self) {
        self.health.imu_calibrated = self.sensors.imu_calibrated();
        let now_us = self.now_us();
        let outputs = self.control.tick(
            &ControlInputs {
                remote: &self.remote,
                imu: &self.imu,
                mag: &self.mag,
                logic: &self.logic,
                pc: &self.pc_command,
                health: &self.health,
                params: &ParamStatus::default(),
                flash_request: FlashRequest::None,
                watchdog: WatchdogPeriod::Short,
            },
            now_us,
            &mut self.diagnostics,
        );
        for (bus, frame) in outputs.frames {
            self.world.deliver(*bus, frame, self.now);
            for byte in frame.padded_payload() {
                self.sent_digest = self.sent_digest.rotate_left(5) ^ u64::from(byte);
            }
        }
        self.follow_wire();
    }

    fn follow_wire(&mut self) {
        let mut events: Vec<WireEvent> = Vec::new();
        self.world.drain_wire_events(&mut events);
        let names = self.world.signal_names();
        for event in events {
            match names[event.signal].as_str() {
                "can.m3508.0.current_ma" => self.wheel_currents_ma[0] = event.value,
                "can.m3508.1.current_ma" => self.wheel_currents_ma[1] = event.value,
                _ => {}
            }
        }
    }

    fn read_imu(&mut self) {
        match self.sensors.read_imu(&mut self.world, self.now) {
            Ok(state) => self.imu = state,
            Err(_) => self.health.imu.errors += 1,
        }
    }

    fn serve_mag(&mut self) {
        if self.now.is_multiple_of(20 * MS) {
            self.sensors.start_mag(&mut self.world, self.now);
        }
        match self.sensors.fetch_mag(&mut self.world, self.now) {
            Some(Ok(state)) => self.mag = state,
            Some(Err(())) => self.health.mag.errors += 1,
            None => {}
        }
    }
}
