//! Default settings of a robot.

use super::{MotorLayout, ROBOT_LAYOUT};
use crate::domain::{
    HeaterConfig, ImuCalibration, JointControllerConfig, MagCalibration, RemoteMapping,
    RobotConfig, SafetyConfig, StandUpConfig, WheelControllerConfig,
};

impl MotorLayout {
    /// The defaults of this robot.
    pub fn default_config(&self) -> RobotConfig {
        RobotConfig {
            wheel_odom: self.profile.wheel_odom,
            wheel_ctrl: WheelControllerConfig {
                current_limit_ma: self.profile.wheel_current_ma,
                ..WheelControllerConfig::default()
            },
            joint_ctrl: JointControllerConfig::default(),
            joints: self.joints.each_ref().map(|slot| slot.config),
            safety: SafetyConfig::default(),
            mounting: self.profile.mounting,
            imu: ImuCalibration::default(),
            mag: MagCalibration::default(),
            heater: HeaterConfig::default(),
            radio: RemoteMapping::default(),
            stand_up: StandUpConfig::default(),
        }
    }
}

/// The defaults of the robot with DM4310 joints.
impl Default for RobotConfig {
    fn default() -> Self {
        ROBOT_LAYOUT.default_config()
    }
}
