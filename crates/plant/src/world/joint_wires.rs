//! The joints' motors on CAN2 and what their frames tell.

use super::{WireEvent, World, signals};
use crate::{complaint::Complaint, joints::Heard, time::Ps, wire::CanFrame};

impl World {
    pub(super) fn joint_heard(&mut self, joint: usize, frame: &CanFrame, now: Ps) {
        let shaft = self.joint_shaft(joint);
        match self.joints[joint].receive(frame, shaft, now) {
            Heard::Nothing => {}
            Heard::Frame => self.tell_joint(joint, now),
            Heard::NotModelled(what) => self.complaints.push(Complaint::fails(what)),
        }
    }

    pub(super) fn joint_sent(&mut self, joint: usize, now: Ps) {
        let before = self.joints[joint].fed_back();
        self.joints[joint].sent();
        let said = self.joints[joint].fed_back();
        let [_, _, pos_rad, vel_rps, _] = signals::joint(joint);
        self.tell_change(pos_rad, before.pos_rad, said.pos_rad, now);
        self.tell_change(vel_rps, before.vel_rps, said.vel_rps, now);
    }

    /// Events for whatever of the drive's state differs from what the last ones said.
    pub(super) fn tell_joint(&mut self, joint: usize, now: Ps) {
        let state = self.joints[joint].wire_state(self.joint_shaft(joint));
        let told = std::mem::replace(&mut self.joints_told[joint], state);
        let [enabled, torque_nm, _, _, stop_frames] = signals::joint(joint);
        self.tell_change(enabled, told.enabled.into(), state.enabled.into(), now);
        self.tell_change(torque_nm, told.asked_nm, state.asked_nm, now);
        self.tell_change(
            stop_frames,
            told.stop_frames as f64,
            state.stop_frames as f64,
            now,
        );
    }

    fn tell_change(&mut self, signal: usize, before: f64, value: f64, at: Ps) {
        if before != value {
            self.wire_events.push(WireEvent { at, signal, value });
        }
    }
}
