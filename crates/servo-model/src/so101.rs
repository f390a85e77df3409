//! An SO-101 arm: six servos, where their joints end, and what gravity does to them.
//!
//! Lengths, limits and masses are those of the arm's URDF (`so101_new_calib.urdf` of TheRobotStudio/SO-ARM100).

use std::f64::consts::TAU;

use crate::{
    bus::Body,
    servo::{Load, STEPS, Servo, Version},
};

/// Joints from the base to the jaw, with their limits, rad. Their places are those of the servos, and their ids one more.
pub const JOINTS: [(&str, f64, f64); 6] = [
    ("shoulder_pan", -1.91986, 1.91986),
    ("shoulder_lift", -1.74533, 1.74533),
    ("elbow_flex", -1.69, 1.69),
    ("wrist_flex", -1.65806, 1.65806),
    ("wrist_roll", -2.74385, 2.84121),
    ("gripper", -0.174533, 1.74533),
];

/// Angle of a shaft at which its joint is at zero, steps. Growing steps are growing angles of the joint. Both are assumed; an
/// assembled arm differs from joint to joint, which is what calibration is for.
const ZERO_STEPS: f64 = 2048.0;

/// Steps of a joint's angle, rad.
fn steps(angle_rad: f64) -> f64 {
    ZERO_STEPS + angle_rad * STEPS / TAU
}

/// Angle of a joint, rad, for the angle of its shaft, steps.
fn angle_rad(shaft_steps: f64) -> f64 {
    (shaft_steps - ZERO_STEPS) * TAU / STEPS
}

/// The arm folded onto itself, as it rests without torque, rad.
const FOLDED: [f64; 6] = [0.0, -1.7, 1.65, 1.0, 0.0, 0.0];

/// Gravity, m/s².
const GRAVITY: f64 = 9.81;

/// Vectors from joint to joint in the plane of the arm with all angles at zero, forward and up, m: lift to elbow, elbow to wrist,
/// wrist to the end of the gripper.
const LINKS: [(f64, f64); 3] = [(0.028, 0.11257), (0.1349, 0.0052), (0.1593, -0.0079)];
/// Masses of upper arm, lower arm, and of wrist, gripper and jaw together, kg. Each is assumed in the middle of its link.
const MASSES: [f64; 3] = [0.103, 0.104, 0.178];
/// Distance of the lift axis from the pan axis, m.
const REACH: f64 = 0.0304;

/// Six servos as they leave the workshop: ids 1 to 6, no return delay, uncalibrated, with the arm folded and mechanical stops at
/// the joints' limits.
pub fn so101_servos(version: Version) -> Vec<Servo> {
    let joints = (1..).zip(JOINTS.iter().zip(FOLDED));
    let servos = joints.map(|(id, ((_, low, high), angle))| {
        Servo::new(version, steps(angle))
            .with_id(id)
            .with_return_delay(0)
            .with_stops(steps(*low), steps(*high))
    });
    servos.collect()
}

/// The arm as the load of its servos.
#[derive(Clone, Copy, Debug, Default)]
pub struct So101;

impl So101 {
    /// Where the arm is for the angles of its shafts, steps: the angle of the pan, rad, and in the plane of the arm the lift axis,
    /// the elbow, the wrist and the gripper's end, forward and up from the lift axis, m.
    pub fn pose(self, shaft_steps: [f64; 6]) -> (f64, [(f64, f64); 4]) {
        let [pan, lift, elbow, wrist, ..] = shaft_steps.map(angle_rad);
        (pan, points([lift, elbow, wrist]))
    }
}

impl Body for So101 {
    fn loads(&self, shaft_steps: &[f64]) -> Vec<Load> {
        let mut steps = [ZERO_STEPS; 6];
        for (known, shaft) in steps.iter_mut().zip(shaft_steps) {
            *known = *shaft;
        }
        let (_, points) = self.pose(steps);
        let mut loads = vec![Load::default(); shaft_steps.len()];
        for (joint, load) in loads.iter_mut().enumerate() {
            *load = match joint {
                0 => swing(&points),
                1..=3 => lever(&points, joint - 1),
                _ => Load::default(),
            };
        }
        loads
    }
}

/// Lift axis, elbow, wrist and the gripper's end in the plane of the arm, from the lift axis on, m.
fn points(angles: [f64; 3]) -> [(f64, f64); 4] {
    let mut points = [(0.0, 0.0); 4];
    let mut pitch: f64 = 0.0;
    for (link, ((forward, up), angle)) in LINKS.iter().zip(angles).enumerate() {
        // A growing angle lowers what is in front.
        pitch += angle;
        let (sin, cos) = pitch.sin_cos();
        let (x, z) = points[link];
        points[link + 1] = (x + forward * cos + up * sin, z - forward * sin + up * cos);
    }
    points
}

fn middle(points: &[(f64, f64); 4], link: usize) -> (f64, f64) {
    let ((x, z), (to_x, to_z)) = (points[link], points[link + 1]);
    ((x + to_x) / 2.0, (z + to_z) / 2.0)
}

/// What a horizontal axis carries: all links from `joint` on.
fn lever(points: &[(f64, f64); 4], joint: usize) -> Load {
    let (x, z) = points[joint];
    let mut load = Load::default();
    for (link, mass) in MASSES.iter().enumerate().skip(joint) {
        let (mass_x, mass_z) = middle(points, link);
        load.torque_nm += mass * GRAVITY * (mass_x - x);
        load.inertia_kgm2 += mass * ((mass_x - x).powi(2) + (mass_z - z).powi(2));
    }
    load
}

/// What the pan axis turns: no weight, but the inertia of all.
fn swing(points: &[(f64, f64); 4]) -> Load {
    let links = MASSES.iter().enumerate();
    let inertias = links.map(|(link, mass)| mass * (REACH + middle(points, link).0).powi(2));
    Load {
        inertia_kgm2: inertias.sum(),
        ..Load::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lift axis of the arm, m.
    const LIFT: (f64, f64) = (0.0692, 0.1166);

    // Computed from the URDF's whole chain with NumPy: angles of lift, elbow and wrist, and where the gripper's end is.
    #[test]
    fn the_gripper_is_where_the_urdf_has_it() {
        for (angles, x, z) in [
            ([0.0, 0.0, 0.0], 0.3914, 0.2265),
            ([0.3, 0.0, 0.0], 0.4094, 0.1264),
            ([0.0, 0.3, 0.0], 0.3774, 0.1397),
            ([0.0, 0.0, 0.3], 0.3819, 0.1798),
        ] {
            let end = points(angles)[3];
            let off = (LIFT.0 + end.0 - x).hypot(LIFT.1 + end.1 - z);
            assert!(off < 1e-3, "{angles:?}: {off}");
        }
    }

    // Upper arm up, the rest forward: 0.103 kg at 14 mm, 0.104 at 95, 0.178 at 243, each times g.
    #[test]
    fn gravity_pulls_the_arm_down() {
        let zero = [ZERO_STEPS; 6];
        let loads = So101.loads(&zero);
        assert!((loads[1].torque_nm - 0.535).abs() < 0.005, "{loads:?}");
        assert!(loads[2].torque_nm > loads[3].torque_nm && loads[3].torque_nm > 0.1);
        assert_eq!((loads[0].torque_nm, loads[5].torque_nm), (0.0, 0.0));
        assert!(loads[0].inertia_kgm2 > 0.005);
    }
}
