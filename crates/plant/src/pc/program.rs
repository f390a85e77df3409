//! The program on the PC: it sends one command at a fixed rate, until it is told another.

use super::{
    codec::{self, Downlink, MotorCommand, Uplink},
    faults::LinkFaults,
};
use crate::{
    random::Random,
    time::{Ps, from_seconds},
};

/// A change of what the program sends. An unset field keeps its value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcInput {
    /// Whether it sends at all. It starts with the frame that is due at once. The first start plugs the cable in too.
    pub on: Option<bool>,
    /// Frames a second, up to [`MAX_RATE_HZ`](PcInput::MAX_RATE_HZ).
    pub rate_hz: Option<f64>,
    /// Speeds of the left and right wheel, rad/s, forward positive.
    pub wheels_rps: Option<[f64; 2]>,
    /// Kd of both wheels, N·m·s/rad.
    pub wheel_kd: Option<f64>,
    /// What the joints do.
    pub joints: Option<PcJoints>,
    /// Kp of the joints, N·m/rad.
    pub joint_kp: Option<f64>,
    /// Kd of the joints, N·m·s/rad.
    pub joint_kd: Option<f64>,
    /// Whether the Kp of the wheels, which has no effect, counts the frames. A program without it looks frozen.
    pub counts: Option<bool>,
    /// What it asks of the robot's own controller. From then on it sends frames that take the place of the sticks, until it is
    /// told something about wheels or joints.
    pub drive: Option<PcDrive>,
}

impl PcInput {
    /// What the line carries, 38 characters of ten bits a frame.
    pub const MAX_RATE_HZ: f64 = 1_200.0;

    /// Whether it says what wheels or joints should do.
    pub fn is_for_motors(&self) -> bool {
        self.wheels_rps.is_some() || self.joints.is_some()
    }

    /// A robot at rest: wheels at 0, joints held where they are.
    pub fn rest() -> Self {
        Self {
            on: Some(true),
            wheels_rps: Some([0.0; 2]),
            joints: Some(PcJoints::Hold),
            ..Self::default()
        }
    }
}

/// What the program asks of the joints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PcJoints {
    /// Nothing: both gains are 0.
    #[default]
    Limp,
    /// To stay at the angles that the last frame of the robot told, or at those of the first one.
    Hold,
    /// To go to these angles, rad.
    At([f64; 4]),
}

/// What takes the place of the sticks: shares of the highest, −1 … 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PcDrive {
    /// Speed, forward positive.
    pub vx: f64,
    /// Turn, left positive.
    pub wz: f64,
    /// Height of a standing robot.
    pub height: f64,
    /// Roll of a standing robot, right side down positive.
    pub roll: f64,
    /// Jumps each time it becomes true.
    pub jump: bool,
}

#[derive(Clone, Debug)]
pub(super) struct Program {
    on: bool,
    started: bool,
    period: Ps,
    next_frame: Ps,
    wheels_rps: [f64; 2],
    wheel_kd: f64,
    joints: PcJoints,
    joint_kp: f64,
    joint_kd: f64,
    counts: bool,
    drive: Option<PcDrive>,
    sent: u64,
    last: Vec<u8>,
    random: Random,
}

impl Program {
    pub(super) fn new(random: Random) -> Self {
        Self {
            on: false,
            started: false,
            period: from_seconds(1.0 / 100.0),
            next_frame: 0,
            wheels_rps: [0.0; 2],
            wheel_kd: 1.0,
            joints: PcJoints::Limp,
            joint_kp: 20.0,
            joint_kd: 1.0,
            counts: true,
            drive: None,
            sent: 0,
            last: Downlink::default().encode().to_vec(),
            random,
        }
    }

    pub(super) fn set(&mut self, input: PcInput, told: Option<&Uplink>, now: Ps) {
        let on = input.on.unwrap_or(self.on);
        if on && !self.on {
            self.next_frame = now;
        }
        self.on = on;
        self.started |= on;
        if let Some(rate_hz) = input.rate_hz {
            let rate_hz = rate_hz.clamp(0.1, PcInput::MAX_RATE_HZ);
            self.period = from_seconds(1.0 / rate_hz);
        }
        self.wheels_rps = input.wheels_rps.unwrap_or(self.wheels_rps);
        self.wheel_kd = input.wheel_kd.unwrap_or(self.wheel_kd);
        self.joints = input.joints.unwrap_or(self.joints);
        self.joint_kp = input.joint_kp.unwrap_or(self.joint_kp);
        self.joint_kd = input.joint_kd.unwrap_or(self.joint_kd);
        self.counts = input.counts.unwrap_or(self.counts);
        self.drive = input
            .drive
            .or(self.drive.filter(|_| !input.is_for_motors()));
        self.hold(told);
    }

    /// Replaces "where they are" by angles, as soon as these are known.
    fn hold(&mut self, told: Option<&Uplink>) {
        if let (PcJoints::Hold, Some(told)) = (self.joints, told) {
            let [_, _, joints @ ..] = told.motors;
            self.joints = PcJoints::At(joints.map(|joint| joint.pos_rad));
        }
    }

    /// Whether it has ever been switched on.
    pub(super) fn started(&self) -> bool {
        self.started
    }

    pub(super) fn sent(&self) -> u64 {
        self.sent
    }

    pub(super) fn next_frame(&self) -> Ps {
        if self.on { self.next_frame } else { Ps::MAX }
    }

    /// The frame that is due at `next_frame`.
    pub(super) fn frame(&mut self, faults: LinkFaults, told: Option<&Uplink>) -> Vec<u8> {
        self.next_frame += self.period;
        self.hold(told);
        self.sent += 1;
        if faults.extremes {
            self.last = self.extremes();
        } else if !faults.frozen {
            self.last = self.command();
        }
        self.last.clone()
    }

    fn command(&self) -> Vec<u8> {
        let count = if self.counts { self.sent % 65_536 } else { 0 };
        match &self.drive {
            Some(drive) => {
                let shares = [drive.vx, drive.wz, drive.height, drive.roll];
                codec::drive_frame(shares, drive.jump, (count % 256) as u8).to_vec()
            }
            None => self.targets(count).encode().to_vec(),
        }
    }

    /// The frame's content for motors.
    fn targets(&self, count: u64) -> Downlink {
        let wheel = |n: usize| MotorCommand {
            target: self.wheels_rps[n],
            kp: count as f64 * 1_000.0 / 65_535.0,
            kd: self.wheel_kd,
        };
        let joint = |n: usize| match self.joints {
            PcJoints::At(pos_rad) => MotorCommand {
                target: pos_rad[n],
                kp: self.joint_kp,
                kd: self.joint_kd,
            },
            PcJoints::Limp | PcJoints::Hold => MotorCommand::default(),
        };
        Downlink {
            motors: [wheel(0), wheel(1), joint(0), joint(1), joint(2), joint(3)],
        }
    }

    /// Every field at one end of its range, drawn anew for each frame.
    fn extremes(&mut self) -> Vec<u8> {
        let mut high = || self.random.unit() >= 0.5;
        if self.drive.is_some() {
            let shares = [0; 4].map(|_| if high() { 1.0 } else { -1.0 });
            let jump = high();
            let count = if high() { 0xFF } else { 0 };
            return codec::drive_frame(shares, jump, count).to_vec();
        }
        let mut end = || if high() { 0xFFFF } else { 0 };
        codec::down_frame([0; 6].map(|_| [end(), end(), end()])).to_vec()
    }
}
