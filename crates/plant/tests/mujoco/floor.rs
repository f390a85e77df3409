//! A run on the floor, in the plant and with MuJoCo's own contacts and steps.

use robot_description::Robot;
use robot_plant::free::{FreeBody, FreeInputs, FreeSetup, FreeState, Hold};
use serde_json::{Value, json};

use crate::oracle::{Oracle, state_json};

pub const STEP_S: f64 = 250e-6;
const EVERY: usize = 4;
/// Time from one moment of a run to the next.
pub const EVERY_S: f64 = STEP_S * EVERY as f64;
pub const GRAVITY_MPS2: f64 = 9.80665;
/// Assumptions of the plant: friction, rolling resistance by load and radius, and a tyre that gives so much under half of the
/// robot, damped by its share under wheel and motor.
pub const FRICTION: f64 = 0.8;
pub const ROLLING: f64 = 0.015;
pub const GIVES_M: f64 = 0.8e-3;
const TYRE_DAMPING: f64 = 0.15;
/// The least friction of a contact in MuJoCo.
pub const LEAST_FRICTION_M: f64 = 1e-5;
/// Hips held by springs and dampers as stiff as their motors: Nm/rad, Nm s/rad.
pub const STIFF: [f64; 2] = [150.0, 4.0];

/// Its hips are held at their first angles, its wheels are under a constant torque.
pub struct Run<'a> {
    pub robot: &'a Robot,
    pub state: FreeState,
    /// Nm/rad, Nm s/rad.
    pub hips: [f64; 2],
    pub wheel_nm: [f64; 2],
    pub seconds: f64,
}

impl Run<'_> {
    fn moments(&self) -> usize {
        (self.seconds / EVERY_S).round() as usize
    }

    /// What `moment` sees at each one. `stepped` sees every step.
    pub fn in_plant<M>(
        &self,
        mut stepped: impl FnMut(&FreeBody),
        moment: impl Fn(&FreeBody) -> M,
    ) -> Vec<M> {
        let mut body = FreeBody::new(self.robot, &FreeSetup::default());
        body.set_state(&self.state);
        let wanted_rad = body.joint_pos_rad();
        let [kp, kd] = self.hips;
        let moments = (0..self.moments()).map(|_| {
            for _ in 0..EVERY {
                let (rad, rps) = (body.joint_pos_rad(), body.joint_vel_rps());
                let inputs = FreeInputs {
                    wheel_nm: self.wheel_nm,
                    joint_nm: std::array::from_fn(|n| kp * (wanted_rad[n] - rad[n]) - kd * rps[n]),
                    ..FreeInputs::default()
                };
                body.step(&inputs, STEP_S);
                stepped(&body);
            }
            moment(&body)
        });
        moments.collect()
    }

    /// The question to MuJoCo: its tyres are hard, and resist rolling and not twisting.
    pub fn question(&self) -> Value {
        json!({
            "state": state_json(&self.state),
            "wheel_nm": self.wheel_nm,
            "step_s": STEP_S,
            "steps": self.moments() * EVERY,
            "every": EVERY,
            "kp": self.hips[0],
            "kd": self.hips[1],
            "friction": FRICTION,
            "twisting_m": LEAST_FRICTION_M,
            "rolling_m": ROLLING * self.robot.wheels.radius_m,
            "rolling_nm": 0.0,
        })
    }

    /// Makes the tyres of a question as soft as the plant's.
    pub fn soften_tyres(&self, question: &mut Value) {
        let wheels = &self.robot.wheels;
        let n_per_mps = self.damping_n_per_mps(TYRE_DAMPING, wheels.mass_kg + wheels.motor_mass_kg);
        question["tyre_n_per_m"] = json!(self.n_per_m());
        question["tyre_n_per_mps"] = json!(n_per_mps);
    }

    /// Stiffness of a tyre.
    pub fn n_per_m(&self) -> f64 {
        self.robot.total_mass_kg() / 2.0 * GRAVITY_MPS2 / GIVES_M
    }

    /// Damping of a mass on such a spring, as a share of the critical one.
    pub fn damping_n_per_mps(&self, share: f64, kg: f64) -> f64 {
        2.0 * share * (self.n_per_m() * kg).sqrt()
    }

    /// The rows that MuJoCo answers. `test` keeps the files of tests apart.
    pub fn ask(&self, test: &str, task: &str, question: Value) -> Option<Vec<Value>> {
        let oracle = Oracle::new(self.robot, test)?;
        match oracle.ask(Hold::Free, task, question) {
            Value::Array(rows) => Some(rows),
            other => panic!("no list: {other}"),
        }
    }
}
