//! Rotations in double precision.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::Vector;

/// A rotation that turns body vectors into the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation(UnitQuaternion<f64>);

impl Default for Rotation {
    /// No rotation.
    fn default() -> Self {
        Self(UnitQuaternion::identity())
    }
}

impl Rotation {
    /// By the length of `vector_rad` about its direction: the exponential map.
    pub fn by(vector_rad: Vector) -> Self {
        Self(UnitQuaternion::from_scaled_axis(Vector3::from(vector_rad)))
    }

    /// As [`by`](Self::by), in degrees.
    pub fn by_deg(vector_deg: Vector) -> Self {
        Self::by(vector_deg.map(f64::to_radians))
    }

    /// From a quaternion, scalar first, of any length but zero.
    pub fn from_wxyz([w, x, y, z]: [f64; 4]) -> Self {
        Self(UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)))
    }

    /// The unit quaternion, scalar first.
    pub fn to_wxyz(self) -> [f64; 4] {
        let [x, y, z, w] = self.0.into_inner().coords.into();
        [w, x, y, z]
    }

    /// Rows of the matrix that turns body vectors into the world.
    pub fn rows(self) -> [Vector; 3] {
        self.0.to_rotation_matrix().into_inner().transpose().data.0
    }

    /// This rotation, then `next` about axes that have turned with the body.
    pub fn then_in_body(self, next: Self) -> Self {
        Self(UnitQuaternion::new_normalize(
            (self.0 * next.0).into_inner(),
        ))
    }

    /// The rotation that undoes this one.
    pub fn inverse(self) -> Self {
        Self(self.0.inverse())
    }

    /// A body vector as seen from the world.
    pub fn turn(self, vector: Vector) -> Vector {
        (self.0 * Vector3::from(vector)).into()
    }

    /// A world vector as seen from the body.
    pub fn seen_from_body(self, vector: Vector) -> Vector {
        self.inverse().turn(vector)
    }

    /// The rotation vector that turns the world so that `self` becomes `other`, at most half a turn, rad.
    pub fn to(self, other: Self) -> Vector {
        (other.0 * self.0.inverse()).scaled_axis().into()
    }

    /// Angle of the rotation, 0 … 180°.
    pub fn angle_deg(self) -> f64 {
        let [w, x, y, z] = self.to_wxyz();
        // The arc tangent keeps its precision near zero.
        2.0 * x.hypot(y).hypot(z).atan2(w.abs()).to_degrees()
    }

    /// Angle between both rotations, 0 … 180°.
    pub fn angle_to_deg(self, other: Self) -> f64 {
        other.then_in_body(self.inverse()).angle_deg()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: Vector, expected: Vector) {
        for (got, expected) in got.iter().zip(expected) {
            assert!((got - expected).abs() < 1e-12, "{got} against {expected}");
        }
    }

    #[test]
    fn a_body_that_faces_north_has_its_nose_there() {
        let facing_north = Rotation::by_deg([0.0, 0.0, 90.0]);
        close(facing_north.turn([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        close(
            facing_north.seen_from_body([0.0, 1.0, 0.0]),
            [1.0, 0.0, 0.0],
        );
        close(facing_north.rows()[0], [0.0, -1.0, 0.0]);
        let [w, _, _, z] = facing_north.to_wxyz();
        assert!((w - z).abs() < 1e-15 && w > 0.0);
    }

    #[test]
    fn the_next_turn_is_about_the_turned_axes() {
        let nose_down = Rotation::by_deg([0.0, 90.0, 0.0]);
        let rolled = nose_down.then_in_body(Rotation::by_deg([90.0, 0.0, 0.0]));
        // The nose still points down, the left side to where the top was: east.
        close(rolled.turn([1.0, 0.0, 0.0]), [0.0, 0.0, -1.0]);
        close(rolled.turn([0.0, 1.0, 0.0]), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn the_way_from_one_to_another_is_seen_from_the_world() {
        let from = Rotation::by_deg([10.0, 20.0, 30.0]);
        let way = [0.1, -0.2, 0.05];
        close(from.to(Rotation::by(way).then_in_body(from)), way);
        let tiny = Rotation::by([0.0, 1e-9, 0.0]).then_in_body(from);
        assert!((from.angle_to_deg(tiny).to_radians() - 1e-9).abs() < 1e-15);
    }
}
