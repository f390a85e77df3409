//! The registers, by address.

use super::{Encoding, Memory, Register};

/// Major version of the servo's firmware.
pub const FIRMWARE_MAJOR: Register =
    Register::new("firmware_major", 0, 1, Encoding::Unsigned, Memory::ReadOnly);

/// Minor version of the servo's firmware.
pub const FIRMWARE_MINOR: Register =
    Register::new("firmware_minor", 1, 1, Encoding::Unsigned, Memory::ReadOnly);

/// 777 is an STS3215.
pub const MODEL: Register = Register::new("model", 3, 2, Encoding::Unsigned, Memory::ReadOnly);

/// 0 to 253; 1 as shipped.
pub const ID: Register = Register::new("id", 5, 1, Encoding::Unsigned, Memory::Eeprom);

/// 0 is 1 Mb/s, 1 500 kb/s, 2 250 kb/s, 3 128 kb/s, 4 115,200 b/s. Sources disagree on what follows.
pub const BAUD_RATE: Register =
    Register::new("baud_rate", 6, 1, Encoding::Unsigned, Memory::Eeprom);

/// Time before an answer, in 2 µs; 250 as shipped.
pub const RETURN_DELAY: Register =
    Register::new("return_delay", 7, 1, Encoding::Unsigned, Memory::Eeprom);

/// 0: only reads and pings are answered; 1: every request.
pub const RESPONSE_LEVEL: Register =
    Register::new("response_level", 8, 1, Encoding::Unsigned, Memory::Eeprom);

/// Lowest goal that the servo takes, in steps.
pub const MIN_POSITION: Register =
    Register::new("min_position", 9, 2, Encoding::Unsigned, Memory::Eeprom);

/// Highest goal that the servo takes, in steps.
pub const MAX_POSITION: Register =
    Register::new("max_position", 11, 2, Encoding::Unsigned, Memory::Eeprom);

/// °C.
pub const MAX_TEMPERATURE: Register =
    Register::new("max_temperature", 13, 1, Encoding::Unsigned, Memory::Eeprom);

/// 0.1 V.
pub const MAX_VOLTAGE: Register =
    Register::new("max_voltage", 14, 1, Encoding::Unsigned, Memory::Eeprom);

/// 0.1 V.
pub const MIN_VOLTAGE: Register =
    Register::new("min_voltage", 15, 1, Encoding::Unsigned, Memory::Eeprom);

/// 0.1 % of the stall torque.
pub const MAX_TORQUE: Register =
    Register::new("max_torque", 16, 2, Encoding::Unsigned, Memory::Eeprom);

/// Settings of the drive; bit 4 makes the position count turns.
pub const PHASE: Register = Register::new("phase", 18, 1, Encoding::Unsigned, Memory::Eeprom);

/// Proportional gain of the position loop.
pub const P_GAIN: Register = Register::new("p_gain", 21, 1, Encoding::Unsigned, Memory::Eeprom);

/// Differential gain of the position loop.
pub const D_GAIN: Register = Register::new("d_gain", 22, 1, Encoding::Unsigned, Memory::Eeprom);

/// Integral gain of the position loop.
pub const I_GAIN: Register = Register::new("i_gain", 23, 1, Encoding::Unsigned, Memory::Eeprom);

/// Steps.
pub const DEAD_ZONE_CW: Register =
    Register::new("dead_zone_cw", 26, 1, Encoding::Unsigned, Memory::Eeprom);

/// Steps.
pub const DEAD_ZONE_CCW: Register =
    Register::new("dead_zone_ccw", 27, 1, Encoding::Unsigned, Memory::Eeprom);

/// 6.5 mA.
pub const PROTECTION_CURRENT: Register = Register::new(
    "protection_current",
    28,
    2,
    Encoding::Unsigned,
    Memory::Eeprom,
);

/// Steps: the servo reports the angle of its shaft less this.
pub const HOMING_OFFSET: Register = Register::new(
    "homing_offset",
    31,
    2,
    Encoding::SignMagnitude(11),
    Memory::Eeprom,
);

/// 0 position, 1 speed, 2 open loop, 3 steps.
pub const MODE: Register = Register::new("mode", 33, 1, Encoding::Unsigned, Memory::Eeprom);

/// Torque that is left after an overload, in %.
pub const PROTECTION_TORQUE: Register = Register::new(
    "protection_torque",
    34,
    1,
    Encoding::Unsigned,
    Memory::Eeprom,
);

/// How long an overload lasts before it counts, in 10 ms.
pub const PROTECTION_TIME: Register =
    Register::new("protection_time", 35, 1, Encoding::Unsigned, Memory::Eeprom);

/// Torque that counts as an overload, in %.
pub const OVERLOAD_TORQUE: Register =
    Register::new("overload_torque", 36, 1, Encoding::Unsigned, Memory::Eeprom);

/// 1 on, 0 off; 128 makes the present angle the middle, 2048.
pub const TORQUE_ENABLE: Register =
    Register::new("torque_enable", 40, 1, Encoding::Unsigned, Memory::Ram);

/// 100 steps/s²; 0 is the most.
pub const ACCELERATION: Register =
    Register::new("acceleration", 41, 1, Encoding::Unsigned, Memory::Ram);

/// Steps.
pub const GOAL_POSITION: Register = Register::new(
    "goal_position",
    42,
    2,
    Encoding::SignMagnitude(15),
    Memory::Ram,
);

/// The manufacturer's SDK always writes 0.
pub const GOAL_TIME: Register = Register::new("goal_time", 44, 2, Encoding::Unsigned, Memory::Ram);

/// Steps/s; 0 is the most.
pub const GOAL_SPEED: Register = Register::new(
    "goal_speed",
    46,
    2,
    Encoding::SignMagnitude(15),
    Memory::Ram,
);

/// 0.1 % of the stall torque.
pub const TORQUE_LIMIT: Register =
    Register::new("torque_limit", 48, 2, Encoding::Unsigned, Memory::Ram);

/// 1: writes to registers that survive without power are lost with it; 0: they are stored.
pub const LOCK: Register = Register::new("lock", 55, 1, Encoding::Unsigned, Memory::Ram);

/// Steps, 4096 a turn.
pub const PRESENT_POSITION: Register = Register::new(
    "present_position",
    56,
    2,
    Encoding::SignMagnitude(15),
    Memory::ReadOnly,
);

/// Steps/s.
pub const PRESENT_SPEED: Register = Register::new(
    "present_speed",
    58,
    2,
    Encoding::SignMagnitude(15),
    Memory::ReadOnly,
);

/// 0.1 % of the full drive.
pub const PRESENT_LOAD: Register = Register::new(
    "present_load",
    60,
    2,
    Encoding::SignMagnitude(10),
    Memory::ReadOnly,
);

/// 0.1 V.
pub const PRESENT_VOLTAGE: Register = Register::new(
    "present_voltage",
    62,
    1,
    Encoding::Unsigned,
    Memory::ReadOnly,
);

/// °C.
pub const PRESENT_TEMPERATURE: Register = Register::new(
    "present_temperature",
    63,
    1,
    Encoding::Unsigned,
    Memory::ReadOnly,
);

/// The servo's [alarms](crate::bus::Alarms).
pub const STATUS: Register = Register::new("status", 65, 1, Encoding::Unsigned, Memory::ReadOnly);

/// 1 while the servo moves.
pub const MOVING: Register = Register::new("moving", 66, 1, Encoding::Unsigned, Memory::ReadOnly);

/// 6.5 mA.
pub const PRESENT_CURRENT: Register = Register::new(
    "present_current",
    69,
    2,
    Encoding::SignMagnitude(15),
    Memory::ReadOnly,
);

/// All of them, by address.
pub const ALL: [Register; 40] = [
    FIRMWARE_MAJOR,
    FIRMWARE_MINOR,
    MODEL,
    ID,
    BAUD_RATE,
    RETURN_DELAY,
    RESPONSE_LEVEL,
    MIN_POSITION,
    MAX_POSITION,
    MAX_TEMPERATURE,
    MAX_VOLTAGE,
    MIN_VOLTAGE,
    MAX_TORQUE,
    PHASE,
    P_GAIN,
    D_GAIN,
    I_GAIN,
    DEAD_ZONE_CW,
    DEAD_ZONE_CCW,
    PROTECTION_CURRENT,
    HOMING_OFFSET,
    MODE,
    PROTECTION_TORQUE,
    PROTECTION_TIME,
    OVERLOAD_TORQUE,
    TORQUE_ENABLE,
    ACCELERATION,
    GOAL_POSITION,
    GOAL_TIME,
    GOAL_SPEED,
    TORQUE_LIMIT,
    LOCK,
    PRESENT_POSITION,
    PRESENT_SPEED,
    PRESENT_LOAD,
    PRESENT_VOLTAGE,
    PRESENT_TEMPERATURE,
    STATUS,
    MOVING,
    PRESENT_CURRENT,
];
