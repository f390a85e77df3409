//! Where a wheel's round tyre touches the ground.

use super::{
    Vec2, Vec3,
    ground::{Face, Profile},
};

/// Places where one wheel touches: more than two at once count as the deepest two.
pub(super) const TOUCHES: usize = 2;
/// Least share of the axle across the course for which edges are felt.
const LEAST_ACROSS: f64 = 0.2;

/// A wheel as a circle with a tyre of round cross-section around it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    pub centre: Vec3,
    /// Unit vector along the axle, left.
    pub axle: Vec3,
    /// Outer radius.
    pub radius_m: f64,
    /// Radius of the cross-section.
    pub tyre_m: f64,
}

/// A contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Number of the face or edge, the same as long as the wheel is on it.
    pub feature: usize,
    /// On the surface of the ground.
    pub point: Vec3,
    /// Unit vector out of the ground.
    pub normal: Vec3,
    pub depth_m: f64,
}

impl Ring {
    /// Contacts with a profile, the deepest first.
    pub fn touches(&self, profile: &Profile) -> [Option<Touch>; TOUCHES] {
        let mut found = [None; TOUCHES];
        for (number, face) in profile.near(self.centre.x, self.radius_m) {
            keep_deepest(&mut found, self.on_face(2 * number, face));
            if let Some(next) = profile.after(number) {
                keep_deepest(&mut found, self.on_edge(2 * number + 1, face, next));
            }
        }
        found
    }

    fn on_face(&self, feature: usize, face: &Face) -> Option<Touch> {
        let normal = face.normal();
        let normal = Vec3::new(normal.x, 0.0, normal.y);
        let start = Vec3::new(face.from.x, self.centre.y, face.from.y);
        let height_m = (self.centre - start).dot(&normal);
        if height_m > self.radius_m {
            return None;
        }
        let into = self.axle * normal.dot(&self.axle) - normal;
        // A wheel that lies flat touches all around; any place will do.
        let length = into.norm();
        let into = if length > 1e-3 {
            into / length
        } else {
            self.axle.cross(&Vec3::z())
        };
        let lowest = self.centre + into * (self.radius_m - self.tyre_m);
        let depth_m = self.tyre_m - (lowest - start).dot(&normal);
        let within = depth_m > 0.0 && depth_m < self.radius_m;
        (within && face.faces(Vec2::new(lowest.x, lowest.z))).then(|| Touch {
            feature,
            point: lowest - normal * (self.tyre_m - depth_m),
            normal,
            depth_m,
        })
    }

    /// With the edge between two faces, where they make a convex one. The edge meets the wheel's middle plane in a point.
    fn on_edge(&self, feature: usize, face: &Face, next: &Face) -> Option<Touch> {
        let turn = face.along.x * next.along.y - face.along.y * next.along.x;
        if turn >= 0.0 || self.axle.y.abs() < LEAST_ACROSS {
            return None;
        }
        let corner = next.from;
        let to_corner = Vec2::new(corner.x - self.centre.x, corner.y - self.centre.z);
        let across_m = -(to_corner.x * self.axle.x + to_corner.y * self.axle.z) / self.axle.y;
        let from_corner = Vec3::new(-to_corner.x, -across_m, -to_corner.y);
        let distance_m = from_corner.norm();
        let depth_m = self.radius_m - distance_m;
        if depth_m <= 0.0 || distance_m < 1e-6 {
            return None;
        }
        let normal = from_corner / distance_m;
        let in_profile = Vec2::new(normal.x, normal.z);
        let between = in_profile.dot(&face.along) >= 0.0 && in_profile.dot(&next.along) < 0.0;
        between.then(|| Touch {
            feature,
            point: self.centre - from_corner,
            normal,
            depth_m,
        })
    }
}

fn keep_deepest(found: &mut [Option<Touch>; TOUCHES], touch: Option<Touch>) {
    let Some(touch) = touch else { return };
    let depth_m = |slot: &Option<Touch>| slot.map_or(0.0, |it| it.depth_m);
    if touch.depth_m > depth_m(&found[0]) {
        found[1] = found[0];
        found[0] = Some(touch);
    } else if touch.depth_m > depth_m(&found[1]) {
        found[1] = Some(touch);
    }
}
