//! The gains balance the robot in MuJoCo, which knows nothing of the model that they come from.

use std::{fs, path::Path};

use robot_balance_design::{LinearModel, Schedule, delay_ticks};
use robot_description::{Hold, Robot};
use robot_test_support::Python;
use serde_json::{Value, json};

const GRAVITY_MPS2: f64 = 9.80665;
const SECONDS: f64 = 4.0;
/// A second after the push and another two.
const STILL_FROM_S: f64 = 3.0;
/// Columns of a moment: time, then the state.
const WAY: usize = 1;
const SPEED: usize = 2;
const PITCH: usize = 9;

struct Trial {
    robot: &'static str,
    pitch_rad: f64,
    /// Speed that a push at 1 s gives to the whole robot, forward and left.
    push_mps: [f64; 2],
}

struct Outcome {
    moments: Vec<Vec<f64>>,
    most_nm: Vec<f64>,
}

impl Trial {
    /// Runs it, or returns `None` where there is no MuJoCo.
    fn run(&self) -> Option<Outcome> {
        let python = Python::with_science()?;
        let tree = Path::new(env!("CARGO_MANIFEST_DIR"));
        let file = tree.join(format!("../../robots/{}.toml", self.robot));
        let robot = Robot::read(&file).expect("a robot");
        let name = format!("{}-{}-{:?}.xml", self.robot, self.pitch_rad, self.push_mps);
        let model = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        fs::write(&model, robot.mjcf(Hold::Free)).expect("a folder for it");
        let mut command = python.command(tree.join("tests/mujoco/balance.py"));
        command.arg(&model);
        let answer = Python::answer(command, &self.question(&robot).to_string());
        let answer: Value = serde_json::from_slice(&answer).expect("JSON");
        let moments = answer["moments"].as_array().expect("a list");
        Some(Outcome {
            moments: moments.iter().map(numbers).collect(),
            most_nm: numbers(&answer["most_nm"]),
        })
    }

    fn question(&self, robot: &Robot) -> Value {
        let length_m = f64::midpoint(robot.legs.min_m, robot.legs.max_m);
        let schedule = Schedule::new(robot).expect("gains");
        let gains = schedule.gains([length_m; 2]);
        let rows: Vec<Vec<f64>> = gains
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect();
        let model = LinearModel::new(robot, [length_m; 2]).expect("a model");
        let mass_kg = robot.total_mass_kg();
        let axles_kg = 2.0 * (robot.wheels.mass_kg + robot.wheels.motor_mass_kg);
        json!({
            "gains": rows,
            "delay_ticks": delay_ticks(robot),
            "lean_rad": model.equilibrium.lean_rad,
            "leg_torque_nm": model.equilibrium.leg_torque_nm,
            "length_m": length_m,
            "carried_n": (mass_kg - axles_kg) * GRAVITY_MPS2,
            "pitch_rad": self.pitch_rad,
            "push_ns": [mass_kg * self.push_mps[0], mass_kg * self.push_mps[1], 0.0],
            "push_at_s": 1.0,
            "seconds": SECONDS,
        })
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter()
        .map(|it| it.as_f64().expect("a number"))
        .collect()
}

impl Outcome {
    /// Largest value of a column after a time.
    fn most(&self, column: usize, from_s: f64) -> f64 {
        let later = self.moments.iter().filter(|it| it[0] > from_s);
        later.fold(0.0, |most, it| most.max(it[column].abs()))
    }
}

/// Upright and still, near where it started.
fn assert_stands(trial: &Trial, outcome: &Outcome) {
    let [way_m, speed_mps, pitch_rad] =
        [WAY, SPEED, PITCH].map(|it| outcome.most(it, STILL_FROM_S));
    println!(
        "{}, pitch {} rad, push {:?} m/s: leans by {:.2} rad, rolls {:.2} m; from {STILL_FROM_S} s on {way_m:.3} m, \
         {speed_mps:.3} m/s, {pitch_rad:.4} rad; torques {:.1?} N·m",
        trial.robot,
        trial.pitch_rad,
        trial.push_mps,
        outcome.most(PITCH, 0.0),
        outcome.most(WAY, 0.0),
        outcome.most_nm,
    );
    assert!(way_m < 0.02 && speed_mps < 0.05 && pitch_rad < 0.01);
}

#[test]
fn a_tilted_robot_gets_upright() {
    let trial = Trial {
        robot: "fivebar",
        pitch_rad: 0.1,
        push_mps: [0.0; 2],
    };
    let Some(outcome) = trial.run() else { return };
    assert_stands(&trial, &outcome);
    assert!(outcome.most(PITCH, 0.0) > 0.09, "it starts tilted");
}

/// The state feedback alone, without what the firmware does about slip and long ways.
#[test]
fn pushed_robots_come_back() {
    for robot in ["fivebar", "fivebar-rs00"] {
        let trial = Trial {
            robot,
            pitch_rad: 0.0,
            push_mps: [1.0, 0.0],
        };
        let Some(outcome) = trial.run() else { return };
        assert_stands(&trial, &outcome);
        assert!(outcome.most(WAY, 0.0) > 0.2, "it was pushed");
    }
}
