//! A motion with limits of speed and acceleration: a trapezoid in speed.

use super::motor::CYCLE_S;

/// Where the servo wants to be on its way to a goal, and how fast.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Profile {
    pub position_steps: f64,
    pub speed_steps_s: f64,
}

impl Profile {
    /// Starts from where the shaft is.
    pub fn at(position_steps: f64) -> Self {
        Self {
            position_steps,
            speed_steps_s: 0.0,
        }
    }

    /// Goes on for one cycle towards a position.
    pub fn towards(&mut self, goal_steps: f64, max_speed: f64, acceleration: f64) {
        let left = goal_steps - self.position_steps;
        // The speed from which it can still stop at the goal, whole cycles considered.
        let lost = acceleration * CYCLE_S / 2.0;
        let braking = (2.0 * acceleration * left.abs() + lost * lost).sqrt() - lost;
        let wanted = left.signum() * braking.min(max_speed);
        self.speed_up(wanted, acceleration);
        self.position_steps += self.speed_steps_s * CYCLE_S;
        let is_there = (goal_steps - self.position_steps) * left <= 0.0;
        if is_there && self.speed_steps_s.abs() <= 2.0 * acceleration * CYCLE_S {
            *self = Self::at(goal_steps);
        }
    }

    /// Goes on for one cycle at a speed.
    pub fn at_speed(&mut self, speed_steps_s: f64, acceleration: f64) {
        self.speed_up(speed_steps_s, acceleration);
        self.position_steps += self.speed_steps_s * CYCLE_S;
    }

    fn speed_up(&mut self, wanted: f64, acceleration: f64) {
        let most = acceleration * CYCLE_S;
        self.speed_steps_s += (wanted - self.speed_steps_s).clamp(-most, most);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // 2,000 steps at 1,000 steps/s and 5,000 steps/s²: 0.2 s up, 0.2 s down, 200 steps in both, 1,800 at full speed.
    #[test]
    fn the_way_takes_the_time_of_a_trapezoid() {
        let mut profile = Profile::at(0.0);
        let mut cycles = 0;
        let mut fastest: f64 = 0.0;
        while profile.position_steps < 2000.0 && cycles < 10_000 {
            profile.towards(2000.0, 1000.0, 5000.0);
            fastest = fastest.max(profile.speed_steps_s);
            cycles += 1;
        }
        assert!((2195..=2210).contains(&cycles), "{cycles}");
        assert_eq!(fastest, 1000.0);
        assert_eq!(profile, Profile::at(2000.0));
    }

    #[test]
    fn a_short_way_never_reaches_full_speed_and_does_not_overshoot() {
        let mut profile = Profile::at(100.0);
        let mut lowest = f64::MAX;
        for _ in 0..2000 {
            profile.towards(50.0, 1000.0, 100.0);
            lowest = lowest.min(profile.position_steps);
        }
        assert!(lowest >= 49.9, "{lowest}");
        assert_eq!(profile, Profile::at(50.0));
    }
}
