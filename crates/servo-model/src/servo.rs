//! One servo: what it remembers, how it moves, what it answers.

mod memory;
mod motor;
mod profile;
mod protection;
mod writing;

pub use motor::{Load, STEPS, Version};
pub use protection::status;
pub use writing::Reply;

use memory::{
    ACCELERATION, ACCELERATION_LIMIT, CCW_DEAD_ZONE, CW_DEAD_ZONE, D_GAIN, GOAL_POSITION,
    GOAL_SPEED, HOMING_OFFSET, ID, MAX_POSITION, MIN_POSITION, MODE, MOVING, Memory, P_GAIN, PHASE,
    PRESENT_CURRENT, PRESENT_GOAL, PRESENT_LOAD, PRESENT_POSITION, PRESENT_SPEED,
    PRESENT_TEMPERATURE, PRESENT_VOLTAGE, PWM, STATUS, TORQUE_ENABLE, TORQUE_LIMIT, sign_magnitude,
    signed,
};
use motor::{CYCLE_S, Motor, NO_LOAD_STEPS_S};
use profile::Profile;
use protection::{CURRENT_UNIT_A, Measured, Protection};

/// Nanoseconds of a control cycle.
const CYCLE_NS: u64 = 1_000_000;
/// Output for one step of position error and one unit of gain: with a gain of 16 the SO-101's MJCF has 17.8 N·m/rad.
const P_SCALE: f64 = 17.8 / (STEPS_PER_RAD * 16.0 * 3.35);
/// Output for one step/s of speed error and one unit of gain. Assumed: it damps well with the gains as shipped.
const D_SCALE: f64 = 0.8 / (STEPS_PER_RAD * 32.0 * 3.35);
const STEPS_PER_RAD: f64 = STEPS / std::f64::consts::TAU;
/// Rated speed, 45 turns a minute. Speed 0 in a goal means this one.
const FULL_SPEED: f64 = 45.0 * STEPS / 60.0;
/// Steps/s² of one unit of the acceleration register.
const ACCELERATION_UNIT: f64 = 100.0;
/// Slower than this, steps/s, the servo says that it does not move.
const MOVING_SPEED: f64 = 2.0;

/// How it controls its motor, register 33.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Position,
    Wheel,
    Pwm,
    Step,
}

/// A servo of the STS3215 kind.
#[derive(Clone, Debug)]
pub struct Servo {
    memory: Memory,
    motor: Motor,
    profile: Profile,
    protection: Protection,
    /// Goal in mode 3, steps from the encoder's zero over all turns since power-on.
    step_goal: f64,
    /// Writes that wait for ACTION.
    registered: Option<(u8, Vec<u8>)>,
    /// Whole turns that the servo does not know of, since they happened before its power came.
    unknown_turns: f64,
    duty: f64,
    load: Load,
    supply_v: f64,
    ambient_c: f64,
    now_ns: u64,
}

/// What can be seen of a servo from outside, without the bus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Id by which it answers.
    pub id: u8,
    /// Present position as the register has it, steps.
    pub position_steps: i32,
    /// Position that it was told to go to, steps.
    pub goal_steps: i32,
    /// Angle of the shaft from the encoder's zero, steps.
    pub shaft_steps: f64,
    /// Speed of the shaft, steps/s.
    pub speed_steps_s: f64,
    /// Output of the driver, −1 to 1.
    pub duty: f64,
    /// Current of the motor, A.
    pub current_a: f64,
    /// Temperature, °C.
    pub temperature_c: f64,
    /// Supply, V.
    pub supply_v: f64,
    /// Whether its driver is on.
    pub has_torque: bool,
    /// Bits of [`status`].
    pub status: u8,
}

impl Servo {
    /// Returns a servo as it leaves the factory (id 1, 1 Mb/s), with power on, at rest with its shaft at `angle_steps` from the
    /// encoder's zero.
    pub fn new(version: Version, angle_steps: f64) -> Self {
        let ambient_c = 25.0;
        let mut servo = Self {
            memory: Memory::new(version.max_voltage()),
            motor: Motor::new(version, angle_steps, ambient_c),
            profile: Profile::default(),
            protection: Protection::default(),
            step_goal: 0.0,
            registered: None,
            unknown_turns: 0.0,
            duty: 0.0,
            load: Load::default(),
            supply_v: version.rated_v(),
            ambient_c,
            now_ns: 0,
        };
        servo.power_on();
        servo
    }

    /// The same with another id, as if it had been set up on its own.
    pub fn with_id(mut self, id: u8) -> Self {
        self.set_up(ID, u16::from(id));
        self
    }

    /// The same with the return delay that most arms are given, register 7, in units of 2 µs.
    pub fn with_return_delay(mut self, units: u8) -> Self {
        self.set_up(memory::RETURN_DELAY, u16::from(units));
        self
    }

    /// The same with another baud rate, register 6: 0 is 1 Mb/s, 7 is 38,400 b/s.
    pub fn with_baud_code(mut self, code: u8) -> Self {
        self.set_up(memory::BAUD_RATE, u16::from(code));
        self
    }

    /// The same with a homing offset, −2047 to 2047 steps, and position limits as a calibration writes them.
    pub fn with_calibration(mut self, homing_offset: i16, range_min: u16, range_max: u16) -> Self {
        self.set_up(HOMING_OFFSET, sign_magnitude(i32::from(homing_offset), 11));
        self.set_up(MIN_POSITION, range_min);
        self.set_up(MAX_POSITION, range_max);
        self
    }

    /// The same with mechanical stops, steps from the encoder's zero.
    pub fn with_stops(mut self, low: f64, high: f64) -> Self {
        self.motor.stops = Some((low, high));
        self
    }

    fn set_up(&mut self, register: memory::Register, value: u16) {
        self.memory.set(memory::LOCK, 0);
        self.memory.set_kept(register, value);
        self.memory.set(memory::LOCK, 1);
    }

    /// Puts it under power again: what is not kept in EEPROM starts anew, and turns are forgotten.
    pub fn power_on(&mut self) {
        self.memory.power_on();
        self.registered = None;
        self.protection = Protection::default();
        self.duty = 0.0;
        self.unknown_turns = (self.motor.angle_steps / STEPS).floor() * STEPS;
        self.profile = Profile::at(self.position());
        self.step_goal = self.position();
        self.memory
            .set(GOAL_POSITION, sign_magnitude(self.position() as i32, 15));
        self.feed_back();
    }

    /// Changes what the shaft works against.
    pub fn set_load(&mut self, load: Load) {
        self.load = load;
    }

    /// What the shaft works against.
    pub fn load(&self) -> Load {
        self.load
    }

    /// Changes the supply. Without one the driver is off; [`power_on`](Self::power_on) says that it is back.
    pub fn set_supply_v(&mut self, supply_v: f64) {
        self.supply_v = supply_v;
    }

    /// The supply, V.
    pub fn supply_v(&self) -> f64 {
        self.supply_v
    }

    /// Changes the temperature around it, °C.
    pub fn set_ambient_c(&mut self, ambient_c: f64) {
        self.ambient_c = ambient_c;
    }

    /// Heats the case to a temperature, °C.
    pub fn set_temperature_c(&mut self, temperature_c: f64) {
        self.motor.temperature_c = temperature_c;
    }

    /// Turns the shaft by hand to an angle, steps from the encoder's zero.
    pub fn turn_to(&mut self, angle_steps: f64) {
        self.motor.angle_steps = angle_steps;
        self.motor.speed_steps_s = 0.0;
    }

    /// Angle of the shaft from the encoder's zero over all turns, steps.
    pub fn shaft_steps(&self) -> f64 {
        self.motor.angle_steps
    }

    /// Gives it another id, kept without power.
    pub fn set_id(&mut self, id: u8) {
        let lock = self.memory.get(memory::LOCK);
        self.set_up(ID, u16::from(id));
        self.memory.set(memory::LOCK, lock);
    }

    /// Lets time pass up to `now_ns`.
    pub fn advance(&mut self, now_ns: u64) {
        let mut has_moved = false;
        while self.now_ns + CYCLE_NS <= now_ns {
            self.now_ns += CYCLE_NS;
            self.cycle();
            has_moved = true;
        }
        if has_moved {
            self.feed_back();
        }
    }

    /// What can be seen of it.
    pub fn view(&self) -> View {
        View {
            id: self.id(),
            position_steps: self.position() as i32,
            goal_steps: signed(self.memory.get(GOAL_POSITION), 15),
            shaft_steps: self.motor.angle_steps,
            speed_steps_s: self.motor.speed_steps_s,
            duty: self.duty,
            current_a: self.motor.current_a,
            temperature_c: self.motor.temperature_c,
            supply_v: self.supply_v,
            has_torque: self.has_torque(),
            status: self.protection.status(),
        }
    }

    fn has_torque(&self) -> bool {
        self.memory.get(TORQUE_ENABLE) == 1 && self.supply_v > 0.0
    }

    fn mode(&self) -> Mode {
        match self.memory.get(MODE) {
            1 => Mode::Wheel,
            2 => Mode::Pwm,
            3 => Mode::Step,
            _ => Mode::Position,
        }
    }

    /// Bit 4 of the phase register: positions are not wrapped. So do both limits at zero.
    fn counts_turns(&self) -> bool {
        let has_no_limits =
            self.memory.get(MIN_POSITION) == 0 && self.memory.get(MAX_POSITION) == 0;
        self.memory.get(PHASE) & 1 << 4 != 0 || has_no_limits
    }

    /// Present position: what the encoder says less the homing offset, steps.
    fn position(&self) -> f64 {
        let encoder = (self.motor.angle_steps - self.unknown_turns).floor();
        let position = encoder - f64::from(signed(self.memory.get(HOMING_OFFSET), 11));
        if self.counts_turns() {
            position
        } else {
            position.rem_euclid(STEPS)
        }
    }

    /// Bit 2 of the phase register: speeds have the unit of 1 step/s, else of 50.
    fn speed_unit(&self) -> f64 {
        if self.memory.get(PHASE) & 1 << 2 != 0 {
            1.0
        } else {
            50.0
        }
    }

    fn acceleration(&self) -> f64 {
        let most = self.memory.get(ACCELERATION_LIMIT);
        let wanted = match self.memory.get(ACCELERATION) {
            0 => most,
            wanted => wanted.min(most),
        };
        f64::from(wanted.max(1)) * ACCELERATION_UNIT
    }

    fn goal_speed(&self) -> f64 {
        f64::from(signed(self.memory.get(GOAL_SPEED), 15)) * self.speed_unit()
    }

    /// The goal of the position modes, within the limits.
    fn goal(&self) -> f64 {
        if self.mode() == Mode::Step {
            return self.step_goal;
        }
        let goal = f64::from(signed(self.memory.get(GOAL_POSITION), 15));
        let low = f64::from(self.memory.get(MIN_POSITION));
        let high = f64::from(self.memory.get(MAX_POSITION));
        if low < high {
            goal.clamp(low, high)
        } else {
            goal
        }
    }

    fn cycle(&mut self) {
        let driven = self.has_torque().then(|| self.output());
        if driven.is_none() {
            self.profile = Profile::at(self.position());
        }
        self.duty = driven.unwrap_or(0.0);
        self.motor
            .step(driven, self.supply_v, &self.load, self.ambient_c);
        let measured = Measured {
            effort: self.motor.effort(),
            current_a: self.motor.current_a,
            supply_v: self.supply_v,
            temperature_c: self.motor.temperature_c,
        };
        self.protection.step(&self.memory, &measured);
    }

    /// Output of the driver, −1 to 1.
    fn output(&mut self) -> f64 {
        let acceleration = self.acceleration();
        let wanted = match self.mode() {
            Mode::Position | Mode::Step => {
                let speed = match self.goal_speed().abs() {
                    0.0 => FULL_SPEED,
                    speed => speed.min(FULL_SPEED),
                };
                self.profile.towards(self.goal(), speed, acceleration);
                self.hold()
            }
            Mode::Wheel => {
                let speed = self.goal_speed().clamp(-FULL_SPEED, FULL_SPEED);
                self.profile.at_speed(speed, acceleration);
                // In this mode the position is only that which keeps the speed.
                let lag = self.profile.speed_steps_s - self.motor.speed_steps_s;
                self.profile.speed_steps_s / NO_LOAD_STEPS_S + lag * 32.0 * D_SCALE * 4.0
            }
            Mode::Pwm => f64::from(signed(self.memory.get(PWM), 10)) / 1000.0,
        };
        let limit = f64::from(self.memory.get(TORQUE_LIMIT)) / 1000.0;
        let limit = limit.min(self.protection.output_limit(&self.memory));
        wanted.clamp(-limit, limit)
    }

    /// The controller of the position modes: proportional to the error of position, damped by the error of speed.
    fn hold(&self) -> f64 {
        let error = self.profile.position_steps - self.exact_position();
        let zone = if error > 0.0 {
            CW_DEAD_ZONE
        } else {
            CCW_DEAD_ZONE
        };
        let zone = f64::from(self.memory.get(zone));
        let error = error.signum() * (error.abs() - zone).max(0.0);
        let lag = self.profile.speed_steps_s - self.motor.speed_steps_s;
        let p = f64::from(self.memory.get(P_GAIN)) * P_SCALE;
        let d = f64::from(self.memory.get(D_GAIN)) * D_SCALE;
        // What the motor generates is known from the profile's speed.
        error * p + lag * d + self.profile.speed_steps_s / NO_LOAD_STEPS_S
    }

    /// As [`position`](Self::position), with the part of a step that no register shows.
    fn exact_position(&self) -> f64 {
        let angle = self.motor.angle_steps;
        self.position() + (angle - angle.floor())
    }

    fn feed_back(&mut self) {
        let is_moving = self.motor.speed_steps_s.abs() > MOVING_SPEED
            || self.has_torque() && self.profile.speed_steps_s != 0.0;
        let current = (self.motor.current_a / CURRENT_UNIT_A).round() as u16;
        let speed = (self.motor.speed_steps_s / self.speed_unit()).round() as i32;
        let load = (self.duty * 1000.0).round() as i32;
        let position = self.position() as i32;
        let set = |memory: &mut Memory| {
            memory.set(PRESENT_POSITION, sign_magnitude(position, 15));
            memory.set(PRESENT_SPEED, sign_magnitude(speed, 15));
            memory.set(PRESENT_LOAD, sign_magnitude(load, 10));
            memory.set(PRESENT_CURRENT, current);
        };
        set(&mut self.memory);
        let volts = (self.supply_v * 10.0).round().clamp(0.0, 255.0) as u16;
        self.memory.set(PRESENT_VOLTAGE, volts);
        let degrees = self.motor.temperature_c.round().clamp(0.0, 255.0) as u16;
        self.memory.set(PRESENT_TEMPERATURE, degrees);
        self.memory.set(STATUS, u16::from(self.protection.status()));
        self.memory.set(MOVING, u16::from(is_moving));
        self.memory
            .set(PRESENT_GOAL, sign_magnitude(self.goal() as i32, 15));
    }
}

/// Seconds of a cycle are nanoseconds of a cycle.
const _: () = assert!((CYCLE_S * 1e9) as u64 == CYCLE_NS);
