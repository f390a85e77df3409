//! A robot of the tests' own: its joints go where they are told, and nothing else moves.

use std::path::Path;

use robot_app::link::MotorState;

use super::*;
use crate::config;

/// The policy `fivebar/flat` of the vectors.
pub(crate) fn policy() -> PolicyDescription {
    let policies = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vectors/policies");
    config::read(&policies, "fivebar", "flat").expect("a policy")
}

pub(crate) fn robot() -> Robot {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/fivebar.toml");
    Robot::read(&file).expect("a robot")
}

/// A run and the robot that it drives.
pub(crate) struct Bench {
    pub(crate) runner: Runner,
    pub(crate) state: Uplink,
    pub(crate) time_s: f64,
    pub(crate) age_s: f64,
    pub(crate) silence_s: f64,
    pub(crate) obstacle: Option<Obstacle>,
    pub(crate) stop: Option<Stop>,
    /// Joints follow their targets.
    pub(crate) follows: bool,
    pub(crate) last: Downlink,
}

/// Where the robot's joints are at first.
pub(crate) const REST_RAD: f32 = 0.4;

impl Bench {
    /// A robot that obeys, and a network that gives these actions.
    pub(crate) fn new(actions: [f32; 6]) -> Self {
        let network: Network = Box::new(move |_, output| {
            output.copy_from_slice(&actions);
            Ok(())
        });
        let runner =
            Runner::new(&policy(), &robot(), network, Timing::default()).expect("its robot");
        let joint = MotorState {
            pos_rad: REST_RAD,
            vel_rps: 0.0,
        };
        let wheel = MotorState::default();
        Self {
            runner,
            state: Uplink {
                q_xyzw: [0.0, 0.0, 0.0, 1.0],
                motors: [wheel, wheel, joint, joint, joint, joint],
                ..Uplink::default()
            },
            time_s: 0.0,
            age_s: 0.001,
            silence_s: 0.1,
            obstacle: None,
            stop: None,
            follows: true,
            last: Downlink::default(),
        }
    }

    pub(crate) fn cycle(&mut self) -> Downlink {
        self.time_s += 0.005;
        self.last = self.runner.cycle(&Now {
            time_s: self.time_s,
            state: &self.state,
            age_s: self.age_s,
            silence_s: self.silence_s,
            obstacle: self.obstacle.clone(),
            commands: Commands::default(),
            stop: self.stop.take(),
        });
        if self.follows {
            for (motor, joint) in self.state.motors[2..].iter_mut().zip(&self.last.joints) {
                if joint.kp > 0.0 {
                    motor.pos_rad = joint.pos_rad;
                }
            }
        }
        self.last
    }

    /// Goes on until a state of the run.
    pub(crate) fn until(&mut self, phase: Phase) {
        for _ in 0..2_000 {
            self.cycle();
            if self.runner.machine().phase() == phase {
                return;
            }
        }
        panic!("never {phase:?}: {:?}", self.runner.in_the_way());
    }

    pub(crate) fn phase(&self) -> Phase {
        self.runner.machine().phase()
    }

    pub(crate) fn ended_by(&self) -> &'static str {
        self.runner
            .machine()
            .ended_by()
            .map_or("nothing", Stop::name)
    }

    pub(crate) fn is_limp(&self) -> bool {
        let joints = self
            .last
            .joints
            .iter()
            .all(|it| it.kp == 0.0 && it.kd == 0.0);
        joints && self.last.wheels.iter().all(|it| it.kd == 0.0)
    }
}
