//! Values that fit this code to one robot.

use super::{Orientation, RemoteMapping};

/// Wheel geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct WheelOdomConfig {
    pub wheel_radius_m: f32,
    /// Distance of the two contact points.
    pub wheel_track_m: f32,
    /// Rotor turns a wheel turn.
    pub gear_ratio: f32,
    /// +1 or −1: rotor direction that drives the robot forward.
    pub rpm_sign_left: f32,
    pub rpm_sign_right: f32,
}

impl Default for WheelOdomConfig {
    fn default() -> Self {
        Self {
            wheel_radius_m: 0.06,
            wheel_track_m: 0.42,
            gear_ratio: 3591.0 / 187.0,
            rpm_sign_left: 1.0,
            rpm_sign_right: -1.0,
        }
    }
}

impl WheelOdomConfig {
    /// Sign of wheel 0 = left, 1 = right.
    pub const fn rpm_signs(&self) -> [f32; 2] {
        [self.rpm_sign_left, self.rpm_sign_right]
    }

    /// Ground speed in m/s of one rotor revolution a minute.
    pub fn mps_per_rpm(&self) -> f32 {
        self.wheel_radius_m * (core::f32::consts::TAU / 60.0) / self.gear_ratio
    }
}

/// Wheel speed controller.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct WheelControllerConfig {
    /// Speed at full stick.
    pub max_vx_mps: f32,
    /// Turn rate at full stick.
    pub max_wz_rps: f32,
    /// Motor current for each m/s of wheel speed error.
    pub kp_ma_per_mps: f32,
    pub current_limit_ma: f32,
    /// Without wheel feedback: motor current for each m/s of wanted wheel speed.
    pub open_loop_ma_per_mps: f32,
    /// Feedback older than this counts as none.
    pub feedback_timeout_us: u32,
}

impl Default for WheelControllerConfig {
    fn default() -> Self {
        Self {
            max_vx_mps: 1.5,
            max_wz_rps: 4.0,
            kp_ma_per_mps: 60_000.0,
            current_limit_ma: 8_000.0,
            open_loop_ma_per_mps: 1_000.0,
            feedback_timeout_us: 50_000,
        }
    }
}

/// How the default controller holds the legs, and what people have done to their motors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct JointControllerConfig {
    /// N·m/rad.
    pub hold_kp: f32,
    /// N·m·s/rad.
    pub hold_kd: f32,
    /// 1 when somebody has set the time-out of each RS00: its MIT protocol can neither set nor read it. Of other motors it
    /// says nothing.
    pub rs00_timeout_set: u32,
}

impl Default for JointControllerConfig {
    fn default() -> Self {
        Self {
            hold_kp: 20.0,
            hold_kd: 1.0,
            rs00_timeout_set: 0,
        }
    }
}

/// One joint's place in the robot and what it may do, in joint coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct JointConfig {
    /// +1 or −1: sense of the motor that turns the joint forward.
    pub direction: f32,
    /// Motor angle at joint angle zero.
    pub zero_rad: f32,
    pub min_rad: f32,
    pub max_rad: f32,
    pub max_torque_nm: f32,
    pub max_speed_rps: f32,
    pub max_kp: f32,
    pub max_kd: f32,
}

/// Limits of `SafetyPolicy` and `Arming`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SafetyConfig {
    /// A remote frame older than this: remote lost.
    pub remote_timeout_us: u32,
    /// Good fraction of the last 64 remote frames below this: link too bad to drive.
    pub min_remote_quality: f32,
    pub imu_timeout_us: u32,
    /// A command on the logic bus older than this is zero.
    pub command_timeout_us: u32,
    /// Errors a sensor may add to its leaky account (one forgiven every 100 ms) before safe mode.
    pub max_sensor_errors: u32,
    /// Frames that may fail to leave in a row before a bus counts as congested.
    pub max_tx_failures: u32,
    /// How far a stick may be off centre while arming, 0 … 1.
    pub stick_centre: f32,
    /// How long a flip of the enable switch may wait for settings being written to flash; for nothing else it waits.
    pub arm_request_us: u32,
    /// A joint's reply older than this: silent.
    pub joint_timeout_us: u32,
    /// Angle between the body's z axis and the vertical beyond this: fallen over.
    pub max_tilt_rad: f32,
    pub max_wheel_c: f32,
    pub max_joint_c: f32,
    /// Below this: no arming, a warning while armed. 0 switches both battery limits off.
    pub battery_low_v: f32,
    /// Below this: everything stops.
    pub battery_empty_v: f32,
    /// How long enable off and e-stop thrown together clear latched stops.
    pub clear_hold_us: u32,
    /// 1: what was stopped in part moves again only after the sticks have been centred.
    pub resume_centred: u32,
}

impl Default for SafetyConfig {
    fn default() -> Self {
        Self {
            remote_timeout_us: 100_000,
            min_remote_quality: 0.5,
            imu_timeout_us: 25_000,
            command_timeout_us: 50_000,
            max_sensor_errors: 20,
            max_tx_failures: 20,
            stick_centre: 0.05,
            arm_request_us: 3_000_000,
            joint_timeout_us: 50_000,
            max_tilt_rad: 0.9,
            max_wheel_c: 90.0,
            max_joint_c: 90.0,
            battery_low_v: 21.0,
            battery_empty_v: 19.0,
            clear_hold_us: 1_000_000,
            resume_centred: 1,
        }
    }
}

/// How the sensors sit. Applied to what they measure before anything else, so that all other settings and all results
/// are in the robot's axes (x forward, y left, z up).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct MountingConfig {
    /// The IMU's axes in the robot's.
    pub board: Orientation,
    /// The magnetometer's axes in the IMU's, as if those were the robot's. `None`: nobody knows, and the heading goes
    /// without it.
    pub mag: Option<Orientation>,
}

/// In body axes (x forward, y left, z up): calibrated = (turned − bias) · scale.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct ImuCalibration {
    pub accel_bias_mps2: [f32; 3],
    pub accel_scale: [f32; 3],
    /// Stored offset; the start-up calibration replaces it by what it measures within 2 °/s of it.
    pub gyro_bias_dps: [f32; 3],
    pub gyro_scale: [f32; 3],
}

impl Default for ImuCalibration {
    fn default() -> Self {
        Self {
            accel_bias_mps2: [0.0; 3],
            accel_scale: [1.0; 3],
            gyro_bias_dps: [0.0; 3],
            gyro_scale: [1.0; 3],
        }
    }
}

/// Hard and soft iron of the robot, applied in the body frame: calibrated = soft_iron · (turned − bias).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct MagCalibration {
    pub bias_ut: [f32; 3],
    /// Symmetric, row by row.
    pub soft_iron: [[f32; 3]; 3],
}

impl Default for MagCalibration {
    fn default() -> Self {
        Self {
            bias_ut: [0.0; 3],
            soft_iron: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        }
    }
}

/// Control of the IMU's heater.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct HeaterConfig {
    /// Below 20 switches the heater off.
    pub target_c: f32,
    /// Duty (0 … 1) a kelvin.
    pub kp: f32,
    /// Duty a kelvin and second.
    pub ki: f32,
    pub max_duty: f32,
}

impl Default for HeaterConfig {
    fn default() -> Self {
        Self {
            target_c: 40.0,
            kp: 0.2,
            ki: 0.01,
            max_duty: 1.0,
        }
    }
}

/// Everything about one robot that can be changed while it stands: the tuning channel writes it. Its defaults depend on
/// the motors: `motor::layout::MotorLayout::default_config`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct RobotConfig {
    pub wheel_odom: WheelOdomConfig,
    pub wheel_ctrl: WheelControllerConfig,
    pub joint_ctrl: JointControllerConfig,
    pub joints: [JointConfig; 4],
    pub safety: SafetyConfig,
    pub mounting: MountingConfig,
    pub imu: ImuCalibration,
    pub mag: MagCalibration,
    pub heater: HeaterConfig,
    pub radio: RemoteMapping,
}
