//! Motion in the air, and of the legs of a clamped robot.

use robot_description::Robot;
use robot_plant::free::{FreeBody, FreeInputs, FreeSetup, FreeState, Hold};
use serde_json::{Value, json};

use crate::oracle::{Oracle, numbers, robot, state_json};

/// Step of the plant in the simulated world.
const STEP_S: f64 = 250e-6;
/// Step of the oracle, whose method is of the fourth order.
const ORACLE_STEP_S: f64 = 500e-6;
/// States are compared this often.
const EVERY_S: f64 = 0.02;
const HEIGHT_M: f64 = 20.0;

/// Largest differences after any time of a motion: of the place in m, of an angle in rad.
const APART: [f64; 2] = [1e-6, 1e-5];
/// Dry friction that locks the hips gives way by as much.
const LOCKED_APART: [f64; 2] = [2e-5, 5e-4];
/// More than any torque here.
const LOCKING_NM: f64 = 400.0;

/// A motion and what drives it: steady torques, and torques that swing as cosines.
struct Flight {
    hold: Hold,
    seconds: f64,
    state: FreeState,
    /// Steady and swinging torques of the hips.
    hips_nm: [[f64; 4]; 2],
    rps: f64,
    hips_locked: bool,
    /// Largest difference of a place in m and of an angle in rad.
    apart: [f64; 2],
}

impl Flight {
    /// Torques of hips and wheels: steady ones, and swinging ones at the moment `t_s`.
    fn inputs(&self, t_s: f64) -> FreeInputs {
        let swing = (self.rps * t_s).cos();
        let [steady, amplitude] = self.hips_nm;
        FreeInputs {
            joint_nm: std::array::from_fn(|n| steady[n] + amplitude[n] * swing),
            wheel_nm: WHEEL_NM.map(|it| it * swing),
            joint_dry_nm: if self.hips_locked { LOCKING_NM } else { 0.0 },
            ..FreeInputs::default()
        }
    }

    fn question(&self) -> Value {
        json!({
            "state": state_json(&self.state),
            "step_s": ORACLE_STEP_S,
            "steps": (self.seconds / ORACLE_STEP_S).round() as u32,
            "every": (EVERY_S / ORACLE_STEP_S).round() as u32,
            "inputs": {
                "rps": self.rps,
                "hips_locked": self.hips_locked,
                "steady_joint_nm": self.hips_nm[0],
                "swing_joint_nm": self.hips_nm[1],
                "steady_wheel_nm": [0.0, 0.0],
                "swing_wheel_nm": WHEEL_NM,
            },
        })
    }

    fn assert_as_in_mujoco(&self, robot: &Robot, test: &str) {
        let Some(oracle) = Oracle::new(robot, test) else {
            return;
        };
        let expected = oracle.ask(self.hold, "flight", self.question());
        let setup = FreeSetup {
            hold: self.hold,
            ..FreeSetup::default()
        };
        let mut body = FreeBody::new(robot, &setup);
        body.set_state(&self.state);
        let steps_between = (EVERY_S / STEP_S).round() as u32;
        let mut step = 0_u32;
        let mut worst = [0.0_f64; 2];
        for expected in expected.as_array().expect("a list") {
            for _ in 0..steps_between {
                let middle_s = (f64::from(step) + 0.5) * STEP_S;
                body.step(&self.inputs(middle_s), STEP_S);
                step += 1;
            }
            let found = state_json(&body.state());
            let apart = |key: &str| largest_difference(&found[key], &expected[key]);
            worst[0] = worst[0].max(apart("position_m"));
            worst[1] = ["attitude", "joint_rad", "wheel_rad"]
                .map(apart)
                .into_iter()
                .fold(worst[1], f64::max);
            assert!(
                worst[0] < self.apart[0] && worst[1] < self.apart[1],
                "{worst:?} after {step} steps: {found} instead of {expected}"
            );
        }
        println!(
            "{test}: {:.1e} m and {:.1e} rad apart at most",
            worst[0], worst[1]
        );
    }
}

const WHEEL_NM: [f64; 2] = [0.4, -0.3];

fn largest_difference(found: &Value, expected: &Value) -> f64 {
    let pairs = numbers(found).into_iter().zip(numbers(expected));
    pairs.fold(0.0, |it, (a, b)| it.max((a - b).abs()))
}

fn tumbling() -> FreeState {
    FreeState {
        position_m: [0.0, 0.0, HEIGHT_M],
        attitude: [1.0, 0.0, 0.0, 0.0],
        velocity_mps: [1.0, -0.5, 3.0],
        rate_rps: [2.0, -1.5, 1.5],
        joint_rad: [-0.3, 0.4, -0.2, 0.1],
        joint_rps: [1.0, -0.5, 0.5, 0.8],
        wheel_rad: [0.0; 2],
        wheel_rps: [30.0, -10.0],
    }
}

#[test]
fn a_tumbling_robot_swings_its_legs_as_in_mujoco() {
    let flight = Flight {
        hold: Hold::Free,
        seconds: 0.44,
        state: tumbling(),
        hips_nm: [[0.0; 4], [0.4, -0.3, -0.4, 0.2]],
        rps: 15.0,
        hips_locked: false,
        apart: APART,
    };
    flight.assert_as_in_mujoco(&robot("fivebar"), "tumbling");
}

#[test]
fn a_tumbling_robot_with_locked_hips_turns_as_in_mujoco() {
    let flight = Flight {
        hold: Hold::Free,
        seconds: 1.0,
        state: FreeState {
            joint_rps: [0.0; 4],
            ..tumbling()
        },
        hips_nm: [[0.0; 4]; 2],
        rps: 15.0,
        hips_locked: true,
        apart: LOCKED_APART,
    };
    flight.assert_as_in_mujoco(&robot("fivebar"), "locked");
}

#[test]
fn legs_of_a_clamped_robot_swing_as_in_mujoco() {
    let robot = robot("fivebar");
    let flight = Flight {
        hold: Hold::Clamped,
        seconds: 0.3,
        state: FreeState {
            velocity_mps: [0.0; 3],
            rate_rps: [0.0; 3],
            ..tumbling()
        },
        // About what the legs weigh.
        hips_nm: [[0.45, -0.45, 0.45, -0.45], [0.3, 0.2, -0.3, 0.3]],
        rps: 20.0,
        hips_locked: false,
        apart: APART,
    };
    flight.assert_as_in_mujoco(&robot, "clamped");
}
