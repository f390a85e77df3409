//! The surface of a course: flat faces one after the other along x, each as wide as its side of the world.

use super::{Terrain, Vec2, Vec3};

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

/// A side of the world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Side {
    /// Where y > 0.
    #[default]
    Left,
    Right,
}

impl Side {
    pub fn at(y_m: f64) -> Self {
        if y_m > 0.0 { Self::Left } else { Self::Right }
    }
}

/// Both sides of the world, and where it is slippery.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    /// Left, right.
    sides: [Profile; 2],
    /// From, to, factor on friction.
    strip: Option<(f64, f64, f64)>,
    highest_m: f64,
}

impl Ground {
    pub fn new(terrain: &Terrain) -> Self {
        let sides = terrain.corners().map(|corners| {
            let corners: Vec<Vec2> = corners.into_iter().map(Vec2::from).collect();
            Profile::through(&corners)
        });
        let strip = match *terrain {
            Terrain::Slippery {
                start_m,
                length_m,
                grip,
            } => Some((start_m, start_m + length_m, grip)),
            _ => None,
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

    pub fn profile(&self, side: Side) -> &Profile {
        let [left, right] = &self.sides;
        match side {
            Side::Left => left,
            Side::Right => right,
        }
    }

    /// Factor on the friction at a place.
    pub fn grip(&self, x_m: f64) -> f64 {
        match self.strip {
            Some((from, to, grip)) if (from..to).contains(&x_m) => grip,
            _ => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn depth(terrain: &Terrain, x: f64, y: f64, z: f64) -> Option<(Vec3, f64)> {
        Ground::new(terrain)
            .profile(Side::at(y))
            .depth_of(Vec3::new(x, y, z))
    }

    #[test]
    fn level_ground_is_at_zero() {
        let (normal, depth_m) = depth(&Terrain::Flat, 3.0, 0.0, -0.01).unwrap_or_default();
        assert_eq!((normal, depth_m), (Vec3::z(), 0.01));
        assert_eq!(depth(&Terrain::Flat, 3.0, 0.0, 0.01), None);
    }

    #[test]
    fn a_point_in_a_step_leaves_it_by_the_nearest_face() {
        let step = Terrain::Step {
            at_m: 1.0,
            height_m: 0.1,
        };
        let (normal, depth_m) = depth(&step, 1.01, 0.0, 0.05).unwrap_or_default();
        assert!((normal + Vec3::x()).norm() < 1e-12 && (depth_m - 0.01).abs() < 1e-12);
        let (normal, depth_m) = depth(&step, 1.2, 0.0, 0.09).unwrap_or_default();
        assert!((normal - Vec3::z()).norm() < 1e-12 && (depth_m - 0.01).abs() < 1e-12);
        assert_eq!(depth(&step, 0.99, 0.0, 0.05), None);
    }

    #[test]
    fn a_slope_rises_at_its_angle() {
        let slope = Terrain::Slope {
            start_m: 1.0,
            angle_rad: 0.25,
            length_m: 2.0,
        };
        let (normal, depth_m) = depth(&slope, 2.0, 0.0, 0.0).unwrap_or_default();
        assert!((normal - Vec3::new(-0.25_f64.sin(), 0.0, 0.25_f64.cos())).norm() < 1e-12);
        assert!((depth_m - 0.25_f64.sin()).abs() < 1e-12);
    }

    #[test]
    fn one_ramp_is_on_the_left_only() {
        let ramp = Terrain::OneSidedRamp {
            start_m: 0.0,
            angle_rad: 0.1,
            height_m: 0.05,
            top_m: 1.0,
        };
        assert!(depth(&ramp, 1.0, 0.2, 0.04).is_some());
        assert!(depth(&ramp, 1.0, -0.2, 0.04).is_none());
        assert!(depth(&ramp, 3.0, 0.2, 0.04).is_none());
    }

    #[test]
    fn plates_differ_left_and_right_and_stay_within_their_height() {
        let plates = |seed| Terrain::Plates {
            start_m: 0.0,
            count: 10,
            length_m: 0.3,
            height_m: 0.02,
            tilt_rad: 0.05,
            seed,
        };
        let ground = Ground::new(&plates(1));
        // 20 mm, and half a plate at 0.05 rad.
        assert!((0.002..0.0276).contains(&ground.highest_m()));
        let heights = |terrain: &Terrain, y: f64| -> Vec<_> {
            let below = |plate: u8| depth(terrain, 0.15 + 0.3 * f64::from(plate), y, -0.1);
            (0..10).map(|plate| below(plate).map(|it| it.1)).collect()
        };
        assert_ne!(heights(&plates(1), 0.2), heights(&plates(1), -0.2));
        assert_ne!(heights(&plates(1), 0.2), heights(&plates(2), 0.2));
        assert_eq!(heights(&plates(1), 0.2), heights(&plates(1), 0.2));
    }

    #[test]
    fn a_strip_is_slippery() {
        let ground = Ground::new(&Terrain::Slippery {
            start_m: 1.0,
            length_m: 0.5,
            grip: 0.1,
        });
        assert_eq!([0.9, 1.2, 1.6].map(|x| ground.grip(x)), [1.0, 0.1, 1.0]);
    }
}
