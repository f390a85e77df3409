//! Settings that adapt the firmware to one robot.

use super::{Orientation, RemoteMapping};
use crate::math::scalar;

/// Geometry of the wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct WheelOdomConfig {
    /// Wheel radius in m.
    pub wheel_radius_m: f32,
    /// Distance between the two contact points in m.
    pub wheel_track_m: f32,
    /// Rotor turns per wheel turn.
    pub gear_ratio: f32,
    /// Rotor direction of the left wheel that drives the robot forward, +1 or −1.
    pub rpm_sign_left: f32,
    /// The same for the right wheel.
    pub rpm_sign_right: f32,
}

impl WheelOdomConfig {
    /// Rotor directions of the left and the right wheel.
    pub const fn rpm_signs(&self) -> [f32; 2] {
        [self.rpm_sign_left, self.rpm_sign_right]
    }

    /// Ground speed in m/s at a rotor speed of 1 rpm.
    pub fn mps_per_rpm(&self) -> f32 {
        self.wheel_radius_m * self.rps_per_rpm()
    }

    /// Speed of the wheel in rad/s at a rotor speed of 1 rpm.
    pub fn rps_per_rpm(&self) -> f32 {
        (core::f32::consts::TAU / 60.0) / self.gear_ratio
    }

    /// Current in mA that gives a torque of 1 N·m at the wheel. An M3508 gives 0.3 N·m/A at the output of its own gear
    /// (datasheet).
    pub fn ma_per_nm(&self) -> f32 {
        const M3508_GEAR: f32 = 3591.0 / 187.0;
        const M3508_MA_PER_NM: f32 = 1_000.0 / 0.3;
        M3508_MA_PER_NM * M3508_GEAR / self.gear_ratio
    }
}

/// Settings of the wheel speed controller.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct WheelControllerConfig {
    /// Speed at full stick in m/s.
    pub max_vx_mps: f32,
    /// Turn rate at full stick in rad/s.
    pub max_wz_rps: f32,
    /// Motor current in mA per m/s of wheel speed error.
    pub kp_ma_per_mps: f32,
    /// Limit of each wheel's current in mA.
    pub current_limit_ma: f32,
    /// Motor current in mA per m/s of target speed, while there is no wheel feedback.
    pub open_loop_ma_per_mps: f32,
    /// Maximum age of wheel feedback in µs.
    pub feedback_timeout_us: u32,
}

/// How the default controller holds the legs, and what has been set on the motors by hand.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct JointControllerConfig {
    /// Stiffness in N·m/rad.
    pub hold_kp: f32,
    /// Damping in N·m·s/rad.
    pub hold_kd: f32,
    /// 1 if the time-out of each RS00 has been set by hand, as its MIT protocol can neither set nor read it. It does
    /// not concern other motors.
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

/// Place and limits of one joint, in joint coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct JointConfig {
    /// Motor direction that turns the joint forward, +1 or −1.
    pub direction: f32,
    /// Motor angle at joint angle zero, in rad.
    pub zero_rad: f32,
    /// Lower soft limit in rad.
    pub min_rad: f32,
    /// Upper soft limit in rad.
    pub max_rad: f32,
    /// Torque limit in N·m.
    pub max_torque_nm: f32,
    /// Speed limit in rad/s.
    pub max_speed_rps: f32,
    /// Largest stiffness in N·m/rad.
    pub max_kp: f32,
    /// Largest damping in N·m·s/rad.
    pub max_kd: f32,
}

/// Limits of `SafetyPolicy` and `Arming`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SafetyConfig {
    /// Maximum age of a remote frame in µs. Beyond it the remote is lost.
    pub remote_timeout_us: u32,
    /// Smallest fraction of good frames among the last 64. Below it the link is too bad to drive.
    pub min_remote_quality: f32,
    /// Maximum age of an IMU sample in µs.
    pub imu_timeout_us: u32,
    /// Maximum age of a command on the logic bus in µs. Beyond it the command is zero.
    pub command_timeout_us: u32,
    /// Number of sensor errors that stops the robot. One is forgotten every 100 ms.
    pub max_sensor_errors: u32,
    /// Number of consecutive unsent frames after which a bus counts as congested.
    pub max_tx_failures: u32,
    /// Limit of a stick's deflection while arming, 0…1.
    pub stick_centre: f32,
    /// Time in µs that a request to arm may wait for a write to flash. It waits for nothing else.
    pub arm_request_us: u32,
    /// Maximum age of a joint's reply in µs. Beyond it the joint is silent.
    pub joint_timeout_us: u32,
    /// Limit of the angle between the body's z axis and the vertical in rad. Beyond it the robot has fallen.
    pub max_tilt_rad: f32,
    /// Temperature limit of the wheel motors in °C.
    pub max_wheel_c: f32,
    /// Temperature limit of the joint motors in °C.
    pub max_joint_c: f32,
    /// Battery voltage that blocks arming and gives a warning while armed. 0 disables both battery limits.
    pub battery_low_v: f32,
    /// Battery voltage below which everything stops.
    pub battery_empty_v: f32,
    /// Time in µs for which the clearing gesture (enable off and e-stop thrown) must be held.
    pub clear_hold_us: u32,
    /// 1: after a partial stop the part moves only when the sticks have been centred.
    pub resume_centred: u32,
    /// Maximum age of a PC's command in µs. Beyond it the PC is lost.
    pub pc_timeout_us: u32,
    /// Time in µs after which a PC that turns the wheels by an unchanging command is lost. 0 disables this check.
    pub pc_frozen_us: u32,
    /// Limit of the angle between the body's z axis and the vertical in rad while the robot balances. Beyond it the
    /// balance is lost.
    pub max_balance_tilt_rad: f32,
    /// Time in µs for which a balancing robot must be beyond that limit.
    pub balance_tilt_us: u32,
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
            pc_timeout_us: 100_000,
            pc_frozen_us: 5_000_000,
            max_balance_tilt_rad: 0.7,
            balance_tilt_us: 20_000,
        }
    }
}

/// Limits of standing up. They apply beside the usual ones.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct StandUpConfig {
    /// Longest time in µs. A robot that still lies has failed.
    pub time_us: u32,
    /// Torque limit of each joint in N·m.
    pub max_joint_nm: f32,
    /// Speed limit of each joint in rad/s.
    pub max_joint_rps: f32,
    /// Limit of each wheel's current in mA.
    pub max_wheel_ma: f32,
}

impl StandUpConfig {
    /// Makes the limits of a joint stricter. It is out of line, as flash is scarce.
    #[inline(never)]
    pub fn limit_joint(&self, joint: &mut JointConfig) {
        joint.max_torque_nm = scalar::min(joint.max_torque_nm, self.max_joint_nm);
        joint.max_speed_rps = scalar::min(joint.max_speed_rps, self.max_joint_rps);
    }

    /// The stricter limits of the wheels.
    #[must_use]
    pub fn limit_wheels(&self, wheels: &WheelControllerConfig) -> WheelControllerConfig {
        WheelControllerConfig {
            current_limit_ma: scalar::min(wheels.current_limit_ma, self.max_wheel_ma),
            ..*wheels
        }
    }
}

impl Default for StandUpConfig {
    fn default() -> Self {
        Self {
            time_us: 3_000_000,
            max_joint_nm: 5.0,
            max_joint_rps: 10.0,
            max_wheel_ma: 8_000.0,
        }
    }
}

/// How the sensors are mounted. It is applied to measurements before anything else, so all other settings and results
/// are in the robot's axes (x forward, y left, z up).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct MountingConfig {
    /// Orientation of the IMU's axes in the robot.
    pub board: Orientation,
    /// Orientation of the magnetometer's axes relative to those of the IMU. `None` means unknown, and the heading is
    /// estimated without the magnetometer.
    pub mag: Option<Orientation>,
}

/// Calibration of the IMU in body axes (x forward, y left, z up): calibrated = (rotated − bias) · scale.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct ImuCalibration {
    /// Offset of the accelerometer in m/s².
    pub accel_bias_mps2: [f32; 3],
    /// Scale of the accelerometer.
    pub accel_scale: [f32; 3],
    /// Stored offset of the gyro in °/s. The start-up calibration replaces it by its measurement if that lies within
    /// 2 °/s.
    pub gyro_bias_dps: [f32; 3],
    /// Scale of the gyro.
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

/// Hard and soft iron of the robot in the body frame: calibrated = soft_iron · (rotated − bias).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct MagCalibration {
    /// Hard-iron offset in µT.
    pub bias_ut: [f32; 3],
    /// Symmetric soft-iron matrix, row by row.
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

/// Settings of the IMU's heater.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct HeaterConfig {
    /// Target temperature in °C. Below 20 °C the heater is off.
    pub target_c: f32,
    /// Proportional gain: duty (0…1) per K.
    pub kp: f32,
    /// Integral gain: duty per K·s.
    pub ki: f32,
    /// Largest duty, 0…1.
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

/// All settings of a robot that can be changed while it is disarmed, through the tuning channel. Their defaults depend on
/// the motors: see `motor::layout::MotorLayout::default_config`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct RobotConfig {
    /// Geometry of the wheels.
    pub wheel_odom: WheelOdomConfig,
    /// Wheel speed controller.
    pub wheel_ctrl: WheelControllerConfig,
    /// Joint controller.
    pub joint_ctrl: JointControllerConfig,
    /// Left front, left rear, right front, right rear.
    pub joints: [JointConfig; 4],
    /// Limits of the safety stage.
    pub safety: SafetyConfig,
    /// Mounting of the sensors.
    pub mounting: MountingConfig,
    /// Calibration of the IMU.
    pub imu: ImuCalibration,
    /// Calibration of the magnetometer.
    pub mag: MagCalibration,
    /// The IMU's heater.
    pub heater: HeaterConfig,
    /// Channels of the radio.
    pub radio: RemoteMapping,
    /// Limits of standing up.
    pub stand_up: StandUpConfig,
}
