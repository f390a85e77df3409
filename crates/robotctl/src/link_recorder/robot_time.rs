//! The time axis of a recording, from the time in the robot's state.
//!
//! A state frame has the time as an `f32` in s. After some hours its steps are longer than the frames' period, so
//! several frames have the same time. The axis spreads them evenly within what the steps allow.

use robot_app::link::Uplink;

use super::STATE_PERIOD_S;

/// A longer step of time is believed only if the next frame confirms it: one frame in 256 damaged ones has a CRC that
/// fits.
const DOUBTFUL_STEP_S: f64 = 0.5;

/// A state frame and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arrival {
    /// Time on the recording's axis. It rises from frame to frame.
    pub t_s: f64,
    /// Time since the frame before.
    pub after_s: f64,
    /// The robot has restarted: its time began again, and the axis continues.
    pub restarted: bool,
    pub state: Uplink,
}

#[derive(Debug, Default)]
pub(super) struct RobotTime {
    first_s: Option<f64>,
    /// Time of the last frame on the axis.
    last_s: f64,
    /// What to add to the robot's time. It is 0 until the robot restarts.
    offset_s: f64,
    /// A frame whose time does not follow that of the frame before.
    doubtful: Option<Uplink>,
    implausible: u64,
}

impl RobotTime {
    /// Returns the frames that are known to be good now, in their order.
    pub fn add(&mut self, state: &Uplink) -> Vec<Arrival> {
        if self.first_s.is_some() && self.follows(state) {
            // A doubtful frame before it was a damaged one.
            self.implausible += u64::from(self.doubtful.take().is_some());
            return vec![self.arrival(state, false)];
        }
        match self.doubtful.take() {
            Some(before) if confirms(&before, state) => {
                let restarted =
                    self.first_s.is_some() && self.offset_s + seconds(&before) < self.last_s;
                if restarted {
                    self.offset_s = self.last_s + STATE_PERIOD_S - seconds(&before);
                }
                vec![self.arrival(&before, restarted), self.arrival(state, false)]
            }
            before => {
                self.implausible += u64::from(before.is_some());
                self.doubtful = Some(*state);
                Vec::new()
            }
        }
    }

    /// Time of the first frame.
    pub fn first_s(&self) -> Option<f64> {
        self.first_s
    }

    /// Number of frames that were dropped.
    pub fn implausible(&self) -> u64 {
        self.implausible
    }

    fn follows(&self, state: &Uplink) -> bool {
        let step_s = self.offset_s + seconds(state) - self.last_s;
        (-resolution_s(state)..DOUBTFUL_STEP_S).contains(&step_s)
    }

    fn arrival(&mut self, state: &Uplink, restarted: bool) -> Arrival {
        let reported_s = self.offset_s + seconds(state);
        let half_s = 0.5 * resolution_s(state);
        let (t_s, after_s) = match self.first_s {
            None => {
                self.first_s = Some(reported_s);
                (reported_s, 0.0)
            }
            Some(_) => {
                let expected_s = self.last_s + STATE_PERIOD_S;
                let t_s = expected_s.clamp(reported_s - half_s, reported_s + half_s);
                // The least step keeps the order where the clamp would end it.
                let t_s = t_s.max(self.last_s + 1e-6);
                (t_s, t_s - self.last_s)
            }
        };
        self.last_s = t_s;
        Arrival {
            t_s,
            after_s,
            restarted,
            state: *state,
        }
    }
}

fn seconds(state: &Uplink) -> f64 {
    state.time_s.into()
}

/// Returns the step of the robot's time.
fn resolution_s(state: &Uplink) -> f64 {
    f64::from(state.time_s.next_up() - state.time_s)
}

fn confirms(before: &Uplink, state: &Uplink) -> bool {
    let step_s = seconds(state) - seconds(before);
    (0.0..DOUBTFUL_STEP_S).contains(&step_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time_s: f32) -> Uplink {
        Uplink {
            time_s,
            ..Uplink::default()
        }
    }

    fn times(time: &mut RobotTime, reported_s: &[f32]) -> Vec<f64> {
        let arrivals = reported_s.iter().flat_map(|t| time.add(&at(*t)));
        arrivals.map(|arrival| arrival.t_s).collect()
    }

    #[test]
    fn the_axis_is_the_robots_time() {
        let found = times(&mut RobotTime::default(), &[1.0, 1.0024, 1.0048, 1.1]);
        for (found, expected) in found.iter().zip([1.0, 1.0024, 1.0048, 1.1]) {
            assert!((found - expected).abs() < 1e-6, "{found}");
        }
        assert_eq!(found.len(), 4);
    }

    /// After ten hours a step of the robot's time is 3.9 ms.
    #[test]
    fn frames_of_the_same_reported_time_are_spread_evenly() {
        let sent: Vec<f64> = (0..2_000)
            .map(|n| 36_000.0 + 0.0024 * f64::from(n))
            .collect();
        let reported: Vec<f32> = sent.iter().map(|t| *t as f32).collect();
        let found = times(&mut RobotTime::default(), &reported);
        assert_eq!(found.len(), sent.len());
        for (found, sent) in found.windows(2).zip(sent.windows(2)) {
            assert!((found[1] - sent[1]).abs() < 0.004, "{found:?} {sent:?}");
            assert!(found[1] - found[0] > 0.001, "{found:?}");
        }
    }

    #[test]
    fn a_restart_goes_on_where_the_axis_was() {
        let mut time = RobotTime::default();
        times(&mut time, &[50.0, 50.0024]);
        let arrivals: Vec<_> = [0.2, 0.2024, 0.2048]
            .iter()
            .flat_map(|t| time.add(&at(*t)))
            .collect();
        assert_eq!(arrivals.len(), 3);
        assert!(arrivals[0].restarted && !arrivals[1].restarted);
        assert!((arrivals[0].t_s - 50.0048).abs() < 1e-4, "{arrivals:?}");
        assert!((arrivals[2].t_s - arrivals[0].t_s - 0.0048).abs() < 1e-5);
    }

    #[test]
    fn a_damaged_frame_whose_crc_fits_does_not_move_the_axis() {
        let mut time = RobotTime::default();
        let found = times(
            &mut time,
            &[5.0, 5.0024, 7e7, 5.0048, f32::NAN, 0.001, 5.0072, 5.0096],
        );
        assert_eq!(found.len(), 5);
        assert!((found[4] - 5.0096).abs() < 1e-5, "{found:?}");
        assert_eq!(time.implausible(), 3);
    }

    #[test]
    fn a_long_gap_is_believed_when_the_next_frame_confirms_it() {
        let mut time = RobotTime::default();
        let all = [5.0, 5.0024, 9.0, 9.0024];
        let arrivals: Vec<_> = all.iter().flat_map(|t| time.add(&at(*t))).collect();
        assert_eq!(arrivals.len(), 4);
        assert!((arrivals[2].after_s - 3.9976).abs() < 1e-4);
        assert_eq!(time.implausible(), 0);
    }
}
