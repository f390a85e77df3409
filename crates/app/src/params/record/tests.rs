//! Records written by hand, with IEEE 754 values in hex.

use super::*;
use crate::{
    motor::layout::{ROBOT_LAYOUT, RS00_LAYOUT},
    tuning::PARAMETERS,
};

/// Heater settings: 45 °C, 0.5, 0.25, 0.75.
const HEATER: [u32; 4] = [0x4234_0000, 0x3F00_0000, 0x3E80_0000, 0x3F40_0000];
const NAN: u32 = 0x7FC0_0000;

fn position(number: u8) -> GroupIndex {
    let mut groups = PARAMETERS.iter();
    groups.position(|group| group.number == number).unwrap()
}

fn record(key: u8, variant: u8, version: u8, values: &[u32]) -> Record {
    Record {
        id: RecordId { key, variant },
        version,
        values: heapless::Vec::from_slice(values).unwrap(),
    }
}

fn loaded(record: &Record, groups: &[ParameterGroup]) -> (LoadOutcome, RobotConfig) {
    let mut config = RobotConfig::default();
    let verdict = load(record, groups, &ROBOT_LAYOUT, &mut config);
    (verdict, config)
}

/// `PARAMETERS` of a later firmware, in which the heater's group has grown to its present size.
fn later_firmware(version: u8) -> [ParameterGroup; 1] {
    let heater = &PARAMETERS[position(7)];
    assert_eq!(heater.name, "heater");
    [ParameterGroup { version, ..*heater }]
}

#[test]
fn a_record_holds_its_values_in_index_order() {
    let (verdict, config) = loaded(&record(7, 0, 1, &HEATER), &PARAMETERS);
    assert_eq!(verdict, LoadOutcome::Loaded(position(7)));
    let heater = config.heater;
    assert_eq!((heater.target_c, heater.kp), (45.0, 0.5));
    assert_eq!((heater.ki, heater.max_duty), (0.25, 0.75));
    let encoded = encode(&PARAMETERS[position(7)], &config, &ROBOT_LAYOUT);
    assert_eq!(encoded, record(7, 0, 1, &HEATER));
}

#[test]
fn every_group_is_restored_unchanged() {
    let mut tuned = RobotConfig::default();
    for parameter in PARAMETERS.iter().flat_map(|group| group.parameters) {
        parameter.write(&mut tuned, parameter.max).unwrap();
    }
    // Fields in which these maxima would reverse a direction, and channels without travel.
    tuned.mag = RobotConfig::default().mag;
    tuned.mag.bias_ut = [-12.5, 3.0, 0.1];
    for (count, channel) in (0..).zip([
        &mut tuned.radio.steering,
        &mut tuned.radio.drive,
        &mut tuned.radio.select,
        &mut tuned.radio.dead_man,
        &mut tuned.radio.enable,
        &mut tuned.radio.mode,
        &mut tuned.radio.e_stop,
    ]) {
        (channel.low, channel.centre) = (count, 1_000 + count);
    }
    for joint in &mut tuned.joints {
        joint.min_rad = -0.1;
    }
    let mut config = RobotConfig::default();
    for (position, group) in PARAMETERS.iter().enumerate() {
        let record = encode(group, &tuned, &ROBOT_LAYOUT);
        assert_eq!(record.values.len(), group.parameters.len());
        let verdict = load(&record, &PARAMETERS, &ROBOT_LAYOUT, &mut config);
        assert_eq!(verdict, LoadOutcome::Loaded(position), "{}", group.name);
    }
    assert_eq!(config, tuned);
}

#[test]
fn an_earlier_version_keeps_its_values_and_new_settings_get_defaults() {
    let groups = later_firmware(3);
    for (version, held) in [(1, 1), (1, 2), (2, 3)] {
        let old = record(7, 0, version, &HEATER[..held]);
        let (verdict, config) = loaded(&old, &groups);
        assert_eq!(verdict, LoadOutcome::Loaded(0));
        let mut expected = RobotConfig::default().heater;
        expected.target_c = 45.0;
        if held > 1 {
            expected.kp = 0.5;
        }
        if held > 2 {
            expected.ki = 0.25;
        }
        assert_eq!(config.heater, expected, "{held} values");
    }
}

#[test]
fn a_record_that_does_not_fit_its_version_is_refused() {
    for (version, held, now) in [(1, 3, 1), (2, 4, 1), (2, 3, 1), (1, 4, 2), (1, 0, 1)] {
        let (verdict, config) = loaded(
            &record(7, 0, version, &HEATER[..held]),
            &later_firmware(now),
        );
        assert_eq!(
            verdict,
            LoadOutcome::Refused(0),
            "version {version}, {held}"
        );
        assert_eq!(config, RobotConfig::default());
    }
    let longer = [HEATER[0], HEATER[1], HEATER[2], HEATER[3], HEATER[0]];
    let (verdict, _) = loaded(&record(7, 0, 1, &longer), &PARAMETERS);
    assert_eq!(verdict, LoadOutcome::Refused(position(7)));
}

/// The checks are those of a tuning write: first each value, then all together.
#[test]
fn one_bad_value_rejects_the_whole_group() {
    let half = 0x3F00_0000;
    let two = 0x4000_0000;
    let joint = |values: [u32; 3]| {
        let [direction, min, max] = values;
        let values = [direction, 0, min, max, half, half, half, half];
        record(16, 1, 1, &values)
    };
    let bad = [
        // NaN, negative infinity, 100 °C, −0.5.
        record(7, 0, 1, &[HEATER[0], HEATER[1], HEATER[2], NAN]),
        record(7, 0, 1, &[HEATER[0], 0xFF80_0000, HEATER[2], HEATER[3]]),
        record(7, 0, 1, &[0x42C8_0000, HEATER[1], HEATER[2], HEATER[3]]),
        record(7, 0, 1, &[HEATER[0], 0xBF00_0000, HEATER[2], HEATER[3]]),
        // No direction; limits in the wrong order.
        joint([half, half, two]),
        joint([0x3F80_0000, two, half]),
    ];
    for record in bad {
        let (verdict, config) = loaded(&record, &PARAMETERS);
        assert!(matches!(verdict, LoadOutcome::Refused(_)), "{record:?}");
        assert_eq!(config, RobotConfig::default(), "{record:?}");
    }
    let (verdict, config) = loaded(&joint([0x3F80_0000, half, two]), &PARAMETERS);
    assert_eq!(verdict, LoadOutcome::Loaded(position(16)));
    assert_eq!(
        (config.joints[0].min_rad, config.joints[0].max_rad),
        (0.5, 2.0)
    );
}

#[test]
fn foreign_records_are_ignored() {
    let (verdict, config) = loaded(&record(99, 0, 1, &HEATER), &PARAMETERS);
    assert_eq!(verdict, LoadOutcome::Foreign);
    assert_eq!(config, RobotConfig::default());
    assert_eq!(
        loaded(&record(7, 1, 1, &HEATER), &PARAMETERS).0,
        LoadOutcome::Foreign
    );
}

/// Make 1 is the DM4310 and make 2 the RS00.
#[test]
fn a_joint_record_applies_to_one_make_of_motor() {
    let joint = |variant| {
        let half = 0x3F00_0000;
        let values = [0x3F80_0000, half, 0, half, half, half, half, half];
        record(18, variant, 1, &values)
    };
    for (layout, own, other) in [(&ROBOT_LAYOUT, 1, 2), (&RS00_LAYOUT, 2, 1)] {
        let mut config = layout.default_config();
        let verdict = load(&joint(other), &PARAMETERS, layout, &mut config);
        assert_eq!(verdict, LoadOutcome::Foreign);
        assert_eq!(config, layout.default_config());
        let verdict = load(&joint(own), &PARAMETERS, layout, &mut config);
        assert_eq!(verdict, LoadOutcome::Loaded(position(18)));
        assert_eq!(config.joints[2].zero_rad, 0.5);
        let encoded = encode(&PARAMETERS[position(18)], &config, layout);
        assert_eq!(encoded, joint(own));
    }
}
