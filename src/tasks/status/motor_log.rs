//! Log lines about motors that block arming, and about frames that belong to no motor.

use robot_app::diagnostics::{BusUnknownFrames, ChangeThrottle, DiagnosticsSnapshot};
use robot_app::domain::{BusId, JointConfig};
use robot_app::motor::layout::MotorLayout;
use robot_app::safety::{ArmingState, MotorReadiness};

/// Names in the order of `ChassisCommand`.
const WHEEL_NAMES: [&str; 2] = ["left", "right"];
pub const JOINT_NAMES: [&str; 4] = ["left front", "left rear", "right front", "right rear"];
/// Time in which motors start and are set up.
const SETTLED_US: u64 = 1_000_000;

/// What was logged last.
#[derive(Default)]
pub struct MotorLog {
    findings: ChangeThrottle<MotorReadiness>,
    /// Per bus: the identifier that was last logged, and that of a speed controller.
    strangers: [ChangeThrottle<(u16, u16)>; 2],
}

impl MotorLog {
    /// Logs changes; nothing while the robot is armed.
    pub fn report(
        &mut self,
        d: &DiagnosticsSnapshot,
        joints: &[JointConfig; 4],
        layout: &MotorLayout,
    ) {
        if d.arming.state == ArmingState::Armed || d.ts_us < SETTLED_US {
            return;
        }
        if let Some(found) = self.findings.due(d.motors, d.ts_us) {
            log_wheels(found, d, layout);
            log_joints(found, d, joints);
        }
        if d.motors == MotorReadiness::default() {
            return;
        }
        let buses = BusId::ALL.into_iter().zip(&mut self.strangers);
        for ((bus, notice), heard) in buses.zip(&d.strangers.buses) {
            let BusUnknownFrames {
                frames,
                last_id,
                esc_id,
            } = *heard;
            if frames > 0 && notice.due((last_id, esc_id), d.ts_us).is_some() {
                defmt::warn!(
                    "{} carries an identifier that is nobody's: {=u16:#x}, {=u32} such frames",
                    bus,
                    last_id,
                    frames
                );
            }
        }
    }
}

fn log_wheels(found: MotorReadiness, d: &DiagnosticsSnapshot, layout: &MotorLayout) {
    let wheels = layout.wheels();
    let [can1, can2] = &d.strangers.buses;
    let heard = match wheels.bus {
        BusId::Can1 => can1,
        BusId::Can2 => can2,
    };
    for (bit, (name, esc)) in [1, 2]
        .into_iter()
        .zip(WHEEL_NAMES.into_iter().zip(wheels.escs))
    {
        let own_id = esc.feedback_id().raw();
        if found.wheels_unheard & bit != 0 && heard.esc_id != 0 {
            defmt::error!(
                "{=str} wheel: {=u16:#x} not heard since boot on {}, but {=u16:#x} is: its C620 has number {=u16} instead of {=u16}",
                name,
                own_id,
                wheels.bus,
                heard.esc_id,
                heard.esc_id & 0xF,
                own_id & 0xF
            );
        } else if found.wheels_unheard & bit != 0 {
            defmt::error!(
                "{=str} wheel: {=u16:#x} not heard since boot on {}: no supply, another number, or another bus",
                name,
                own_id,
                wheels.bus
            );
        }
        if found.wheels_doubtful & bit != 0 {
            defmt::error!(
                "{=str} wheel: its angle does not move as its speed says: two C620 with number {=u16}, or a broken sensor",
                name,
                own_id & 0xF
            );
        }
    }
}

fn log_joints(found: MotorReadiness, d: &DiagnosticsSnapshot, configs: &[JointConfig; 4]) {
    let joints = d.sensors.motor.joints.iter().zip(configs);
    for (bit, (name, (joint, config))) in [1, 2, 4, 8]
        .into_iter()
        .zip(JOINT_NAMES.into_iter().zip(joints))
    {
        if found.joints_silent & bit != 0 {
            defmt::error!(
                "{=str} joint: silent: no supply, another identifier, or the maker's own protocol",
                name
            );
        } else if found.joints_unready & bit != 0 {
            defmt::warn!("{=str} joint: {}", name, joint.state);
        }
        if found.joints_outside & bit != 0 {
            defmt::error!(
                "{=str} joint: at {=i32} mrad, beyond its limits {=i32} and {=i32} mrad: zero not set, or wrong by a turn (6283 mrad)",
                name,
                mrad(joint.pos_rad),
                mrad(config.min_rad),
                mrad(config.max_rad)
            );
        }
    }
}

fn mrad(rad: f32) -> i32 {
    (rad * 1_000.0) as i32
}
