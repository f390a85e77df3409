//! Rotations in double precision, as matrices.

use crate::math::Quaternion;

/// Rows of the matrix that turns body vectors into the world.
#[derive(Clone, Copy, Debug)]
pub struct Rotation {
    pub rows: [[f64; 3]; 3],
}

impl Rotation {
    /// By the vector `angle_rad`, axis times angle (Rodrigues' formula).
    pub fn by(angle_rad: [f64; 3]) -> Self {
        let angle = dot(angle_rad, angle_rad).sqrt();
        let (sin, cos) = if angle < 1e-9 {
            (1.0, 0.5)
        } else {
            (angle.sin() / angle, (1.0 - angle.cos()) / (angle * angle))
        };
        let turned = |unit: [f64; 3]| {
            let once = cross(angle_rad, unit);
            let twice = cross(angle_rad, once);
            std::array::from_fn(|axis| unit[axis] + sin * once[axis] + cos * twice[axis])
        };
        let columns = Self {
            rows: [
                turned([1.0, 0.0, 0.0]),
                turned([0.0, 1.0, 0.0]),
                turned([0.0, 0.0, 1.0]),
            ],
        };
        columns.inverse()
    }

    pub fn of(attitude: Quaternion) -> Self {
        let [w, x, y, z] = attitude.to_wxyz().map(f64::from);
        let length2 = w * w + x * x + y * y + z * z;
        let turned = |[a, b, c]: [f64; 3]| {
            // v + 2w(u × v) + 2u × (u × v), u of length √(length2).
            let once = cross([x, y, z], [a, b, c]);
            let twice = cross([x, y, z], once);
            std::array::from_fn(|axis| {
                [a, b, c][axis] + 2.0 * (w * once[axis] + twice[axis]) / length2
            })
        };
        let columns = Self {
            rows: [
                turned([1.0, 0.0, 0.0]),
                turned([0.0, 1.0, 0.0]),
                turned([0.0, 0.0, 1.0]),
            ],
        };
        columns.inverse()
    }

    pub fn inverse(self) -> Self {
        let [[a, b, c], [d, e, f], [g, h, i]] = self.rows;
        Self {
            rows: [[a, d, g], [b, e, h], [c, f, i]],
        }
    }

    /// A turn in the body after this one: self · next.
    pub fn then_in_body(self, next: Self) -> Self {
        let columns = next.inverse().rows;
        Self {
            rows: self.rows.map(|row| columns.map(|column| dot(row, column))),
        }
    }

    pub fn apply(self, v: [f64; 3]) -> [f64; 3] {
        self.rows.map(|row| dot(row, v))
    }

    /// A world vector as seen from the body.
    pub fn seen_from_body(self, v: [f64; 3]) -> [f64; 3] {
        self.inverse().apply(v)
    }

    /// What must turn the world so that `self` becomes `other`: axis times angle, below half a turn.
    pub fn to(self, other: Self) -> [f64; 3] {
        let [[_, xy, xz], [yx, _, yz], [zx, zy, _]] = other.then_in_body(self.inverse()).rows;
        let sines = [(zy - yz) / 2.0, (xz - zx) / 2.0, (yx - xy) / 2.0];
        let sine = dot(sines, sines).sqrt();
        let cosine = other.alike(self);
        let factor = if sine < 1e-12 {
            1.0
        } else {
            sine.atan2(cosine) / sine
        };
        sines.map(|part| part * factor)
    }

    /// Cosine of the angle between both.
    fn alike(self, other: Self) -> f64 {
        let sum: f64 = (0..3).map(|i| dot(self.rows[i], other.rows[i])).sum();
        (sum - 1.0) / 2.0
    }

    /// Angle between both.
    pub fn angle_deg(self, other: Self) -> f64 {
        let turn = self.to(other);
        dot(turn, turn).sqrt().to_degrees()
    }
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross([ax, ay, az]: [f64; 3], [bx, by, bz]: [f64; 3]) -> [f64; 3] {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}
