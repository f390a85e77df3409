//! Delay and hard iron of a robot in motion whose attitude is known exactly.

use super::*;
use robot_test_support::Random;

struct Moving {
    magnetic: MagneticHeading,
    random: Random,
    /// Delay of the magnetometer beyond its time stamps.
    late_s: f64,
    carried_ut: [f64; 3],
    /// Heading error of the estimated attitude, positive to the left.
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

    /// Returns the largest heading innovation of a window, in degrees.
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
        let noise = self.random.vector(0.3);
        let seen = std::array::from_fn(|axis| field[axis] + self.carried_ut[axis] + noise[axis]);
        if let Some(turn_rad) = self.magnetic.feed(to_f32(seen), &strapdown, 0.0) {
            // The heading is aligned: the attitude is the truth from here on.
            assert!(turn_rad.abs() < 0.5);
            self.magnetic.discard_world_frame();
        }
    }

    fn late_ms(&self) -> f32 {
        1e3 * self.magnetic.delay.seconds()
    }
}

fn quaternion(attitude: Rotation) -> Quaternion {
    let [w, x, y, z] = to_f32(attitude.to_wxyz());
    Quaternion { w, x, y, z }
}

#[test]
fn a_delay_is_compensated() {
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
fn hard_iron_is_compensated() {
    let mut robot = Moving::new(0.0, [6.0, -7.0, 5.0]);
    robot.run(200.0);
    let left_deg = robot.run(60.0);
    let found = robot.magnetic.hard_iron.compensation_ut();
    println!("{found:.1?} µT, headings within {left_deg:.2}°");
    let errors = [found[0] - 6.0, found[1] + 7.0, found[2] - 5.0];
    assert!(vector::norm(errors) < 2.5, "{found:?}");
}

/// The reference field is rotated or dropped with the world.
#[test]
fn another_heading_is_no_delay() {
    for (turn_rad, discarded) in [(0.1, false), (0.35, true), (-0.35, true)] {
        let mut robot = Moving::new(0.0, [0.0; 3]);
        robot.run(30.0);
        let before_ms = robot.late_ms();
        robot.world_rad = turn_rad;
        if discarded {
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
