//! Joint stepping: a pair of keys for each joint.

use std::{collections::BTreeMap, time::Duration};

use super::key::{Action, StopKey};

/// Keys that add and take away, for up to eight joints.
const PAIRS: [(char, char); 8] = [
    ('q', 'a'),
    ('w', 's'),
    ('e', 'd'),
    ('r', 'f'),
    ('t', 'g'),
    ('y', 'h'),
    ('u', 'j'),
    ('i', 'k'),
];
/// Steps of a goal in a period on the way home.
const HOME_STEP: i32 = 40;
/// Step sizes, in steps of the servo; 11 are a degree.
const SIZES: [i32; 6] = [1, 5, 10, 20, 50, 100];

/// A line of the screen.
pub struct Row {
    pub name: String,
    pub keys: (char, char),
    pub goal: i32,
    pub position: Option<i32>,
    pub least: i32,
    pub most: i32,
}

/// The state of the screen.
pub struct JointPanel {
    rows: Vec<Row>,
    size: usize,
    stop: StopKey,
    is_engaged: bool,
    /// Where the joints are on their way to, which any key ends.
    way: Option<BTreeMap<String, i32>>,
    pub note: String,
}

impl JointPanel {
    /// Takes names, limits and present positions.
    pub fn new(joints: Vec<(String, i32, i32)>, positions: &BTreeMap<String, i32>) -> Self {
        let row = |((name, least, most), keys): ((String, i32, i32), (char, char))| Row {
            goal: positions.get(&name).copied().unwrap_or((least + most) / 2),
            position: positions.get(&name).copied(),
            name,
            keys,
            least,
            most,
        };
        Self {
            rows: joints.into_iter().zip(PAIRS).map(row).collect(),
            size: 2,
            stop: StopKey::default(),
            is_engaged: true,
            way: None,
            note: String::new(),
        }
    }

    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Steps of a key press.
    pub fn step(&self) -> i32 {
        SIZES.get(self.size).copied().unwrap_or(1)
    }

    pub fn is_engaged(&self) -> bool {
        self.is_engaged
    }

    /// Goals of all joints.
    pub fn goals(&self) -> BTreeMap<String, i32> {
        self.rows
            .iter()
            .map(|row| (row.name.clone(), row.goal))
            .collect()
    }

    /// Takes what the servos report.
    pub fn take_positions(&mut self, positions: &BTreeMap<String, i32>) {
        for row in &mut self.rows {
            row.position = positions.get(&row.name).copied();
        }
    }

    /// Makes the present positions the goals, as the arm does when it holds.
    pub fn goals_from_positions(&mut self) {
        for row in &mut self.rows {
            row.goal = row.position.unwrap_or(row.goal).clamp(row.least, row.most);
        }
    }

    /// Goes back to goals that the arm has, and ends a way.
    pub fn take_back(&mut self, goals: &BTreeMap<String, i32>) {
        self.way = None;
        for row in &mut self.rows {
            row.goal = goals.get(&row.name).copied().unwrap_or(row.goal);
        }
    }

    /// Begins a soft way to a pose.
    pub fn go(&mut self, pose: BTreeMap<String, i32>) {
        self.way = Some(pose);
    }

    /// Takes the next step of a way. To be called once in a period.
    pub fn advance(&mut self) -> Action {
        let Some(way) = &self.way else {
            return Action::Nothing;
        };
        let mut is_there = true;
        for row in &mut self.rows {
            let goal = way.get(&row.name).copied().unwrap_or(row.goal);
            let goal = goal.clamp(row.least, row.most);
            row.goal += (goal - row.goal).clamp(-HOME_STEP, HOME_STEP);
            is_there &= row.goal == goal;
        }
        if is_there {
            self.way = None;
        }
        Action::Send
    }

    /// Takes a key.
    pub fn press(&mut self, key: char, now: Duration) -> Action {
        self.note.clear();
        self.way = None;
        match key {
            ' ' => return self.stopped(now),
            // Also while torque is on: a joint may have lost its own.
            '\n' => {
                self.is_engaged = true;
                return Action::Engage;
            }
            '[' => self.size = self.size.saturating_sub(1),
            ']' => self.size = (self.size + 1).min(SIZES.len() - 1),
            'x' => {
                self.is_engaged = false;
                return Action::Release;
            }
            '0' if self.is_engaged => return Action::Home,
            '\x1b' => return Action::End,
            _ if !self.is_engaged => self.note = "no torque: Enter switches it on".to_owned(),
            _ => return self.stepped(key),
        }
        Action::Nothing
    }

    fn stopped(&mut self, now: Duration) -> Action {
        let action = self.stop.press(now);
        if action == Action::Release {
            self.is_engaged = false;
        }
        action
    }

    fn stepped(&mut self, key: char) -> Action {
        let step = self.step();
        for row in &mut self.rows {
            let wanted = match key {
                _ if key == row.keys.0 => row.goal + step,
                _ if key == row.keys.1 => row.goal - step,
                _ => continue,
            };
            row.goal = wanted.clamp(row.least, row.most);
            if row.goal != wanted {
                self.note = format!("{} is at its limit of {}", row.name, row.goal);
            }
            return Action::Send;
        }
        Action::Nothing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel() -> JointPanel {
        let joints = [("pan", 1000, 3000), ("lift", 2000, 2100)];
        let joints = joints.map(|(name, least, most)| (name.to_owned(), least, most));
        let positions = BTreeMap::from([("pan".to_owned(), 2048), ("lift".to_owned(), 2095)]);
        JointPanel::new(joints.to_vec(), &positions)
    }

    #[test]
    fn keys_step_their_joint_up_to_its_limit() {
        let mut panel = panel();
        assert_eq!(panel.press('q', Duration::ZERO), Action::Send);
        assert_eq!(panel.goals()["pan"], 2058);
        panel.press('a', Duration::ZERO);
        panel.press(']', Duration::ZERO);
        panel.press('a', Duration::ZERO);
        assert_eq!(panel.goals()["pan"], 2028);
        assert_eq!(panel.press('w', Duration::ZERO), Action::Send);
        assert_eq!(panel.goals()["lift"], 2100);
        assert_eq!(panel.note, "lift is at its limit of 2100");
        assert_eq!(panel.press('z', Duration::ZERO), Action::Nothing);
    }

    #[test]
    fn step_sizes_have_ends() {
        let mut panel = panel();
        for _ in 0..20 {
            panel.press(']', Duration::ZERO);
        }
        assert_eq!(panel.step(), 100);
        for _ in 0..20 {
            panel.press('[', Duration::ZERO);
        }
        assert_eq!(panel.step(), 1);
    }

    #[test]
    fn without_torque_nothing_moves_until_enter() {
        let mut panel = panel();
        assert_eq!(panel.press('x', Duration::ZERO), Action::Release);
        assert_eq!(panel.press('q', Duration::ZERO), Action::Nothing);
        assert_eq!(panel.press('0', Duration::ZERO), Action::Nothing);
        assert_eq!(panel.goals()["pan"], 2048);
        panel.take_positions(&BTreeMap::from([("pan".to_owned(), 1500)]));
        panel.goals_from_positions();
        assert_eq!(panel.press('\n', Duration::ZERO), Action::Engage);
        assert_eq!(panel.press('q', Duration::ZERO), Action::Send);
        assert_eq!(panel.goals()["pan"], 1510);
    }

    #[test]
    fn goals_that_were_not_sent_are_taken_back() {
        let mut panel = panel();
        let before = panel.goals();
        panel.press('q', Duration::ZERO);
        panel.go(BTreeMap::from([("lift".to_owned(), 2000)]));
        panel.take_back(&before);
        assert_eq!(panel.goals(), before);
        assert_eq!(panel.advance(), Action::Nothing);
    }

    #[test]
    fn the_way_home_is_soft_and_any_key_ends_it() {
        let mut panel = panel();
        assert_eq!(panel.advance(), Action::Nothing);
        assert_eq!(panel.press('0', Duration::ZERO), Action::Home);
        panel.go(BTreeMap::from([
            ("pan".to_owned(), 2148),
            ("lift".to_owned(), 2048),
        ]));
        assert_eq!(panel.advance(), Action::Send);
        assert_eq!((panel.goals()["pan"], panel.goals()["lift"]), (2088, 2055));
        assert_eq!(panel.press(' ', Duration::ZERO), Action::Hold);
        assert_eq!(panel.advance(), Action::Nothing);
        panel.go(BTreeMap::from([("pan".to_owned(), 9000)]));
        let steps = (0..100)
            .take_while(|_| panel.advance() == Action::Send)
            .count();
        assert_eq!((panel.goals()["pan"], steps), (3000, 23));
    }
}
