//! The control loop with six motors and the tasks around it. Every frame that leaves is checked against the rules.

use robot_app::{
    control::ChassisController,
    diagnostics::DiagnosticsSnapshot,
    domain::{BusId, CanFrame, RobotConfig, StandardId, StateEstimate},
    motor::layout::{ROBOT_LAYOUT, RS00_LAYOUT},
    tick::ControlLoop,
    tuning::{READ_ID, REPLY_ID, WRITE_ID},
};

use crate::{
    motors::{JointMotor, WheelMotor},
    phase::{Clock, Phase},
    producers::Producers,
    replies::Replies,
    rules::{Allowed, Rules},
    wire::{JointFrame, Make, Mit, Sent, understand},
};

/// C620 counts of the 8 A limit: 8000 · 16384 / 20000, rounded up. Tuning can raise it to 15 A.
pub const LIMIT_COUNTS: i32 = 6_554;
const TUNED_LIMIT_COUNTS: i32 = 12_288;
/// Default speed limit of each joint.
const JOINT_RPS: f32 = 15.0;
/// Joint angle = this times motor angle.
const DIRECTIONS: [f32; 4] = [1.0, 1.0, -1.0, -1.0];

/// The frames that left the board in one tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tick {
    /// Counts of wheels 0 and 1.
    pub wheels: [i32; 2],
    pub joints: [Option<JointFrame>; 4],
    /// Replies of the tuning channel, on any bus.
    pub replies: Vec<[u8; 8]>,
}

impl Tick {
    pub fn drives(&self) -> bool {
        self.wheels != [0; 2]
    }

    /// Whether a joint is enabled or commanded.
    pub fn enables_joints(&self) -> bool {
        self.joints
            .iter()
            .flatten()
            .any(|frame| !frame.is_harmless())
    }
}

pub struct Bench<C: ChassisController> {
    control: ControlLoop<C>,
    diagnostics: DiagnosticsSnapshot,
    make: Make,
    rules: Rules,
    producers: Producers,
    wheels: [WheelMotor; 2],
    joints: [JointMotor; 4],
    counts: [i32; 2],
    replies: Replies,
    now_us: u64,
    /// A request of the tuning channel has come.
    pub tuned: bool,
    pub ticks: Vec<Tick>,
}

impl<C: ChassisController> Bench<C> {
    pub fn new(make: Make, controller: C) -> Self {
        let layout = match make {
            Make::Dm4310 => &ROBOT_LAYOUT,
            Make::Rs00 => &RS00_LAYOUT,
        };
        let mut config = RobotConfig::default();
        config.joint_ctrl.rs00_timeout_set = 1;
        Self {
            control: ControlLoop::with_layout(layout, config, controller),
            diagnostics: DiagnosticsSnapshot::default(),
            make,
            rules: Rules::default(),
            producers: Producers::default(),
            wheels: [WheelMotor::default(); 2],
            joints: [1, 2, 3, 4].map(|number| JointMotor::new(number, make)),
            counts: [0; 2],
            replies: Replies::new(make),
            now_us: 1_000_000,
            tuned: false,
            ticks: Vec::new(),
        }
    }

    pub fn run(&mut self, phases: &[Phase]) -> &mut Self {
        for phase in phases {
            self.now_us = self.now_us.saturating_add(phase.time_jump_us);
            for tick in 0..phase.ticks {
                self.now_us = match phase.clock {
                    Clock::Runs => self.now_us.saturating_add(1_000),
                    Clock::Stands => self.now_us,
                    Clock::RunsBack(us) => self.now_us.saturating_sub(us.into()),
                    Clock::Rushes(us) => self.now_us.saturating_add(us.into()),
                };
                self.producers.run(phase, tick, self.now_us);
                self.receive_from_buses(phase);
                self.receive_from_pc();
                self.tick(phase);
            }
        }
        self
    }

    fn hear(&mut self, bus: BusId, id: u16, data: &[u8]) {
        let id = StandardId::new(id & 0x7FF).expect("11 bits");
        let frame = CanFrame::from_payload(id, data).expect("at most eight bytes");
        self.tuned |= [WRITE_ID, READ_ID].contains(&id);
        if bus == BusId::Can2 {
            self.replies.note(id.raw(), data);
        }
        self.control
            .on_can_frame(bus, &frame, self.now_us, &self.diagnostics);
    }

    fn receive_from_pc(&mut self) {
        for frame in std::mem::take(&mut self.producers.requests) {
            self.tuned |= [WRITE_ID, READ_ID].contains(&frame.id());
            self.control
                .on_link_frame(&frame, self.now_us, &self.diagnostics);
        }
    }

    fn receive_from_buses(&mut self, phase: &Phase) {
        let (id, data) = &phase.frame;
        for bus in BusId::ALL {
            self.hear(bus, *id, data);
        }
        for wheel in 0..2 {
            let report = self.wheels[wheel].report(self.counts[wheel], phase.wheels[wheel]);
            if let Some(report) = report {
                self.hear(BusId::Can1, 0x201 + wheel as u16, &report);
            }
        }
        for (id, data) in self.replies.take() {
            self.hear(BusId::Can2, id, &data);
        }
    }

    fn tick(&mut self, phase: &Phase) {
        let inputs = self.producers.inputs();
        let fault = self.replies.has_reported_fault();
        let allowed = self.rules.allow(
            &inputs,
            phase.wheels,
            phase.joints,
            fault,
            self.tuned,
            self.now_us,
        );
        let outputs = self
            .control
            .tick(&inputs, self.now_us, &mut self.diagnostics);
        assert_sound(outputs.estimate);
        let frames = outputs.frames.to_vec();
        for frame in outputs.link_frames {
            assert_eq!(frame.id(), REPLY_ID, "only an answer goes to the PC");
        }
        for bus in BusId::ALL {
            let on_bus = frames.iter().filter(|(sent, _)| *sent == bus).count();
            assert!(on_bus <= 3, "{on_bus} frames for three mailboxes");
        }
        let mut tick = Tick::default();
        let mut wheel_frames = 0;
        for frame in &frames {
            match understand(frame, self.make) {
                Sent::TuningReply(reply) => tick.replies.push(reply),
                Sent::Wheels(counts) => {
                    wheel_frames += 1;
                    self.check_wheels(counts, allowed);
                    tick.wheels = [counts[0], counts[1]];
                }
                Sent::Joint(joint, frame) => {
                    self.check_joint(joint, frame, allowed);
                    tick.joints[joint] = Some(frame);
                    let reply = self.joints[joint].hear(frame, phase.joints[joint]);
                    self.replies.extend(reply);
                }
            }
        }
        assert_eq!(wheel_frames, 1, "one frame for the wheels in each tick");
        self.counts = tick.wheels;
        self.rules.driving |= tick.drives() || tick.enables_joints();
        self.ticks.push(tick);
    }

    fn check_wheels(&self, counts: [i32; 4], allowed: Allowed) {
        let limit = if self.tuned {
            TUNED_LIMIT_COUNTS
        } else {
            LIMIT_COUNTS
        };
        let zero = counts == [0; 4];
        assert!(
            allowed.wheels || zero,
            "torque {counts:?} at {}",
            self.now_us
        );
        assert!(
            counts.iter().all(|count| count.abs() <= limit),
            "{counts:?}"
        );
        assert_eq!(counts[2..], [0, 0]);
    }

    fn check_joint(&self, joint: usize, frame: JointFrame, allowed: Allowed) {
        let may = match frame {
            frame if frame.is_harmless() => true,
            JointFrame::Enable => allowed.joints,
            JointFrame::Mit(mit) if mit.is_off(self.make) => allowed.joints,
            _ => allowed.commands,
        };
        assert!(may, "joint {joint}: {frame:?} at {}", self.now_us);
        match frame {
            JointFrame::Mit(mit) => self.check_torque(joint, mit),
            JointFrame::PositionSpeed { pos_rad, max_rps } => {
                assert!(pos_rad.is_finite() && max_rps.is_finite());
                let [min_rad, max_rad] = range_rad(self.make, joint);
                let angle_rad = DIRECTIONS[joint] * pos_rad;
                let inside = (min_rad..=max_rad).contains(&angle_rad)
                    && (0.0..=JOINT_RPS).contains(&max_rps);
                assert!(self.tuned || inside, "{frame:?}");
            }
            JointFrame::Speed { vel_rps } => {
                assert!(vel_rps.is_finite());
                assert!(self.tuned || vel_rps.abs() <= JOINT_RPS, "{frame:?}");
            }
            _ => {}
        }
    }

    /// Within the limit, and not outwards beyond a soft limit, for one of the motions that the firmware may believe in.
    fn check_torque(&self, joint: usize, mit: Mit) {
        let limit_nm = match (self.tuned, self.make) {
            (false, Make::Dm4310) => 5.0,
            (false, Make::Rs00) => 10.0,
            (true, Make::Dm4310) => 7.0,
            (true, Make::Rs00) => 14.0,
        };
        let [min_rad, max_rad] = range_rad(self.make, joint);
        let is_sound = self.replies.believable(joint).iter().any(|motion| {
            let asked_nm = mit.asked_nm(*motion);
            let steps_nm = 1.01 * mit.steps_nm(*motion, self.make) + 1e-3;
            let angle_rad = DIRECTIONS[joint] * motion.pos_rad;
            let turning_nm = DIRECTIONS[joint] * asked_nm;
            let outwards = (angle_rad >= max_rad + 1e-3 && turning_nm > steps_nm)
                || (angle_rad <= min_rad - 1e-3 && turning_nm < -steps_nm);
            asked_nm.abs() <= limit_nm + steps_nm && (self.tuned || !outwards)
        });
        assert!(
            is_sound || mit.is_off(self.make),
            "joint {joint}: {mit:?} for {:?}",
            self.replies.believable(joint)
        );
    }
}

/// Default soft limits of a joint in rad. Those of the rear joints mirror those of the front ones.
fn range_rad(make: Make, joint: usize) -> [f32; 2] {
    let [down_rad, up_rad] = match make {
        Make::Dm4310 => [-1.35, 0.75],
        Make::Rs00 => [-1.3, 0.65],
    };
    if joint.is_multiple_of(2) {
        [down_rad, up_rad]
    } else {
        [-up_rad, -down_rad]
    }
}

/// For any sensor values, the estimate is a rotation with finite numbers.
fn assert_sound(estimate: &StateEstimate) {
    let squared: f32 = estimate.q_wxyz.iter().map(|part| part * part).sum();
    assert!((squared - 1.0).abs() < 1e-4, "{estimate:?}");
    let vectors = [
        estimate.rpy_rad,
        estimate.vel_mps,
        estimate.pos_m,
        estimate.gyro_bias_rps,
    ];
    assert!(vectors.iter().flatten().all(|part| part.is_finite()));
}
