//! Detects that the pilot has released the sticks. A stick that passes through the centre does not count.

use crate::domain::{RemoteState, SafetyConfig};

/// Both sticks must be centred for this long.
const REST_US: u64 = 200_000;
/// After a stall of the chip the radio gets this much time to be received again, as it was not the radio that paused.
const CATCH_UP_US: u64 = 50_000;

/// Debounces the centre position of both sticks. It starts as not centred.
#[derive(Clone, Debug, Default)]
pub struct CentredSticks {
    /// The last time that the sticks were off centre or their position unknown.
    moved_us: Option<u64>,
    stalled_us: u64,
}

impl CentredSticks {
    /// Takes note that the whole chip stood still until `now_us`.
    pub fn after_stall(&mut self, now_us: u64) {
        self.stalled_us = now_us;
    }

    /// Discards all earlier positions.
    pub fn restart(&mut self) {
        self.moved_us = None;
    }

    /// Returns whether the sticks are centred; called once a tick. `fresh` means that the remote was received
    /// recently.
    pub fn step(
        &mut self,
        remote: &RemoteState,
        fresh: bool,
        config: &SafetyConfig,
        now_us: u64,
    ) -> bool {
        let limit = config.stick_centre;
        let centred = remote.vx.abs() <= limit && remote.wz.abs() <= limit;
        let unknown = !fresh && now_us.saturating_sub(self.stalled_us) > CATCH_UP_US;
        let moved_us = match self.moved_us {
            Some(moved_us) if centred && !unknown => moved_us,
            _ => *self.moved_us.insert(now_us),
        };
        now_us.saturating_sub(moved_us) >= REST_US
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Bench {
        rest: CentredSticks,
        remote: RemoteState,
        fresh: bool,
        now_us: u64,
    }

    impl Bench {
        fn new() -> Self {
            Self {
                rest: CentredSticks::default(),
                remote: RemoteState::default(),
                fresh: true,
                now_us: 5_000_000,
            }
        }

        /// Runs ticks of 1 ms and returns the last result.
        fn run(&mut self, milliseconds: u32) -> bool {
            let mut rests = false;
            for _ in 0..milliseconds {
                self.now_us += 1_000;
                let config = SafetyConfig::default();
                rests = self
                    .rest
                    .step(&self.remote, self.fresh, &config, self.now_us);
            }
            rests
        }
    }

    #[test]
    fn sticks_count_as_centred_after_a_fifth_of_a_second() {
        let mut bench = Bench::new();
        assert!(!bench.run(200));
        assert!(bench.run(1));
    }

    #[test]
    fn a_stick_passing_the_centre_does_not_count_as_centred() {
        for (vx, wz) in [
            (0.06, 0.0),
            (-0.06, 0.0),
            (0.0, 0.06),
            (0.0, -0.06),
            (f32::NAN, 0.0),
        ] {
            let mut bench = Bench::new();
            assert!(bench.run(300));
            (bench.remote.vx, bench.remote.wz) = (vx, wz);
            assert!(!bench.run(1));
            (bench.remote.vx, bench.remote.wz) = (0.05, -0.05);
            assert!(!bench.run(199));
            assert!(bench.run(1));
        }
    }

    #[test]
    fn sticks_without_a_radio_link_do_not_count_as_centred() {
        let mut bench = Bench::new();
        assert!(bench.run(300));
        bench.fresh = false;
        assert!(!bench.run(1));
        bench.fresh = true;
        assert!(!bench.run(199));
        assert!(bench.run(1));
    }

    #[test]
    fn a_stall_is_tolerated_but_a_lost_radio_is_not() {
        let mut bench = Bench::new();
        assert!(bench.run(300));
        bench.now_us += 250_000;
        bench.rest.after_stall(bench.now_us);
        bench.fresh = false;
        assert!(bench.run(50));
        assert!(!bench.run(1));
    }

    #[test]
    fn a_restart_discards_earlier_positions() {
        let mut bench = Bench::new();
        assert!(bench.run(300));
        bench.rest.restart();
        assert!(!bench.run(200));
        assert!(bench.run(1));
    }
}
