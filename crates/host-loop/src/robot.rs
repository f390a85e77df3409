//! The robot: stages of the app, joined by the simulated world instead of the tasks of the image.

use robot_app::{
    control::UserController,
    diagnostics::{DiagnosticsSnapshot, Telemetry},
    domain::{
        ChassisCommand, FlashRequest, ImuState, LogicBus, MagState, ParamStatus, PcCommand,
        RemoteUpdate, RobotConfig, SystemHealth,
    },
    input::{RemoteFormat, RemoteReceiver},
    link::{self, Uplink},
    logic::{LogicInputs, LogicStage, UserLogic},
    motor::layout::MotorLayout,
    safety::{ArmingState, WatchdogPeriod},
    tick::{ControlInputs, ControlLoop},
};
use robot_plant::{
    time::{MS, Ps, US, to_seconds},
    world::{PlantKind, RadioKind, RemoteInput, WireEvent, World, WorldConfig, WorldError},
};

use crate::{buses::Buses, layout_of, sensors::Sensors};

const TICK: Ps = MS;
const IMU_PERIOD: Ps = 5 * MS;
/// The IMU is read this long before the tick that uses its sample.
const IMU_LEAD: Ps = 200 * US;
const MAG_PERIOD: Ps = 20 * MS;
const LOGIC_PERIOD: Ps = 10 * MS;
const BATTERY_PERIOD: Ps = 240 * MS;
/// Duration of a tick up to its first frame: about 8,000 instructions at 168 MHz.
const TICK_COMPUTES: Ps = 50 * US;
/// A radio character with its start and stop bits at 100 kBd.
const CHARACTER: Ps = 120 * US;

/// A robot and the world around it. A clone goes on from the same moment on its own.
#[derive(Clone)]
pub struct Robot {
    world: World,
    now: Ps,
    buses: Buses,
    receiver: RemoteReceiver,
    radio_bytes: Vec<u8>,
    sensors: Sensors,
    logic_stage: LogicStage,
    control: ControlLoop<UserController>,
    config: RobotConfig,
    remote: RemoteUpdate,
    imu: ImuState,
    mag: MagState,
    logic: LogicBus,
    health: SystemHealth,
    diagnostics: DiagnosticsSnapshot,
    /// Of the newest tick that had one.
    telemetry: Telemetry,
    wheel_currents_ma: [f64; 2],
    wire_events: Vec<WireEvent>,
    /// Direct command of a user's logic, which bypasses the controller.
    pub direct: Option<ChassisCommand>,
    /// What the PC sends every 10 ms.
    pub pc: Option<PcCommand>,
    /// What came last.
    pc_command: PcCommand,
    sent_digest: u64,
}

impl Robot {
    /// A robot that is powered on and has its sensors brought up. Its time is slightly above zero.
    ///
    /// # Panics
    /// A sensor does not answer.
    pub fn new(plant: PlantKind, radio: RadioKind) -> Self {
        let world = WorldConfig {
            plant,
            radio,
            seed: 7,
            ..WorldConfig::default()
        };
        Self::in_world(world, RobotConfig::default()).expect("there is no recording to load")
    }

    /// The same in any world, with these settings.
    ///
    /// # Errors
    /// The recorded trial of the world cannot be read.
    ///
    /// # Panics
    /// A sensor does not answer, or [`layout_of`] the robot is `None`.
    pub fn in_world(world: WorldConfig, config: RobotConfig) -> Result<Self, WorldError> {
        let layout = layout_of(&world.robot).expect("this program was built with the robot's file");
        Self::controlled_by(layout, world, config)
    }

    /// The same with the controller of another robot: that of the world differs from what its controller was made for.
    ///
    /// # Errors
    /// The recorded trial of the world cannot be read.
    ///
    /// # Panics
    /// A sensor does not answer.
    pub fn controlled_by(
        layout: &'static MotorLayout,
        world: WorldConfig,
        config: RobotConfig,
    ) -> Result<Self, WorldError> {
        let format = match world.radio {
            RadioKind::Sbus => RemoteFormat::Sbus,
            RadioKind::Dbus => RemoteFormat::Dbus,
        };
        let mut world = World::new(world)?;
        let mut sensors = Sensors::new();
        sensors.set_mounting(&config.mounting);
        let up = sensors.bring_up(&mut world, 0);
        let now = up.next_multiple_of(20 * MS);
        world.advance(now);
        Ok(Self {
            world,
            now,
            buses: Buses::new(),
            receiver: RemoteReceiver::new(format, config.radio),
            radio_bytes: Vec::new(),
            sensors,
            logic_stage: LogicStage::new(UserLogic),
            control: ControlLoop::with_layout(layout, config, UserController::default()),
            config,
            remote: RemoteUpdate::default(),
            imu: ImuState::default(),
            mag: MagState::default(),
            logic: LogicBus::default(),
            health: SystemHealth::default(),
            diagnostics: DiagnosticsSnapshot::default(),
            telemetry: Telemetry::default(),
            wheel_currents_ma: [0.0; 2],
            wire_events: Vec::new(),
            direct: None,
            pc: None,
            pc_command: PcCommand::default(),
            sent_digest: 0,
        })
    }

    /// Moves sticks and switches.
    pub fn remote(&mut self, input: RemoteInput) {
        self.world.set_remote(input);
    }

    /// Begins or ends a fault.
    ///
    /// # Panics
    /// No fault has this name.
    pub fn fault(&mut self, name: &str, active: bool) {
        self.world.set_fault(name, active).expect("a known fault");
    }

    /// Time since power-on.
    pub fn seconds(&self) -> f64 {
        to_seconds(self.now)
    }

    /// Runs until `seconds` after power-on and calls `look` after each tick.
    pub fn run_until(&mut self, seconds: f64, mut look: impl FnMut(&Self)) {
        while self.seconds() < seconds {
            self.tick();
            look(self);
        }
    }

    /// Runs for so many ticks.
    pub fn run_ticks(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.tick();
        }
    }

    /// True while the motors may move.
    pub fn armed(&self) -> bool {
        self.diagnostics.arming.state == ArmingState::Armed
    }

    /// The report of the last tick.
    pub fn diagnostics(&self) -> &DiagnosticsSnapshot {
        &self.diagnostics
    }

    /// What a state frame of the PC link says now. It is at most one tick old. The microcontroller has 40 °C.
    pub fn uplink(&self) -> Uplink {
        let observation = link::Observation {
            telemetry: &self.telemetry,
            remote: &self.remote,
            wheel_odom: &self.config.wheel_odom,
            battery_v: self.diagnostics.battery_v,
            mcu_c: 40.0,
        };
        observation.uplink()
    }

    /// The world, to look at.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world, to change it.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The currents read from the wire, in the motors' own direction.
    pub fn wheel_currents_ma(&self) -> [f64; 2] {
        self.wheel_currents_ma
    }

    /// Every byte sent on CAN so far, folded into one number.
    pub fn sent_digest(&self) -> u64 {
        self.sent_digest
    }

    /// Present value of a signal of the world.
    ///
    /// # Panics
    /// No signal has this name.
    pub fn signal(&self, name: &str) -> f64 {
        self.world.signal(name).expect(name)
    }

    /// Error of the estimated attitude: total, of the heading, of the inclination.
    ///
    /// # Panics
    /// A recording plays and has a gap here.
    pub fn attitude_error_deg(&self) -> [f64; 3] {
        let q = self.diagnostics.estimate.q_wxyz.map(f64::from);
        self.world.attitude_error_deg(q).expect("truth has no gaps")
    }

    fn now_us(&self) -> u64 {
        self.now / US
    }

    fn tick(&mut self) {
        let at = self.now + TICK;
        if at.is_multiple_of(IMU_PERIOD) {
            self.run_world(at - IMU_LEAD);
            self.read_imu();
        }
        self.run_world(at);
        self.buses.drop_waiting();
        self.receive_radio();
        self.serve_mag();
        if self.now.is_multiple_of(BATTERY_PERIOD) {
            self.health.battery_v = self.signal("truth.battery_v") as f32;
        }
        if self.now.is_multiple_of(LOGIC_PERIOD) {
            self.step_logic();
            self.receive_from_pc();
        }
        self.receive_can();
        self.control_tick();
        self.follow_wire();
    }

    fn run_world(&mut self, until: Ps) {
        self.buses.run(&mut self.world, self.now, until);
        self.now = until;
    }

    fn step_logic(&mut self) {
        let inputs = LogicInputs {
            config: &self.config.safety,
            remote: &self.remote,
            sensors: &self.diagnostics.sensors,
            estimate: &self.diagnostics.estimate,
            armed: self.armed(),
            battery_v: self.diagnostics.battery_v,
        };
        self.logic = self.logic_stage.step(&inputs, self.now_us());
        if let Some(command) = self.direct {
            self.logic.cmd = command;
            self.logic.cmd_valid = true;
        }
    }

    fn receive_from_pc(&mut self) {
        let now_us = self.now_us();
        if let Some(command) = self.pc {
            self.pc_command = PcCommand {
                ts_us: now_us,
                changed_us: now_us,
                ..command
            };
        }
    }

    fn receive_radio(&mut self) {
        self.radio_bytes.clear();
        let mut last_us = self.now_us();
        while let Some(character) = self.world.radio_char(self.now) {
            self.radio_bytes.push(character.byte);
            last_us = (character.start + CHARACTER) / US;
        }
        let remote = &mut self.remote;
        self.receiver
            .feed(&self.radio_bytes, last_us, |update| *remote = update);
    }

    fn receive_can(&mut self) {
        self.buses.take_received(|bus, frame, at| {
            self.control
                .on_can_frame(bus, frame, at / US, &self.diagnostics);
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
        if let Some(telemetry) = outputs.telemetry {
            self.telemetry = *telemetry;
        }
        for (bus, frame) in outputs.frames {
            self.buses.send(*bus, frame, self.now + TICK_COMPUTES);
            for byte in frame.padded_payload() {
                self.sent_digest = self.sent_digest.rotate_left(5) ^ u64::from(byte);
            }
        }
    }

    /// Notes the currents that have arrived at the wheels.
    fn follow_wire(&mut self) {
        self.world.drain_wire_events(&mut self.wire_events);
        for event in self.wire_events.drain(..) {
            match self.world.signal_names()[event.signal].as_str() {
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
        if self.now.is_multiple_of(MAG_PERIOD) {
            self.sensors.start_mag(&mut self.world, self.now);
        }
        match self.sensors.fetch_mag(&mut self.world, self.now) {
            Ok(Some(state)) => self.mag = state,
            Ok(None) => {}
            Err(_) => self.health.mag.errors += 1,
        }
    }
}
