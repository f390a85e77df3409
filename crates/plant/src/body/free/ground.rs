//! The surface of a course: flat faces one after the other along x, each as wide as its side of the world.

use super::{Terrain, Vec2, Vec3};
use crate::random::{Random, Stream};

/// Ends of the world along x.
const FAR_M: f64 = 1e4;

/// A straight piece of a profile, in x and z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub from: Vec2,
    pub length_m: f64,
    /// Unit vector from its start to its end.
    pub along: Vec2,
}

impl Face {
    fn between(from: Vec2, to: Vec2) -> Self {
        let length_m = (to - from).norm();
        Self {
            from,
            length_m,
            along: (to - from) / length_m,
        }
    }

    /// Unit vector out of the ground, in x and z.
    pub fn normal(&self) -> Vec2 {
        Vec2::new(-self.along.y, self.along.x)
    }

    pub fn end(&self) -> Vec2 {
        self.from + self.along * self.length_m
    }

    /// Whether the point of the face nearest to a place of the same plane lies between its ends.
    pub fn faces(&self, place: Vec2) -> bool {
        (0.0..self.length_m).contains(&(place - self.from).dot(&self.along))
    }
}

/// Faces in the order of x. Neighbours share an end, so that vertical faces make steps.
#[derive(Clone, Debug)]
pub(super) struct Profile(Vec<Face>);

impl Profile {
    /// Through the given corners, level before the first and behind the last.
    fn through(corners: &[Vec2]) -> Self {
        let (first, last) = match corners {
            [first, .., last] => (*first, *last),
            [only] => (*only, *only),
            [] => (Vec2::zeros(), Vec2::zeros()),
        };
        let mut points = vec![Vec2::new(-FAR_M, first.y)];
        points.extend_from_slice(corners);
        points.push(Vec2::new(FAR_M, last.y));
        let faces = points.windows(2).filter_map(|pair| match pair {
            [from, to] if from != to => Some(Face::between(*from, *to)),
            _ => None,
        });
        Self(faces.collect())
    }

    /// The faces within a distance along x, each with its number.
    pub fn near(&self, x_m: f64, reach_m: f64) -> impl Iterator<Item = (usize, &Face)> {
        let first = self.0.partition_point(|face| face.end().x < x_m - reach_m);
        self.0
            .iter()
            .enumerate()
            .skip(first)
            .take_while(move |(_, face)| face.from.x <= x_m + reach_m)
    }

    pub fn after(&self, number: usize) -> Option<&Face> {
        self.0.get(number + 1)
    }

    /// Normal and depth of a point below the surface; `None` above it.
    pub fn depth_of(&self, point: Vec3) -> Option<(Vec3, f64)> {
        let place = Vec2::new(point.x, point.z);
        let level = |face: &Face| face.along.x > 1e-6;
        let under = self.0.partition_point(|face| face.end().x <= point.x);
        let under = self.0.iter().skip(under).find(|face| level(face))?;
        let depth_m = (under.from - place).dot(&under.normal());
        if depth_m <= 0.0 {
            return None;
        }
        let mut nearest = (under.normal(), depth_m);
        for (_, face) in self.near(point.x, depth_m) {
            let depth_m = (face.from - place).dot(&face.normal());
            if depth_m > 0.0 && depth_m < nearest.1 && face.faces(place) {
                nearest = (face.normal(), depth_m);
            }
        }
        let (normal, depth_m) = nearest;
        Some((Vec3::new(normal.x, 0.0, normal.y), depth_m))
    }
}

/// Both sides of the world, and where it is slippery.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    /// Where y > 0, where not.
    sides: [Profile; 2],
    /// From, to, factor on friction.
    strip: Option<(f64, f64, f64)>,
    highest_m: f64,
}

impl Ground {
    pub fn new(terrain: &Terrain) -> Self {
        let both = |corners: &[Vec2]| {
            let profile = Profile::through(corners);
            [profile.clone(), profile]
        };
        let mut strip = None;
        let sides = match *terrain {
            Terrain::Flat => both(&[]),
            Terrain::Slope {
                start_m,
                angle_rad,
                length_m,
            } => {
                let length_m = length_m.clamp(0.01, FAR_M / 2.0);
                let rise_m = length_m * angle_rad.clamp(-1.05, 1.05).tan();
                both(&[
                    Vec2::new(start_m, 0.0),
                    Vec2::new(start_m + length_m, rise_m),
                ])
            }
            Terrain::OneSidedRamp {
                start_m,
                angle_rad,
                height_m,
                top_m,
            } => {
                let run_m = height_m.abs() / angle_rad.clamp(0.01, 1.05).tan();
                let at = |x: f64, z: f64| Vec2::new(start_m + x, z);
                let ramp = [
                    at(0.0, 0.0),
                    at(run_m, height_m),
                    at(run_m + top_m, height_m),
                    at(2.0 * run_m + top_m, 0.0),
                ];
                [Profile::through(&ramp), Profile::through(&[])]
            }
            Terrain::Step { at_m, height_m } => {
                both(&[Vec2::new(at_m, 0.0), Vec2::new(at_m, height_m)])
            }
            Terrain::Gap {
                at_m,
                width_m,
                depth_m,
            } => both(&[
                Vec2::new(at_m, 0.0),
                Vec2::new(at_m, -depth_m),
                Vec2::new(at_m + width_m, -depth_m),
                Vec2::new(at_m + width_m, 0.0),
            ]),
            Terrain::Plates {
                start_m,
                count,
                length_m,
                height_m,
                tilt_rad,
                seed,
            } => {
                let mut random = Random::new(seed, Stream::Plates);
                let mut side = || {
                    let mut corners = vec![Vec2::new(start_m, 0.0)];
                    for plate in 0..count.min(64) {
                        let middle_m = height_m * random.unit();
                        let tilt_rad = random.symmetric(tilt_rad);
                        let rise_m = length_m / 2.0 * tilt_rad.clamp(-1.0, 1.0).tan();
                        let from_m = start_m + f64::from(plate) * length_m;
                        // No plate digs into the ground.
                        let edge = |z: f64| (middle_m + z).max(0.0);
                        corners.push(Vec2::new(from_m, edge(-rise_m)));
                        corners.push(Vec2::new(from_m + length_m, edge(rise_m)));
                    }
                    corners.push(Vec2::new(
                        start_m + f64::from(count.min(64)) * length_m,
                        0.0,
                    ));
                    Profile::through(&corners)
                };
                [side(), side()]
            }
            Terrain::Slippery {
                start_m,
                length_m,
                grip,
            } => {
                strip = Some((start_m, start_m + length_m, grip));
                both(&[])
            }
        };
        let ends = sides
            .iter()
            .flat_map(|side| side.0.iter().map(|face| face.end().y));
        Self {
            highest_m: ends.fold(0.0, f64::max),
            sides,
            strip,
        }
    }

    pub fn highest_m(&self) -> f64 {
        self.highest_m
    }

    pub fn profile(&self, y_m: f64) -> &Profile {
        let [left, right] = &self.sides;
        if y_m > 0.0 { left } else { right }
    }

    /// Factor on the friction at a place.
    pub fn grip(&self, x_m: f64) -> f64 {
        match self.strip {
            Some((from, to, grip)) if (from..to).contains(&x_m) => grip,
            _ => 1.0,
        }
    }
}
