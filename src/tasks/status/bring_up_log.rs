//! Log lines of the bring-up: the step, the motor under test, and how the joints are turned by hand.

use robot_app::bring_up::{BringUpStatus, BringUpStep, JointMotionMonitor, JointReading, Turn};
use robot_app::diagnostics::{ChangeThrottle, DiagnosticsSnapshot};

/// Silent while bring-up is off.
#[derive(Default)]
pub struct BringUpLog {
    status: ChangeThrottle<BringUpStatus>,
    watch: JointMotionMonitor,
}

impl BringUpLog {
    pub fn report_changes(&mut self, d: &DiagnosticsSnapshot) {
        let Some(status) = self.status.due(d.bring_up, d.ts_us) else {
            return;
        };
        let by = if status.by_radio {
            "radio"
        } else {
            "tuning channel"
        };
        match status.step {
            BringUpStep::OneMotor => defmt::warn!(
                "bring-up by {=str}: {}, motor {=u8}, {}",
                by,
                status.step,
                status.motor,
                status.trial
            ),
            step if status.by_radio => {
                defmt::warn!(
                    "bring-up by {=str}: {}, motor {=u8} chosen",
                    by,
                    step,
                    status.motor
                );
            }
            step => defmt::warn!("bring-up by {=str}: {}", by, step),
        }
    }

    /// Logs the joint angles; to be called a few times a second.
    pub fn report_joints(&mut self, d: &DiagnosticsSnapshot) {
        if d.bring_up.step == BringUpStep::Off {
            return;
        }
        let [left_front, left_rear, right_front, right_rear] =
            self.watch.update(&d.sensors.motor.joints);
        defmt::info!(
            "joints: left front {=i32} mrad {=str}, left rear {=i32} mrad {=str}, right front {=i32} mrad {=str}, right rear {=i32} mrad {=str}",
            left_front.pos_mrad,
            turning(left_front),
            left_rear.pos_mrad,
            turning(left_rear),
            right_front.pos_mrad,
            turning(right_front),
            right_rear.pos_mrad,
            turning(right_rear)
        );
    }
}

fn turning(reading: JointReading) -> &'static str {
    match reading.turn {
        Turn::Still => "still",
        Turn::Forward => "turning forward",
        Turn::Back => "turning back",
    }
}
