//! How the balancing robot answers steps and pushes: in its plane, with torque limits, friction and late torques.

use std::collections::VecDeque;

use nalgebra::{Matrix2, SVector, Vector2};
use robot_description::Robot;

use crate::{
    DesignError,
    dynamics::{Dynamics, GRAVITY_MPS2, LENGTH, Pose, Vector},
    leg::LegPose,
    model::{GainMatrix, INPUTS, LinearModel, STATES},
    regulator::{TICK_S, delay_ticks},
};

/// Steps of the integration in each tick.
const STEPS: usize = 4;
/// The legs are commanded in every second tick.
const LEG_PERIOD: usize = 2;

/// What holds the legs' lengths.
const STIFFNESS_N_PER_M: f64 = 1500.0;
const DAMPING_N_S_PER_M: f64 = 60.0;

/// What happens to the robot, which stood still before.
#[derive(Clone, Copy, Debug)]
pub struct Event {
    /// Speed in m/s that the pilot asks for from the start, until `stop_s`.
    pub speed_mps: f64,
    /// When the pilot lets go, s.
    pub stop_s: f64,
    /// Largest change in m/s² of the speed that is asked for.
    pub acceleration_mps2: f64,
    /// Momentum over the whole mass, m/s, which the body takes at its centre of mass at the start.
    pub push_mps: f64,
    /// Friction between tyre and ground.
    pub friction: f64,
    /// Largest distance in m from where the robot ought to be that counts; what is more is forgotten.
    pub position_error_m: f64,
    /// Largest deviation in m/s from the speed that is asked for that counts.
    pub speed_error_mps: f64,
}

/// One instant of a response.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Time, s.
    pub time_s: f64,
    /// Speed in m/s of the body's centre of mass.
    pub body_mps: f64,
    /// Speed in m/s of the axles.
    pub axle_mps: f64,
    /// Speed that is asked for, m/s.
    pub asked_mps: f64,
    /// Lean of the left leg, rad.
    pub lean_rad: f64,
    /// Pitch of the body, rad.
    pub pitch_rad: f64,
    /// Torque on the left wheel, N·m.
    pub wheel_nm: f64,
}

/// Returns the response over `time_s`, one sample a tick; it ends early where the robot falls.
///
/// Both legs keep the hips as high as legs of `length_m` do, as far as they reach.
///
/// # Errors
/// [`DesignError`] where the links do not reach the length.
pub fn response(
    robot: &Robot,
    length_m: f64,
    gains: &GainMatrix,
    event: &Event,
    time_s: f64,
) -> Result<Vec<Sample>, DesignError> {
    let model = LinearModel::new(robot, [length_m; 2])?;
    let mut motion = Motion::new(robot, length_m, &model, event)?;
    let limits = Limits::new(robot, length_m)?;
    let [left_nm, right_nm] = model.equilibrium.leg_torque_nm;
    let equilibrium = SVector::from([0.0, 0.0, left_nm, right_nm]);
    let at_rest = Torques {
        state: equilibrium,
        push_n: [limits.above_axle_n; 2],
    };
    let mut on_their_way = VecDeque::from(vec![at_rest; delay_ticks(robot)]);
    let mut applied = at_rest;
    let (mut asked_m, mut asked_mps) = (0.0, 0.0);
    let mut samples = Vec::new();
    for tick in 0..(time_s / TICK_S) as usize {
        let now_s = tick as f64 * TICK_S;
        let wanted_mps = if now_s < event.stop_s {
            event.speed_mps
        } else {
            0.0
        };
        let most_mps = event.acceleration_mps2 * TICK_S;
        asked_mps += (wanted_mps - asked_mps).clamp(-most_mps, most_mps);
        asked_m += asked_mps * TICK_S;
        let [nearest_m, farthest_m] =
            [-1.0, 1.0].map(|side| motion.places[0] + side * event.position_error_m);
        asked_m = asked_m.clamp(nearest_m, farthest_m);

        let mut error = motion.error(asked_m, asked_mps, model.equilibrium.lean_rad);
        error[1] = error[1].clamp(-event.speed_error_mps, event.speed_error_mps);
        on_their_way.push_back(Torques {
            state: equilibrium - gains * error,
            push_n: motion.pushes_n(&limits),
        });
        if let Some(due) = on_their_way.pop_front() {
            limits.apply(&due, tick % LEG_PERIOD == 0, &mut applied);
        }
        let Some(sample) = motion.tick(&applied) else {
            break;
        };
        samples.push(Sample {
            time_s: now_s,
            asked_mps,
            ..sample
        });
    }
    Ok(samples)
}

/// What the motors do.
#[derive(Clone, Copy, Debug)]
struct Torques {
    /// Inputs of the linear model.
    state: SVector<f64, INPUTS>,
    /// Force along each leg.
    push_n: [f64; 2],
}

/// What the motors can do about a level body.
struct Limits {
    wheel_nm: f64,
    joint_nm: f64,
    /// Angle of a hip joint over the leg's angle, and over its length in m.
    joint_per_angle: f64,
    joint_per_length: f64,
    /// Weight above each axle: all but the wheels and their motors.
    above_axle_n: f64,
    /// Height of the hips above the axles.
    height_m: f64,
    length_m: [f64; 2],
}

impl Limits {
    fn new(robot: &Robot, length_m: f64) -> Result<Self, DesignError> {
        let leg = LegPose::new(&robot.legs, length_m, 0.0).ok_or(DesignError::Reach {
            left_m: length_m,
            right_m: length_m,
        })?;
        let [joint_per_angle, joint_per_length] = leg.thighs[0].angle_rad.by.map(f64::abs);
        let wheels = &robot.wheels;
        let axles_kg = 2.0 * (wheels.mass_kg + wheels.motor_mass_kg);
        Ok(Self {
            wheel_nm: wheels.max_current_a * wheels.torque_nm_per_a,
            joint_nm: robot.joints.peak_nm,
            joint_per_angle,
            joint_per_length,
            above_axle_n: (robot.total_mass_kg() - axles_kg) * GRAVITY_MPS2 / 2.0,
            height_m: length_m,
            length_m: [robot.legs.min_m, robot.legs.max_m],
        })
    }

    /// Limits the torques. The push gets what the lean leaves of the joints; legs get theirs when it is their turn.
    fn apply(&self, wanted: &Torques, legs_too: bool, applied: &mut Torques) {
        let limited = |value: f64, limit: f64| value.clamp(-limit, limit);
        for leg in [0, 1] {
            applied.state[leg] = limited(wanted.state[leg], self.wheel_nm);
            if legs_too {
                let most_nm = 2.0 * self.joint_nm * self.joint_per_angle;
                let lean_nm = limited(wanted.state[2 + leg], most_nm);
                let left_nm = self.joint_nm - lean_nm.abs() / (2.0 * self.joint_per_angle);
                applied.state[2 + leg] = lean_nm;
                let most_n = 2.0 * left_nm * self.joint_per_length;
                applied.push_n[leg] = limited(wanted.push_n[leg], most_n);
            }
        }
    }
}

struct Motion<'a> {
    robot: &'a Robot,
    friction: f64,
    places: Vector,
    rates: Vector,
    /// Force in N between each tyre and the ground.
    contact_n: f64,
}

impl<'a> Motion<'a> {
    fn new(
        robot: &'a Robot,
        length_m: f64,
        model: &LinearModel,
        event: &Event,
    ) -> Result<Self, DesignError> {
        let lean_rad = model.equilibrium.lean_rad;
        let mut places = Vector::zeros();
        places[2] = lean_rad;
        places[3] = lean_rad;
        places[LENGTH[0]] = length_m;
        places[LENGTH[1]] = length_m;
        let contact_n = robot.total_mass_kg() * GRAVITY_MPS2 / 2.0;
        let mut motion = Self {
            robot,
            friction: event.friction,
            places,
            rates: Vector::zeros(),
            contact_n,
        };
        let dynamics = motion.dynamics().ok_or(DesignError::Reach {
            left_m: length_m,
            right_m: length_m,
        })?;
        let impulse = event.push_mps * robot.total_mass_kg() * dynamics.body;
        motion.rates = dynamics.mass.try_inverse().ok_or(DesignError::Mass)? * impulse;
        Ok(motion)
    }

    fn dynamics(&self) -> Option<Dynamics> {
        let pose = Pose {
            length_m: LENGTH.map(|i| self.places[i]),
            lean_rad: [self.places[2], self.places[3]],
            pitch_rad: self.places[4],
        };
        Dynamics::new(self.robot, &pose, &self.rates)
    }

    /// What the controller acts on: the deviation from what is asked for.
    fn error(&self, asked_m: f64, asked_mps: f64, lean_rad: f64) -> SVector<f64, STATES> {
        let mut state = SVector::zeros();
        for i in 0..5 {
            state[2 * i] = self.places[i];
            state[2 * i + 1] = self.rates[i];
        }
        state[0] -= asked_m;
        state[1] -= asked_mps;
        state[4] -= lean_rad;
        state[6] -= lean_rad;
        state
    }

    /// Forces along the legs that keep the hips at their height.
    fn pushes_n(&self, limits: &Limits) -> [f64; 2] {
        [0, 1].map(|leg| {
            let (cos, length_m) = (self.places[2 + leg].cos(), self.places[LENGTH[leg]]);
            let [shortest_m, longest_m] = limits.length_m;
            let wanted_m = (limits.height_m / cos).clamp(shortest_m, longest_m);
            let spring_n = STIFFNESS_N_PER_M * (wanted_m - length_m);
            let rate = self.rates[LENGTH[leg]];
            limits.above_axle_n / cos + spring_n - DAMPING_N_S_PER_M * rate
        })
    }

    /// Moves on by one tick. `None` once the robot has fallen.
    fn tick(&mut self, torques: &Torques) -> Option<Sample> {
        let step_s = TICK_S / STEPS as f64;
        for _ in 0..STEPS {
            self.step(torques, step_s)?;
        }
        if self.places[2].abs() > 1.2 || self.places[4].abs() > 1.0 {
            return None;
        }
        let dynamics = self.dynamics()?;
        Some(Sample {
            time_s: 0.0,
            body_mps: dynamics.body.dot(&self.rates),
            axle_mps: self.rates[0],
            asked_mps: 0.0,
            lean_rad: self.places[2],
            pitch_rad: self.places[4],
            wheel_nm: torques.state[0],
        })
    }

    fn step(&mut self, torques: &Torques, step_s: f64) -> Option<()> {
        let dynamics = self.dynamics()?;
        let inverse = dynamics.mass.try_inverse()?;
        let mut forces = dynamics.inputs * torques.state - dynamics.bias - dynamics.slope;
        for leg in [0, 1] {
            forces[LENGTH[leg]] += torques.push_n[leg];
        }
        let free = self.rates + step_s * inverse * forces;
        // The friction that stops all slip within this step, as far as it goes.
        let [left, right] = dynamics.slip();
        let moved = [inverse * left, inverse * right];
        let coupling = Matrix2::new(
            left.dot(&moved[0]),
            left.dot(&moved[1]),
            right.dot(&moved[0]),
            right.dot(&moved[1]),
        );
        let slip = Vector2::new(left.dot(&free), right.dot(&free));
        let most = self.friction * self.contact_n * step_s;
        let impulse = (coupling.try_inverse()? * slip).map(|i| i.clamp(-most, most));
        let after = free - moved[0] * impulse[0] - moved[1] * impulse[1];
        let lifted = dynamics.upward.dot(&((after - self.rates) / step_s)) + dynamics.upward_bias;
        let weight_n = dynamics.total_mass_kg * GRAVITY_MPS2;
        self.contact_n = ((weight_n + lifted) / 2.0).max(0.0);
        self.rates = after;
        self.places += step_s * after;
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::{discrete::DiscreteModel, regulator::Regulator};

    const LENGTH_M: f64 = 0.2;

    fn robot() -> Robot {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/fivebar.toml");
        Robot::read(Path::new(file)).expect("a robot of this repository")
    }

    fn pushed(push_mps: f64, friction: f64) -> Event {
        Event {
            speed_mps: 0.0,
            stop_s: 0.0,
            acceleration_mps2: 3.0,
            push_mps,
            friction,
            position_error_m: 0.05,
            speed_error_mps: 1.5,
        }
    }

    /// Speed of the axles, lean and pitch.
    type Signals = [f64; 3];

    /// The linear system from the speeds that an impulse at the body's centre gives to wheels that roll.
    fn linear(robot: &Robot, regulator: &Regulator, push_mps: f64, ticks: usize) -> Vec<Signals> {
        let motion = Motion::new(robot, LENGTH_M, &regulator.model, &pushed(0.0, 1.0));
        let dynamics = motion.expect("a pose").dynamics().expect("within reach");
        let rolling = dynamics.rolling();
        let mass = rolling.transpose() * dynamics.mass * rolling;
        let impulse = rolling.transpose() * dynamics.body * push_mps * robot.total_mass_kg();
        let rates = mass.try_inverse().expect("masses") * impulse;
        let mut state = SVector::<f64, STATES>::zeros();
        for i in 0..5 {
            state[2 * i + 1] = rates[i];
        }
        let DiscreteModel { a, b } = &regulator.discrete;
        let mut late = VecDeque::from(vec![SVector::<f64, INPUTS>::zeros(); delay_ticks(robot)]);
        let mut applied = SVector::<f64, INPUTS>::zeros();
        let signals = (0..ticks).map(|tick| {
            late.push_back(-regulator.gains * state);
            let due = late.pop_front().expect("one was put in");
            let fresh = if tick % LEG_PERIOD == 0 { 4 } else { 2 };
            applied.rows_mut(0, fresh).copy_from(&due.rows(0, fresh));
            state = a * state + b * applied;
            [state[1], state[4], state[8]]
        });
        signals.collect()
    }

    /// The linear model's legs keep their lengths. Here they are springs, which the rotor's reaction on its shank moves too:
    /// the differences of axles, lean and pitch are 5, 4 and 18 %.
    #[test]
    fn a_small_push_is_answered_as_by_the_linear_loop() {
        let robot = robot();
        let regulator = Regulator::new(&robot, [LENGTH_M; 2]).expect("gains");
        let event = pushed(0.01, 1e3);
        let samples = response(&robot, LENGTH_M, &regulator.gains, &event, 1.0).expect("a length");
        let expected = linear(&robot, &regulator, event.push_mps, samples.len());
        assert_eq!(expected.len(), 1000);
        for (signal, most) in [0.08, 0.08, 0.25].into_iter().enumerate() {
            let found = samples
                .iter()
                .map(|it| [it.axle_mps, it.lean_rad, it.pitch_rad][signal]);
            let pairs = found.zip(expected.iter().map(|it| it[signal]));
            let (mut apart, mut largest) = (0.0_f64, 0.0_f64);
            for (found, expected) in pairs {
                apart = apart.max((found - expected).abs());
                largest = largest.max(expected.abs());
            }
            assert!(apart < most * largest, "{signal}: {apart} of {largest}");
        }
    }

    /// Half of the robot's weight is on each wheel: at friction 0.1 no torque gives more than 0.1 g.
    #[test]
    fn little_grip_cannot_catch_a_push() {
        let robot = robot();
        let regulator = Regulator::new(&robot, [LENGTH_M; 2]).expect("gains");
        let last_s = |friction| {
            let event = pushed(1.0, friction);
            let samples =
                response(&robot, LENGTH_M, &regulator.gains, &event, 2.0).expect("a length");
            samples.last().map_or(0.0, |it| it.time_s)
        };
        assert!(last_s(0.6) > 1.99 && last_s(0.1) < 1.9);
    }
}
