//! A lasting acceleration looks like a tilt. Only the gyro shows that it is none.

use crate::{
    figures::Figures,
    motion::{GRAVITY_MPS2, Motion, window},
    run::Run,
    sensors::Sensors,
};

/// The gyro holds the attitude to 0.2° for 4 s. A mean of the force over three seconds would tilt it by 60 % of the
/// apparent angle. A filter that models acceleration lets in less than a third.
#[test]
fn accelerating_and_braking_do_not_tilt_the_estimate() {
    let mut figures = Figures::default();
    for (push_mps2, seconds) in [(1.0, 3.0), (3.0, 1.0), (3.0, 3.0), (5.0, 1.0)] {
        let motion = Motion::at_rest().accelerated(move |t| {
            let forward = window(t, 20.0, 20.0 + seconds, 0.1);
            let back = window(t, 30.0, 30.0 + seconds, 0.1);
            [push_mps2 * (forward - back), 0.0, 0.0]
        });
        let mut run = Run::new(motion, Sensors::real());
        run.skip(20.0);
        let worst = run.worst(45.0);
        let name = format!("{push_mps2} m/s² for {seconds} s");
        let tilt_deg = (push_mps2 / GRAVITY_MPS2).atan().to_degrees();
        figures.at_most(
            &format!("{name} ({tilt_deg:.1}° of apparent tilt), inclination in °"),
            worst.inclination_deg,
            0.2 + tilt_deg * 0.3 * (seconds / 3.0_f64).sqrt(),
        );
        figures.at_most(&format!("{name}, heading in °"), worst.heading_deg, 2.0);
        run.skip(50.0);
        let after = run.worst(60.0);
        figures.at_most(
            &format!("{name}, inclination 15 s after in °"),
            after.inclination_deg,
            0.5,
        );
    }
    figures.done();
}

/// A circle to the left, entered and left within a second each.
#[derive(Clone, Copy)]
struct Circle {
    push_mps2: f64,
    rate_rps: f64,
}

impl Circle {
    const FROM_S: f64 = 20.0;
    const TO_S: f64 = 40.0;
    const TRACK_M: f64 = 0.42;

    fn share(t: f64) -> f64 {
        window(t, Self::FROM_S, Self::TO_S, 1.0)
    }

    /// Angle since the entry. The ramps count half.
    fn angle_rad(self, t: f64) -> f64 {
        let ramp = |from: f64| (t - from).clamp(0.0, 1.0).powi(2) / 2.0 + (t - from - 1.0).max(0.0);
        self.rate_rps * (ramp(Self::FROM_S) - ramp(Self::TO_S - 1.0))
    }

    /// The same before, in and after the circle.
    fn speed_mps(self) -> f64 {
        self.push_mps2 / self.rate_rps
    }

    fn motion(self) -> Motion {
        Motion::at_rest()
            .turning(move |t| [0.0, 0.0, (self.rate_rps * Self::share(t)).to_degrees()])
            .accelerated(move |t| {
                // Across the path to the left. The path starts along x.
                let (sin, cos) = self.angle_rad(t).sin_cos();
                let push_mps2 = self.push_mps2 * Self::share(t);
                [-push_mps2 * sin, push_mps2 * cos, 0.0]
            })
    }

    fn wheels_mps(self, t: f64) -> [f64; 2] {
        let difference_mps = self.rate_rps * Self::share(t) * Self::TRACK_M;
        [-0.5, 0.5].map(|side| self.speed_mps() + side * difference_mps)
    }
}

const CIRCLES: [Circle; 3] = [
    Circle {
        push_mps2: 2.0,
        rate_rps: 2.0,
    },
    Circle {
        push_mps2: 2.0,
        rate_rps: 4.0,
    },
    Circle {
        push_mps2: 1.0,
        rate_rps: 1.0,
    },
];

/// On a circle the acceleration rotates with the robot, so its mean is zero. Entering it changes the velocity by at
/// most twice the speed v. A mean over τ = 3 s tilts by 2 v/(g τ) at most, a filter that models acceleration by half of
/// that.
#[test]
fn driving_in_a_circle_does_not_tilt_the_estimate() {
    let mut figures = Figures::default();
    for circle in CIRCLES {
        let limit_deg = (circle.speed_mps() / (GRAVITY_MPS2 * 3.0)).to_degrees();
        let mut run = Run::new(circle.motion(), Sensors::real());
        run.skip(20.0);
        let worst = run.worst(50.0);
        let Circle {
            push_mps2,
            rate_rps,
        } = circle;
        let name = format!("circle, {push_mps2} m/s² at {rate_rps} rad/s");
        figures.at_most(
            &format!("{name}, inclination in °"),
            worst.inclination_deg,
            limit_deg,
        );
        figures.at_most(&format!("{name}, heading in °"), worst.heading_deg, 3.0);
    }
    figures.done();
}

/// Rolling wheels show the acceleration along the path and, with the yaw rate, the one across it. 0.7° of tilt are 0.12
/// m/s², an eighth of the weakest acceleration here.
#[test]
fn acceleration_that_the_wheels_show_is_no_tilt() {
    let mut figures = Figures::default();
    for circle in CIRCLES {
        let motion = circle.motion().rolling(move |t| circle.wheels_mps(t));
        let mut run = Run::new(motion, Sensors::real());
        run.skip(20.0);
        let worst = run.worst(50.0);
        let rate_rps = circle.rate_rps;
        figures.at_most(
            &format!("circle at {rate_rps} rad/s on wheels, inclination in °"),
            worst.inclination_deg,
            0.7,
        );
    }
    for (push_mps2, seconds) in [(1.0, 2.0), (2.5, 0.8)] {
        // The ramps take their time from the end of the plateau.
        let speed_mps = move |t: f64, from: f64| {
            let since = t - from;
            let ramp = |from: f64| {
                (since - from).clamp(0.0, 0.1).powi(2) / 0.2 + (since - from - 0.1).max(0.0)
            };
            push_mps2 * (ramp(0.0) - ramp(seconds - 0.1))
        };
        let motion = Motion::at_rest()
            .accelerated(move |t| {
                let forward = window(t, 20.0, 20.0 + seconds, 0.1);
                let back = window(t, 30.0, 30.0 + seconds, 0.1);
                [push_mps2 * (forward - back), 0.0, 0.0]
            })
            .rolling(move |t| [speed_mps(t, 20.0) - speed_mps(t, 30.0); 2]);
        let mut run = Run::new(motion, Sensors::real());
        run.skip(20.0);
        let worst = run.worst(45.0);
        figures.at_most(
            &format!("{push_mps2} m/s² for {seconds} s on wheels, inclination in °"),
            worst.inclination_deg,
            0.7,
        );
    }
    figures.done();
}
