//! How strong something may be until half of the robots fall.

use crate::Robots;

/// Steps of halving: 1/64 of the span.
const HALVINGS: u32 = 6;

/// Something that can be made stronger.
pub(crate) struct Bisection {
    pub what: &'static str,
    pub unit: &'static str,
    /// Every robot should survive this.
    pub from: f64,
    /// No robot should survive this.
    pub to: f64,
    pub survives: fn(&Robots, u64, f64) -> bool,
}

impl Bisection {
    /// The strength that this robot just survives, by halving the span.
    pub fn limit_of(&self, robots: &Robots, seed: u64) -> f64 {
        let (mut low, mut high) = (self.from, self.to);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if (self.survives)(robots, seed, middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

/// The limits of many robots.
#[derive(Clone, Debug)]
pub struct Limit {
    /// What was made stronger.
    pub what: &'static str,
    /// Unit of the limits.
    pub unit: &'static str,
    /// One for each robot, ascending.
    pub each: Vec<f64>,
}

impl Limit {
    pub(crate) fn new(bisection: &Bisection, mut each: Vec<f64>) -> Self {
        each.sort_by(f64::total_cmp);
        Self {
            what: bisection.what,
            unit: bisection.unit,
            each,
        }
    }

    /// Half of the robots survive more. Zero without robots.
    pub fn median(&self) -> f64 {
        let middle = self.each.len() / 2;
        match self.each.len() {
            0 => 0.0,
            count if count.is_multiple_of(2) => 0.5 * (self.each[middle - 1] + self.each[middle]),
            _ => self.each[middle],
        }
    }

    /// Share of robots that survive this.
    pub fn surviving(&self, strength: f64) -> f64 {
        let survivors = self.each.iter().filter(|limit| **limit > strength).count();
        survivors as f64 / self.each.len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limit(each: &[f64]) -> Limit {
        Limit {
            what: "push",
            unit: "m/s",
            each: each.to_vec(),
        }
    }

    #[test]
    fn half_of_the_robots_survive_more_than_the_median() {
        assert_eq!(limit(&[1.0, 2.0, 4.0]).median(), 2.0);
        assert_eq!(limit(&[1.0, 2.0, 4.0, 5.0]).median(), 3.0);
        assert_eq!(limit(&[1.0, 2.0, 4.0, 5.0]).surviving(2.0), 0.5);
    }

    #[test]
    fn halving_finds_the_limit_to_a_sixty_fourth() {
        let bisection = Bisection {
            what: "push",
            unit: "m/s",
            from: 0.0,
            to: 64.0,
            survives: |_, seed, strength| strength < 20.0 + seed as f64,
        };
        let robots = Robots {
            robot: robot_plant::world::WorldConfig::default().robot,
            vary: false,
        };
        for seed in 0..5 {
            let found = bisection.limit_of(&robots, seed);
            assert!((found - 20.0 - seed as f64).abs() <= 0.5, "{found}");
        }
    }
}
