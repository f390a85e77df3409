//! Whether the pilot's hands are off the sticks: a stick on its way through the centre is no rest.

use crate::domain::{RemoteState, SafetyConfig};

/// Both sticks have been centred for this long before they count as at rest.
const REST_US: u64 = 200_000;
/// After a stall of the chip the radio needs this long to be heard again; that it was not heard meanwhile is nobody's
/// doing.
const CATCH_UP_US: u64 = 50_000;

/// Starts as not at rest.
#[derive(Clone, Debug, Default)]
pub struct StickRest {
    /// Last time the sticks were off centre, or nobody knew where they were.
    moved_us: Option<u64>,
    stalled_us: u64,
}

impl StickRest {
    /// The whole chip stood still until `now_us`.
    pub fn after_stall(&mut self, now_us: u64) {
        self.stalled_us = now_us;
    }

    /// What the sticks were said to be before does not count any more.
    pub fn restart(&mut self) {
        self.moved_us = None;
    }

    /// Once a tick. `fresh`: the remote has been heard of late.
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
        rest: StickRest,
        remote: RemoteState,
        fresh: bool,
        now_us: u64,
    }

    impl Bench {
        fn new() -> Self {
            Self {
                rest: StickRest::default(),
                remote: RemoteState::default(),
                fresh: true,
                now_us: 5_000_000,
            }
        }

        /// Ticks of 1 ms; the last answer.
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
    fn centred_sticks_rest_after_a_fifth_of_a_second() {
        let mut bench = Bench::new();
        assert!(!bench.run(200));
        assert!(bench.run(1));
    }

    #[test]
    fn a_stick_in_passing_is_no_rest() {
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
    fn sticks_that_nobody_hears_do_not_rest() {
        let mut bench = Bench::new();
        assert!(bench.run(300));
        bench.fresh = false;
        assert!(!bench.run(1));
        bench.fresh = true;
        assert!(!bench.run(199));
        assert!(bench.run(1));
    }

    #[test]
    fn a_stall_is_forgiven_but_not_a_radio_that_stays_away() {
        let mut bench = Bench::new();
        assert!(bench.run(300));
        bench.now_us += 250_000;
        bench.rest.after_stall(bench.now_us);
        bench.fresh = false;
        assert!(bench.run(50));
        assert!(!bench.run(1));
    }

    #[test]
    fn new_settings_start_anew() {
        let mut bench = Bench::new();
        assert!(bench.run(300));
        bench.rest.restart();
        assert!(!bench.run(200));
        assert!(bench.run(1));
    }
}
