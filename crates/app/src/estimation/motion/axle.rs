//! The way from a wheel's axle to the point whose velocity is estimated, on a robot with moving legs.

use crate::{
    kinematics::Leg,
    math::{Vector3, scalar},
};

/// The way and its rate, in the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::estimation) struct AxlePath {
    /// From the axle to the point, forward and up.
    offset_m: [f32; 2],
    rate_mps: [f32; 2],
    /// Turn of the shank that carries the wheel's motor, about +y.
    pub carrier_rps: f32,
}

impl AxlePath {
    /// The point is `up_m` above the hip centre.
    pub fn new(leg: &Leg, up_m: f32) -> Self {
        let (sin, cos) = scalar::sin_cos(leg.angle_rad);
        let across_mps = leg.length_m * leg.angle_rps;
        Self {
            offset_m: [-leg.length_m * sin, leg.length_m * cos + up_m],
            rate_mps: [
                -leg.length_mps * sin - across_mps * cos,
                leg.length_mps * cos - across_mps * sin,
            ],
            carrier_rps: leg.carrier_rps,
        }
    }

    /// The path to the middle between both axles.
    pub fn mean([left, right]: &[Self; 2]) -> Self {
        let mean = |[lx, lz]: [f32; 2], [rx, rz]: [f32; 2]| [0.5 * (lx + rx), 0.5 * (lz + rz)];
        Self {
            offset_m: mean(left.offset_m, right.offset_m),
            rate_mps: mean(left.rate_mps, right.rate_mps),
            carrier_rps: 0.5 * (left.carrier_rps + right.carrier_rps),
        }
    }

    /// Velocity of the point relative to the axle, in body axes, while the body turns at `rate_rps`.
    pub fn velocity(&self, [wx, wy, wz]: Vector3) -> Vector3 {
        let [x, z] = self.offset_m;
        let [x_mps, z_mps] = self.rate_mps;
        [x_mps + wy * z, wz * x - wx * z, z_mps - wy * x]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STRAIGHT: Leg = Leg {
        length_m: 0.2,
        angle_rad: 0.0,
        length_mps: 0.0,
        angle_rps: 0.0,
        carrier_rps: 0.0,
        length_per_rad: [0.0; 2],
        angle_per_rad: [0.0; 2],
        carrier_per_rad: [0.0; 2],
        fits: true,
    };

    fn close(got: Vector3, wanted: Vector3) {
        for (got, wanted) in got.iter().zip(wanted) {
            assert!((got - wanted).abs() < 1e-6, "{got} {wanted}");
        }
    }

    #[test]
    fn a_body_that_pitches_on_a_stiff_leg_carries_the_point_forward() {
        let path = AxlePath::new(&STRAIGHT, 0.05);
        // 1 rad/s nose down, 0.25 m above the axle.
        close(path.velocity([0.0, 1.0, 0.0]), [0.25, 0.0, 0.0]);
        // Right side down.
        close(path.velocity([1.0, 0.0, 0.0]), [0.0, -0.25, 0.0]);
    }

    #[test]
    fn an_axle_that_swings_forward_leaves_the_point_behind() {
        let swinging = Leg {
            angle_rps: 2.0,
            ..STRAIGHT
        };
        close(
            AxlePath::new(&swinging, 0.05).velocity([0.0; 3]),
            [-0.4, 0.0, 0.0],
        );
        // Body and leg turn together in the world, so that the leg hangs still: only the point above the hips moves.
        close(
            AxlePath::new(&swinging, 0.05).velocity([0.0, 2.0, 0.0]),
            [0.1, 0.0, 0.0],
        );
    }

    #[test]
    fn a_leg_that_extends_lifts_the_point_along_itself() {
        let rising = Leg {
            angle_rad: 0.5,
            length_mps: 1.0,
            ..STRAIGHT
        };
        close(
            AxlePath::new(&rising, 0.05).velocity([0.0; 3]),
            [-0.479_425_5, 0.0, 0.877_582_6],
        );
    }

    /// By differences of the point's place in the world.
    #[test]
    fn the_velocity_is_the_derivative_of_the_place() {
        let leg_at = |t: f64| (0.2 + 0.5 * t, 0.3 - 1.5 * t);
        let place = |t: f64| {
            let (length, angle) = leg_at(t);
            let (x, z) = (-length * angle.sin(), length * angle.cos() + 0.05);
            // Nose down.
            let pitch: f64 = 0.2 + 0.8 * t;
            [
                pitch.cos() * x + pitch.sin() * z,
                pitch.cos() * z - pitch.sin() * x,
            ]
        };
        let (before, after) = (place(-1e-6), place(1e-6));
        let [vx, vz] = [0, 1].map(|axis| (after[axis] - before[axis]) / 2e-6);
        let (sin, cos) = 0.2_f64.sin_cos();
        let in_body = [cos * vx - sin * vz, 0.0, sin * vx + cos * vz];
        let leg = Leg {
            length_m: 0.2,
            angle_rad: 0.3,
            length_mps: 0.5,
            angle_rps: -1.5,
            ..STRAIGHT
        };
        let got = AxlePath::new(&leg, 0.05).velocity([0.0, 0.8, 0.0]);
        for (got, wanted) in got.iter().zip(in_body) {
            assert!((f64::from(*got) - wanted).abs() < 1e-5, "{got} {wanted}");
        }
    }
}
