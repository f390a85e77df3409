//! Trials whose true attitude is known in closed form, from files to figures.

mod damaged;
mod recorder;
mod resampling;

use recorder::{HZ200, NATIVE, Rate, Turn};
use robot_replay::{At, Figures, Mode, Trial, run};

fn figures(test: &str, turn: &Turn, rate: Rate, mode: Mode, at: At) -> Figures {
    let folder = recorder::folder(test);
    let trial = Trial::read(&recorder::write(&folder, "turn", rate, &turn.columns(rate))).unwrap();
    run(&trial, mode, [0.0; 3]).score(&trial, at).unwrap()
}

/// At 90 °/s, a delay of half a row in reference or samples would show as 0.22°.
#[test]
fn a_constant_turn_is_followed_at_any_rate_and_any_instant() {
    let turn = Turn {
        rate_dps: 90.0,
        reference_off_deg: 0.0,
    };
    for (name, rate) in [("turn-200", HZ200), ("turn-native", NATIVE)] {
        for mode in [Mode::NineAxis, Mode::SixAxis] {
            for at in [At::Samples, At::EveryTick] {
                let error = figures(name, &turn, rate, mode, at);
                assert!(error.total_deg < 0.1, "{name} {mode:?} {at:?}: {error:?}");
            }
        }
    }
}

#[test]
fn heading_is_absolute_with_magnetometer_and_has_one_free_offset_without() {
    let turn = Turn {
        rate_dps: 30.0,
        reference_off_deg: 12.0,
    };
    for at in [At::Samples, At::EveryTick] {
        let absolute = figures("off", &turn, HZ200, Mode::NineAxis, at);
        assert!((absolute.heading_deg - 12.0).abs() < 0.05, "{absolute:?}");
        assert!((absolute.total_deg - 12.0).abs() < 0.05, "{absolute:?}");
        assert!(absolute.inclination_deg < 0.05, "{absolute:?}");
        let free = figures("off", &turn, HZ200, Mode::SixAxis, at);
        assert!(free.total_deg < 0.05, "{free:?}");
    }
}

#[test]
fn an_added_offset_is_estimated_as_bias() {
    let turn = Turn {
        rate_dps: 0.0,
        reference_off_deg: 0.0,
    };
    let folder = recorder::folder("bias");
    let trial = Trial::read(&recorder::write(
        &folder,
        "rest",
        HZ200,
        &turn.columns(HZ200),
    ))
    .unwrap();
    let offset_dps = [0.5, -1.0, 0.75];
    let run = run(&trial, Mode::NineAxis, offset_dps);
    let found_dps = run.ticks.last().unwrap().gyro_bias_rps.map(f32::to_degrees);
    for (found, put_in) in found_dps.iter().zip(offset_dps) {
        assert!((found - put_in).abs() < 0.05, "{found_dps:?}");
    }
}

#[test]
fn without_a_reference_there_are_attitudes_but_no_errors() {
    let turn = Turn {
        rate_dps: 30.0,
        reference_off_deg: 0.0,
    };
    let folder = recorder::folder("no-reference");
    let columns = &turn.columns(HZ200)[..10];
    let trial = Trial::read(&recorder::write(&folder, "turn", HZ200, columns)).unwrap();
    let run = run(&trial, Mode::NineAxis, [0.0; 3]);
    assert_eq!(run.score(&trial, At::EveryTick), None);
    assert!(run.compare(&trial, At::EveryTick).is_empty());
    assert!(run.ticks.last().unwrap().valid);
}
