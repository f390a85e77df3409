use robot_plant::time::MS;

use super::*;

/// Feeds one value a millisecond from 0 and returns the verdict.
fn run(bound: Bound, window: (Ps, Ps), values: &[f64]) -> Verdict {
    let window = Window {
        start: window.0 * MS,
        end: window.1 * MS,
    };
    let mut judge = Judge::new(bound, window);
    for (i, v) in values.iter().enumerate() {
        judge.see(i as Ps * MS, *v);
    }
    judge.finish("s", None, (values.len() as Ps - 1) * MS, None)
}

#[test]
fn bounds_hold_or_fail_on_their_edge() {
    let values = [9.0, 1.0, -2.0, 1.5, 9.0];
    for (bound, holds) in [
        (Bound::MaxAbs(2.0), true),
        (Bound::MaxAbs(1.99), false),
        (Bound::Min(-2.0), true),
        (Bound::Min(-1.9), false),
        (Bound::Max(1.5), true),
        (Bound::Max(1.4), false),
        (Bound::Equals(1.0), false),
        (
            Bound::Within {
                value: 0.0,
                tolerance: 2.0,
            },
            true,
        ),
        (
            Bound::Within {
                value: 0.1,
                tolerance: 2.0,
            },
            false,
        ),
    ] {
        let verdict = run(bound, (1, 3), &values);
        assert_eq!(verdict.failure.is_none(), holds, "{bound}: {verdict:?}");
    }
}

#[test]
fn flags_are_judged_by_their_bit() {
    let flags = [0.0, 5.0, 4.0, 6.0, 0.0];
    for (bound, holds) in [
        (Bound::HasBit(2), true),
        (Bound::HasBit(0), false),
        (Bound::LacksBit(3), true),
        (Bound::LacksBit(1), false),
    ] {
        assert_eq!(
            run(bound, (1, 3), &flags).failure.is_none(),
            holds,
            "{bound}"
        );
    }
}

#[test]
fn a_failure_names_the_worst_reading() {
    let verdict = run(Bound::MaxAbs(0.0), (0, 4), &[0.0, 1.0, -3.0, 2.0, 0.0]);
    let worst = Reading {
        at: 2 * MS,
        value: -3.0,
    };
    assert_eq!(verdict.decisive, Some(worst));
    assert_eq!(verdict.failure.as_deref(), Some("was -3 at 0.0020 s"));
}

#[test]
fn states_and_flags_are_called_by_their_names() {
    let flags = Meaning::Flags([(0, "lost".to_owned()), (3, "e-stop".to_owned())].into());
    let window = Window { start: 0, end: MS };
    let mut judge = Judge::new(Bound::LacksBit(3), window);
    judge.see(0, 9.0);
    let verdict = judge.finish("s", None, MS, Some(&flags));
    assert_eq!(verdict.expected, "lacks bit 3 (e-stop)");
    let why = verdict.failure.as_deref();
    assert_eq!(why, Some("was 9 (lost e-stop) at 0.0000 s"));
}

#[test]
fn nothing_seen_is_a_failure() {
    assert!(
        run(Bound::MaxAbs(1.0), (5, 9), &[0.0; 20])
            .failure
            .is_none()
    );
    assert!(run(Bound::MaxAbs(1.0), (5, 9), &[0.0; 8]).failure.is_some());
    let between_samples = Window {
        start: MS / 4,
        end: MS / 2,
    };
    let mut judge = Judge::new(Bound::Max(1.0), between_samples);
    judge.see(0, 0.0);
    judge.see(MS, 0.0);
    assert!(judge.finish("s", None, MS, None).failure.is_some());
}

#[test]
fn values_are_short_whatever_their_size() {
    assert_eq!(readable(0.592_001_23), "0.592001");
    assert_eq!(readable(-1.234_567_8e-300), "-1.23457e-300");
    assert_eq!(readable(0.0), "0");
    assert_eq!(readable(f64::NAN), "NaN");
}

#[test]
fn not_a_number_never_passes() {
    for bound in [Bound::MaxAbs(1.0), Bound::Min(0.0), Bound::Equals(0.0)] {
        assert!(run(bound, (0, 2), &[0.0, f64::NAN, 0.0]).failure.is_some());
    }
}

#[test]
fn a_crossing_happens_inside_the_window() {
    let step = [0.0, 0.0, 1.0, 1.0, 0.0];
    assert!(run(Bound::RisesAbove(0.5), (0, 3), &step).failure.is_none());
    assert!(run(Bound::RisesAbove(0.5), (2, 3), &step).failure.is_some());
    assert!(run(Bound::FallsBelow(0.5), (2, 4), &step).failure.is_none());
    assert!(run(Bound::FallsBelow(0.5), (0, 3), &step).failure.is_some());
}

#[test]
fn an_instant_is_judged_once_at_the_next_sample() {
    let window = Window::instant(3 * MS / 2);
    let mut judge = Judge::new(Bound::Equals(2.0), window);
    for (at, value) in [(MS, 1.0), (2 * MS, 2.0), (3 * MS, 3.0)] {
        judge.see(at, value);
    }
    let verdict = judge.finish("s", None, 3 * MS, None);
    assert_eq!((verdict.readings, verdict.failure), (1, None));
}

#[test]
fn a_flag_is_found_by_its_name_or_the_known_ones_are_listed() {
    let flags = Meaning::Flags([(0, "lost".to_owned()), (3, "e-stop".to_owned())].into());
    let flag = |name: &str, set| NamedFlag {
        name: name.to_owned(),
        set,
    };
    let bound = |f: NamedFlag| f.bound("s", Some(&flags));
    assert_eq!(bound(flag("e-stop", true)), Ok(Bound::HasBit(3)));
    assert_eq!(bound(flag("lost", false)), Ok(Bound::LacksBit(0)));
    let why = bound(flag("hot", true)).unwrap_err().to_string();
    assert!(why.contains("lost, e-stop"), "{why}");
    assert!(flag("lost", true).bound("s", None).is_err());
}
