//! Commands on their way from the pilot to the motors.

use crate::math::scalar;

/// A normalised drive command from the pilot or a planner.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct HighLevelCommand {
    /// Forward, −1…1.
    pub vx: f32,
    /// Turn, −1…1, counter-clockwise from above positive.
    pub wz: f32,
    /// Leg length while standing, −1…1: shortest, middle, longest.
    pub height: f32,
    /// Roll while standing, −1…1, right side down positive.
    pub roll: f32,
    /// Jump. It is set from the pilot's request on for a tenth of a second.
    pub jump: bool,
    /// Stand up and balance. Without it the robot sits down.
    pub stand: bool,
}

/// Current of one wheel motor in the motor's own direction (see `WheelFeedback`). A requested current may have any
/// value, even NaN. Only a [`MotorCurrent`] leaves the board.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct WheelCommand {
    /// Torque current in mA.
    pub current_ma: f32,
}

/// Control mode of a joint motor. It is a whole word, so commands have no padding and are copied fast.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u32)]
pub enum JointMode {
    /// Enabled without torque: the joint turns freely.
    #[default]
    Off = 0,
    /// Torque = `kp`·(`pos_rad` − angle) + `kd`·(`vel_rps` − speed) + `tau_nm`.
    Mit = 1,
    /// Move to `pos_rad` at no more than `vel_rps`.
    PositionSpeed = 2,
    /// Turn at `vel_rps`.
    Speed = 3,
}

/// Command of one joint in joint coordinates (see `JointFeedback`). A requested command may hold any value, even NaN.
/// Limits are applied before anything leaves the board.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct JointCommand {
    /// Control mode.
    pub mode: JointMode,
    /// Target angle in rad.
    pub pos_rad: f32,
    /// Target speed, or speed limit, in rad/s.
    pub vel_rps: f32,
    /// Stiffness in N·m/rad.
    pub kp: f32,
    /// Damping in N·m·s/rad.
    pub kd: f32,
    /// Feed-forward torque in N·m.
    pub tau_nm: f32,
}

/// Commands of all actuators.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct ChassisCommand {
    /// Left, right.
    pub wheels: [WheelCommand; 2],
    /// Left front, left rear, right front, right rear.
    pub joints: [JointCommand; 4],
}

impl ChassisCommand {
    /// No current and no torque: the default as a constant.
    pub const STOP: Self = {
        let wheel = WheelCommand { current_ma: 0.0 };
        let joint = JointCommand {
            mode: JointMode::Off,
            pos_rad: 0.0,
            vel_rps: 0.0,
            kp: 0.0,
            kd: 0.0,
            tau_nm: 0.0,
        };
        Self {
            wheels: [wheel; 2],
            joints: [joint; 4],
        }
    };
}

/// A motor current that may leave the board: finite and within the limit it was made with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotorCurrent {
    ma: f32,
}

impl MotorCurrent {
    /// No current.
    pub const ZERO: Self = Self { ma: 0.0 };
    /// Full scale of the C620 in mA: ±20 A (datasheet).
    pub const FULL_SCALE_MA: f32 = 20_000.0;

    /// Clamps a current to ±`limit_ma`, and the limit itself to 0…20 A. NaN on either side gives zero.
    pub fn clamped(requested_ma: f32, limit_ma: f32) -> Self {
        if requested_ma.is_nan() || limit_ma.is_nan() {
            return Self::ZERO;
        }
        let limit = limit_ma.clamp(0.0, Self::FULL_SCALE_MA);
        Self {
            ma: scalar::clamp(requested_ma, -limit, limit),
        }
    }

    /// The current in mA.
    pub const fn ma(self) -> f32 {
        self.ma
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motor_current_is_finite_and_limited() {
        let cases = [
            (f32::NAN, 8_000.0, 0.0),
            (1.0, f32::NAN, 0.0),
            (f32::INFINITY, 8_000.0, 8_000.0),
            (f32::NEG_INFINITY, 8_000.0, -8_000.0),
            (9_000.0, -1.0, 0.0),
            (-30_000.0, f32::INFINITY, -20_000.0),
            (123.0, 8_000.0, 123.0),
        ];
        for (requested, limit, expected) in cases {
            assert_eq!(MotorCurrent::clamped(requested, limit).ma(), expected);
        }
    }
}
