//! Requires a pause after rejected IMU samples, as the motion between them was not measured.

use crate::domain::ImuRejects;

/// The attitude counts as settled after this long without a rejected sample.
const SETTLED_US: u64 = 500_000;

/// Watches the counters of rejected samples. It starts as not settled.
#[derive(Clone, Debug, Default)]
pub struct AttitudeSettling {
    rejected: u32,
    since_us: Option<u64>,
}

impl AttitudeSettling {
    /// Returns whether the attitude has settled; called a few times a second. Skipped gyro frames do not count, as
    /// the rest of their sample was used.
    pub fn step(&mut self, rejects: &ImuRejects, now_us: u64) -> bool {
        let reasons = [
            rejects.absent,
            rejects.frozen,
            rejects.implausible,
            rejects.saturated,
        ];
        let rejected = reasons.into_iter().fold(0, u32::wrapping_add);
        let since_us = match self.since_us {
            Some(since_us) if rejected == self.rejected => since_us,
            _ => *self.since_us.insert(now_us),
        };
        self.rejected = rejected;
        now_us.saturating_sub(since_us) >= SETTLED_US
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_second_without_rejected_samples_settles_the_attitude() {
        let mut rest = AttitudeSettling::default();
        let mut rejects = ImuRejects::default();
        assert!(!rest.step(&rejects, 1_000));
        assert!(!rest.step(&rejects, 500_999));
        assert!(rest.step(&rejects, 501_000));
        rejects.gyro_frames = 3;
        assert!(rest.step(&rejects, 510_000));
        let mut now_us = 510_000;
        for reject in [
            |rejects: &mut ImuRejects| rejects.absent = 1,
            |rejects: &mut ImuRejects| rejects.frozen = 1,
            |rejects: &mut ImuRejects| rejects.implausible = 1,
            |rejects: &mut ImuRejects| rejects.saturated = u32::MAX,
        ] {
            reject(&mut rejects);
            assert!(!rest.step(&rejects, now_us));
            assert!(!rest.step(&rejects, now_us + 499_999));
            now_us += 500_000;
            assert!(rest.step(&rejects, now_us));
        }
    }
}
