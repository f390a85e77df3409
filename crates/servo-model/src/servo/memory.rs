//! The registers of an STS3215: an area that survives power, if it was written with the lock open, and one that does not.
//!
//! Addresses, sizes, ranges and defaults are those of the manufacturer's memory table for magnetic encoder STS servos.

/// A register: one byte, or two with the low one first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Register {
    address: u8,
    size: u8,
    /// Values that a write may leave in it; a write of any other changes nothing.
    range: (u16, u16),
}

/// Addresses 0 to 86; what lies behind reads as zero.
const SIZE: usize = 87;
/// The first address that loses its value without power.
const VOLATILE: usize = 40;
/// The first address of the control area, which can be written, and the first of the feedback behind it, which cannot.
const FEEDBACK: usize = 56;

const fn register(address: u8, size: u8, least: u16, most: u16) -> Register {
    Register {
        address,
        size,
        range: (least, most),
    }
}

pub const ID: Register = register(5, 1, 0, 253);
pub const BAUD_RATE: Register = register(6, 1, 0, 7);
pub const RETURN_DELAY: Register = register(7, 1, 0, 254);
pub const RESPONSE_LEVEL: Register = register(8, 1, 0, 1);
pub const MIN_POSITION: Register = register(9, 2, 0, 4094);
pub const MAX_POSITION: Register = register(11, 2, 0, 4095);
pub const MAX_TEMPERATURE: Register = register(13, 1, 0, 100);
pub const MAX_VOLTAGE: Register = register(14, 1, 0, 254);
pub const MIN_VOLTAGE: Register = register(15, 1, 0, 254);
pub const MAX_TORQUE: Register = register(16, 2, 0, 1000);
pub const PHASE: Register = register(18, 1, 0, 254);
pub const UNLOADING: Register = register(19, 1, 0, 254);
pub const P_GAIN: Register = register(21, 1, 0, 254);
pub const D_GAIN: Register = register(22, 1, 0, 254);
pub const CW_DEAD_ZONE: Register = register(26, 1, 0, 32);
pub const CCW_DEAD_ZONE: Register = register(27, 1, 0, 32);
pub const PROTECTION_CURRENT: Register = register(28, 2, 0, 2047);
pub const HOMING_OFFSET: Register = register(31, 2, 0, 4095);
pub const MODE: Register = register(33, 1, 0, 3);
pub const PROTECTIVE_TORQUE: Register = register(34, 1, 0, 100);
pub const PROTECTION_TIME: Register = register(35, 1, 0, 254);
pub const OVERLOAD_TORQUE: Register = register(36, 1, 0, 100);
pub const OVERCURRENT_TIME: Register = register(38, 1, 0, 254);
pub const TORQUE_ENABLE: Register = register(40, 1, 0, 128);
pub const ACCELERATION: Register = register(41, 1, 0, 254);
pub const GOAL_POSITION: Register = register(42, 2, 0, 0xFFFF);
pub const PWM: Register = register(44, 2, 0, 0xFFFF);
pub const GOAL_SPEED: Register = register(46, 2, 0, 0xFFFF);
pub const TORQUE_LIMIT: Register = register(48, 2, 0, 1000);
pub const LOCK: Register = register(55, 1, 0, 1);
pub const PRESENT_POSITION: Register = register(56, 2, 0, 0);
pub const PRESENT_SPEED: Register = register(58, 2, 0, 0);
pub const PRESENT_LOAD: Register = register(60, 2, 0, 0);
pub const PRESENT_VOLTAGE: Register = register(62, 1, 0, 0);
pub const PRESENT_TEMPERATURE: Register = register(63, 1, 0, 0);
pub const REG_WRITE_FLAG: Register = register(64, 1, 0, 0);
pub const STATUS: Register = register(65, 1, 0, 0);
pub const MOVING: Register = register(66, 1, 0, 0);
pub const PRESENT_GOAL: Register = register(67, 2, 0, 0);
pub const PRESENT_CURRENT: Register = register(69, 2, 0, 0);
pub const ACCELERATION_LIMIT: Register = register(85, 1, 0, 254);

/// Registers whose values have a range narrower than their bytes.
const RANGED: [Register; 31] = [
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
    UNLOADING,
    P_GAIN,
    D_GAIN,
    CW_DEAD_ZONE,
    CCW_DEAD_ZONE,
    PROTECTION_CURRENT,
    HOMING_OFFSET,
    MODE,
    PROTECTIVE_TORQUE,
    PROTECTION_TIME,
    OVERLOAD_TORQUE,
    OVERCURRENT_TIME,
    TORQUE_ENABLE,
    ACCELERATION,
    TORQUE_LIMIT,
    LOCK,
    register(20, 1, 0, 254),
    register(23, 1, 0, 254),
    register(37, 1, 0, 254),
    ACCELERATION_LIMIT,
];

impl Register {
    fn span(self) -> std::ops::Range<usize> {
        let start = usize::from(self.address);
        start..start + usize::from(self.size)
    }

    /// Whether a write of `length` bytes at `address` touches it.
    pub fn is_in(self, address: u8, length: usize) -> bool {
        let written = usize::from(address)..usize::from(address) + length;
        self.span().start < written.end && written.start < self.span().end
    }
}

/// A signed value in sign-magnitude form: the sign is a bit of its own.
pub fn sign_magnitude(value: i32, sign_bit: u32) -> u16 {
    let most = (1_u32 << sign_bit) - 1;
    let magnitude = value.unsigned_abs().min(most) as u16;
    if value < 0 {
        magnitude | 1 << sign_bit
    } else {
        magnitude
    }
}

/// The value of a field in sign-magnitude form.
pub fn signed(field: u16, sign_bit: u32) -> i32 {
    let magnitude = i32::from(field & ((1 << sign_bit) - 1));
    if field >> sign_bit & 1 == 1 {
        -magnitude
    } else {
        magnitude
    }
}

/// What a servo holds, with and without power.
#[derive(Clone, Debug)]
pub struct Memory {
    now: [u8; SIZE],
    kept: [u8; VOLATILE],
}

impl Memory {
    /// Returns the memory of a servo as it leaves the factory, with power on. `max_voltage` has the unit 0.1 V.
    pub fn new(max_voltage: u8) -> Self {
        let mut memory = Self {
            now: [0; SIZE],
            kept: [0; VOLATILE],
        };
        for (address, value) in FACTORY {
            memory.now[usize::from(address)] = value;
        }
        memory.set(MAX_VOLTAGE, u16::from(max_voltage));
        memory.set(MAX_POSITION, 4095);
        memory.set(MAX_TORQUE, 1000);
        memory.set(PROTECTION_CURRENT, 500);
        memory.kept.copy_from_slice(&memory.now[..VOLATILE]);
        memory.power_on();
        memory
    }

    /// Takes up what survived, and the defaults of all else.
    pub fn power_on(&mut self) {
        self.now[..VOLATILE].copy_from_slice(&self.kept);
        self.now[VOLATILE..80].fill(0);
        self.set(TORQUE_LIMIT, self.get(MAX_TORQUE));
        self.set(LOCK, 1);
    }

    pub fn get(&self, register: Register) -> u16 {
        match self.now[register.span()] {
            [low, high] => u16::from_le_bytes([low, high]),
            [byte] => u16::from(byte),
            _ => 0,
        }
    }

    /// Sets a register from inside of the servo.
    pub fn set(&mut self, register: Register, value: u16) {
        let bytes = value.to_le_bytes();
        self.now[register.span()].copy_from_slice(&bytes[..usize::from(register.size)]);
    }

    /// Sets a register and, with the lock open, its value for the next power-on.
    pub fn set_kept(&mut self, register: Register, value: u16) {
        self.set(register, value);
        self.keep(register.span());
    }

    /// Returns `length` bytes from `address` on.
    pub fn read(&self, address: u8, length: u8) -> Vec<u8> {
        let start = usize::from(address);
        (start..start + usize::from(length))
            .map(|at| self.now.get(at).copied().unwrap_or(0))
            .collect()
    }

    /// Writes what can be written. Feedback and versions stay, and so does a register that the value is out of range for.
    pub fn write(&mut self, address: u8, data: &[u8]) {
        let before = self.now;
        let start = usize::from(address);
        for (at, byte) in (start..).zip(data) {
            let is_writable = (5..FEEDBACK).contains(&at) || (80..SIZE).contains(&at);
            if let Some(cell) = self.now.get_mut(at).filter(|_| is_writable) {
                *cell = *byte;
            }
        }
        for register in RANGED {
            let (least, most) = register.range;
            let value = self.get(register);
            if register.is_in(address, data.len()) && !(least..=most).contains(&value) {
                self.now[register.span()].copy_from_slice(&before[register.span()]);
            }
        }
        self.keep(start..start + data.len());
    }

    fn keep(&mut self, written: std::ops::Range<usize>) {
        if self.get(LOCK) != 0 {
            return;
        }
        let end = written.end.min(VOLATILE);
        if let (Some(kept), Some(now)) = (
            self.kept.get_mut(written.start..end),
            self.now.get(written.start..end),
        ) {
            kept.copy_from_slice(now);
        }
    }
}

/// One-byte values as shipped. Firmware 3.10, model 777 as bytes 9 and 3; the factory area from 80 on.
const FACTORY: [(u8, u8); 27] = [
    (0, 3),
    (1, 10),
    (3, 9),
    (4, 3),
    (5, 1),
    (7, 250),
    (8, 1),
    (13, 70),
    (15, 40),
    (18, 12),
    (19, 44),
    (20, 47),
    (21, 32),
    (22, 32),
    (24, 16),
    (26, 1),
    (27, 1),
    (30, 1),
    (34, 20),
    (35, 200),
    (36, 80),
    (37, 10),
    (38, 200),
    (39, 200),
    (80, 2),
    (84, 68),
    (85, 254),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_under_lock_is_in_force_until_the_power_goes() {
        let mut memory = Memory::new(140);
        assert_eq!(memory.get(LOCK), 1);
        memory.write(31, &[0x34, 0x02]);
        assert_eq!(memory.get(HOMING_OFFSET), 0x234);
        memory.power_on();
        assert_eq!(memory.get(HOMING_OFFSET), 0);
        memory.write(55, &[0]);
        memory.write(31, &[0x34, 0x02]);
        memory.write(55, &[1]);
        memory.power_on();
        assert_eq!(memory.get(HOMING_OFFSET), 0x234);
        assert_eq!(memory.get(LOCK), 1);
    }

    #[test]
    fn opening_the_lock_later_keeps_nothing_that_was_written_before() {
        let mut memory = Memory::new(140);
        memory.write(5, &[9]);
        memory.write(55, &[0]);
        memory.power_on();
        assert_eq!(memory.get(ID), 1);
    }

    #[test]
    fn feedback_versions_and_values_out_of_range_stay() {
        let mut memory = Memory::new(140);
        memory.write(0, &[7, 7, 7, 7, 7, 254]);
        assert_eq!(memory.read(0, 6), [3, 10, 0, 9, 3, 1]);
        memory.write(56, &[1, 2, 3]);
        assert_eq!(memory.read(56, 3), [0, 0, 0]);
        memory.write(48, &[0xE9, 0x03]);
        assert_eq!(memory.get(TORQUE_LIMIT), 1000);
        memory.write(200, &[1, 2]);
        assert_eq!(memory.read(200, 2), [0, 0]);
        // Written in one go, what fits is taken and what does not stays.
        memory.write(33, &[4, 30]);
        assert_eq!((memory.get(MODE), memory.get(PROTECTIVE_TORQUE)), (0, 30));
    }

    #[test]
    fn the_torque_limit_starts_as_the_maximum_torque() {
        let mut memory = Memory::new(140);
        memory.write(55, &[0]);
        memory.write(16, &[0xF4, 0x01]);
        memory.power_on();
        assert_eq!(memory.get(TORQUE_LIMIT), 500);
    }

    #[test]
    fn sign_and_magnitude_are_apart() {
        for (value, bit, field) in [
            (0, 15, 0),
            (-1, 15, 0x8001),
            (2047, 11, 0x7FF),
            (-2047, 11, 0xFFF),
            (-500, 10, 0x5F4),
        ] {
            assert_eq!(sign_magnitude(value, bit), field);
            assert_eq!(signed(field, bit), value);
        }
    }
}
