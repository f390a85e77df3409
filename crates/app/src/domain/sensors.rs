//! Measurements in physical units.

/// One calibrated IMU sample in the body frame (x forward, y left, z up).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct ImuState {
    /// Specific force: +9.8 on z at rest. The range is ±118 (12 g) on each axis.
    pub accel_mps2: [f32; 3],
    /// Angular rate without offset. The range is ±2000 on each axis.
    pub gyro_dps: [f32; 3],
    /// The offset that was removed, before scaling.
    pub gyro_bias_dps: [f32; 3],
    /// Temperature of the accelerometer, renewed every 1.28 s; 0 before the first value.
    pub temperature_c: f32,
    /// An axis is at the end of its range, so the true value may lie beyond.
    pub saturated: bool,
    /// Time in ms that each gyro axis spent at the end of its range within the interval. The robot turned further
    /// than `gyro_dps` says, by an unknown angle.
    pub gyro_clipped_ms: [u8; 3],
    /// End of the interval since the previous sample, over which `gyro_dps` is the mean rate. The filter delay of the
    /// sensor is subtracted. 0 = no sample yet.
    pub ts_us: u64,
}

/// One calibrated magnetometer sample in the body frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct MagState {
    /// Magnetic field: at most 1600 on x and y and 2500 on z before calibration. The earth's field is 25 to 65
    /// strong.
    pub mag_ut: [f32; 3],
    /// Middle of the measuring time, 0 = no sample yet.
    pub ts_us: u64,
}

/// Last report of one M3508.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct WheelFeedback {
    /// Rotor angle, 0…8191 per turn.
    pub rotor_angle: u16,
    /// Rotor speed before the gear, by the right-hand rule about the outward shaft.
    pub rpm: i16,
    /// Torque current, ±20,000. Positive current pushes towards positive `rpm`.
    pub current_ma: f32,
    /// Temperature of the motor in °C.
    pub temperature_c: u8,
    /// The reports contradict themselves or the command, so the motor repeats an old one.
    pub frozen: bool,
    /// The angle contradicts the speed: there are two senders, or the sensor is broken.
    pub doubtful: bool,
    /// Age of the report; `u32::MAX` before the first.
    pub age_us: u32,
    /// Time of reception, 0 = no report yet.
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

/// State of a joint motor as known to the board.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum JointState {
    /// No reply came within the time limit.
    #[default]
    Silent = 0,
    /// The motor replies, but its ranges, time-out or mode are not verified yet.
    SettingUp = 1,
    /// Verified, without torque.
    Disabled = 2,
    /// Enabling was requested but is not confirmed.
    Enabling = 3,
    /// The motor follows commands.
    Enabled = 4,
    /// The motor reports a fault and gives no torque until that is cleared.
    Fault = 5,
}

/// Last report of one joint, in joint coordinates: angle = direction · (motor angle − zero).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct JointFeedback {
    /// Angle in rad.
    pub pos_rad: f32,
    /// Speed in rad/s.
    pub vel_rps: f32,
    /// Torque in N·m.
    pub torque_nm: f32,
    /// The higher of driver and winding temperature in °C, as far as the motor reports them.
    pub temperature_c: f32,
    /// State of the motor.
    pub state: JointState,
    /// The motor's own fault code, 0 = none. DM4310: the ERR nibble if it is 8 or more. RS00: the fault word.
    pub fault_code: u32,
    /// The reports contradict themselves or the command, so the motor repeats an old one.
    pub frozen: bool,
    /// By its last report the motor gives torque, whatever it was commanded. An RS00 does not report this.
    pub reports_enabled: bool,
    /// Age of the report; `u32::MAX` before the first.
    pub age_us: u32,
    /// Time of reception, 0 = no report yet.
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

/// Feedback of all motors, in the order of `ChassisCommand`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct MotorFeedback {
    /// Left, right.
    pub wheels: [WheelFeedback; 2],
    /// Left front, left rear, right front, right rear.
    pub joints: [JointFeedback; 4],
    /// Time of the tick to which the ages refer. Each motor has its own time of report.
    pub ts_us: u64,
}

/// The measurements that a controller gets in one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SensorsSnapshot {
    /// The newest IMU sample.
    pub imu: ImuState,
    /// The newest magnetometer sample.
    pub mag: MagState,
    /// The newest feedback of all motors.
    pub motor: MotorFeedback,
    /// Time of the tick. Each part has its own time of measurement.
    pub ts_us: u64,
}
