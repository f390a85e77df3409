//! What follows from a robot's file: loads, margins, speeds.

mod jump;

pub use jump::Jump;
pub(crate) use jump::jump;

use crate::{
    Bus, Robot,
    five_bar::{FiveBar, Margins},
};

/// Standard gravity in m/s².
pub(crate) const GRAVITY_MPS2: f64 = 9.80665;
/// Bits of a standard frame with eight bytes, all possible stuff bits and the intermission.
const FRAME_BITS: f64 = 135.0;
const BITS_PER_SECOND: f64 = 1e6;
/// Frames a second of the tuning channel: replies and recorded samples.
const TUNING_FRAMES: f64 = 1_250.0;
/// Steps over the range of a hip, and of a length.
const STEPS: u32 = 40;

/// Load of the hips while standing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// Leg length in m.
    pub length_m: f64,
    /// Torque in N·m of each hip.
    pub hip_nm: f64,
    /// Share of the motor's continuous torque.
    pub share: f64,
}

/// What follows from a robot's file.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// Standing at some heights, lowest first.
    pub stands: Vec<Stand>,
    /// Force in N along each leg of a robot that stands still.
    pub carried_n: f64,
    /// Force in N along a leg at its shortest with the hips at their torque limit.
    pub push_n: f64,
    /// The highest jump.
    pub jump: Jump,
    /// Speed in m/s at which the unloaded wheels turn.
    pub top_speed_mps: f64,
    /// Acceleration in m/s² by the wheels' torque, with all masses that turn.
    pub acceleration_mps2: f64,
    /// Distance in m of the body from the ground at the lowest height.
    pub clearance_m: f64,
    /// Backward and forward lean in rad of the legs at middle height.
    pub leans_rad: [f64; 2],
    /// Angle in rad by which the shanks stay away from one line.
    pub between_shanks_rad: f64,
    /// Angle in rad by which the knees stay away from folded and straight.
    pub at_knee_rad: f64,
    /// Load of CAN1 and CAN2, 0…1.
    pub bus_loads: [f64; 2],
}

impl Robot {
    /// Returns the figures of a robot whose [`check`](Self::check) found no error.
    pub fn figures(&self) -> Figures {
        let margins = worst_margins(self);
        let wheels = &self.wheels;
        let turning_kg =
            2.0 * (wheels.inertia_kgm2 + wheels.rotor_inertia_kgm2) / wheels.radius_m.powi(2);
        let force_n = 2.0 * wheels.max_current_a * wheels.torque_nm_per_a / wheels.radius_m;
        Figures {
            stands: heights(self)
                .map(|length_m| stand(self, length_m))
                .collect(),
            carried_n: carried_n(self),
            push_n: self.joints.torque_limit_nm / leverage(self, self.legs.min_m),
            jump: jump(self),
            top_speed_mps: top_speed_mps(self),
            acceleration_mps2: force_n / (self.total_mass_kg() + turning_kg),
            clearance_m: clearance_m(self),
            leans_rad: leans_rad(self, middle_m(self)),
            between_shanks_rad: margins.map_or(f64::NAN, |it| it.between_shanks_rad),
            at_knee_rad: margins.map_or(f64::NAN, |it| it.at_knee_rad),
            bus_loads: [Bus::Can1, Bus::Can2].map(|bus| bus_load(self, bus)),
        }
    }
}

/// Five heights of the range that the pilot can ask for.
fn heights(robot: &Robot) -> impl Iterator<Item = f64> {
    let [low_m, high_m] = robot.control.limits.height_m;
    (0..=4).map(move |step| low_m + (high_m - low_m) * f64::from(step) / 4.0)
}

pub(crate) fn middle_m(robot: &Robot) -> f64 {
    let [low_m, high_m] = robot.control.limits.height_m;
    (low_m + high_m) / 2.0
}

/// Torque of each hip for 1 N along the leg.
fn leverage(robot: &Robot, length_m: f64) -> f64 {
    let leg = FiveBar::new(&robot.legs);
    leg.torque_per_newton(length_m).unwrap_or(f64::NAN)
}

/// The hips carry what is above them; the wheels and the lower ends of the shanks stand by themselves.
fn carried_n(robot: &Robot) -> f64 {
    robot.split_mass().carried_kg * GRAVITY_MPS2 / 2.0
}

fn stand(robot: &Robot, length_m: f64) -> Stand {
    let hip_nm = carried_n(robot) * leverage(robot, length_m);
    Stand {
        length_m,
        hip_nm,
        share: hip_nm / robot.joints.continuous_nm,
    }
}

/// The height at which standing costs most.
pub(crate) fn hardest_stand(robot: &Robot) -> Stand {
    let [low_m, high_m] = robot.control.limits.height_m;
    let lengths = (0..=STEPS).map(|step| low_m + (high_m - low_m) * share(step));
    let stands = lengths.map(|length_m| stand(robot, length_m));
    stands
        .max_by(|a, b| a.hip_nm.total_cmp(&b.hip_nm))
        .unwrap_or_else(|| stand(robot, low_m))
}

pub(crate) fn clearance_m(robot: &Robot) -> f64 {
    let [low_m, _] = robot.control.limits.height_m;
    let bottom_m = robot.body.box_centre_m[2] - robot.body.box_m[2] / 2.0;
    low_m + robot.wheels.radius_m + bottom_m
}

pub(crate) fn top_speed_mps(robot: &Robot) -> f64 {
    robot.wheels.no_load_rps * robot.wheels.radius_m
}

/// Lean of the legs that brings the axles under the centre of what they carry, with folded legs.
pub(crate) fn folded_lean_rad(robot: &Robot) -> f64 {
    let share = robot.body.mass_kg / robot.split_mass().carried_kg;
    let [x, _, z] = robot.body.com_m.map(|along_m| share * along_m);
    // The body stays level: the axle is straight below the centre.
    let down_m = (robot.legs.min_m.powi(2) - x * x).max(0.0).sqrt().max(z);
    x.atan2(down_m)
}

pub(crate) fn in_range(robot: &Robot, [front_rad, rear_rad]: [f64; 2]) -> bool {
    let within = |[min_rad, max_rad]: [f64; 2], rad| (min_rad..=max_rad).contains(&rad);
    let ranges = &robot.joints.range_rad;
    within(ranges.front, front_rad) && within(ranges.rear, rear_rad)
}

/// How far the legs of a length can lean backward and forward, in steps of 0.01 rad.
pub(crate) fn leans_rad(robot: &Robot, length_m: f64) -> [f64; 2] {
    let leg = FiveBar::new(&robot.legs);
    let reach = |sign: f64| {
        let leans = (0..=157).map(|step| sign * f64::from(step) / 100.0);
        leans
            .take_while(|lean_rad| {
                leg.hips_rad(length_m, *lean_rad)
                    .is_some_and(|hips| in_range(robot, hips))
            })
            .last()
            .unwrap_or(0.0)
    };
    [reach(-1.0), reach(1.0)]
}

/// The smallest margins over all hip angles. `None` if the shanks do not meet at some.
pub(crate) fn worst_margins(robot: &Robot) -> Option<Margins> {
    let leg = FiveBar::new(&robot.legs);
    let ranges = &robot.joints.range_rad;
    let at = |[min_rad, max_rad]: [f64; 2], step| min_rad + (max_rad - min_rad) * share(step);
    let mut worst: Option<Margins> = None;
    for front in 0..=STEPS {
        for rear in 0..=STEPS {
            let here = leg.margins([at(ranges.front, front), at(ranges.rear, rear)])?;
            let so_far = worst.unwrap_or(here);
            worst = Some(Margins {
                between_shanks_rad: so_far.between_shanks_rad.min(here.between_shanks_rad),
                at_knee_rad: so_far.at_knee_rad.min(here.at_knee_rad),
            });
        }
    }
    worst
}

fn share(step: u32) -> f64 {
    f64::from(step) / f64::from(STEPS)
}

/// The load of a bus, 0…1: a command to both wheels and their two feedbacks in every tick, a command and a reply of each
/// joint in its ticks, and the tuning channel.
pub(crate) fn bus_load(robot: &Robot, bus: Bus) -> f64 {
    let wheels = if robot.wheels.bus == bus {
        3_000.0
    } else {
        0.0
    };
    let period = f64::from(robot.joints.period_ticks.max(1));
    let joints = if robot.joints.bus == bus {
        8_000.0 / period
    } else {
        0.0
    };
    (TUNING_FRAMES + wheels + joints) * FRAME_BITS / BITS_PER_SECOND
}

/// Most frames for motors that start on a bus in one tick.
pub(crate) fn frames_in_a_tick(robot: &Robot, bus: Bus) -> usize {
    let wheels = usize::from(robot.wheels.bus == bus);
    let joints = |tick: u8| {
        let due = robot.joints.phases.iter().filter(|phase| **phase == tick);
        due.count()
    };
    let ticks = 0..robot.joints.period_ticks.max(1);
    let most = if robot.joints.bus == bus {
        ticks.map(joints).max()
    } else {
        None
    };
    wheels + most.unwrap_or(0)
}

pub(crate) fn name(bus: Bus) -> &'static str {
    match bus {
        Bus::Can1 => "CAN1",
        Bus::Can2 => "CAN2",
    }
}

#[cfg(test)]
mod tests;
