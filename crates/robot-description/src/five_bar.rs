//! Geometry, statics and limits of a five-bar leg, for the checks and for models of other programs.
//!
//! Everything is in the leg's plane: x forward, z up, from the hip centre.

use crate::{
    Legs,
    parts::{ENDS, out},
};

/// Lengths of a leg.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FiveBar {
    half_gap_m: f64,
    thigh_m: f64,
    shank_m: f64,
}

/// Both thighs from hip to knee and both shanks from knee to axle, front before rear.
struct Links {
    thighs: [[f64; 2]; 2],
    shanks: [[f64; 2]; 2],
}

/// How far a pose is from those in which the leg locks or gives way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Margins {
    /// Angle in rad between the two shanks at the axle, counted to the nearer of 0 and π. At 0 the axle would give way
    /// although the hips stand still.
    pub(crate) between_shanks_rad: f64,
    /// Smaller angle in rad of the two between a thigh and its shank, counted to the nearer of folded and straight. It is
    /// negative beyond. At 0 a hip has no leverage on the axle.
    pub(crate) at_knee_rad: f64,
}

impl Links {
    fn knees_rad(&self) -> [f64; 2] {
        [0, 1].map(|end| angle(self.thighs[end], self.shanks[end]))
    }
}

impl FiveBar {
    pub(crate) fn new(legs: &Legs) -> Self {
        Self {
            half_gap_m: legs.hip_gap_m / 2.0,
            thigh_m: legs.thigh.length_m,
            shank_m: legs.shank.length_m,
        }
    }

    /// Angles in rad of the front and the rear hip with the axle at a distance from the hip centre and an angle from
    /// straight down, forward positive. `None` if the links do not reach.
    pub(crate) fn hips_rad(&self, length_m: f64, lean_rad: f64) -> Option<[f64; 2]> {
        let (x, z) = (length_m * lean_rad.sin(), -length_m * lean_rad.cos());
        let direction = |out: f64| {
            let (dx, dz) = (x - out * self.half_gap_m, z);
            let distance = dx.hypot(dz);
            let [l1, l2] = [self.thigh_m, self.shank_m];
            let cosine = (distance * distance + l1 * l1 - l2 * l2) / (2.0 * distance * l1);
            (cosine.abs() < 1.0).then(|| dz.atan2(dx) + out * cosine.acos())
        };
        let [front, rear] = ENDS.map(|end| direction(out(end)));
        // The rear thigh at angle 0 points backward.
        let [front_rad, rear_rad] = [front?, rear? + std::f64::consts::PI];
        Some([front_rad, rear_rad].map(wrapped))
    }

    /// The links with these hip angles, the knees outward. `None` if the shanks do not meet.
    fn links(&self, [front_rad, rear_rad]: [f64; 2]) -> Option<Links> {
        let hips = [[self.half_gap_m, 0.0], [-self.half_gap_m, 0.0]];
        let thighs = [
            [front_rad.cos(), front_rad.sin()],
            [-rear_rad.cos(), -rear_rad.sin()],
        ]
        .map(|[x, z]| [x * self.thigh_m, z * self.thigh_m]);
        let [front, rear] = [0, 1].map(|end| add(hips[end], thighs[end]));
        let [dx, dz] = subtract(front, rear);
        let apart = dx.hypot(dz);
        let height = (self.shank_m.powi(2) - apart * apart / 4.0).max(0.0).sqrt();
        if height == 0.0 || apart == 0.0 {
            return None;
        }
        let middle = [(front[0] + rear[0]) / 2.0, (front[1] + rear[1]) / 2.0];
        // The lower one of the two places in which the shanks meet.
        let axle = add(middle, [height * dz / apart, -height * dx / apart]);
        let shanks = [subtract(axle, front), subtract(axle, rear)];
        Some(Links { thighs, shanks })
    }

    /// Angles in rad of the front and the rear shank relative to their thighs, about −y: 0 where a shank continues its thigh.
    /// `None` if the shanks do not meet.
    pub(crate) fn knees_rad(&self, hips_rad: [f64; 2]) -> Option<[f64; 2]> {
        Some(self.links(hips_rad)?.knees_rad())
    }

    /// Margins of the pose with these hip angles. `None` if the shanks do not meet.
    pub(crate) fn margins(&self, hips_rad: [f64; 2]) -> Option<Margins> {
        let links = self.links(hips_rad)?;
        let [front, rear] = links.shanks;
        let [front_knee_rad, rear_knee_rad] = links.knees_rad();
        Some(Margins {
            between_shanks_rad: nearest(angle(front, rear)),
            at_knee_rad: nearest(-front_knee_rad).min(nearest(rear_knee_rad)),
        })
    }

    /// Torque in N·m of each hip for 1 N along a leg of this length that points straight down.
    pub(crate) fn torque_per_newton(&self, length_m: f64) -> Option<f64> {
        let [_, down_rad] = self.hips_rad(length_m, 0.0)?;
        // Half of d(length)/d(angle): both hips turn by the angle.
        let out_m = self.half_gap_m + self.thigh_m * down_rad.cos();
        let shank_down_m = length_m - self.thigh_m * down_rad.sin();
        let thigh_m = self.thigh_m;
        Some((thigh_m * down_rad.cos() + out_m * thigh_m * down_rad.sin() / shank_down_m) / 2.0)
    }
}

fn add(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

fn subtract(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// Angle in rad from `a` to `b`, in the sense from x to z, within ±π.
fn angle(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}

/// Distance of an angle from 0 or π, whichever is nearer; negative for a negative angle.
fn nearest(rad: f64) -> f64 {
    rad.signum() * rad.abs().min(std::f64::consts::PI - rad.abs())
}

fn wrapped(rad: f64) -> f64 {
    rad.sin().atan2(rad.cos())
}

#[cfg(test)]
mod tests;
