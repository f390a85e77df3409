//! Measurements in physical units.

/// One calibrated IMU sample in the body frame (x forward, y left, z up).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct ImuState {
    /// Specific force: +9.8 on z at rest. ±118 (12 g) on each axis.
    pub accel_mps2: [f32; 3],
    /// Offset taken out. ±2000 on each axis.
    pub gyro_dps: [f32; 3],
    /// The offset that was taken out, before scaling.
    pub gyro_bias_dps: [f32; 3],
    /// Of the accelerometer's die, renewed every 1.28 s; 0 before the first.
    pub temperature_c: f32,
    /// An axis is at the end of its range, so the true value may lie beyond.
    pub saturated: bool,
    /// How long each axis of the gyro was at the end of its range within the interval, ms: it turned further than
    /// `gyro_dps` says, by an unknown angle.
    pub gyro_clipped_ms: [u8; 3],
    /// End of the interval since the sample before, whose mean rate `gyro_dps` is; the delay of the sensor's filter is
    /// taken off. 0 = no sample yet.
    pub ts_us: u64,
}

/// One calibrated magnetometer sample in the body frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct MagState {
    /// At most 1600 on x and y, 2500 on z before calibration; the earth's field is 25 to 65 long.
    pub mag_ut: [f32; 3],
    /// Middle of the time over which it was measured, 0 = no sample yet.
    pub ts_us: u64,
}

/// Last report of one M3508.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct WheelFeedback {
    /// Rotor angle, 0 … 8191 a turn.
    pub rotor_angle: u16,
    /// Rotor speed before the gear, right-hand rule about the outward shaft.
    pub rpm: i16,
    /// Torque current, ±20,000; positive pushes towards positive `rpm`.
    pub current_ma: f32,
    pub temperature_c: u8,
    /// Its reports contradict themselves or what was commanded: it repeats an old one.
    pub frozen: bool,
    /// Its angle does not move as its speed says: there are two senders, or its sensor is broken.
    pub doubtful: bool,
    /// Since `ts_us`; `u32::MAX` before the first report.
    pub age_us: u32,
    /// When it was received, 0 = no report yet.
    pub ts_us: u64,
}

impl Default for WheelFeedback {
    fn default() -> Self {
        Self {
            rotor_angle: 0,
            rpm: 0,
            current_ma: 0.0,
            temperature_c: 0,
            frozen: false,
            doubtful: false,
            age_us: u32::MAX,
            ts_us: 0,
        }
    }
}

/// What a joint motor does, as far as the board knows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum JointState {
    /// No reply within the time limit.
    #[default]
    Silent = 0,
    /// Answers, but its ranges, time-out or mode are not verified yet.
    SettingUp = 1,
    /// Verified, gives no torque.
    Disabled = 2,
    /// Asked to enable, not confirmed.
    Enabling = 3,
    /// Obeys commands.
    Enabled = 4,
    /// Reports a fault and gives no torque until that is cleared.
    Fault = 5,
}

/// Last report of one joint, in joint coordinates: angle = direction · (motor angle − zero).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct JointFeedback {
    pub pos_rad: f32,
    pub vel_rps: f32,
    pub torque_nm: f32,
    /// The hotter of driver and winding, as far as the motor tells.
    pub temperature_c: f32,
    pub state: JointState,
    /// The motor's own fault code, 0 = none: DM4310 the ERR nibble if it is 8 or more, RS00 the fault word.
    pub fault_code: u32,
    /// Its reports contradict themselves or what was commanded: it repeats an old one.
    pub frozen: bool,
    /// By its last report it gives torque, whatever it was told. An RS00 reports no such thing.
    pub reports_enabled: bool,
    /// Since `ts_us`; `u32::MAX` before the first report.
    pub age_us: u32,
    /// When it was received, 0 = no report yet.
    pub ts_us: u64,
}

impl Default for JointFeedback {
    fn default() -> Self {
        Self {
            pos_rad: 0.0,
            vel_rps: 0.0,
            torque_nm: 0.0,
            temperature_c: 0.0,
            state: JointState::Silent,
            fault_code: 0,
            frozen: false,
            reports_enabled: false,
            age_us: u32::MAX,
            ts_us: 0,
        }
    }
}

/// All motors, in the order of `ChassisCommand`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct MotorFeedback {
    pub wheels: [WheelFeedback; 2],
    pub joints: [JointFeedback; 4],
    /// Tick that the ages refer to; each motor has its own time of report.
    pub ts_us: u64,
}

/// What control sees of the world in one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SensorsSnapshot {
    pub imu: ImuState,
    pub mag: MagState,
    pub motor: MotorFeedback,
    /// The tick; each part has its own time of measurement.
    pub ts_us: u64,
}
