//! Samples that are saturated, lost, late or repeated.

use robot_test_support::{Vector, dot};

use crate::{
    figures::Figures,
    motion::{Motion, carried_rate_dps, window},
    run::Run,
    sensors::{Sensors, Timing},
};

/// 2,300 °/s for 0.3 s, of which the gyro shows 2,000. Up to 90° are lost, and field and gravity have to bring them
/// back.
fn impact(axis: usize) -> Motion {
    Motion::at_rest().turning(move |t| {
        let mut rate: Vector = [0.0, 0.0, 20.0 * (0.5 * t).sin()];
        rate[axis] += 2_300.0 * window(t, 30.0, 30.3, 0.02);
        rate
    })
}

#[test]
fn a_saturated_gyro_is_recovered_from() {
    let mut figures = Figures::default();
    for axis in 0..3 {
        let mut run = Run::new(impact(axis), Sensors::real());
        run.skip(30.31);
        let at_once = run.error();
        println!(
            "after the impact about axis {axis}: {:.1}° off",
            at_once.total_deg
        );
        run.skip(35.0);
        let soon = run.worst(60.0);
        run.skip(60.0);
        let later = run.worst(70.0);
        let name = format!("saturated about axis {axis}");
        figures.at_most(
            &format!("{name}, inclination after 5 s in °"),
            soon.inclination_deg,
            3.0,
        );
        figures.at_most(
            &format!("{name}, heading after 5 s in °"),
            soon.heading_deg,
            10.0,
        );
        figures.at_most(
            &format!("{name}, inclination after 30 s in °"),
            later.inclination_deg,
            0.5,
        );
        figures.at_most(
            &format!("{name}, heading after 30 s in °"),
            later.heading_deg,
            2.0,
        );
        figures.at_most(
            &format!("{name}, gyro bias after 40 s in °/s"),
            run.bias_error_dps(),
            0.3,
        );
    }
    figures.done();
}

/// After a rest that showed the bias, the robot hits ten kerbs, one every 3 s. It loses 2 m/s within 10 ms, 0.8 of that
/// beyond 12 g, and regains it within 0.7 s. A mean over three seconds would tilt by 3.9° without the saturated samples
/// and by 1.6° with them.
#[test]
fn kerbs_beyond_the_range_do_not_tilt_the_estimate() {
    let mut figures = Figures::default();
    let motion = Motion::at_rest().accelerated(|t| {
        let since = if t < 12.0 { 0.0 } else { t.rem_euclid(3.0) };
        let stop = window(since, 1.0, 1.011, 0.001);
        let push = window(since, 1.2, 2.0, 0.1);
        [2.0 / 0.7 * push - 200.0 * stop, 0.0, 0.0]
    });
    let mut run = Run::new(motion, Sensors::real());
    run.skip(10.0);
    let worst = run.worst(42.0);
    figures.at_most(
        "kerbs beyond 12 g, inclination in °",
        worst.inclination_deg,
        2.5,
    );
    figures.done();
}

/// In an even rotation the neighbours of a gap show the rate in it, up to the 100 ms that are bridged. The force of the
/// last 5 ms stands for all of the gap, though its level part has rotated by then.
#[test]
fn a_gap_in_an_even_rotation_costs_nothing() {
    let mut figures = Figures::default();
    for lost in [1, 5, 19] {
        let motion = Motion::at_rest()
            .turning(|t| [40.0, -30.0, 200.0].map(|rate| rate * window(t, 10.0, 1e9, 0.2)));
        let sensors = Sensors::ideal().losing(move |number| number > 2_400 && number % 400 < lost);
        let mut run = Run::new(motion, sensors);
        run.skip(11.0);
        let worst = run.worst(60.0);
        let name = format!("{lost} samples lost every 2 s");
        // The output is extrapolated for 25 ms, then it stays until the next sample.
        let standing_s = (lost as f64 + 1.0) * 0.005 - 0.025;
        let limit_deg = 0.3 + 206.2 * standing_s.max(0.0);
        figures.at_most(&format!("{name}, total in °"), worst.total_deg, limit_deg);
        run.skip(60.4);
        let between = run.worst(61.9);
        figures.at_most(
            &format!("{name}, total between two holes in °"),
            between.total_deg,
            0.3 + 4.0 * 0.005 * lost as f64,
        );
    }
    figures.done();
}

/// Every twentieth sample is lost at random in motion. 5 ms at up to 700 °/s² are 0.01° each time.
#[test]
fn lost_samples_in_motion_cost_little() {
    let mut figures = Figures::default();
    for (lost, limit_deg) in [(1, 2.0), (5, 3.0)] {
        let sensors = Sensors::real().losing(move |number| number % 100 < lost);
        let mut run = Run::new(Motion::carried_about(), sensors);
        run.skip(10.0);
        let worst = run.worst(120.0);
        let name = format!("{lost} of 100 samples lost in motion");
        figures.at_most(&format!("{name}, total in °"), worst.total_deg, limit_deg);
    }
    figures.done();
}

/// True time stamps make up for any jitter. Wrong ones cost rate × error for one sample.
#[test]
fn late_and_jittering_samples_cost_little() {
    let mut figures = Figures::default();
    let steady = || Motion::at_rest().turning(|t| [0.0, 0.0, 200.0 * window(t, 5.0, 1e9, 1.0)]);
    for (timing, limit_deg) in [
        (Timing::Jitter, 0.2),
        // 2 ms of error, and 3 ms of lag until the tick that sees the sample, at 200 °/s.
        (Timing::WrongStamps, 0.2 + 200.0 * 0.002),
        (Timing::Late, 0.2),
    ] {
        let mut run = Run::new(steady(), Sensors::ideal().timed(timing));
        run.skip(7.0);
        let worst = run.worst(60.0);
        figures.at_most(
            &format!("{timing:?} at 200 °/s, total in °"),
            worst.total_deg,
            limit_deg,
        );
        let mut run = Run::new(Motion::carried_about(), Sensors::real().timed(timing));
        run.skip(10.0);
        let worst = run.worst(60.0);
        figures.at_most(
            &format!("{timing:?} in motion, total in °"),
            worst.total_deg,
            2.5,
        );
    }
    figures.done();
}

/// A sample with the same time stamp is not used again, whatever its values.
#[test]
fn a_repeated_time_stamp_is_no_new_sample() {
    let motion = || Motion::at_rest().turning(carried_rate_dps);
    let mut once = Run::new(motion(), Sensors::real());
    let mut again = Run::new(motion(), Sensors::real());
    for _ in 0..5_000 {
        once.step();
        again.step_then_repeat_other_values();
        assert_eq!(once.estimate.q_wxyz, again.estimate.q_wxyz);
        assert_eq!(once.estimate.gyro_bias_rps, again.estimate.gyro_bias_rps);
    }
}

/// The robot is turned over within three seconds without samples. Then rest shows the tilt and the field the heading.
/// While the tilt jumps, the estimate is not valid.
#[test]
fn a_robot_turned_over_without_samples_is_found_out() {
    let mut figures = Figures::default();
    for axis in 0..3 {
        let motion = Motion::at_rest().turning(move |t| {
            let mut rate: Vector = [0.0; 3];
            // Area of the trapezium: 170°.
            rate[axis] = 85.0 * window(t, 10.5, 12.75, 0.25);
            rate
        });
        let sensors = Sensors::real().losing(|number| (2_060..2_580).contains(&number));
        let mut run = Run::new(motion, sensors);
        run.skip(13.0);
        while run.time_s() < 30.0 {
            let before = run.up();
            run.step();
            let jump_deg = dot(before, run.up()).min(1.0).acos().to_degrees();
            assert!(
                jump_deg < 5.0 || !run.estimate.valid,
                "up jumps by {jump_deg}° and counts"
            );
        }
        let name = format!("turned over about axis {axis} while silent");
        let worst = run.worst(60.0);
        figures.at_most(
            &format!("{name}, inclination after 17 s in °"),
            worst.inclination_deg,
            0.5,
        );
        figures.at_most(
            &format!("{name}, heading after 17 s in °"),
            worst.heading_deg,
            2.0,
        );
        assert!(run.estimate.valid);
    }
    figures.done();
}
