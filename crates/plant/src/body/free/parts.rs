//! The moving parts of one leg at one pose, lifted from the leg's plane into body axes.

use super::{
    Vec2, Vec3,
    five_bar::{HIPS, Linkage},
    model::{Model, Rod},
};

/// Two thighs, two shanks, the wheel's motor, the wheel.
pub(super) const PARTS: usize = 6;
/// Coordinates of a leg: front hip, rear hip, wheel.
pub(super) const LEG_COORDINATES: usize = 3;
const SHANKS: usize = 2;
const MOTOR: usize = 4;
const WHEEL: usize = 5;

/// One part: where it is, and how it moves with the leg's coordinates against the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub mass_kg: f64,
    /// Its centre of mass, in body axes.
    pub place: Vec3,
    /// Derivative of the place by both hips: in x and z only.
    pub slope: [Vec2; HIPS],
    /// Turn about +y per unit of each coordinate.
    pub turn: [f64; LEG_COORDINATES],
    /// About its centre of mass.
    pub inertia: PlanarInertia,
}

/// Inertia of what is its own mirror image in the leg's plane: y is a principal axis. In body axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanarInertia {
    pub xx: f64,
    pub yy: f64,
    pub zz: f64,
    pub xz: f64,
}

impl PlanarInertia {
    const ZERO: Self = Self {
        xx: 0.0,
        yy: 0.0,
        zz: 0.0,
        xz: 0.0,
    };

    /// A rod has its inertia about all axes across it, and none about itself.
    fn of_rod(rod: Rod, along: Vec2) -> Self {
        Self {
            xx: rod.inertia_kgm2 * along.y * along.y,
            yy: rod.inertia_kgm2,
            zz: rod.inertia_kgm2 * along.x * along.x,
            xz: -rod.inertia_kgm2 * along.x * along.y,
        }
    }

    pub fn times(&self, v: Vec3) -> Vec3 {
        Vec3::new(
            self.xx * v.x + self.xz * v.z,
            self.yy * v.y,
            self.xz * v.x + self.zz * v.z,
        )
    }
}

/// A leg at one pose.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    pub linkage: Linkage,
    pub parts: [Part; PARTS],
}

/// Accelerations of a part against the body at constant speeds of hips and wheel.
#[derive(Clone, Copy, Debug)]
pub(super) struct PartCentripetal {
    pub place: Vec2,
    /// About +y.
    pub turn: f64,
}

/// A vector of the leg's plane, in body axes.
pub(super) fn lift(v: Vec2) -> Vec3 {
    Vec3::new(v.x, 0.0, v.y)
}

impl Leg {
    pub fn at(model: &Model, side: usize, hip_rad: [f64; HIPS]) -> Self {
        let linkage = model.bar.at(hip_rad);
        let y = model.plane_y[side];
        let own = |hip: usize, value: Vec2| {
            let mut slope = [Vec2::zeros(); HIPS];
            slope[hip] = value;
            slope
        };
        let thigh = |hip: usize| {
            let rod = model.thigh;
            let start = linkage.knee[hip] - linkage.thigh[hip] * model.bar.thigh_m;
            let mut turn = [0.0; LEG_COORDINATES];
            turn[hip] = -1.0;
            Part {
                mass_kg: rod.mass_kg,
                place: Vec3::new(0.0, y, 0.0) + lift(start + linkage.thigh[hip] * rod.com_m),
                slope: own(
                    hip,
                    linkage.knee_slope[hip] * (rod.com_m / model.bar.thigh_m),
                ),
                turn,
                inertia: PlanarInertia::of_rod(rod, linkage.thigh[hip]),
            }
        };
        let shank_turn = |hip: usize| linkage.shank_slope[hip].map(|it| -it);
        let shank = |hip: usize| {
            let rod = model.shank;
            let share = rod.com_m / model.bar.shank_m;
            let [front, rear] = shank_turn(hip);
            let knee = own(hip, linkage.knee_slope[hip]);
            Part {
                mass_kg: rod.mass_kg,
                place: Vec3::new(0.0, y, 0.0)
                    + lift(linkage.knee[hip] * (1.0 - share) + linkage.axle * share),
                slope: std::array::from_fn(|h| {
                    knee[h] * (1.0 - share) + linkage.axle_slope[h] * share
                }),
                turn: [front, rear, 0.0],
                inertia: PlanarInertia::of_rod(rod, linkage.shank[hip]),
            }
        };
        let [front, rear] = shank_turn(model.carrier);
        let motor = Part {
            mass_kg: model.motor_kg,
            place: Vec3::new(0.0, y, 0.0) + lift(linkage.axle),
            slope: linkage.axle_slope,
            turn: [front, rear, 0.0],
            inertia: PlanarInertia::ZERO,
        };
        let disc = model.disc;
        let wheel = Part {
            mass_kg: disc.mass_kg,
            place: Vec3::new(0.0, model.wheel_y[side], 0.0) + lift(linkage.axle),
            turn: [front, rear, 1.0],
            inertia: PlanarInertia {
                xx: disc.tilt_kgm2,
                yy: disc.spin_kgm2,
                zz: disc.tilt_kgm2,
                xz: 0.0,
            },
            ..motor
        };
        Self {
            linkage,
            parts: [thigh(0), thigh(1), shank(0), shank(1), motor, wheel],
        }
    }

    pub fn wheel(&self) -> &Part {
        &self.parts[WHEEL]
    }

    pub fn centripetal(&self, model: &Model, hip_rps: [f64; HIPS]) -> [PartCentripetal; PARTS] {
        let terms = self.linkage.centripetal(hip_rps);
        std::array::from_fn(|index| match index {
            0..SHANKS => PartCentripetal {
                place: terms.knee[index] * (model.thigh.com_m / model.bar.thigh_m),
                turn: 0.0,
            },
            SHANKS..MOTOR => {
                let hip = index - SHANKS;
                let share = model.shank.com_m / model.bar.shank_m;
                PartCentripetal {
                    place: terms.knee[hip] * (1.0 - share) + terms.axle * share,
                    turn: -terms.shank[hip],
                }
            }
            _ => PartCentripetal {
                place: terms.axle,
                turn: -terms.shank[model.carrier],
            },
        })
    }
}

impl Part {
    /// Speed of its place against the body.
    pub fn velocity(&self, leg_rps: [f64; LEG_COORDINATES]) -> Vec3 {
        lift(self.slope[0] * leg_rps[0] + self.slope[1] * leg_rps[1])
    }

    /// Its turn about +y against the body.
    pub fn turn_rps(&self, leg_rps: [f64; LEG_COORDINATES]) -> f64 {
        self.turn[0] * leg_rps[0] + self.turn[1] * leg_rps[1] + self.turn[2] * leg_rps[2]
    }
}
