//! The five-bar leg in its plane: where its links are while the leg turns at constant length.

use nalgebra::Vector2;
use robot_description::Legs;

/// A quantity and its first and second derivative by the leg's angle β, at constant leg length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Along<T> {
    pub value: T,
    pub first: T,
    pub second: T,
}

/// One of the four links.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkPose {
    /// Centre of mass from the hip centre in body axes (forward, up), m.
    pub centre_m: Along<Vector2<f64>>,
    /// Angle from forward towards up, rad: it grows against the pitch.
    pub angle_rad: Along<f64>,
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
    let axle = length_m * Vector2::new(angle_rad.sin(), -angle_rad.cos());
    let axle_turned = length_m * Vector2::new(angle_rad.cos(), angle_rad.sin());

    let to_axle = axle - hip;
    let distance_m = to_axle.norm();
    let cos_at_hip = (thigh_m * thigh_m + distance_m * distance_m - shank_m * shank_m)
        / (2.0 * thigh_m * distance_m);
    if !(-1.0..1.0).contains(&cos_at_hip) {
        return None;
    }
    let thigh = to_axle.y.atan2(to_axle.x) + outward * cos_at_hip.acos();
    let knee = hip + thigh_m * along(thigh);
    let to_axle = axle - knee;
    let shank = to_axle.y.atan2(to_axle.x);

    // hip + thigh + shank = axle, derived once and twice by the leg's angle; each link's rate is the part across the other.
    let rates = |across: Vector2<f64>| {
        let open = (shank - thigh).sin();
        (
            across.dot(&along(shank)) / (thigh_m * open),
            -across.dot(&along(thigh)) / (shank_m * open),
        )
    };
    let (thigh_first, shank_first) = rates(axle_turned);
    let (thigh_second, shank_second) = rates(
        -axle
            + thigh_m * thigh_first.powi(2) * along(thigh)
            + shank_m * shank_first.powi(2) * along(shank),
    );
    let thigh = Along {
        value: thigh,
        first: thigh_first,
        second: thigh_second,
    };
    let shank = Along {
        value: shank,
        first: shank_first,
        second: shank_second,
    };
    let knee = end_of(fixed(hip), thigh_m, thigh);
    Some((
        LinkPose {
            centre_m: end_of(fixed(hip), legs.thigh.com_m, thigh),
            angle_rad: thigh,
            mass_kg: legs.thigh.mass_kg,
            inertia_kgm2: legs.thigh.inertia_kgm2,
        },
        LinkPose {
            centre_m: end_of(knee, legs.shank.com_m, shank),
            angle_rad: shank,
            mass_kg: legs.shank.mass_kg,
            inertia_kgm2: legs.shank.inertia_kgm2,
        },
    ))
}

fn along(angle_rad: f64) -> Vector2<f64> {
    Vector2::new(angle_rad.cos(), angle_rad.sin())
}

fn fixed(value: Vector2<f64>) -> Along<Vector2<f64>> {
    Along {
        value,
        first: Vector2::zeros(),
        second: Vector2::zeros(),
    }
}

/// Returns the point at `length_m` from `start` in the direction `angle_rad`.
fn end_of(start: Along<Vector2<f64>>, length_m: f64, angle: Along<f64>) -> Along<Vector2<f64>> {
    let direction = along(angle.value);
    let normal = Vector2::new(-direction.y, direction.x);
    Along {
        value: start.value + length_m * direction,
        first: start.first + length_m * angle.first * normal,
        second: start.second
            + length_m * (angle.second * normal - angle.first * angle.first * direction),
    }
}
