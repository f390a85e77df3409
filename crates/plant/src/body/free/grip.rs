//! Forces at one place of contact: a spring and damper along the normal, a spring that slips across it.

use super::{Vec2, Vec3};
use nalgebra::SVector;

/// Depth at which the damping is whole, so that no force jumps at the first touch.
const DAMPED_FROM_M: f64 = 1e-3;

/// How stiff a contact is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stiffness {
    pub normal_n_per_m: f64,
    pub normal_n_per_mps: f64,
    pub tangent_n_per_m: f64,
    pub tangent_n_per_mps: f64,
}

impl Stiffness {
    /// Force out of the ground, never negative. `rising_mps` is the speed out of the ground.
    pub fn normal_n(&self, depth_m: f64, rising_mps: f64) -> f64 {
        let damping = self.normal_n_per_mps * share(depth_m);
        (self.normal_n_per_m * depth_m - damping * rising_mps).max(0.0)
    }

    /// Force along the ground against stretch and sliding speed. Where it would exceed `most_n` the contact slips, and the
    /// stretch becomes that of the greatest force.
    fn tangent_n<const N: usize>(
        &self,
        stretch: &mut SVector<f64, N>,
        slide_mps: SVector<f64, N>,
        most_n: f64,
    ) -> SVector<f64, N> {
        let wanted = -*stretch * self.tangent_n_per_m - slide_mps * self.tangent_n_per_mps;
        let size_n = wanted.norm();
        if size_n <= most_n {
            return wanted;
        }
        let force = wanted * (most_n / size_n);
        *stretch = -force / self.tangent_n_per_m;
        force
    }
}

fn share(depth_m: f64) -> f64 {
    (depth_m / DAMPED_FROM_M).min(1.0)
}

/// Friction of a body on the ground: a spring from where it sticks. It slips where it would exceed the friction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stick {
    stretch: Vec3,
}

impl Stick {
    /// Force along the ground against a sliding speed, at most `most_n`.
    pub fn force_n(
        &mut self,
        stiffness: &Stiffness,
        normal: Vec3,
        slide_mps: Vec3,
        most_n: f64,
        dt_s: f64,
    ) -> Vec3 {
        let stretch = self.stretch + slide_mps * dt_s;
        self.stretch = stretch - normal * normal.dot(&stretch);
        stiffness.tangent_n(&mut self.stretch, slide_mps, most_n)
    }
}

/// Friction of a rolling tyre: as [`Stick`], in the tyre's forward and left direction, and with a tread that rolls out of the contact
/// within the relaxation length. At rest it does not creep; rolling, its force is proportional to the slip until it slides.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tread {
    stretch: Vec2,
}

/// Way in which the tread of a tyre takes up a slip. With the tyre's stiffness it gives 15 to 20 times the load per unit of slip, as
/// a hard rubber wheel does. An assumption.
const RELAXATION_M: f64 = 0.03;

impl Tread {
    /// Force forward and left against the slip, at most `most_n`.
    pub fn force_n(
        &mut self,
        stiffness: &Stiffness,
        slip_mps: Vec2,
        rolling_mps: f64,
        most_n: f64,
        dt_s: f64,
    ) -> Vec2 {
        self.stretch =
            (self.stretch + slip_mps * dt_s) / (1.0 + rolling_mps.abs() * dt_s / RELAXATION_M);
        stiffness.tangent_n(&mut self.stretch, slip_mps, most_n)
    }
}
