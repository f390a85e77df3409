//! The passage of time.

use super::World;
use crate::{
    attitude,
    body::{Floor, Stance},
    faults::{Fault, RADIO_LOSSES},
    joints::{JOINTS, Shaft},
    m3508::M3508,
    motion::Motion,
    pc::LinkFaults,
    physics::{PHYSICS_STEP, physics_step_s},
    radio::RadioFaults,
    supply::Charge,
    time::Ps,
};

/// Earth's magnetic field in ENU, µT: 22 north and 42 into the ground, as in the middle of Europe or China, without
/// declination.
const EARTH_FIELD_UT: [f64; 3] = [0.0, 22.0, -42.0];
/// Sign of a right-hand turn about the outward shaft when the wheel rolls forward: left, right.
pub(super) const SHAFT_SIGN: [f64; 2] = [1.0, -1.0];

impl World {
    /// The next instant at which the board could notice something: a character on the line of radio or PC, a motor's frame, or the
    /// end of a magnetometer conversion. The mechanics before it need no call of [`advance`](Self::advance).
    pub fn next_event(&self) -> Ps {
        let mut next = self.next_can_event();
        next = next.min(self.radio.next_event(self.now));
        next = next.min(self.pc.next_event(self.now));
        next = next.min(self.mag.next_event());
        match self.serial_adapter.next_start() {
            at if at > self.now => next = next.min(at),
            _ => {}
        }
        next
    }

    /// The next instant at which a motor has a frame to send. One that waits already does not count.
    pub fn next_can_event(&self) -> Ps {
        let [left, right] = &self.escs;
        let mut next = left.next_feedback().min(right.next_feedback());
        for joint in &self.joints {
            match joint.reply_at() {
                Some(at) if at > self.now => next = next.min(at),
                _ => {}
            }
        }
        next
    }

    /// Advances the world to `now`, which must not be earlier than in the call before.
    pub fn advance(&mut self, now: Ps) {
        while let Some((at, due)) = self.first_due(now) {
            match due {
                Due::Step => self.step(at),
                Due::Feedback(wheel) => {
                    let shaft_rps = self.shaft_rps();
                    self.escs[wheel].prepare_feedback(shaft_rps[wheel]);
                }
                Due::Frame => self.radio.start_frame(self.radio_faults()),
                Due::Link => self.pc.act(self.link_faults()),
                Due::Conversion => self.mag.convert(),
            }
        }
        self.now = self.now.max(now);
        self.note_whole_frames();
    }

    /// The earliest event up to `now`. Mechanics come first among simultaneous ones, so that the others see them up to date.
    fn first_due(&self, now: Ps) -> Option<(Ps, Due)> {
        [
            (self.next_step, Due::Step),
            (self.escs[0].next_feedback(), Due::Feedback(0)),
            (self.escs[1].next_feedback(), Due::Feedback(1)),
            (self.radio.next_frame(), Due::Frame),
            (self.pc.next_due(), Due::Link),
            (self.mag.next_event(), Due::Conversion),
        ]
        .into_iter()
        .min_by_key(|(at, _)| *at)
        .filter(|(at, _)| *at <= now)
    }

    fn step(&mut self, at: Ps) {
        self.next_step += PHYSICS_STEP;
        let shaft_rps = self.shaft_rps();
        let supply_v = self.battery.volts();
        let mut torques_nm = [0.0; 2];
        let mut power_w = 0.0;
        for (wheel, esc) in self.escs.iter_mut().enumerate() {
            esc.step(shaft_rps[wheel], supply_v);
            torques_nm[wheel] = SHAFT_SIGN[wheel] * esc.motor.torque_nm();
            power_w += esc.motor.torque_nm() * shaft_rps[wheel];
        }
        power_w += self.step_joints(at, supply_v);
        self.battery.set_charge(self.charge());
        self.battery.load(power_w);
        let floor = if self.faults.has(Fault::FloorSlippery) {
            Floor::Slippery
        } else {
            Floor::Clean
        };
        self.body
            .step(torques_nm, M3508::friction(), floor, physics_step_s());
        self.tilt.step(self.stance(), physics_step_s());
        let body_motion = self.motion(at);
        let board_motion = Motion {
            accel_mps2: self.mounting.to_sensor(body_motion.accel_mps2),
            gyro_rps: self.mounting.to_sensor(body_motion.gyro_rps),
        };
        self.imu.step(board_motion, at, physics_step_s());
        if self.mag.is_converting(at) {
            let board_field_ut = self.mounting.to_sensor(self.field_ut(at));
            self.mag
                .sample_field(self.mag_mounting.to_sensor(board_field_ut));
        }
    }

    fn charge(&self) -> Charge {
        if self.faults.has(Fault::BatteryEmpty) {
            Charge::Empty
        } else if self.faults.has(Fault::BatteryLow) {
            Charge::Low
        } else {
            Charge::Half
        }
    }

    /// Steps the joints and returns the mechanical power of their motors, W.
    fn step_joints(&mut self, at: Ps, supply_v: f64) -> f64 {
        let mut power_w = 0.0;
        for index in 0..JOINTS {
            let shaft = self.joint_shaft(index);
            let joint = &mut self.joints[index];
            let was_enabled = joint.enabled();
            joint.step(shaft, supply_v, at);
            power_w += joint.torque_nm() * self.legs.vel_rps[index];
            let (torque_nm, friction_nm) = (joint.torque_nm(), joint.friction_nm());
            if joint.enabled() != was_enabled {
                self.report_joint(index, at);
            }
            self.legs
                .step(index, torque_nm, friction_nm, physics_step_s());
        }
        power_w
    }

    pub(super) fn joint_shaft(&self, joint: usize) -> Shaft {
        self.joints[joint].shaft(self.legs.pos_rad[joint], self.legs.vel_rps[joint])
    }

    /// Speeds of the wheels' output shafts in their own sense of rotation, rad/s.
    pub(super) fn shaft_rps(&self) -> [f64; 2] {
        let wheel_rps = self.body.wheel_rps();
        [SHAFT_SIGN[0] * wheel_rps[0], SHAFT_SIGN[1] * wheel_rps[1]]
    }

    fn stance(&self) -> Stance {
        if self.faults.has(Fault::Blow) {
            Stance::Struck
        } else if self.faults.has(Fault::Tilted) {
            Stance::Fallen
        } else {
            Stance::Upright
        }
    }

    /// Specific force and angular rate of the body, in the body's axes.
    pub(super) fn motion(&self, at: Ps) -> Motion {
        match &self.playback {
            Some(playback) => playback.motion(at),
            None => self.tilt.apply(self.body.motion()),
        }
    }

    fn field_ut(&self, at: Ps) -> [f64; 3] {
        match &self.playback {
            Some(playback) => playback.field_ut(at),
            None => attitude::to_body(self.tilt.attitude(self.body.pose().yaw_rad), EARTH_FIELD_UT),
        }
    }

    fn radio_faults(&self) -> RadioFaults {
        RadioFaults {
            silent: self.faults.has(Fault::SbusSilent),
            failsafe: self.faults.has(Fault::SbusFailsafe),
            frame_lost: self.faults.has(Fault::SbusFrameLost),
            noise: self.faults.has(Fault::SbusNoise),
            loss: self.radio_loss(),
        }
    }

    pub(super) fn link_faults(&self) -> LinkFaults {
        let has = |fault| self.faults.has(fault);
        LinkFaults {
            cut_down: has(Fault::LinkCut) || has(Fault::LinkCutDown),
            cut_up: has(Fault::LinkCut) || has(Fault::LinkCutUp),
            noise: has(Fault::LinkNoise),
            flood: has(Fault::LinkFlood),
            held_low: has(Fault::LinkBreak),
            frozen: has(Fault::PcFrozen),
            extremes: has(Fault::PcExtremes),
        }
    }

    fn radio_loss(&self) -> f64 {
        let active = RADIO_LOSSES
            .iter()
            .filter(|(fault, _)| self.faults.has(*fault));
        active.map(|(_, share)| *share).fold(0.0, f64::max)
    }
}

#[derive(Clone, Copy, Debug)]
enum Due {
    Step,
    Feedback(usize),
    Frame,
    Link,
    Conversion,
}
