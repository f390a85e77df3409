//! Turns wishes into commands: ramps, wheel speeds, joints that hold their angle.

use robot_app::{
    domain::{JointTarget, WheelTarget},
    link::Downlink,
};

use super::{RobotView, Wish};

/// Steps of the wheels' Kp, which has no effect. It changes in each frame, so that no frame repeats the one before: a PC
/// that turns the wheels and repeats itself counts as lost (docs/safety.md).
const COUNTER_STEPS: u16 = 256;
/// One step of a gain on the wire.
const GAIN_STEP: f32 = 1000.0 / 65_535.0;

/// Geometry of the chassis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheels {
    pub radius_m: f64,
    /// Distance between the centres of the wheels.
    pub track_m: f64,
}

/// Highest speeds, and how quickly they are reached. The wheels stop without a ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    pub speed_mps: f64,
    pub turn_rps: f64,
    pub accel_mps2: f64,
    pub turn_accel_rps2: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// N·m·s/rad at the wheel.
    pub wheel_kd: f32,
    /// N·m/rad.
    pub joint_kp: f32,
    /// N·m·s/rad.
    pub joint_kd: f32,
}

/// Makes the commands of the PC, one after the other.
#[derive(Clone, Debug)]
pub struct Driver {
    wheels: Wheels,
    limits: Limits,
    gains: Gains,
    forward_mps: f64,
    turn_rps: f64,
    /// Angles that the joints hold; `None` until the robot follows.
    hold_rad: Option<[f32; 4]>,
    /// After a stop the user has to let go once before anything moves.
    must_let_go: bool,
    counter: u16,
}

impl Driver {
    pub fn new(wheels: Wheels, limits: Limits, gains: Gains) -> Self {
        Self {
            wheels,
            limits,
            gains,
            forward_mps: 0.0,
            turn_rps: 0.0,
            hold_rad: None,
            must_let_go: true,
            counter: 0,
        }
    }

    /// Returns the command for `dt_s` after the one before.
    pub fn step(&mut self, dt_s: f64, wish: Wish, robot: &RobotView) -> Downlink {
        if robot.obstacle().is_some() {
            return self.rest(robot);
        }
        self.must_let_go &= wish.is_held;
        if wish.is_held && !self.must_let_go {
            let Limits {
                speed_mps,
                turn_rps,
                accel_mps2,
                turn_accel_rps2,
            } = self.limits;
            let wanted_mps = wish.forward.clamp(-1.0, 1.0) * speed_mps;
            let wanted_rps = wish.turn.clamp(-1.0, 1.0) * turn_rps;
            self.forward_mps = ramped(self.forward_mps, wanted_mps, accel_mps2 * dt_s);
            self.turn_rps = ramped(self.turn_rps, wanted_rps, turn_accel_rps2 * dt_s);
        } else {
            self.forward_mps = 0.0;
            self.turn_rps = 0.0;
        }
        let measured = measured_rad(robot);
        let hold_rad = *self.hold_rad.get_or_insert(measured);
        self.command(hold_rad)
    }

    /// Returns a command from rest: wheels at 0, and joints hold the angle that they have.
    pub fn rest(&mut self, robot: &RobotView) -> Downlink {
        self.forward_mps = 0.0;
        self.turn_rps = 0.0;
        self.hold_rad = None;
        self.must_let_go = true;
        self.command(measured_rad(robot))
    }

    /// Returns true while a held dead-man has no effect, because it was held through a stop.
    pub fn must_let_go(&self) -> bool {
        self.must_let_go
    }

    /// Returns the present targets: forward in m/s, turn to the left in rad/s.
    pub fn targets(&self) -> (f64, f64) {
        (self.forward_mps, self.turn_rps)
    }

    /// Returns the targets of the left and the right wheel in rad/s.
    pub fn wheel_targets_rps(&self) -> [f64; 2] {
        let Wheels { radius_m, track_m } = self.wheels;
        let apart_mps = 0.5 * self.turn_rps * track_m;
        [self.forward_mps - apart_mps, self.forward_mps + apart_mps].map(|mps| mps / radius_m)
    }

    fn command(&mut self, hold_rad: [f32; 4]) -> Downlink {
        self.counter = (self.counter + 1) % COUNTER_STEPS;
        let counter = f32::from(self.counter) * GAIN_STEP;
        let Gains {
            wheel_kd,
            joint_kp,
            joint_kd,
        } = self.gains;
        Downlink {
            wheels: self.wheel_targets_rps().map(|speed_rps| WheelTarget {
                speed_rps: speed_rps as f32,
                kp: counter,
                kd: wheel_kd,
            }),
            joints: hold_rad.map(|pos_rad| JointTarget {
                pos_rad,
                kp: joint_kp,
                kd: joint_kd,
            }),
        }
    }
}

fn measured_rad(robot: &RobotView) -> [f32; 4] {
    let [_, _, joints @ ..] = robot.state.motors;
    joints.map(|joint| joint.pos_rad)
}

pub(super) fn ramped(from: f64, to: f64, most: f64) -> f64 {
    from + (to - from).clamp(-most, most)
}

#[cfg(test)]
mod tests;
