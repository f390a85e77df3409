//! What the robot says of its own safety: live pages, asked for on the tuning channel.

use robot_app::domain::CanFrame;
use robotctl::{drive::RobotView, tuning::LiveQuestion};

/// One page is asked for in this time in s, so that each comes three times a second.
const ASK_EVERY_S: f64 = 0.1;
/// The page that has the reasons of a stop.
const SAFETY: &str = "safety";

/// Asks for the pages in turn. Time is the caller's, in s.
pub struct Pages {
    questions: [LiveQuestion; 3],
    asked: usize,
    due_s: f64,
    answered_s: Option<f64>,
}

impl Default for Pages {
    fn default() -> Self {
        Self {
            questions: [SAFETY, "arming", "balance"].map(LiveQuestion::new),
            asked: 0,
            due_s: f64::NEG_INFINITY,
            answered_s: None,
        }
    }
}

impl Pages {
    /// Returns the next question, if it is due. A clock that goes back is that of a robot that was switched on anew: what it said
    /// before no longer holds.
    pub fn question(&mut self, time_s: f64) -> Option<CanFrame> {
        if time_s + ASK_EVERY_S < self.due_s {
            self.due_s = time_s;
            self.answered_s = None;
        }
        if time_s < self.due_s {
            return None;
        }
        self.due_s = time_s + ASK_EVERY_S;
        let question = &self.questions[self.asked % self.questions.len()];
        self.asked += 1;
        Some(question.frame())
    }

    /// Takes a frame of the robot, which may be an answer.
    pub fn take(&mut self, frame: &CanFrame, time_s: f64, robot: &mut RobotView) {
        for answer in self.questions.iter().filter_map(|it| it.answer(frame)) {
            if answer.page.name == SAFETY {
                self.answered_s = Some(time_s);
            }
            robot.take(&answer);
        }
    }

    /// Returns for how long in s the robot has not said whether it is safe; without end before the first answer.
    pub fn silence_s(&self, time_s: f64) -> f64 {
        self.answered_s
            .map_or(f64::INFINITY, |answered_s| time_s - answered_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_page_is_asked_for_in_turn_by_time() {
        let mut pages = Pages::default();
        let asked: Vec<_> = (0..100)
            .filter_map(|ms| Some((ms, pages.question(0.005 * f64::from(ms))?)))
            .collect();
        let times: Vec<_> = asked.iter().map(|(ms, _)| *ms).collect();
        assert_eq!(times, [0, 20, 40, 61, 81]);
        assert_eq!(asked[0].1, asked[3].1);
        assert!(asked[0].1 != asked[1].1 && asked[1].1 != asked[2].1);
    }

    #[test]
    fn a_robot_that_was_switched_on_anew_is_asked_at_once() {
        let mut pages = Pages::default();
        assert!(pages.question(60.0).is_some());
        pages.answered_s = Some(60.05);
        assert!(pages.question(60.06).is_none());
        assert!(pages.silence_s(60.06) < 0.02);
        assert!(pages.question(0.3).is_some());
        assert_eq!(pages.silence_s(0.3), f64::INFINITY);
        assert!(pages.question(0.35).is_none() && pages.question(0.41).is_some());
    }
}
