use proptest::prelude::*;

use super::*;

const PLAIN: &str = r#"{
    "shoulder_pan": {
        "id": 1,
        "homing_offset": 0,
        "range_min": 0,
        "range_max": 4096
    },
    "elbow_flex": {
        "id": 3,
        "homing_offset": -12,
        "range_min": 900,
        "range_max": 3100
    }
}"#;

/// As LeRobot writes it: `json.dumps(…, indent=4)`.
const LEROBOT: &str = r#"{
    "shoulder_pan": {
        "id": 1,
        "drive_mode": 0,
        "homing_offset": -1470,
        "range_min": 758,
        "range_max": 3292
    },
    "wrist_roll": {
        "id": 5,
        "drive_mode": 0,
        "homing_offset": 250,
        "range_min": 0,
        "range_max": 4095
    }
}"#;

#[test]
fn files_of_both_formats_come_back_byte_for_byte() {
    for (text, format) in [(PLAIN, Format::Plain), (LEROBOT, Format::LeRobot)] {
        let calibration = Calibration::parse(text, "arm.json").unwrap();
        assert_eq!(calibration.format(), format);
        assert_eq!(calibration.to_json(), text);
    }
}

#[test]
fn a_file_is_saved_and_loaded() {
    let path = std::env::temp_dir().join(format!("robot-arm-{}.json", std::process::id()));
    let calibration = Calibration::parse(LEROBOT, "arm.json").unwrap();
    calibration.save(&path).unwrap();
    assert_eq!(Calibration::load(&path).unwrap(), calibration);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), LEROBOT);
    std::fs::remove_file(&path).unwrap();
    let said = Calibration::load(&path).unwrap_err().to_string();
    assert!(said.contains("armctl calibrate"), "{said}");
}

#[test]
fn home_is_where_the_format_says() {
    let plain = Calibration::parse(PLAIN, "").unwrap();
    let homes: Vec<_> = plain
        .joints()
        .iter()
        .map(|(_, joint)| plain.home(joint))
        .collect();
    assert_eq!(homes, [2048, 2036]);
    let lerobot = Calibration::parse(LEROBOT, "").unwrap();
    assert_eq!(lerobot.home(lerobot.joint("wrist_roll").unwrap()), 2047);
}

/// An error names file, joint, field, value, what is allowed and the cure.
#[test]
fn errors_say_where_what_and_what_to_do() {
    let said = |text: &str| {
        Calibration::parse(text, "left_arm.json")
            .unwrap_err()
            .to_string()
    };
    let of = |joint: &str| said(&format!("{{\"gripper\": {joint}}}"));
    let range = |id: &str, offset: &str, min: &str, max: &str| {
        of(&format!(
            r#"{{"id": {id}, "homing_offset": {offset}, "range_min": {min}, "range_max": {max}}}"#
        ))
    };
    for (said, parts) in [
        (
            range("254", "0", "0", "4095"),
            vec!["id = 254", "0 to 253", "armctl scan"],
        ),
        (
            range("1.5", "0", "0", "4095"),
            vec!["id = 1.5", "whole numbers"],
        ),
        (
            range("6", "2048", "0", "4095"),
            vec!["homing_offset = 2048", "-2048 to 2047"],
        ),
        (
            range("6", "0", "-1", "4095"),
            vec!["range_min = -1", "0 to 4096", "--format lerobot"],
        ),
        (range("6", "0", "0", "4097"), vec!["range_max = 4097"]),
        (
            range("6", "0", "3000", "1000"),
            vec!["range_min = 3000", "range_max = 1000"],
        ),
        (
            range("6", "0", "0", "99999999999"),
            vec!["range_max = 99999999999"],
        ),
        (range("6", "0", "0", "null"), vec!["range_max = null"]),
        (of("3"), vec!["is 3"]),
        (of(r#"{"id": 1}"#), vec!["homing_offset is missing"]),
        (
            of(r#"{"id": 1, "ranje_min": 1}"#),
            vec!["ranje_min is unknown"],
        ),
        (
            of(r#"{"id": 1, "drive_mode": 2, "homing_offset": 0, "range_min": 0, "range_max": 1}"#),
            vec!["drive_mode = 2"],
        ),
        (
            of(
                r#"{"id": 1, "drive_mode": 0, "homing_offset": -2048, "range_min": 0, "range_max": 1}"#,
            ),
            vec![
                "homing_offset = -2048",
                "-2047 to 2047",
                "middle of its travel",
            ],
        ),
    ] {
        assert!(said.starts_with("left_arm.json: gripper: "), "{said}");
        for part in parts {
            assert!(said.contains(part), "{part} in {said}");
        }
    }
    assert!(said("{}").contains("no joints"));
    assert!(said("[1]").contains("is no JSON"));
    assert!(said("{\"a\": 1, // left").contains("no comments"));
    let twice = PLAIN.replace("\"id\": 3", "\"id\": 1");
    assert!(said(&twice).contains("elbow_flex: id = 1 is that of shoulder_pan too"));
    let mixed = PLAIN.replace("\"id\": 3", "\"drive_mode\": 0, \"id\": 3");
    assert!(said(&mixed).contains("elbow_flex: has a drive_mode"));
}

#[test]
fn a_converted_joint_is_at_the_same_angle() {
    let lerobot = Calibration::parse(LEROBOT, "").unwrap();
    let plain = lerobot.to_format(Format::Plain);
    // 758 − 1470 is below 0: a plain file cannot say it.
    assert!(
        plain
            .unwrap_err()
            .to_string()
            .contains("shoulder_pan: its travel, steps -712 to 1822")
    );
    let fits = LEROBOT.replace("-1470", "-700");
    let plain = Calibration::parse(&fits, "")
        .unwrap()
        .to_format(Format::Plain)
        .unwrap();
    let pan = plain.joint("shoulder_pan").unwrap();
    assert_eq!(
        (pan.homing_offset, pan.range_min, pan.range_max),
        (-701, 58, 2592)
    );
    // LeRobot's middle 2047 with an offset of −700 is the angle 1347.
    assert_eq!(plain.home(pan), 1347);
    let inverted = fits.replace("\"drive_mode\": 0", "\"drive_mode\": 1");
    let said = Calibration::parse(&inverted, "")
        .unwrap()
        .to_format(Format::Plain);
    assert!(said.unwrap_err().to_string().contains("gear_sign"));
}

proptest! {
    #[test]
    fn a_conversion_and_back_loses_nothing(offset in -2047i32..=2047, a in 0i32..=4095, b in 0i32..=4095) {
        prop_assume!(a < b);
        let joint = JointCalibration { id: 4, drive_mode: 0, homing_offset: offset, range_min: a, range_max: b };
        let lerobot = Calibration::new(Format::LeRobot, vec![("j".to_owned(), joint)]).unwrap();
        if let Ok(plain) = lerobot.to_format(Format::Plain) {
            prop_assert_eq!(plain.to_format(Format::LeRobot).unwrap(), lerobot);
        }
        let plain = Calibration::new(Format::Plain, vec![("j".to_owned(), joint)]).unwrap();
        if let Ok(lerobot) = plain.to_format(Format::LeRobot) {
            prop_assert_eq!(lerobot.to_format(Format::Plain).unwrap(), plain);
        }
    }

    /// A joint that is moved between two angles, whatever the seam, is calibrated or refused, and never with a wrong range.
    #[test]
    fn a_recorded_travel_is_that_of_the_shaft(
        middle in 0i32..4096, below in 0i32..2500, above in 0i32..2500, offset in -2047i32..=2047,
    ) {
        let reported = |angle: i32| (angle - offset).rem_euclid(4096);
        let mut travel = Travel::new(reported(middle), offset);
        let up = (0..above).step_by(7).chain([above]);
        let down = (-below..above).rev().step_by(7).chain([-below]);
        for step in up.chain(down) {
            travel.follow(reported(middle + step), offset);
        }
        let made = travel.finish(1, Format::LeRobot, false);
        if below + above < 50 {
            prop_assert!(matches!(made, Err(TravelError::NotMoved { .. })), "{:?}", made);
        } else if middle == 4095 {
            prop_assert_eq!(made, Err(TravelError::Offset { offset: 2048 }));
        } else if below > 2047 || above > 2048 {
            prop_assert_eq!(made, Err(TravelError::NotTheMiddle { below, above }));
        } else {
            let made = made.unwrap();
            prop_assert_eq!(made.homing_offset, middle - 2047);
            prop_assert_eq!((made.range_min, made.range_max), (2047 - below, 2047 + above));
        }
        let made = travel.finish(1, Format::Plain, false);
        if below + above >= 50 {
            let crosses = middle < below || middle + above > 4095;
            prop_assert_eq!(made.is_err(), crosses, "{:?}", made);
        }
    }
}
