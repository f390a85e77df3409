//! How the IMU is kept warm, calibrated at start-up and doubted: for diagnostics, arming and indication.

/// What the heater of the IMU does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum HeaterState {
    /// Switched off by its configuration.
    #[default]
    Off = 0,
    /// More than 3 K below the target.
    Heating = 1,
    Holding = 2,
    /// Held off: no valid temperature, or far too hot.
    CutOff = 3,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct HeaterStatus {
    /// On-fraction, 0 … 1.
    pub duty: f32,
    /// Last valid temperature of the package; 0 before the first.
    pub temperature_c: f32,
    pub state: HeaterState,
}

/// What the start-up calibration of the gyro waits for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum CalibrationState {
    #[default]
    WaitingForTemperature = 0,
    /// The robot moves, or has only just stopped.
    WaitingForStillness = 1,
    Measuring = 2,
    Done = 3,
    /// The last still second showed an offset too far from the stored one: a slow turn looks just so. It is measured
    /// again.
    OffsetRefused = 4,
}

/// What is known of the package's temperature: the offset of the gyro moves with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Warmth {
    #[default]
    Unsettled = 0,
    /// Within 3 K of the heater's target.
    AtTarget = 1,
    /// Away from the target, but steady: the heater is off, too weak (USB supply) or not needed.
    Settled = 2,
    /// The sensor has told no temperature for 20 s.
    Unknown = 3,
}

/// Start-up calibration of the gyro.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct CalibrationStatus {
    /// Part of the still second that has been measured, 0 … 1.
    pub progress: f32,
    pub state: CalibrationState,
    /// The temperature it goes by; kept once it is done.
    pub warmth: Warmth,
}

/// Samples that were rejected since boot, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct ImuRejects {
    pub absent: u32,
    pub frozen: u32,
    pub implausible: u32,
    pub saturated: u32,
    /// Single frames of the gyro that their neighbours contradict: the rest of the sample was used.
    pub gyro_frames: u32,
}

/// What was wrong with the gyro's buffer since boot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct GyroBufferStatus {
    /// Frames left out because no rate makes them: −32768 on all axes.
    pub spikes: u32,
    /// Samples whose newest frame was not what the data registers show; the registers were used.
    pub differences: u32,
    /// Resets because differences lasted.
    pub resets: u32,
    /// Resets because it had run over, or nobody had read it for long: after the bring-up, and an erase of flash.
    pub overruns: u32,
}

/// Of the IMU task.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct ImuStatus {
    pub rejects: ImuRejects,
    pub gyro_buffer: GyroBufferStatus,
    pub heater: HeaterStatus,
    pub calibration: CalibrationStatus,
}
