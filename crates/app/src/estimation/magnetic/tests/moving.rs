//! A robot in motion whose attitude is known exactly: what the magnetometer hides is found.

use super::*;
use crate::estimation::testing::Random;

struct Moving {
    magnetic: MagneticHeading,
    random: Random,
    /// The magnetometer is this late, beyond what its stamps say.
    late_s: f64,
    carried_ut: [f64; 3],
    /// The world is believed to be turned to the left by this.
    world_rad: f64,
    samples: u32,
}

impl Moving {
    fn new(late_s: f64, carried_ut: [f64; 3]) -> Self {
        Self {
            magnetic: MagneticHeading::new(),
            random: Random::new(41),
            late_s,
            carried_ut,
            world_rad: 0.0,
            samples: 0,
        }
    }

    fn attitude(t: f64) -> Rotation {
        Rotation::by([0.0, 0.0, 3.0 * (0.8 * t).sin()])
            .then_in_body(Rotation::by([0.0, 1.1 * (0.7 * t).sin(), 0.0]))
            .then_in_body(Rotation::by([1.2 * (0.5 * t).sin(), 0.0, 0.0]))
    }

    /// Worst heading of a window, degrees.
    fn run(&mut self, seconds: f64) -> f32 {
        let windows = (seconds / 0.2).round() as u32;
        let mut worst_deg = 0.0;
        for _ in 0..windows {
            for _ in 0..10 {
                self.sample();
            }
            if let Some(heading) = self.magnetic.close_window(WINDOW_S, SURE).heading {
                worst_deg = scalar::max(worst_deg, heading.innovation.to_degrees().abs());
            }
        }
        worst_deg
    }

    fn sample(&mut self) {
        self.samples += 1;
        let t = 1.0 + f64::from(self.samples) * 0.02;
        let (now, soon) = (Self::attitude(t), Self::attitude(t + 1e-4));
        let rate_rps = now.inverse().to(soon.inverse()).map(|angle| -angle / 1e-4);
        let mut strapdown = Strapdown::new();
        strapdown.attitude = quaternion(Rotation::by([0.0, 0.0, self.world_rad]).then_in_body(now));
        strapdown.rate_rps = to_f32(rate_rps);
        let field = Self::attitude(t - self.late_s).seen_from_body(EARTH_UT);
        let noise = self.random.normals(0.3);
        let seen = std::array::from_fn(|axis| field[axis] + self.carried_ut[axis] + noise[axis]);
        if let Some(turn_rad) = self.magnetic.feed(to_f32(seen), &strapdown, 0.0) {
            // As when north is found: from here on the truth.
            assert!(turn_rad.abs() < 0.5);
            self.magnetic.discard_world_frame();
        }
    }

    fn late_ms(&self) -> f32 {
        1e3 * self.magnetic.delay.seconds()
    }
}

/// From the rotation vector, in parts small enough for the series.
fn quaternion(attitude: Rotation) -> Quaternion {
    let part = Rotation::by([0.0; 3])
        .to(attitude)
        .map(|angle| 0.25 * angle);
    let quarter = Quaternion::from_rotation(to_f32(part));
    let half = quarter.after(quarter);
    half.after(half).normalised()
}

#[test]
fn a_late_magnetometer_is_set_right() {
    let mut robot = Moving::new(0.015, [0.0; 3]);
    robot.run(200.0);
    assert!(
        (robot.late_ms() - 15.0).abs() < 2.5,
        "{} ms",
        robot.late_ms()
    );
    // 15 ms at 2.4 rad/s are 2°.
    let worst_deg = robot.run(60.0);
    println!("{:.1} ms, headings within {worst_deg:.2}°", robot.late_ms());
    assert!(worst_deg < 1.0, "{worst_deg}");
}

#[test]
fn a_magnet_on_the_robot_is_taken_out() {
    let mut robot = Moving::new(0.0, [6.0, -7.0, 5.0]);
    robot.run(200.0);
    let left_deg = robot.run(60.0);
    let found = robot.magnetic.hard_iron.compensation_ut();
    println!("{found:.1?} µT, headings within {left_deg:.2}°");
    let errors = [found[0] - 6.0, found[1] + 7.0, found[2] - 5.0];
    assert!(vector::norm(errors) < 2.5, "{found:?}");
}

/// What is remembered of the field is turned along when the world is.
#[test]
fn another_north_is_no_delay() {
    for (turn_rad, forgotten) in [(0.1, false), (0.35, true), (-0.35, true)] {
        let mut robot = Moving::new(0.0, [0.0; 3]);
        robot.run(30.0);
        let before_ms = robot.late_ms();
        robot.world_rad = turn_rad;
        if forgotten {
            robot.magnetic.discard_world_frame();
        } else {
            robot.magnetic.rotate_world([0.0, 0.0, turn_rad as f32]);
        }
        for _ in 0..40 {
            robot.run(0.2);
            let moved_ms = robot.late_ms() - before_ms;
            assert!(moved_ms.abs() < 0.5, "{turn_rad}: {moved_ms} ms");
        }
    }
}
