//! Default settings of a robot.

use super::{MotorLayout, ROBOT_LAYOUT};
use crate::domain::{
    HeaterConfig, ImuCalibration, JointControllerConfig, MagCalibration, MountingConfig,
    RemoteMapping, RobotConfig, SafetyConfig, WheelControllerConfig, WheelOdomConfig,
};

impl MotorLayout {
    /// The defaults of a robot with these motors.
    pub fn default_config(&self) -> RobotConfig {
        RobotConfig {
            wheel_odom: WheelOdomConfig::default(),
            wheel_ctrl: WheelControllerConfig::default(),
            joint_ctrl: JointControllerConfig::default(),
            joints: self.joints.each_ref().map(|slot| slot.config),
            safety: SafetyConfig::default(),
            mounting: MountingConfig::default(),
            imu: ImuCalibration::default(),
            mag: MagCalibration::default(),
            heater: HeaterConfig::default(),
            radio: RemoteMapping::default(),
        }
    }
}

/// The defaults of the robot with DM4310 joints.
impl Default for RobotConfig {
    fn default() -> Self {
        ROBOT_LAYOUT.default_config()
    }
}
