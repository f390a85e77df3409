//! The five-bar leg in its plane: where its links are, and how they move with the leg's angle and length.

use nalgebra::Vector2;
use robot_description::{Legs, Link};

/// A quantity with its derivatives by the leg's angle β and its length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape<T> {
    pub value: T,
    pub by: [T; 2],
    pub by_two: [[T; 2]; 2],
}

/// One of the four links.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkPose {
    /// Centre of mass from the hip centre in body axes (forward, up), m.
    pub centre_m: Shape<Vector2<f64>>,
    /// Angle from forward towards up, rad: it grows against the pitch.
    pub angle_rad: Shape<f64>,
    pub mass_kg: f64,
    pub inertia_kgm2: f64,
}

/// Two thighs and two shanks; front before rear.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LegPose {
    pub thighs: [LinkPose; 2],
    pub shanks: [LinkPose; 2],
}

impl LegPose {
    /// Returns the leg with this length and angle, or `None` where the links do not reach.
    pub fn new(legs: &Legs, length_m: f64, angle_rad: f64) -> Option<Self> {
        let front = side(legs, length_m, angle_rad, 1.0)?;
        let rear = side(legs, length_m, angle_rad, -1.0)?;
        Some(Self {
            thighs: [front.0, rear.0],
            shanks: [front.1, rear.1],
        })
    }

    pub fn links(&self) -> impl Iterator<Item = &LinkPose> {
        self.thighs.iter().chain(&self.shanks)
    }
}

/// Returns the thigh and the shank of one side: `outward` is 1 at the front and −1 at the rear.
fn side(legs: &Legs, length_m: f64, angle_rad: f64, outward: f64) -> Option<(LinkPose, LinkPose)> {
    let (thigh_m, shank_m) = (legs.thigh.length_m, legs.shank.length_m);
    let hip = Vector2::new(outward * legs.hip_gap_m / 2.0, 0.0);
    let axle = axle(length_m, angle_rad);

    let to_axle = axle.value - hip;
    let distance_m = to_axle.norm();
    let cos_at_hip = (thigh_m * thigh_m + distance_m * distance_m - shank_m * shank_m)
        / (2.0 * thigh_m * distance_m);
    if !(-1.0..1.0).contains(&cos_at_hip) {
        return None;
    }
    let thigh = direction_of(to_axle) + outward * cos_at_hip.acos();
    let shank = direction_of(to_axle - thigh_m * along(thigh));

    // hip + thigh + shank = axle, derived once and twice; a link's rate is the part of the axle's motion across the other.
    let open = (shank - thigh).sin();
    let rates = |motion: Vector2<f64>| {
        [
            motion.dot(&along(shank)) / (thigh_m * open),
            -motion.dot(&along(thigh)) / (shank_m * open),
        ]
    };
    let first = axle.by.map(rates);
    let second = [0, 1].map(|i| {
        [0, 1].map(|j| {
            let thigh_m = thigh_m * first[i][0] * first[j][0];
            let shank_m = shank_m * first[i][1] * first[j][1];
            rates(axle.by_two[i][j] + thigh_m * along(thigh) + shank_m * along(shank))
        })
    });
    let angle = |value: f64, link: usize| Shape {
        value,
        by: first.map(|rates| rates[link]),
        by_two: second.map(|row| row.map(|rates| rates[link])),
    };
    let (thigh, shank) = (angle(thigh, 0), angle(shank, 1));
    let hip = Shape {
        value: hip,
        by: [Vector2::zeros(); 2],
        by_two: [[Vector2::zeros(); 2]; 2],
    };
    let knee = end_of(&hip, thigh_m, &thigh);
    let link = |start: &Shape<Vector2<f64>>, angle: Shape<f64>, link: &Link| LinkPose {
        centre_m: end_of(start, link.com_m, &angle),
        angle_rad: angle,
        mass_kg: link.mass_kg,
        inertia_kgm2: link.inertia_kgm2,
    };
    Some((
        link(&hip, thigh, &legs.thigh),
        link(&knee, shank, &legs.shank),
    ))
}

/// Returns the axle's place from the hip centre in body axes.
fn axle(length_m: f64, angle_rad: f64) -> Shape<Vector2<f64>> {
    let down = Vector2::new(angle_rad.sin(), -angle_rad.cos());
    let across = Vector2::new(angle_rad.cos(), angle_rad.sin());
    Shape {
        value: length_m * down,
        by: [length_m * across, down],
        by_two: [[-length_m * down, across], [across, Vector2::zeros()]],
    }
}

fn along(angle_rad: f64) -> Vector2<f64> {
    Vector2::new(angle_rad.cos(), angle_rad.sin())
}

fn direction_of(vector: Vector2<f64>) -> f64 {
    vector.y.atan2(vector.x)
}

/// Returns the point at `length_m` from `start` in the direction `angle`.
fn end_of(start: &Shape<Vector2<f64>>, length_m: f64, angle: &Shape<f64>) -> Shape<Vector2<f64>> {
    let direction = length_m * along(angle.value);
    let normal = Vector2::new(-direction.y, direction.x);
    Shape {
        value: start.value + direction,
        by: [0, 1].map(|i| start.by[i] + angle.by[i] * normal),
        by_two: [0, 1].map(|i| {
            [0, 1].map(|j| {
                let turns = angle.by[i] * angle.by[j];
                start.by_two[i][j] + angle.by_two[i][j] * normal - turns * direction
            })
        }),
    }
}
