//! Unit quaternions.

use super::{
    scalar,
    vector::{self, Vector3},
};

/// A unit quaternion w + xi + yj + zk. Its user says which frames it rotates between; most often it is body → world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion {
    pub w: f32,
    pub x: f32,
    pub y: f32,
    pub z: f32,
}

impl Quaternion {
    /// No rotation.
    pub const IDENTITY: Self = Self {
        w: 1.0,
        x: 0.0,
        y: 0.0,
        z: 0.0,
    };

    /// Rotation by the vector `angle_rad`, axis times angle. Computed by series: exact in single precision up to 1 rad,
    /// off by 1e-5 at 2 rad.
    pub fn from_rotation(angle_rad: Vector3) -> Self {
        let half = vector::scale(angle_rad, 0.5);
        let s = vector::dot(half, half);
        // Above 0.2 rad the series needs another term.
        if s > 0.01 {
            return Self::from_large_rotation(half, s);
        }
        let w = 1.0 - s * (1.0 / 2.0 - s * (1.0 / 24.0));
        let sinc = 1.0 - s * (1.0 / 6.0 - s * (1.0 / 120.0));
        let [x, y, z] = vector::scale(half, sinc);
        Self { w, x, y, z }
    }

    #[cold]
    #[inline(never)]
    fn from_large_rotation(half: Vector3, s: f32) -> Self {
        let w = 1.0 - s / 2.0 * (1.0 - s / 12.0 * (1.0 - s / 30.0));
        let sinc = 1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0));
        let [x, y, z] = vector::scale(half, sinc);
        let rotation = Self { w, x, y, z };
        // Above 1 rad the error of the series shows in the length.
        if s > 0.25 {
            rotation.normalised()
        } else {
            rotation
        }
    }

    /// The shortest rotation that turns the unit vector `v` = (x, y, z) to +z.
    pub fn levelling([x, y, z]: Vector3) -> Self {
        let w = scalar::sqrt((z + 1.0) / 2.0);
        if w > 1e-3 {
            Self {
                w,
                x: 0.5 * y / w,
                y: -0.5 * x / w,
                z: 0.0,
            }
            .normalised()
        } else {
            // Upside down: half a turn about any level axis.
            Self {
                w: 0.0,
                x: 1.0,
                y: 0.0,
                z: 0.0,
            }
        }
    }

    /// The quaternion product self · first: the rotation `first`, followed by `self`.
    #[must_use]
    pub fn after(self, first: Self) -> Self {
        let (a, b) = (self, first);
        Self {
            w: a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
            x: a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            y: a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            z: a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
        }
    }

    /// Scales to unit length. Returns the identity for a length of zero.
    #[must_use]
    #[inline(never)]
    pub fn normalised(self) -> Self {
        let squared = self.w * self.w + self.x * self.x + self.y * self.y + self.z * self.z;
        let inverse = scalar::inverse_sqrt(squared);
        if inverse == 0.0 {
            return Self::IDENTITY;
        }
        Self {
            w: self.w * inverse,
            x: self.x * inverse,
            y: self.y * inverse,
            z: self.z * inverse,
        }
    }

    /// The same for a quaternion of almost unit length: one Newton step.
    #[must_use]
    pub fn renormalised(self) -> Self {
        let squared = self.w * self.w + self.x * self.x + self.y * self.y + self.z * self.z;
        let inverse = 1.5 - 0.5 * squared;
        if !(0.999..1.001).contains(&inverse) {
            return self.normalised();
        }
        Self {
            w: self.w * inverse,
            x: self.x * inverse,
            y: self.y * inverse,
            z: self.z * inverse,
        }
    }

    /// The rotation matrix, by rows.
    pub fn rotation_matrix(self) -> [Vector3; 3] {
        let Self { w, x, y, z } = self;
        let (xx, yy, zz) = (2.0 * x * x, 2.0 * y * y, 2.0 * z * z);
        let (xy, xz, yz) = (2.0 * x * y, 2.0 * x * z, 2.0 * y * z);
        let (wx, wy, wz) = (2.0 * w * x, 2.0 * w * y, 2.0 * w * z);
        [
            [1.0 - yy - zz, xy - wz, xz + wy],
            [xy + wz, 1.0 - xx - zz, yz - wx],
            [xz - wy, yz + wx, 1.0 - xx - yy],
        ]
    }

    /// Roll, pitch and yaw in rad: rotations about x, then y, then z of the fixed frame, in ±π, ±π/2 and ±π. Near a
    /// pitch of ±π/2 only the difference of roll and yaw is defined.
    pub fn roll_pitch_yaw(self) -> Vector3 {
        let Self { w, x, y, z } = self;
        let yy = y * y;
        let roll = scalar::atan2(w * x + y * z, 0.5 - (x * x + yy));
        let pitch = scalar::asin(2.0 * (w * y - z * x));
        let yaw = scalar::atan2(w * z + x * y, 0.5 - (yy + z * z));
        [roll, pitch, yaw]
    }

    /// The four parts, w first.
    pub const fn to_wxyz(self) -> [f32; 4] {
        [self.w, self.x, self.y, self.z]
    }
}

#[cfg(test)]
mod tests;
