//! Register addresses, and the values written to them.

/// Bit 7 of the first byte of a transfer.
pub const READ: u8 = 0x80;

/// Registers of the accelerometer.
pub mod accel {
    pub const CHIP_ID: u8 = 0x00;
    pub const CHIP_ID_VALUE: u8 = 0x1E;
    /// First register of X, Y, Z. Sensor time follows at 0x18, temperature at 0x22.
    pub const DATA: u8 = 0x12;
    pub const CONF: u8 = 0x40;
    /// 800 Hz, OSR4. The bandwidth of 80 Hz is below the 100 Hz that sampling at 200 Hz allows.
    pub const CONF_800HZ_OSR4: u8 = 0x8B;
    pub const RANGE: u8 = 0x41;
    pub const RANGE_12G: u8 = 0x02;
    pub const PWR_CONF: u8 = 0x7C;
    pub const PWR_CONF_ACTIVE: u8 = 0x00;
    pub const PWR_CTRL: u8 = 0x7D;
    pub const PWR_CTRL_ON: u8 = 0x04;
    pub const SOFT_RESET: u8 = 0x7E;
}

/// Registers of the gyro.
pub mod gyro {
    pub const CHIP_ID: u8 = 0x00;
    pub const CHIP_ID_VALUE: u8 = 0x0F;
    /// Bit of FIFO_STATUS (0x0E): frames were lost. The bits below it are the number of frames.
    pub const FIFO_OVERRUN: u8 = 0x80;
    pub const RANGE: u8 = 0x0F;
    pub const RANGE_2000_DPS: u8 = 0x00;
    pub const BANDWIDTH: u8 = 0x10;
    /// 1000 Hz with 116 Hz bandwidth. Bit 7 always reads 1.
    pub const BANDWIDTH_1000HZ_116HZ: u8 = 0x82;
    pub const POWER: u8 = 0x11;
    pub const POWER_NORMAL: u8 = 0x00;
    pub const SOFT_RESET: u8 = 0x14;
    /// Water mark and tag. A write empties the buffer.
    pub const FIFO_CONFIG_0: u8 = 0x3D;
    pub const FIFO_CONFIG_1: u8 = 0x3E;
    pub const FIFO_BYPASS: u8 = 0x00;
    /// A full buffer takes no more frames. In STREAM mode it is reported to show its axes one place late.
    pub const FIFO_MODE: u8 = 0x40;
    /// Does not count up in a burst; each byte comes from the buffer.
    pub const FIFO_DATA: u8 = 0x3F;
}

/// Value to write to either `SOFT_RESET`.
pub const SOFT_RESET_COMMAND: u8 = 0xB6;
