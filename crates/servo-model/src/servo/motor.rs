//! The motor with its gears, driver and heat.

use std::f64::consts::TAU;

/// Steps of the encoder in one turn of the output shaft.
pub const STEPS: f64 = 4096.0;
/// Length of the servo's control cycle. Assumed.
pub const CYCLE_S: f64 = 1e-3;

/// Friction that does not depend on speed, and inertia of rotor and gears seen at the output. From the SO-101's MJCF.
const DRY_FRICTION_NM: f64 = 0.052;
const ROTOR_KGM2: f64 = 0.028;
/// Speed at full output without load. The servo itself goes no faster than 45 turns a minute, its rated speed; assumed is that it
/// then still has something left to control with.
const NO_LOAD_RAD_S: f64 = 50.0 * TAU / 60.0;
/// The same, steps/s.
pub const NO_LOAD_STEPS_S: f64 = 50.0 * STEPS / 60.0;
/// Current at full voltage and standstill.
const STALL_A: f64 = 2.7;
/// Heat: the case warms 17 °C for each A² in the long run, with a time constant of five minutes. Set so that 1.5 kg on 10 cm warm
/// it by some 15 °C in ten minutes, as users have measured.
const HEATING_C_PER_A2: f64 = 17.0;
const HEAT_TIME_S: f64 = 300.0;

/// A version of the servo, by its supply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// STS3215-C001, 7.4 V, 19.5 kg·cm.
    Volts7,
    /// STS3215-C018, 12 V, 30 kg·cm.
    Volts12,
}

impl Version {
    /// The supply that it is made for, V.
    pub fn rated_v(self) -> f64 {
        match self {
            Self::Volts7 => 7.4,
            Self::Volts12 => 12.0,
        }
    }

    /// Limit of the supply as shipped, 0.1 V.
    pub fn max_voltage(self) -> u8 {
        match self {
            Self::Volts7 => 80,
            Self::Volts12 => 140,
        }
    }

    fn stall_nm(self) -> f64 {
        let kg_cm = match self {
            Self::Volts7 => 19.5,
            Self::Volts12 => 30.0,
        };
        kg_cm * 9.81 * 0.01
    }
}

/// What the output shaft works against.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Torque on the shaft in the direction of growing steps, N·m.
    pub torque_nm: f64,
    /// Inertia beside the rotor's, kg·m².
    pub inertia_kgm2: f64,
    /// The shaft cannot move.
    pub is_blocked: bool,
}

/// The state of the mechanics.
#[derive(Clone, Debug)]
pub struct Motor {
    version: Version,
    /// Angle of the shaft from the encoder's zero over all turns, steps.
    pub angle_steps: f64,
    pub speed_steps_s: f64,
    pub temperature_c: f64,
    pub current_a: f64,
    /// Where the mechanics end, steps.
    pub stops: Option<(f64, f64)>,
}

impl Motor {
    pub fn new(version: Version, angle_steps: f64, temperature_c: f64) -> Self {
        Self {
            version,
            angle_steps,
            speed_steps_s: 0.0,
            temperature_c,
            current_a: 0.0,
            stops: None,
        }
    }

    /// Torque of the motor as a part of what it has at standstill, 0 to 1.
    pub fn effort(&self) -> f64 {
        self.current_a / STALL_A
    }

    /// Moves for one cycle. `duty` is the part of the supply at the motor, −1 to 1, or `None` with the driver off.
    pub fn step(&mut self, duty: Option<f64>, supply_v: f64, load: &Load, ambient_c: f64) {
        let speed = self.speed_steps_s * TAU / STEPS;
        let strength = supply_v / self.version.rated_v();
        // What drives the current: the voltage less what the motor generates. A driver that is off lets none flow.
        let drive = duty.map_or(0.0, |duty| duty * strength - speed / NO_LOAD_RAD_S);
        self.current_a = STALL_A * drive.abs();
        let torque = self.version.stall_nm() * drive + load.torque_nm;
        let inertia = ROTOR_KGM2 + load.inertia_kgm2;
        // Dry friction brings the shaft to rest, but never turns it.
        let pushed = speed + torque / inertia * CYCLE_S;
        let rubbed = DRY_FRICTION_NM / inertia * CYCLE_S;
        let speed = pushed.signum() * (pushed.abs() - rubbed).max(0.0);
        self.speed_steps_s = if load.is_blocked {
            0.0
        } else {
            speed * STEPS / TAU
        };
        self.angle_steps += self.speed_steps_s * CYCLE_S;
        if let Some((low, high)) = self.stops
            && !(low..=high).contains(&self.angle_steps)
        {
            self.angle_steps = self.angle_steps.clamp(low, high);
            self.speed_steps_s = 0.0;
        }
        let heating = HEATING_C_PER_A2 * self.current_a * self.current_a;
        self.temperature_c += (ambient_c + heating - self.temperature_c) * CYCLE_S / HEAT_TIME_S;
    }
}
