//! The robots that cannot fall: clamped on a stand or rolling upright, with legs that nothing loads.

use super::{BodyInputs, legs::Legs, pose::Pose, rolling::Rolling, stand::Stand, tilt::Tilt};
use robot_description::Wheels;

use crate::{attitude::Quaternion, joints::JOINTS, motion::Motion};

#[derive(Clone)]
enum Mechanics {
    Stand(Stand),
    Rolling(Rolling),
}

/// A robot whose balance is taken for granted.
#[derive(Clone)]
pub(crate) struct Upright {
    mechanics: Mechanics,
    legs: Legs,
    tilt: Tilt,
}

impl Upright {
    pub(super) fn stand() -> Self {
        Self::new(Mechanics::Stand(Stand::default()))
    }

    pub(super) fn rolling(wheels: &Wheels) -> Self {
        Self::new(Mechanics::Rolling(Rolling::new(wheels)))
    }

    fn new(mechanics: Mechanics) -> Self {
        Self {
            mechanics,
            legs: Legs::default(),
            tilt: Tilt::default(),
        }
    }

    pub(super) fn step(&mut self, inputs: &BodyInputs, dt_s: f64) {
        let (torques_nm, friction) = (inputs.wheel_nm, inputs.wheel_friction);
        match &mut self.mechanics {
            Mechanics::Stand(stand) => stand.step(torques_nm, friction, dt_s),
            Mechanics::Rolling(rolling) => rolling.step(torques_nm, friction, inputs.floor, dt_s),
        }
        for joint in 0..JOINTS {
            let (torque_nm, friction_nm) = (inputs.joint_nm[joint], inputs.joint_friction_nm);
            self.legs.step(joint, torque_nm, friction_nm, dt_s);
        }
        self.tilt.step(inputs.stance, dt_s);
    }

    pub(super) fn wheel_rps(&self) -> [f64; 2] {
        match &self.mechanics {
            Mechanics::Stand(stand) => stand.wheel_rps(),
            Mechanics::Rolling(rolling) => rolling.wheel_rps(),
        }
    }

    pub(super) fn legs(&self) -> &Legs {
        &self.legs
    }

    pub(super) fn pose(&self) -> Pose {
        match &self.mechanics {
            Mechanics::Stand(_) => Pose::default(),
            Mechanics::Rolling(rolling) => rolling.pose(),
        }
    }

    pub(super) fn attitude(&self) -> Quaternion {
        self.tilt.attitude(self.pose().yaw_rad)
    }

    pub(super) fn motion(&self) -> Motion {
        self.tilt.apply(match &self.mechanics {
            Mechanics::Stand(stand) => stand.motion(),
            Mechanics::Rolling(rolling) => rolling.motion(),
        })
    }
}
