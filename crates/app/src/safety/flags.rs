//! Fault conditions, as bits whose positions never change: recordings and the PC link carry them.

/// A set of conditions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct SafetyFlags(u32);

bitflags::bitflags! {
    impl SafetyFlags: u32 {
        /// No frame came over the air within the time limit.
        const REMOTE_LOST = 1 << 0;
        /// The receiver reports the loss of the radio.
        const REMOTE_FAILSAFE = 1 << 1;
        /// Too many of the last 64 frames were lost.
        const REMOTE_QUALITY = 1 << 2;
        /// The pilot has thrown the e-stop.
        const E_STOP = 1 << 3;
        /// The attitude estimate is not valid.
        const ESTIMATE_INVALID = 1 << 4;
        /// The last IMU sample is too old.
        const IMU_STALE = 1 << 5;
        /// Too many SPI errors or rejected samples of the IMU.
        const IMU_ERRORS = 1 << 6;
        /// Too many I2C errors or rejected samples of the magnetometer.
        const MAG_ERRORS = 1 << 7;
        /// CAN1 is bus-off.
        const CAN1_FAULT = 1 << 8;
        /// CAN2 is bus-off.
        const CAN2_FAULT = 1 << 9;
        /// Too many consecutive frames could not be sent on CAN1.
        const CAN1_CONGESTED = 1 << 10;
        /// Too many consecutive frames could not be sent on CAN2.
        const CAN2_CONGESTED = 1 << 11;
        /// No feedback of the left wheel came within the time limit. Its control falls back to open loop.
        const WHEEL_LEFT_SILENT = 1 << 12;
        /// As [`WHEEL_LEFT_SILENT`](Self::WHEEL_LEFT_SILENT) for the right wheel.
        const WHEEL_RIGHT_SILENT = 1 << 13;
        /// No command on the logic bus is fresh.
        const COMMAND_STALE = 1 << 14;
        /// A task other than the control tick missed its deadline. Unless it recovers, the watchdog resets the chip.
        const TASK_LATE = 1 << 15;
        /// The robot has fallen over.
        const TILT = 1 << 16;
        /// A wheel motor is too hot.
        const WHEEL_HOT = 1 << 17;
        /// A joint motor is too hot.
        const JOINT_HOT = 1 << 18;
        /// The battery is low, or not measured. This stops nothing but blocks arming.
        const BATTERY_LOW = 1 << 19;
        /// The battery is empty.
        const BATTERY_EMPTY = 1 << 20;
        /// A joint motor reports a fault and gives no torque.
        const JOINT_FAULT = 1 << 21;
        /// No reply of a joint came within the time limit.
        const JOINT_SILENT = 1 << 22;
        /// A wheel motor repeats an old report.
        const WHEEL_FROZEN = 1 << 23;
        /// A joint motor repeats an old position.
        const JOINT_FROZEN = 1 << 24;
        /// A joint motor replies, but could not be set up or enabled within a second. Its settings differ, or it is
        /// another motor.
        const JOINT_NOT_READY = 1 << 25;
        /// The cause of a partial stop has ended, but the part waits until the sticks have been centred.
        const STICKS_AWAITED = 1 << 26;
        /// In mode PC: no command of the PC is fresh, or the PC repeats one that turns the wheels.
        const PC_LOST = 1 << 27;
        /// In mode PC: the PC is heard, but has not yet sent a command from rest.
        const PC_AWAITED = 1 << 28;
        /// The robot stood and has lost its balance, or a part that it needs for that.
        const BALANCE_LOST = 1 << 29;
        /// The robot still lay when the time for standing up was over.
        const STAND_UP_FAILED = 1 << 30;
    }
}

impl SafetyFlags {
    /// The empty set.
    pub const NONE: Self = Self(0);

    /// Each of these stops every actuator.
    pub const GLOBAL_STOP: Self = Self(
        Self::REMOTE_LOST.0
            | Self::REMOTE_FAILSAFE.0
            | Self::REMOTE_QUALITY.0
            | Self::E_STOP.0
            | Self::ESTIMATE_INVALID.0
            | Self::IMU_STALE.0
            | Self::IMU_ERRORS.0
            | Self::MAG_ERRORS.0
            | Self::TASK_LATE.0
            | Self::TILT.0
            | Self::BATTERY_EMPTY.0
            | Self::BALANCE_LOST.0
            | Self::STAND_UP_FAILED.0,
    );
    /// Each of these stops both wheels.
    pub const WHEELS_STOP: Self = Self(Self::WHEEL_HOT.0 | Self::WHEEL_FROZEN.0);
    /// Each of these stops all joints: the robot cannot stand on its legs with one joint dead.
    pub const JOINTS_STOP: Self = Self(
        Self::JOINT_HOT.0
            | Self::JOINT_FAULT.0
            | Self::JOINT_SILENT.0
            | Self::JOINT_FROZEN.0
            | Self::JOINT_NOT_READY.0,
    );
    /// Each of these stops everything on its bus. Index = `BusId`.
    pub const BUS_STOP: [Self; 2] = [
        Self(Self::CAN1_FAULT.0 | Self::CAN1_CONGESTED.0),
        Self(Self::CAN2_FAULT.0 | Self::CAN2_CONGESTED.0),
    ];
    /// Each of these gives every actuator zero torque, but leaves the robot armed. A robot that stands balances on the
    /// spot instead.
    pub const PC_STOP: Self = Self(Self::PC_LOST.0 | Self::PC_AWAITED.0);
    /// The robot has fallen. A request to stand up lifts these stops for a while.
    pub const FALLEN: Self = Self(Self::TILT.0 | Self::BALANCE_LOST.0);
    /// These are latched until the pilot clears them, so that a person looks first.
    pub const LATCHING: Self = Self(
        Self::IMU_ERRORS.0
            | Self::MAG_ERRORS.0
            | Self::TILT.0
            | Self::BATTERY_EMPTY.0
            | Self::JOINT_FAULT.0
            | Self::WHEEL_FROZEN.0
            | Self::JOINT_FROZEN.0
            | Self::JOINT_NOT_READY.0
            | Self::BALANCE_LOST.0
            | Self::STAND_UP_FAILED.0,
    );

    pub(super) fn add_if(&mut self, flag: Self, active: bool) {
        if active {
            self.insert(flag);
        }
    }

    /// Names of the conditions in the set, lowest bit first.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        FLAG_NAMES
            .iter()
            .filter(move |(flag, _)| self.intersects(*flag))
            .map(|(_, name)| *name)
    }

    /// Name of a bit, or `None` for an unused one.
    pub fn name_of_bit(bit: u8) -> Option<&'static str> {
        let mut names = FLAG_NAMES.iter();
        let found = names.find(|(flag, _)| flag.0.trailing_zeros() == u32::from(bit));
        found.map(|(_, name)| *name)
    }
}

/// A static rather than a constant, as tools read the names of the bits from the image.
static FLAG_NAMES: [(SafetyFlags, &str); 31] = [
    (SafetyFlags::REMOTE_LOST, "remote-lost"),
    (SafetyFlags::REMOTE_FAILSAFE, "remote-failsafe"),
    (SafetyFlags::REMOTE_QUALITY, "remote-quality"),
    (SafetyFlags::E_STOP, "e-stop"),
    (SafetyFlags::ESTIMATE_INVALID, "estimate-invalid"),
    (SafetyFlags::IMU_STALE, "imu-stale"),
    (SafetyFlags::IMU_ERRORS, "imu-errors"),
    (SafetyFlags::MAG_ERRORS, "mag-errors"),
    (SafetyFlags::CAN1_FAULT, "can1-fault"),
    (SafetyFlags::CAN2_FAULT, "can2-fault"),
    (SafetyFlags::CAN1_CONGESTED, "can1-congested"),
    (SafetyFlags::CAN2_CONGESTED, "can2-congested"),
    (SafetyFlags::WHEEL_LEFT_SILENT, "wheel-left-silent"),
    (SafetyFlags::WHEEL_RIGHT_SILENT, "wheel-right-silent"),
    (SafetyFlags::COMMAND_STALE, "command-stale"),
    (SafetyFlags::TASK_LATE, "task-late"),
    (SafetyFlags::TILT, "tilt"),
    (SafetyFlags::WHEEL_HOT, "wheel-hot"),
    (SafetyFlags::JOINT_HOT, "joint-hot"),
    (SafetyFlags::BATTERY_LOW, "battery-low"),
    (SafetyFlags::BATTERY_EMPTY, "battery-empty"),
    (SafetyFlags::JOINT_FAULT, "joint-fault"),
    (SafetyFlags::JOINT_SILENT, "joint-silent"),
    (SafetyFlags::WHEEL_FROZEN, "wheel-frozen"),
    (SafetyFlags::JOINT_FROZEN, "joint-frozen"),
    (SafetyFlags::JOINT_NOT_READY, "joint-not-ready"),
    (SafetyFlags::STICKS_AWAITED, "sticks-awaited"),
    (SafetyFlags::PC_LOST, "pc-lost"),
    (SafetyFlags::PC_AWAITED, "pc-awaited"),
    (SafetyFlags::BALANCE_LOST, "balance-lost"),
    (SafetyFlags::STAND_UP_FAILED, "stand-up-failed"),
];

#[cfg(feature = "defmt")]
impl defmt::Format for SafetyFlags {
    fn format(&self, f: defmt::Formatter<'_>) {
        if self.is_empty() {
            defmt::write!(f, "none");
        }
        for name in self.names() {
            defmt::write!(f, "{=str} ", name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_flag_has_the_bit_of_its_table_index() {
        for (place, (flag, name)) in (0..).zip(FLAG_NAMES) {
            assert_eq!(flag.bits(), 1 << place, "{name}");
            assert_eq!(SafetyFlags::name_of_bit(place), Some(name));
        }
        assert_eq!(SafetyFlags::name_of_bit(31), None);
    }

    /// The sets of docs/safety.md.
    #[test]
    fn the_sets_hold_the_documented_flags() {
        let [can1, can2] = SafetyFlags::BUS_STOP;
        let sets: [(SafetyFlags, &[&str]); 8] = [
            (
                SafetyFlags::GLOBAL_STOP,
                &[
                    "remote-lost",
                    "remote-failsafe",
                    "remote-quality",
                    "e-stop",
                    "estimate-invalid",
                    "imu-stale",
                    "imu-errors",
                    "mag-errors",
                    "task-late",
                    "tilt",
                    "battery-empty",
                    "balance-lost",
                    "stand-up-failed",
                ],
            ),
            (SafetyFlags::FALLEN, &["tilt", "balance-lost"]),
            (SafetyFlags::WHEELS_STOP, &["wheel-hot", "wheel-frozen"]),
            (
                SafetyFlags::JOINTS_STOP,
                &[
                    "joint-hot",
                    "joint-fault",
                    "joint-silent",
                    "joint-frozen",
                    "joint-not-ready",
                ],
            ),
            (SafetyFlags::PC_STOP, &["pc-lost", "pc-awaited"]),
            (can1, &["can1-fault", "can1-congested"]),
            (can2, &["can2-fault", "can2-congested"]),
            (
                SafetyFlags::LATCHING,
                &[
                    "imu-errors",
                    "mag-errors",
                    "tilt",
                    "battery-empty",
                    "joint-fault",
                    "wheel-frozen",
                    "joint-frozen",
                    "joint-not-ready",
                    "balance-lost",
                    "stand-up-failed",
                ],
            ),
        ];
        for (set, names) in sets {
            assert!(set.names().eq(names.iter().copied()), "{names:?}");
        }
    }
}
