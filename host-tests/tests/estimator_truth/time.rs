//! The robot's clock: late ticks, hours of operation, and where 32 bits of microseconds wrap.

use robot_test_support::Random;

use crate::{
    figures::Figures,
    motion::{Motion, window},
    run::Run,
    sensors::Sensors,
};

/// The same motion gives the same attitude, bit by bit, at any time.
#[test]
fn the_start_time_does_not_matter() {
    let at = |start_us: u64| {
        let sensors = Sensors {
            start_us,
            ..Sensors::real()
        };
        Run::new(Motion::carried_about(), sensors)
    };
    let mut soon = at(1_000_000);
    // 10 s before 32 bits wrap, and after three years.
    let later = [(1 << 32) - 10_000_000, 100_000_000_000_000];
    let mut later = later.map(at);
    for _ in 0..20_000 {
        soon.step();
        for run in &mut later {
            run.step();
            assert_eq!(soon.estimate.q_wxyz, run.estimate.q_wxyz);
            assert_eq!(soon.estimate.gyro_bias_rps, run.estimate.gyro_bias_rps);
            assert_eq!(soon.estimate.valid, run.estimate.valid);
        }
    }
}

/// Ticks at random intervals of 1 … 4 ms. Each output is for its own tick.
#[test]
fn late_ticks_cost_nothing() {
    let mut figures = Figures::default();
    let motion = Motion::at_rest()
        .turning(|t| [50.0, -70.0, 300.0].map(|rate| rate * window(t, 3.0, 1e9, 1.0)));
    let mut run = Run::new(motion, Sensors::ideal());
    let mut noise = Random::new(7);
    let mut total_deg = 0.0_f64;
    while run.time_s() < 60.0 {
        run.step_after(1 + noise.below(4) as u64);
        if run.time_s() > 5.0 {
            total_deg = total_deg.max(run.error().total_deg);
            assert!(run.estimate.valid);
        }
    }
    figures.at_most("late ticks at 312 °/s, total in °", total_deg, 0.3);
    figures.done();
}
