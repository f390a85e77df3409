//! The bring-up sequence, in the order of Bosch's driver.

use super::registers::{READ, SOFT_RESET_COMMAND, accel, gyro};

/// The die that a transfer is for, by its chip select.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SpiTarget {
    /// The accelerometer's die.
    Accel,
    /// The gyro's die.
    Gyro,
}

/// What a failed check of the bring-up found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum InitCheck {
    /// The accelerometer does not answer with its chip id.
    AccelMissing,
    /// The accelerometer's register PWR_CTRL does not read back.
    AccelPowerNotKept,
    /// The accelerometer's register CONF does not read back.
    AccelFilterNotKept,
    /// The accelerometer's range does not read back.
    AccelRangeNotKept,
    /// The gyro does not answer with its chip id.
    GyroMissing,
    /// The gyro's range does not read back.
    GyroRangeNotKept,
    /// The gyro's bandwidth does not read back.
    GyroBandwidthNotKept,
    /// The mode of the gyro's buffer does not read back.
    GyroBufferNotKept,
}

/// One step of the bring-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitStep {
    /// Read a register and ignore the value. The rising chip select switches the accelerometer from I2C to SPI.
    DummyRead {
        /// The die to read.
        target: SpiTarget,
        /// Address of the register.
        register: u8,
    },
    /// Send [`write_command`].
    Write {
        /// The die to write to.
        target: SpiTarget,
        /// Address of the register.
        register: u8,
        /// Its new value.
        value: u8,
    },
    /// Send [`read_command`]. If the last byte received is not `expected`, the bring-up has failed.
    Check {
        /// The die to read.
        target: SpiTarget,
        /// Address of the register.
        register: u8,
        /// The value that it must hold.
        expected: u8,
        /// What another value means.
        failure: InitCheck,
    },
    /// Leave the sensor alone for this long.
    Wait {
        /// Time in µs.
        us: u32,
    },
}

/// Bytes to send for a register write.
pub const fn write_command(register: u8, value: u8) -> [u8; 2] {
    [register & !READ, value]
}

/// Bytes to send for a one-byte register read, and how many of the three to send. The value is the last byte received:
/// the accelerometer answers one byte later than the gyro.
pub const fn read_command(target: SpiTarget, register: u8) -> ([u8; 3], usize) {
    let len = match target {
        SpiTarget::Accel => 3,
        SpiTarget::Gyro => 2,
    };
    ([register | READ, 0, 0], len)
}

const fn accel_write(register: u8, value: u8) -> InitStep {
    InitStep::Write {
        target: SpiTarget::Accel,
        register,
        value,
    }
}

const fn accel_check(register: u8, expected: u8, failure: InitCheck) -> InitStep {
    InitStep::Check {
        target: SpiTarget::Accel,
        register,
        expected,
        failure,
    }
}

const fn gyro_write(register: u8, value: u8) -> InitStep {
    InitStep::Write {
        target: SpiTarget::Gyro,
        register,
        value,
    }
}

const fn gyro_check(register: u8, expected: u8, failure: InitCheck) -> InitStep {
    InitStep::Check {
        target: SpiTarget::Gyro,
        register,
        expected,
        failure,
    }
}

const SELECT_SPI: InitStep = InitStep::DummyRead {
    target: SpiTarget::Accel,
    register: accel::CHIP_ID,
};

/// The bring-up, to be carried out in order. It takes about 130 ms, nearly all of it waiting, and also works on a
/// sensor that is already running.
pub const INIT: &[InitStep] = &[
    // Accelerometer: start-up after reset takes 1 ms.
    SELECT_SPI,
    accel_write(accel::SOFT_RESET, SOFT_RESET_COMMAND),
    InitStep::Wait { us: 2_000 },
    SELECT_SPI,
    InitStep::Wait { us: 100 },
    accel_check(
        accel::CHIP_ID,
        accel::CHIP_ID_VALUE,
        InitCheck::AccelMissing,
    ),
    // Out of suspend. The datasheet asks for 450 µs between writes until then; Bosch's driver waits 5 ms.
    accel_write(accel::PWR_CONF, accel::PWR_CONF_ACTIVE),
    InitStep::Wait { us: 5_000 },
    accel_write(accel::PWR_CTRL, accel::PWR_CTRL_ON),
    InitStep::Wait { us: 5_000 },
    accel_write(accel::CONF, accel::CONF_800HZ_OSR4),
    InitStep::Wait { us: 40_000 },
    accel_write(accel::RANGE, accel::RANGE_12G),
    InitStep::Wait { us: 100 },
    accel_check(
        accel::PWR_CTRL,
        accel::PWR_CTRL_ON,
        InitCheck::AccelPowerNotKept,
    ),
    accel_check(
        accel::CONF,
        accel::CONF_800HZ_OSR4,
        InitCheck::AccelFilterNotKept,
    ),
    accel_check(accel::RANGE, accel::RANGE_12G, InitCheck::AccelRangeNotKept),
    // Gyro: no traffic for 30 ms after reset.
    gyro_write(gyro::SOFT_RESET, SOFT_RESET_COMMAND),
    InitStep::Wait { us: 40_000 },
    gyro_check(gyro::CHIP_ID, gyro::CHIP_ID_VALUE, InitCheck::GyroMissing),
    gyro_write(gyro::POWER, gyro::POWER_NORMAL),
    InitStep::Wait { us: 30_000 },
    gyro_write(gyro::RANGE, gyro::RANGE_2000_DPS),
    InitStep::Wait { us: 100 },
    gyro_write(gyro::BANDWIDTH, gyro::BANDWIDTH_1000HZ_116HZ),
    InitStep::Wait { us: 100 },
    gyro_write(gyro::FIFO_CONFIG_0, 0),
    InitStep::Wait { us: 100 },
    gyro_write(gyro::FIFO_CONFIG_1, gyro::FIFO_BYPASS),
    InitStep::Wait { us: 100 },
    gyro_write(gyro::FIFO_CONFIG_1, gyro::FIFO_MODE),
    InitStep::Wait { us: 100 },
    gyro_check(
        gyro::RANGE,
        gyro::RANGE_2000_DPS,
        InitCheck::GyroRangeNotKept,
    ),
    gyro_check(
        gyro::BANDWIDTH,
        gyro::BANDWIDTH_1000HZ_116HZ,
        InitCheck::GyroBandwidthNotKept,
    ),
    gyro_check(
        gyro::FIFO_CONFIG_1,
        gyro::FIFO_MODE,
        InitCheck::GyroBufferNotKept,
    ),
    // Time until the first filtered samples.
    InitStep::Wait { us: 5_000 },
];
