//! Everything that is shown of a robot's gains.

use robot_balance_design::{
    DesignError, Equilibrium, Event, GainMatrix, Margins, Regulator, Sample, Schedule, delay_ticks,
    extra_delay_ticks, lengths_m, margins, poles, response,
};
use robot_description::Robot;
use serde_json::{Value, json};

/// Lengths of both legs, from the shortest to the longest.
const LENGTHS: usize = 9;
/// Lengths shown in tables, of those.
const SHOWN: [usize; 3] = [0, 4, 8];
/// Momentum over mass of the pushes that are shown, m/s.
const PUSHES_MPS: [f64; 3] = [0.5, 1.0, 1.5];
/// Friction between tyre and ground in the responses.
const FRICTION: f64 = 0.6;
const TIME_S: f64 = 3.0;
/// Speed of the step, m/s.
const STEP_MPS: f64 = 1.0;
/// Errors beyond these count no more, as in the controller.
const MOST_POSITION_ERROR_M: f64 = 0.05;
const MOST_SPEED_ERROR_MPS: f64 = 1.5;

pub struct Study {
    pub robot: Robot,
    pub schedule: Schedule,
    pub delay_ms: usize,
    pub lengths: Vec<AtLength>,
    /// Responses at the middle length: one to each push, and one to a step.
    pub pushes: Vec<(f64, Vec<Sample>)>,
    pub step: Vec<Sample>,
}

/// The loop with both legs at one length.
pub struct AtLength {
    pub length_m: f64,
    pub equilibrium: Equilibrium,
    /// As the firmware computes them.
    pub gains: GainMatrix,
    /// Real and imaginary part in 1/s, the slowest first, without those of torques on their way.
    pub poles: Vec<[f64; 2]>,
    /// Of a wheel and of a leg; left and right are the same.
    pub wheel: Margins,
    pub leg: Margins,
    pub extra_delay_ms: usize,
    /// Largest push that the robot survives, m/s.
    pub largest_push_mps: f64,
}

impl Study {
    pub fn new(robot: &Robot) -> Result<Self, DesignError> {
        let schedule = Schedule::new(robot)?;
        let [shortest_m, longest_m] = robot.control.limits.height_m;
        let lengths = lengths_m(shortest_m, longest_m, LENGTHS)
            .into_iter()
            .map(|length_m| AtLength::new(robot, &schedule, length_m))
            .collect::<Result<Vec<_>, _>>()?;
        let middle = &lengths[LENGTHS / 2];
        let pushes = PUSHES_MPS.into_iter().map(|push_mps| {
            let event = pushed(push_mps);
            let samples = response(robot, middle.length_m, &middle.gains, &event, TIME_S)?;
            Ok((push_mps, samples))
        });
        let asked = Event {
            speed_mps: STEP_MPS,
            stop_s: TIME_S / 2.0,
            ..pushed(0.0)
        };
        Ok(Self {
            pushes: pushes.collect::<Result<_, _>>()?,
            step: response(robot, middle.length_m, &middle.gains, &asked, TIME_S)?,
            delay_ms: delay_ticks(robot),
            robot: robot.clone(),
            schedule,
            lengths,
        })
    }

    /// The lengths of the tables.
    pub fn shown(&self) -> impl Iterator<Item = &AtLength> {
        SHOWN.iter().filter_map(|index| self.lengths.get(*index))
    }

    pub fn json(&self) -> Value {
        let schedule = &self.schedule;
        let lengths = self.lengths.iter().map(AtLength::json);
        json!({
            "robot": self.robot.name,
            "delay_ms": self.delay_ms,
            "schedule": {
                "centre_m": schedule.centre_m,
                "min_m": schedule.min_m,
                "max_m": schedule.max_m,
                "coefficients": schedule.coefficients,
                "worst_fit": schedule.worst_fit,
            },
            "lengths": lengths.collect::<Vec<_>>(),
        })
    }
}

impl AtLength {
    fn new(robot: &Robot, schedule: &Schedule, length_m: f64) -> Result<Self, DesignError> {
        let regulator = Regulator::new(robot, [length_m; 2])?;
        let gains = schedule.gains([length_m; 2]);
        let delay = delay_ticks(robot);
        let model = &regulator.discrete;
        let [wheel, _, leg, _] = margins(model, &gains, delay);
        let slowest = poles(model, &gains, delay).into_iter().take(10);
        Ok(Self {
            length_m,
            equilibrium: regulator.model.equilibrium,
            poles: slowest.map(|pole| [pole.re, pole.im]).collect(),
            wheel,
            leg,
            extra_delay_ms: extra_delay_ticks(model, &gains, delay),
            largest_push_mps: largest_push_mps(robot, length_m, &gains)?,
            gains,
        })
    }

    fn json(&self) -> Value {
        let rows = self.gains.row_iter();
        let margin = |margins: &Margins| {
            json!({
                "gain": [margins.least_gain, margins.most_gain],
                "phase_rad": margins.phase_rad,
                "modulus": margins.modulus,
            })
        };
        json!({
            "length_m": self.length_m,
            "lean_rad": self.equilibrium.lean_rad,
            "leg_torque_nm": self.equilibrium.leg_torque_nm,
            "gains": rows.map(|row| row.iter().copied().collect()).collect::<Vec<Vec<f64>>>(),
            "poles_per_s": self.poles,
            "wheel": margin(&self.wheel),
            "leg": margin(&self.leg),
            "extra_delay_ms": self.extra_delay_ms,
            "largest_push_mps": self.largest_push_mps,
        })
    }
}

/// Returns when, for the last time, the robot was not within 5 cm/s and 2° of standing; `None` if it fell.
pub fn settled_s(samples: &[Sample]) -> Option<f64> {
    let last = samples.last()?;
    let moves = |sample: &&Sample| {
        sample.body_mps.abs().max(sample.axle_mps.abs()) > 0.05
            || sample.pitch_rad.abs() > 2_f64.to_radians()
    };
    let late = samples.iter().rev().find(moves);
    (last.time_s > TIME_S - 0.01).then_some(late.map_or(0.0, |sample| sample.time_s))
}

/// Halves the range in which the robot begins to fall, down to some cm/s.
fn largest_push_mps(robot: &Robot, length_m: f64, gains: &GainMatrix) -> Result<f64, DesignError> {
    let (mut stands, mut falls) = (0.0, 4.0);
    while falls - stands > 0.05 {
        let push_mps = (stands + falls) / 2.0;
        let samples = response(robot, length_m, gains, &pushed(push_mps), TIME_S)?;
        if settled_s(&samples).is_some() {
            stands = push_mps;
        } else {
            falls = push_mps;
        }
    }
    Ok(stands)
}

fn pushed(push_mps: f64) -> Event {
    Event {
        speed_mps: 0.0,
        stop_s: 0.0,
        acceleration_mps2: 3.0,
        push_mps,
        friction: FRICTION,
        position_error_m: MOST_POSITION_ERROR_M,
        speed_error_mps: MOST_SPEED_ERROR_MPS,
    }
}
