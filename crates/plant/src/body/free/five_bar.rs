//! The five-bar linkage of one leg in its plane: x forward, z up, origin in the middle of the two hip axes.
//!
//! A leg's two closed loops have no coordinates of their own. Knees and axle follow from the two hip angles, so the loop cannot
//! open, whatever the step.

use super::Vec2;

/// Front, rear.
pub(super) const HIPS: usize = 2;
/// Least distance between the knees, and least height of the axle under them, that the formulas divide by. End stops keep
/// a leg far from both.
const LEAST_M: f64 = 0.01;

/// Lengths of a leg.
#[derive(Clone, Copy, Debug)]
pub(super) struct FiveBar {
    pub half_gap_m: f64,
    pub thigh_m: f64,
    pub shank_m: f64,
}

/// Places and first derivatives at one pair of hip angles. Columns of derivatives belong to the front and rear hip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linkage {
    bar: FiveBar,
    pub knee: [Vec2; HIPS],
    pub axle: Vec2,
    /// Unit vectors from hip to knee.
    pub thigh: [Vec2; HIPS],
    /// Unit vectors from knee to axle.
    pub shank: [Vec2; HIPS],
    /// Of each knee by its own hip angle; the other hip does not move it.
    pub knee_slope: [Vec2; HIPS],
    pub axle_slope: [Vec2; HIPS],
    /// Of each shank's angle about −y, by both hip angles.
    pub shank_slope: [[f64; HIPS]; HIPS],
    /// 1/(front shank × rear shank).
    inverse_cross: f64,
}

/// Accelerations that remain when the hips turn at constant speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Centripetal {
    pub knee: [Vec2; HIPS],
    pub axle: Vec2,
    /// Of the shanks' angles about −y.
    pub shank: [f64; HIPS],
}

/// A vector turned by a quarter about −y, from x towards z.
pub(super) fn quarter(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// The vector that the scalar product with `along` makes 1, at right angles to `across`: `inverse_cross` is 1/(along × across).
fn dual(across: Vec2, inverse_cross: f64) -> Vec2 {
    Vec2::new(across.y, -across.x) * inverse_cross
}

impl FiveBar {
    pub fn at(&self, hip_rad: [f64; HIPS]) -> Linkage {
        let (front_sin, front_cos) = hip_rad[0].sin_cos();
        let (rear_sin, rear_cos) = hip_rad[1].sin_cos();
        let thigh = [
            Vec2::new(front_cos, front_sin),
            Vec2::new(-rear_cos, -rear_sin),
        ];
        let hip = [self.half_gap_m, -self.half_gap_m];
        let knee: [Vec2; HIPS] =
            std::array::from_fn(|i| Vec2::new(hip[i], 0.0) + thigh[i] * self.thigh_m);
        let knee_slope = thigh.map(|it| quarter(it) * self.thigh_m);
        let axle = self.axle(knee);
        let shank = knee.map(|it| (axle - it) / self.shank_m);
        let cross = shank[0].x * shank[1].y - shank[0].y * shank[1].x;
        // Front and rear shank point down and together, so the product is positive.
        let inverse_cross = 1.0 / cross.max(LEAST_M);
        let axle_slope = [
            dual(shank[1], inverse_cross) * knee_slope[0].dot(&shank[0]),
            -dual(shank[0], inverse_cross) * knee_slope[1].dot(&shank[1]),
        ];
        let shank_slope = std::array::from_fn(|s| {
            std::array::from_fn(|h| {
                let own = if s == h { knee_slope[h] } else { Vec2::zeros() };
                quarter(shank[s]).dot(&(axle_slope[h] - own)) / self.shank_m
            })
        });
        Linkage {
            bar: *self,
            knee,
            axle,
            thigh,
            shank,
            knee_slope,
            axle_slope,
            shank_slope,
            inverse_cross,
        }
    }

    /// The intersection of the two circles about the knees that lies below them.
    fn axle(&self, [front, rear]: [Vec2; HIPS]) -> Vec2 {
        let apart = front - rear;
        let distance_m = apart.norm().max(LEAST_M);
        let half_m = distance_m / 2.0;
        let below_m = (self.shank_m * self.shank_m - half_m * half_m)
            .max(LEAST_M * LEAST_M)
            .sqrt();
        (front + rear) / 2.0 - quarter(apart) * (below_m / distance_m)
    }

    /// Hip angles that bring the axle to a place, knees outward; `None` out of reach.
    pub fn hips_for(&self, axle: Vec2) -> Option<[f64; HIPS]> {
        // Rear is front seen in a mirror, with the angle's sense turned over.
        let front = self.front_hip_for(axle)?;
        let rear = self.front_hip_for(Vec2::new(-axle.x, axle.y))?;
        Some([front, -rear])
    }

    fn front_hip_for(&self, axle: Vec2) -> Option<f64> {
        let to_axle = axle - Vec2::new(self.half_gap_m, 0.0);
        let reach_m = to_axle.norm();
        let cos = (self.thigh_m.powi(2) + reach_m.powi(2) - self.shank_m.powi(2))
            / (2.0 * self.thigh_m * reach_m);
        (cos.abs() <= 1.0).then(|| to_axle.y.atan2(to_axle.x) + cos.acos())
    }
}

impl Linkage {
    pub fn centripetal(&self, hip_rps: [f64; HIPS]) -> Centripetal {
        let knee: [Vec2; HIPS] =
            std::array::from_fn(|i| -self.thigh[i] * (self.bar.thigh_m * hip_rps[i].powi(2)));
        let shank_rps = self.shank_rps(hip_rps);
        // Along each shank the axle must accelerate as the knee does, less the centripetal acceleration of the shank.
        let along: [f64; HIPS] = std::array::from_fn(|i| {
            knee[i].dot(&self.shank[i]) - self.bar.shank_m * shank_rps[i].powi(2)
        });
        let axle = dual(self.shank[1], self.inverse_cross) * along[0]
            - dual(self.shank[0], self.inverse_cross) * along[1];
        let shank = std::array::from_fn(|i| {
            quarter(self.shank[i]).dot(&(axle - knee[i])) / self.bar.shank_m
        });
        Centripetal { knee, axle, shank }
    }

    /// Speeds of the shanks about −y.
    pub fn shank_rps(&self, hip_rps: [f64; HIPS]) -> [f64; HIPS] {
        self.shank_slope
            .map(|slope| slope[0] * hip_rps[0] + slope[1] * hip_rps[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BAR: FiveBar = FiveBar {
        half_gap_m: 0.05,
        thigh_m: 0.12,
        shank_m: 0.22,
    };
    const POSES: [[f64; HIPS]; 5] = [
        [-0.3, 0.3],
        [0.0, 0.0],
        [0.7, 1.2],
        [-1.3, -0.6],
        [1.5, -1.5],
    ];

    #[test]
    fn level_thighs_put_the_axle_where_pythagoras_does() {
        // Knees at ±0.17, so the axle is √(0.22² − 0.17²) below.
        let axle = BAR.at([0.0, 0.0]).axle;
        assert!(axle.x.abs() < 1e-12);
        assert!((axle.y + 0.139_642).abs() < 1e-6, "{axle}");
    }

    #[test]
    fn both_shanks_keep_their_length() {
        for pose in POSES {
            let linkage = BAR.at(pose);
            for knee in linkage.knee {
                assert!(((linkage.axle - knee).norm() - BAR.shank_m).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn slopes_are_the_differences_of_places() {
        let step = 1e-6;
        for pose in POSES {
            let linkage = BAR.at(pose);
            for hip in 0..HIPS {
                let moved = |by: f64| {
                    let mut pose = pose;
                    pose[hip] += by;
                    BAR.at(pose)
                };
                let (plus, minus) = (moved(step), moved(-step));
                let axle = (plus.axle - minus.axle) / (2.0 * step);
                assert!((axle - linkage.axle_slope[hip]).norm() < 1e-8);
                for shank in 0..HIPS {
                    let angle = |l: &Linkage| l.shank[shank].y.atan2(l.shank[shank].x);
                    let slope = (angle(&plus) - angle(&minus)) / (2.0 * step);
                    assert!((slope - linkage.shank_slope[shank][hip]).abs() < 1e-8);
                }
            }
        }
    }

    #[test]
    fn centripetal_terms_are_second_differences_at_constant_speed() {
        let (step, rps) = (1e-4, [3.0, -2.0]);
        for pose in POSES {
            let at = |s: f64| BAR.at(std::array::from_fn(|i| pose[i] + rps[i] * s));
            let (minus, here, plus) = (at(-step), at(0.0), at(step));
            let terms = here.centripetal(rps);
            let axle = (plus.axle - here.axle * 2.0 + minus.axle) / (step * step);
            assert!((axle - terms.axle).norm() < 1e-5, "{axle} {}", terms.axle);
            for i in 0..HIPS {
                let angle = |l: &Linkage| l.shank[i].y.atan2(l.shank[i].x);
                let shank = (angle(&plus) - 2.0 * angle(&here) + angle(&minus)) / (step * step);
                assert!((shank - terms.shank[i]).abs() < 1e-4);
                let knee = (plus.knee[i] - here.knee[i] * 2.0 + minus.knee[i]) / (step * step);
                assert!((knee - terms.knee[i]).norm() < 1e-5);
            }
        }
    }

    #[test]
    fn hips_are_found_again_from_the_axle() {
        for pose in POSES {
            let found = BAR.hips_for(BAR.at(pose).axle);
            let found = found.map(|it| BAR.at(it).axle);
            assert!(found.is_some_and(|it| (it - BAR.at(pose).axle).norm() < 1e-12));
        }
        let [front, rear] = BAR.hips_for(Vec2::new(0.0, -0.18)).unwrap_or_default();
        assert!(
            (front + 0.3).abs() < 0.05 && (rear - 0.3).abs() < 0.05,
            "{front} {rear}"
        );
        assert_eq!(BAR.hips_for(Vec2::new(0.0, -0.5)), None);
    }
}
