//! State of the IMU's heater, calibration and sample checks, for diagnostics, arming and indication.

/// State of the IMU's heater.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum HeaterState {
    /// Switched off in the settings.
    #[default]
    Off = 0,
    /// More than 3 K below the target.
    Heating = 1,
    /// Close to the target.
    Holding = 2,
    /// Held off, as there is no valid temperature or it is far too high.
    CutOff = 3,
}

/// State of the heater.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct HeaterStatus {
    /// Duty, 0…1.
    pub duty: f32,
    /// Last valid temperature of the package; 0 before the first.
    pub temperature_c: f32,
    /// What the heater does.
    pub state: HeaterState,
}

/// State of the gyro's start-up calibration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum CalibrationState {
    /// The temperature has not settled.
    #[default]
    WaitingForTemperature = 0,
    /// The robot moves, or has only just stopped.
    WaitingForStillness = 1,
    /// The offset is being measured.
    Measuring = 2,
    /// The calibration has finished.
    Done = 3,
    /// The last second at rest showed an offset too far from the stored one, as a slow turn would. It is measured
    /// again.
    OffsetRefused = 4,
}

/// State of the package's temperature, on which the gyro's offset depends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum TemperatureGateState {
    /// The temperature is changing.
    #[default]
    Unsettled = 0,
    /// Within 3 K of the heater's target.
    AtTarget = 1,
    /// Steady away from the target: the heater is off, too weak (USB supply) or not needed.
    Settled = 2,
    /// The sensor has reported no temperature for 20 s.
    Unknown = 3,
}

/// State of the gyro's start-up calibration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct CalibrationStatus {
    /// Fraction of the second at rest that has been measured, 0…1.
    pub progress: f32,
    /// State of the calibration.
    pub state: CalibrationState,
    /// The temperature state it relies on, frozen when it is done.
    pub warmth: TemperatureGateState,
}

/// Samples rejected since boot, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct ImuRejects {
    /// No sample came.
    pub absent: u32,
    /// The sample equalled earlier ones.
    pub frozen: u32,
    /// The sample was physically impossible.
    pub implausible: u32,
    /// An axis was at the end of its range.
    pub saturated: u32,
    /// Single gyro frames that their neighbours contradict. The rest of the sample was used.
    pub gyro_frames: u32,
}

/// Faults of the gyro's buffer since boot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct GyroBufferStatus {
    /// Frames skipped because no rate produces them: −32768 on all axes.
    pub spikes: u32,
    /// Samples whose newest frame differed from the data registers. The registers were used.
    pub differences: u32,
    /// Resets because differences persisted.
    pub resets: u32,
    /// Resets because the buffer had overflowed or not been read for long, as after the bring-up or an erase of
    /// flash.
    pub overruns: u32,
}

/// State of the IMU task.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct ImuStatus {
    /// Rejected samples.
    pub rejects: ImuRejects,
    /// Faults of the gyro's buffer.
    pub gyro_buffer: GyroBufferStatus,
    /// The heater.
    pub heater: HeaterStatus,
    /// The start-up calibration.
    pub calibration: CalibrationStatus,
}
