//! Attitudes, and vectors seen from the body.
//!
//! Both orders of a quaternion are in use: w first in rl_sar and in most simulators, w last on the PC link. They are two
//! types here, so that one cannot be taken for the other.

/// How far from 1 the length of an attitude's quaternion may be. Noise of an estimator is far below, a wrong field above.
const LENGTH_TOLERANCE: f32 = 0.01;

/// Four numbers that are no attitude.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "a quaternion of length {length} is no attitude: its length is 1. Are these the right four numbers?"
)]
pub struct NotAnAttitude {
    /// Length of the quaternion.
    pub length: f32,
}

/// An attitude as a unit quaternion w, x, y, z. It turns vectors of the body into vectors of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuatWxyz([f32; 4]);

/// An attitude as a unit quaternion x, y, z, w. It turns vectors of the body into vectors of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuatXyzw([f32; 4]);

impl QuatWxyz {
    /// The body's axes are those of the world.
    pub const LEVEL: Self = Self([1.0, 0.0, 0.0, 0.0]);

    /// Takes w, x, y, z.
    ///
    /// # Errors
    /// The length is not 1 within 0.01.
    pub fn new(wxyz: [f32; 4]) -> Result<Self, NotAnAttitude> {
        unit(wxyz).map(Self)
    }

    /// Returns w, x, y, z.
    pub const fn wxyz(self) -> [f32; 4] {
        self.0
    }

    /// Returns a vector of the world in axes of the body: the rotation by the inverse quaternion,
    /// `v·(2w² − 1) − 2w·(u × v) + 2u·(u · v)` with `u = (x, y, z)`.
    pub fn body_from_world(self, v: [f32; 3]) -> [f32; 3] {
        let [w, x, y, z] = self.0;
        let u = [x, y, z];
        let along = 2.0 * w * w - 1.0;
        let (across, inner) = (cross(u, v), dot(u, v));
        std::array::from_fn(|n| v[n] * along - 2.0 * w * across[n] + 2.0 * inner * u[n])
    }

    /// Returns the direction of gravity in axes of the body: (0, 0, −1) of the world. It has no unit.
    pub fn gravity(self) -> [f32; 3] {
        self.body_from_world([0.0, 0.0, -1.0])
    }
}

impl QuatXyzw {
    /// Takes x, y, z, w.
    ///
    /// # Errors
    /// The length is not 1 within 0.01.
    pub fn new(xyzw: [f32; 4]) -> Result<Self, NotAnAttitude> {
        unit(xyzw).map(Self)
    }

    /// Returns x, y, z, w.
    pub const fn xyzw(self) -> [f32; 4] {
        self.0
    }
}

impl From<QuatXyzw> for QuatWxyz {
    fn from(QuatXyzw([x, y, z, w]): QuatXyzw) -> Self {
        Self([w, x, y, z])
    }
}

impl From<QuatWxyz> for QuatXyzw {
    fn from(QuatWxyz([w, x, y, z]): QuatWxyz) -> Self {
        Self([x, y, z, w])
    }
}

fn unit(quaternion: [f32; 4]) -> Result<[f32; 4], NotAnAttitude> {
    let length = quaternion.iter().map(|it| it * it).sum::<f32>().sqrt();
    // A length that is NaN is not within.
    if (length - 1.0).abs() <= LENGTH_TOLERANCE {
        Ok(quaternion.map(|it| it / length))
    } else {
        Err(NotAnAttitude { length })
    }
}

fn cross([ax, ay, az]: [f32; 3], [bx, by, bz]: [f32; 3]) -> [f32; 3] {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_orders_are_each_others_inverse() {
        let wxyz = QuatWxyz::new([0.5, -0.5, 0.5, 0.5]).unwrap();
        let xyzw = QuatXyzw::from(wxyz);
        assert_eq!(xyzw.xyzw(), [-0.5, 0.5, 0.5, 0.5]);
        assert_eq!(QuatWxyz::from(xyzw), wxyz);
    }

    #[test]
    fn a_nose_that_points_down_feels_gravity_forward() {
        // +90° about y: x of the body points down.
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let nose_down = QuatWxyz::new([half, 0.0, half, 0.0]).unwrap();
        let [x, y, z] = nose_down.gravity();
        assert!(
            (x - 1.0).abs() < 1e-6 && y.abs() < 1e-6 && z.abs() < 1e-6,
            "{x} {y} {z}"
        );
    }

    #[test]
    fn what_is_no_attitude_is_refused() {
        for four in [[0.0; 4], [f32::NAN, 0.0, 0.0, 1.0], [1.0, 0.2, 0.0, 0.0]] {
            assert!(QuatWxyz::new(four).is_err(), "{four:?}");
            assert!(QuatXyzw::new(four).is_err(), "{four:?}");
        }
    }
}
