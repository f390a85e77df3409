//! Turns wishes into drive frames, which take the place of the sticks (docs/pc-link.md#drive).

use robot_app::{domain::PcDrive, link::DriveFrame};

use super::{RobotView, Wish, driver::ramped};

/// Speed and turn go from rest to their highest share in this time, height and roll from their middle to an end.
const TRAVEL_S: f64 = 0.5;

/// Makes drive frames, one after the other. Speed and turn end with the dead-man; height and roll stay, as knobs do.
#[derive(Clone, Debug)]
pub struct SticksDriver {
    /// Highest share of speed and turn.
    most: f64,
    forward: f64,
    turn: f64,
    height: f64,
    roll: f64,
    /// After a stop the user has to let go once before anything moves.
    must_let_go: bool,
    /// Changes in each frame, so that no frame repeats the one before.
    count: u8,
}

impl SticksDriver {
    /// `most` is the highest share of the robot's highest speed and turn, above 0 and at most 1.
    pub fn new(most: f64) -> Self {
        Self {
            most,
            forward: 0.0,
            turn: 0.0,
            height: 0.0,
            roll: 0.0,
            must_let_go: true,
            count: 0,
        }
    }

    /// Returns the frame for `dt_s` after the one before.
    pub fn step(&mut self, dt_s: f64, wish: Wish, robot: &RobotView) -> DriveFrame {
        if robot.obstacle().is_some() {
            return self.rest();
        }
        self.must_let_go &= wish.is_held;
        if !wish.is_held || self.must_let_go {
            (self.forward, self.turn) = (0.0, 0.0);
            return self.frame(false);
        }
        let step = dt_s / TRAVEL_S;
        let share = |wish: f64| wish.clamp(-1.0, 1.0) * self.most;
        self.forward = ramped(self.forward, share(wish.forward), step * self.most);
        self.turn = ramped(self.turn, share(wish.turn), step * self.most);
        let knob = |at: f64, wish: f64| (at + wish.clamp(-1.0, 1.0) * step).clamp(-1.0, 1.0);
        self.height = knob(self.height, wish.raise);
        self.roll = knob(self.roll, wish.tilt);
        self.frame(wish.jump)
    }

    /// Returns a frame from rest, with height and roll in their middle.
    pub fn rest(&mut self) -> DriveFrame {
        *self = Self {
            count: self.count,
            ..Self::new(self.most)
        };
        self.frame(false)
    }

    /// Returns true while a held dead-man has no effect, because it was held through a stop.
    pub fn must_let_go(&self) -> bool {
        self.must_let_go
    }

    /// Returns the present shares: forward, turn to the left, height, roll.
    pub fn shares(&self) -> [f64; 4] {
        [self.forward, self.turn, self.height, self.roll]
    }

    fn frame(&mut self, jump: bool) -> DriveFrame {
        self.count = self.count.wrapping_add(1);
        let [vx, wz, height, roll] = self.shares().map(|share| share as f32);
        DriveFrame(PcDrive {
            vx,
            wz,
            height,
            roll,
            jump,
            count: self.count,
        })
    }
}

#[cfg(test)]
mod tests {
    use robot_app::link::{Keys, Uplink};

    use super::*;

    const DT_S: f64 = 0.01;
    const FORWARD: Wish = Wish {
        is_held: true,
        forward: 1.0,
        ..Wish::NONE
    };

    fn robot(keys: Keys) -> RobotView {
        let mut view = RobotView::default();
        view.state = Uplink {
            keys,
            ..Uplink::default()
        };
        view
    }

    fn ready() -> RobotView {
        robot(Keys::B | Keys::F1 | Keys::START)
    }

    /// A driver whose user has let go once.
    fn driver() -> SticksDriver {
        let mut driver = SticksDriver::new(0.4);
        driver.step(DT_S, Wish::NONE, &ready());
        driver
    }

    fn after(driver: &mut SticksDriver, wish: Wish, steps: usize) -> PcDrive {
        let frames = (0..steps).map(|_| driver.step(DT_S, wish, &ready()).0);
        frames.last().expect("a step")
    }

    #[test]
    fn speed_rises_to_its_share_and_ends_with_the_dead_man() {
        let mut driver = driver();
        let first = after(&mut driver, FORWARD, 1);
        assert!((first.vx - 0.008).abs() < 1e-6, "{first:?}");
        let full = after(&mut driver, FORWARD, 60);
        assert!((full.vx - 0.4).abs() < 1e-6 && full.wz == 0.0, "{full:?}");
        assert_eq!(after(&mut driver, Wish::NONE, 1).vx, 0.0);
        let turn = Wish {
            is_held: true,
            turn: -1.0,
            ..Wish::NONE
        };
        assert!((after(&mut driver, turn, 60).wz + 0.4).abs() < 1e-6);
    }

    #[test]
    fn height_and_roll_stay_where_they_were_put() {
        let mut driver = driver();
        let up = Wish {
            is_held: true,
            raise: 1.0,
            tilt: -1.0,
            ..Wish::NONE
        };
        after(&mut driver, up, 25);
        let kept = after(&mut driver, Wish::NONE, 100);
        assert!((kept.height - 0.5).abs() < 1e-5 && (kept.roll + 0.5).abs() < 1e-5);
        let most = after(&mut driver, up, 100);
        assert_eq!((most.height, most.roll), (1.0, -1.0));
        let frame = driver.step(DT_S, up, &robot(Keys::B)).0;
        assert_eq!((frame.height, frame.roll), (0.0, 0.0));
    }

    /// The robot stops or is armed while the user holds everything: it must not start, or jump, by itself.
    #[test]
    fn after_a_stop_nothing_counts_until_the_dead_man_was_let_go() {
        let mut driver = driver();
        let all = Wish {
            raise: 1.0,
            jump: true,
            ..FORWARD
        };
        assert!(after(&mut driver, all, 1).jump);
        driver.step(DT_S, all, &robot(Keys::A | Keys::F1));
        let held = after(&mut driver, all, 100);
        assert!(driver.must_let_go());
        assert_eq!((held.vx, held.height, held.jump), (0.0, 0.0, false));
        after(&mut driver, Wish::NONE, 1);
        assert!(after(&mut driver, all, 1).jump);
        let unheld = Wish {
            is_held: false,
            ..all
        };
        assert!(!after(&mut driver, unheld, 1).jump);
    }

    #[test]
    fn no_frame_is_the_same_as_the_one_before() {
        let mut driver = driver();
        let frames = (0..600).map(|_| driver.step(DT_S, FORWARD, &ready()).encode());
        let frames: Vec<_> = frames.collect();
        assert!(frames.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
