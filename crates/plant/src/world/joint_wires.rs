//! The joints' motors on CAN2 and the wire events that their frames cause.

use super::{WireEvent, World, signals};
use crate::{complaint::Complaint, joints::Reception, time::Ps, wire::CanFrame};

impl World {
    pub(super) fn joint_received(&mut self, joint: usize, frame: &CanFrame, now: Ps) {
        let shaft = self.joint_shaft(joint);
        match self.joints[joint].receive(frame, shaft, now) {
            Reception::Ignored => {}
            Reception::Accepted => self.report_joint(joint, now),
            Reception::NotModelled(what) => self.complaints.push(Complaint::fails(what)),
        }
    }

    pub(super) fn joint_sent(&mut self, joint: usize, now: Ps) {
        let before = self.joints[joint].fed_back();
        self.joints[joint].sent();
        let after = self.joints[joint].fed_back();
        let [_, _, pos_rad, vel_rps, _] = signals::joint(joint);
        self.report_change(pos_rad, before.pos_rad, after.pos_rad, now);
        self.report_change(vel_rps, before.vel_rps, after.vel_rps, now);
    }

    /// Reports whatever of the drive's state has changed since the last report.
    pub(super) fn report_joint(&mut self, joint: usize, now: Ps) {
        let state = self.joints[joint].wire_state(self.joint_shaft(joint));
        let reported = std::mem::replace(&mut self.joints_reported[joint], state);
        let [enabled, torque_nm, _, _, stop_frames] = signals::joint(joint);
        self.report_change(enabled, reported.enabled.into(), state.enabled.into(), now);
        self.report_change(torque_nm, reported.commanded_nm, state.commanded_nm, now);
        self.report_change(
            stop_frames,
            reported.stop_frames as f64,
            state.stop_frames as f64,
            now,
        );
    }

    fn report_change(&mut self, signal: usize, before: f64, value: f64, at: Ps) {
        if before != value {
            self.wire_events.push(WireEvent { at, signal, value });
        }
    }
}
