//! The passage of time.

use super::World;
use crate::{
    attitude,
    body::{BodyInputs, Floor, Stance},
    faults::{Fault, RADIO_LOSSES},
    free::Push,
    joints::{JOINTS, Shaft},
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

impl World {
    /// The next instant at which the board could notice something: a character on the line of radio or PC, a motor's frame, or the
    /// end of a magnetometer conversion. The mechanics before it need no call of [`advance`](Self::advance).
    pub fn next_event(&self) -> Ps {
        let mut next = self.next_can_event();
        next = next.min(self.radio.next_event(self.now));
        next = next.min(self.pc.next_event(self.now));
        next = next.min(self.mag.next_event());
        next = next.min(self.next_late());
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
                Due::Late => self.hear_late(),
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
            (self.next_late(), Due::Late),
        ]
        .into_iter()
        .min_by_key(|(at, _)| *at)
        .filter(|(at, _)| *at <= now)
    }

    fn step(&mut self, at: Ps) {
        self.next_step += PHYSICS_STEP;
        let shaft_rps = self.shaft_rps();
        let supply_v = self.battery.volts();
        let (signs, strength) = (self.shaft_signs(), self.variation.torque);
        let mut torques_nm = [0.0; 2];
        let mut power_w = 0.0;
        for (wheel, esc) in self.escs.iter_mut().enumerate() {
            esc.step(shaft_rps[wheel], supply_v);
            torques_nm[wheel] = signs[wheel] * strength * esc.motor.torque_nm();
            power_w += esc.motor.torque_nm() * shaft_rps[wheel];
        }
        let joints = self.step_joints(at, supply_v);
        power_w += joints.power_w;
        self.battery.set_charge(self.charge());
        self.battery.load(power_w);
        let floor = if self.faults.has(Fault::FloorSlippery) {
            Floor::Slippery
        } else {
            Floor::Clean
        };
        let inputs = BodyInputs {
            wheel_nm: torques_nm,
            wheel_friction: self.escs[0].motor.friction(),
            joint_nm: joints.torque_nm.map(|nm| strength * nm),
            joint_friction_nm: joints.friction_nm,
            floor,
            stance: self.stance(),
            outside: self.outside_force(at),
        };
        self.body.step(&inputs, physics_step_s());
        let body_motion = self.motion(at);
        let board_motion = Motion {
            accel_mps2: self.to_board(body_motion.accel_mps2),
            gyro_rps: self.to_board(body_motion.gyro_rps),
        };
        self.imu.step(board_motion, at, physics_step_s());
        if self.mag.is_converting(at) {
            let board_field_ut = self.to_board(self.field_ut(at));
            self.mag
                .sample_field(self.mag_mounting.to_sensor(board_field_ut));
        }
    }

    fn to_board(&self, body: [f64; 3]) -> [f64; 3] {
        self.mounting.to_sensor(self.askew.to_board(body))
    }

    fn outside_force(&mut self, at: Ps) -> Option<Push> {
        let (force, ends) = self.push?;
        if at > ends {
            self.push = None;
        }
        self.push.is_some().then_some(force)
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

    /// Steps the joints' drives.
    fn step_joints(&mut self, at: Ps, supply_v: f64) -> JointTorques {
        let vel_rps = self.body.joint_vel_rps();
        let mut torques = JointTorques::default();
        for (index, vel_rps) in vel_rps.into_iter().enumerate() {
            let shaft = self.joint_shaft(index);
            let joint = &mut self.joints[index];
            let was_enabled = joint.enabled();
            joint.step(shaft, supply_v, at);
            torques.torque_nm[index] = joint.torque_nm();
            torques.friction_nm = joint.friction_nm();
            torques.power_w += joint.torque_nm() * vel_rps;
            if joint.enabled() != was_enabled {
                self.report_joint(index, at);
            }
        }
        torques
    }

    pub(super) fn joint_shaft(&self, joint: usize) -> Shaft {
        let (pos_rad, vel_rps) = (self.body.joint_pos_rad(), self.body.joint_vel_rps());
        self.joints[joint].shaft(pos_rad[joint], vel_rps[joint])
    }

    /// Speeds of the wheels' output shafts in their own sense of rotation, rad/s.
    pub(super) fn shaft_rps(&self) -> [f64; 2] {
        let (wheel_rps, signs) = (self.body.motor_rps(), self.shaft_signs());
        [signs[0] * wheel_rps[0], signs[1] * wheel_rps[1]]
    }

    /// Sense of each shaft's own rotation when its wheel rolls forward: left, right.
    pub(super) fn shaft_signs(&self) -> [f64; 2] {
        self.robot.wheels.signs.map(f64::from)
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
            None => self.body.motion(),
        }
    }

    fn field_ut(&self, at: Ps) -> [f64; 3] {
        match &self.playback {
            Some(playback) => playback.field_ut(at),
            None => attitude::to_body(self.body.attitude(), EARTH_FIELD_UT),
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

/// What the joints' motors do during one step.
#[derive(Clone, Copy, Debug, Default)]
struct JointTorques {
    torque_nm: [f64; JOINTS],
    friction_nm: f64,
    /// Mechanical power of all four.
    power_w: f64,
}

#[derive(Clone, Copy, Debug)]
enum Due {
    Step,
    Feedback(usize),
    Frame,
    Link,
    Conversion,
    Late,
}
