//! The robot's clock: hours of it, and where 32 bits of microseconds wrap.

use crate::{motion::Motion, run::Run, sensors::Sensors};

/// The same motion gives the same attitude to the bit whenever it happens.
#[test]
fn it_does_not_matter_when() {
    let at = |start_us: u64| {
        let sensors = Sensors {
            start_us,
            ..Sensors::real()
        };
        Run::new(Motion::carried_about(), sensors)
    };
    let mut soon = at(1_000_000);
    // 10 s before 32 bits wrap; three years.
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
