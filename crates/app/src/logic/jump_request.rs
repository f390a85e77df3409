//! The pilot's request to jump.

/// A request is set for this long, so that no tick of the control loop misses it.
const HELD_US: u64 = 100_000;

/// Turns a press of the jump button into one request. A button that was pressed before the first round makes none.
#[derive(Clone, Debug, Default)]
pub(super) struct JumpRequest {
    seen_released: bool,
    /// Time of the last request.
    requested_us: Option<u64>,
}

impl JumpRequest {
    /// Returns whether a jump is requested.
    pub fn step(&mut self, pressed: bool, now_us: u64) -> bool {
        if pressed && self.seen_released {
            self.requested_us = Some(now_us);
        }
        self.seen_released = !pressed;
        self.requested_us
            .is_some_and(|request_us| now_us.saturating_sub(request_us) < HELD_US)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Feeds the button every 10 ms from 1 s on and returns the times in ms at which a jump was requested.
    fn requests(pressed: impl Fn(u64) -> bool) -> Vec<u64> {
        let mut request = JumpRequest::default();
        let rounds = (0..4_000).step_by(10);
        rounds
            .filter(|&ms| request.step(pressed(ms), 1_000_000 + ms * 1_000))
            .collect()
    }

    fn tenth_from(ms: u64) -> Vec<u64> {
        (ms..ms + 100).step_by(10).collect()
    }

    #[test]
    fn a_press_is_one_request_for_a_tenth_of_a_second() {
        assert_eq!(requests(|ms| ms >= 500), tenth_from(500));
        assert_eq!(requests(|ms| ms == 500), tenth_from(500));
        assert_eq!(requests(|_| true), Vec::<u64>::new());
    }
}
