//! Where the parts of the free robot are, from its true signals.

use robot_description::{Carrier, Robot};
use robot_plant::attitude::{Quaternion, to_earth};

use crate::signals::{SignalTable, Values};

/// A point or a direction: x, y, z.
pub type Vector = [f64; 3];

/// Left, right: sign of y.
pub const SIDES: [f64; 2] = [1.0, -1.0];

/// One leg in body axes, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Front, rear.
    pub hips: [Vector; 2],
    /// Front, rear.
    pub knees: [Vector; 2],
    /// Where both shanks meet.
    pub axle: Vector,
}

/// The robot at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skeleton {
    /// Place of the hip centre in the ENU earth frame, m.
    pub place_m: Vector,
    /// Body → earth, scalar first.
    pub q_wxyz: Quaternion,
    /// Nose down positive.
    pub pitch_rad: f64,
    /// Left, right.
    pub legs: [Leg; 2],
    /// Angle of each wheel about the body's y axis, from some zero.
    pub wheels_rad: [f64; 2],
    /// Speed along the heading.
    pub forward_mps: f64,
}

impl Leg {
    /// Angle about y of the shank that carries the wheel's motor.
    fn carrier_rad(&self, carrier: Carrier) -> f64 {
        let knee = self.knees[match carrier {
            Carrier::Front => 0,
            Carrier::Rear => 1,
        }];
        about_y_rad(knee, self.axle)
    }
}

/// Angle about y that turns the x axis into the direction from one point to another.
pub fn about_y_rad(from: Vector, to: Vector) -> f64 {
    (from[2] - to[2]).atan2(to[0] - from[0])
}

impl Skeleton {
    /// A point of the body in the earth frame.
    pub fn in_world(&self, body: Vector) -> Vector {
        let turned = to_earth(self.q_wxyz, body);
        std::array::from_fn(|axis| self.place_m[axis] + turned[axis])
    }

    /// Centre of a wheel in body axes.
    pub fn wheel(&self, side: usize, robot: &Robot) -> Vector {
        let [x, _, z] = self.legs[side].axle;
        [x, SIDES[side] * robot.wheels.track_m / 2.0, z]
    }

    /// Heading from east, counter-clockwise.
    pub fn yaw_rad(&self) -> f64 {
        let [x, y, _] = to_earth(self.q_wxyz, [1.0, 0.0, 0.0]);
        y.atan2(x)
    }
}

/// Places of the signals that a skeleton needs.
pub struct SkeletonSignals {
    place: [usize; 3],
    attitude: [usize; 4],
    pitch: usize,
    joints: [usize; 4],
    /// Length and angle of each leg.
    legs: [[usize; 2]; 2],
    turned: [usize; 2],
    forward: usize,
}

impl SkeletonSignals {
    /// `None` for a robot that is not free.
    pub fn find(table: &SignalTable) -> Option<Self> {
        let all = |names: &[String]| -> Option<Vec<usize>> {
            names.iter().map(|name| table.index(name)).collect()
        };
        let of = |prefix: &str, parts: &[&str]| {
            all(&parts
                .iter()
                .map(|part| format!("{prefix}{part}"))
                .collect::<Vec<_>>())
        };
        let leg = |side| of(&format!("truth.leg.{side}."), &["length_m", "angle_rad"]);
        let each = |prefix: &str, count: usize, part: &str| {
            all(&(0..count)
                .map(|index| format!("{prefix}{index}{part}"))
                .collect::<Vec<_>>())
        };
        Some(Self {
            place: of("truth.body.", &["x", "y", "z"])?.try_into().ok()?,
            attitude: of("truth.attitude.", &["w", "x", "y", "z"])?
                .try_into()
                .ok()?,
            pitch: table.index("truth.body.pitch")?,
            joints: each("truth.joint.", 4, ".pos_rad")?.try_into().ok()?,
            legs: [leg(0)?.try_into().ok()?, leg(1)?.try_into().ok()?],
            turned: each("truth.wheel.", 2, ".turned_rad")?.try_into().ok()?,
            forward: table.index("truth.body.vx")?,
        })
    }

    /// `None` where a signal has no value.
    pub fn read(&self, values: &Values, robot: &Robot) -> Option<Skeleton> {
        let [lf, lr, rf, rr] = taken(values, self.joints)?;
        let leg = |side: usize, angles_rad| -> Option<Leg> {
            let [length_m, angle_rad] = taken(values, self.legs[side])?;
            Some(leg(robot, SIDES[side], angles_rad, length_m, angle_rad))
        };
        let legs = [leg(0, [lf, lr])?, leg(1, [rf, rr])?];
        let turned_rad = taken(values, self.turned)?;
        Some(Skeleton {
            place_m: taken(values, self.place)?,
            q_wxyz: taken(values, self.attitude)?,
            pitch_rad: values[self.pitch]?,
            wheels_rad: std::array::from_fn(|side| {
                turned_rad[side] + legs[side].carrier_rad(robot.wheels.carrier)
            }),
            forward_mps: values[self.forward]?,
            legs,
        })
    }
}

fn taken<const N: usize>(values: &Values, places: [usize; N]) -> Option<[f64; N]> {
    let taken = places.map(|place| values[place]);
    let whole = taken.iter().all(|value| value.is_some_and(f64::is_finite));
    whole.then(|| taken.map(Option::unwrap_or_default))
}

/// The leg at `side` from the angles of its front and rear joint, and its length and angle.
fn leg(robot: &Robot, side: f64, [front, rear]: [f64; 2], length_m: f64, angle_rad: f64) -> Leg {
    let y = side * robot.legs.plane_y_m;
    let half = robot.legs.hip_gap_m / 2.0;
    let thigh_m = robot.legs.thigh.length_m;
    Leg {
        hips: [[half, y, 0.0], [-half, y, 0.0]],
        knees: [
            [half + thigh_m * front.cos(), y, thigh_m * front.sin()],
            [-half - thigh_m * rear.cos(), y, -thigh_m * rear.sin()],
        ],
        axle: [length_m * angle_rad.sin(), y, -length_m * angle_rad.cos()],
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use robot_plant::world::{PlantKind, Start, World, WorldConfig};
    use std::sync::Arc;

    /// Signals of a robot that rests as it starts, and its file.
    pub(crate) fn at_rest(start: Start) -> (SignalTable, Values, Arc<Robot>) {
        let config = WorldConfig {
            plant: PlantKind::Free,
            start,
            ..WorldConfig::default()
        };
        let robot = Arc::clone(&config.robot);
        let world = World::new(config).expect("no recording to load");
        let table = SignalTable::new(world.signal_names(), &[], &[]);
        let mut values = Vec::new();
        world.sample(&mut values);
        (table, values.into_iter().map(Some).collect(), robot)
    }

    #[test]
    fn both_shanks_meet_at_the_axle_and_wheels_rest_on_the_ground() {
        for start in [Start::Sitting, Start::Standing] {
            let (table, values, robot) = at_rest(start);
            let signals = SkeletonSignals::find(&table).expect("it is free");
            let skeleton = signals.read(&values, &robot).expect("all have values");
            for side in 0..SIDES.len() {
                let leg = &skeleton.legs[side];
                for knee in leg.knees {
                    let off: Vector = std::array::from_fn(|axis| leg.axle[axis] - knee[axis]);
                    let length_m = off.iter().map(|part| part * part).sum::<f64>().sqrt();
                    let shank_m = robot.legs.shank.length_m;
                    assert!((length_m - shank_m).abs() < 1e-9, "{start:?}: {length_m} m");
                }
                let [.., z] = skeleton.in_world(skeleton.wheel(side, &robot));
                // A tyre gives up to 0.8 mm.
                let sunk_m = robot.wheels.radius_m - z;
                assert!((-1e-6..1e-3).contains(&sunk_m), "{start:?}: {sunk_m} m");
            }
        }
    }
}
