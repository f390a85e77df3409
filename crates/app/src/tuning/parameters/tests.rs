use super::*;
use crate::{
    domain::RobotConfig,
    tuning::{ParameterKind, Refusal},
};

fn all() -> impl Iterator<Item = (&'static ParameterGroup, &'static Parameter)> {
    PARAMETERS
        .iter()
        .flat_map(|group| group.parameters.iter().map(move |p| (group, p)))
}

/// Every field of the configuration has four bytes, and three of the soft-iron matrix are mirror images.
#[test]
fn every_field_of_the_configuration_has_a_setting() {
    let fields = size_of::<RobotConfig>() / 4;
    assert_eq!(all().count(), fields - 3);
}

#[test]
fn numbers_and_names_are_unique() {
    for (position, (group, parameter)) in all().enumerate() {
        for (other_group, other) in all().skip(position + 1) {
            assert!((group.number, parameter.index) != (other_group.number, other.index));
            assert!((group.name, parameter.name) != (other_group.name, other.name));
        }
        let found = find(group.number, parameter.index).unwrap();
        assert!(std::ptr::eq(found, parameter));
    }
    assert_eq!(find(1, 5).err(), Some(Refusal::UnknownParameter));
    assert_eq!(find(15, 0).err(), Some(Refusal::UnknownParameter));
}

#[test]
fn a_setting_changes_its_own_field_and_no_other() {
    let default = RobotConfig::default();
    for (group, parameter) in all() {
        for wanted in [parameter.min, parameter.max] {
            let mut config = default;
            assert_eq!(parameter.write(&mut config, wanted), Ok(()));
            for (other_group, other) in all() {
                let same = group.number == other_group.number && parameter.index == other.index;
                let expected = if same { wanted } else { other.read(&default) };
                let name = (group.name, parameter.name, other.name);
                assert_eq!(other.read(&config), expected, "{name:?}");
            }
        }
    }
}

#[test]
fn limits_are_inclusive_and_defaults_lie_between_them() {
    for (group, parameter) in all() {
        let name = (group.name, parameter.name);
        let mut config = RobotConfig::default();
        let value = parameter.read(&config);
        assert_eq!(parameter.write(&mut config, value), Ok(()), "{name:?}");
        for (outside, reason) in [
            (parameter.min.next_down(), Refusal::OutOfRange),
            (parameter.max.next_up(), Refusal::OutOfRange),
            (f32::NAN, Refusal::NotFinite),
            (f32::NEG_INFINITY, Refusal::NotFinite),
        ] {
            assert_eq!(
                parameter.write(&mut config, outside),
                Err(reason),
                "{name:?}"
            );
        }
        assert_eq!(config, RobotConfig::default(), "{name:?}");
    }
}

/// A stored record is read by index (docs/parameters.md).
#[test]
fn indices_begin_at_zero_without_gaps() {
    for group in &PARAMETERS {
        let indices: Vec<u8> = group.parameters.iter().map(|p| p.index).collect();
        let expected: Vec<u8> = (0..group.parameters.len() as u8).collect();
        assert_eq!(indices, expected, "{}", group.name);
    }
}

/// Number, version and settings of each group as stored by robots in the field. A group that grows gets a new version
/// and a new line, and the old lines stay.
#[test]
fn a_group_that_grows_gets_a_new_version() {
    let stored: [(u8, u8, usize); 20] = [
        (1, 1, 5),
        (2, 1, 6),
        (3, 1, 2),
        (3, 2, 3),
        (4, 1, 15),
        (4, 2, 16),
        (4, 3, 18),
        (4, 4, 20),
        (5, 1, 12),
        (6, 1, 9),
        (7, 1, 4),
        (8, 1, 2),
        (9, 1, 14),
        (9, 2, 22),
        (10, 1, 21),
        (11, 1, 4),
        (16, 1, 8),
        (17, 1, 8),
        (18, 1, 8),
        (19, 1, 8),
    ];
    for group in &PARAMETERS {
        let now = (group.number, group.version, group.parameters.len());
        assert!(stored.contains(&now), "{now:?}");
        let versions = |(number, ..): &&(u8, u8, usize)| *number == group.number;
        let newest = stored.iter().filter(versions).max_by_key(|line| line.1);
        assert_eq!(newest, Some(&now), "{}", group.name);
        for (_, version, count) in stored.iter().filter(versions) {
            assert!((*version < group.version) == (*count < group.parameters.len()));
        }
    }
}

/// An `f32` holds every integer up to 2^24.
#[test]
fn integers_are_transferred_exactly() {
    for (_, parameter) in all() {
        if parameter.kind == ParameterKind::Integer {
            assert!(parameter.min >= 0.0 && parameter.max <= 16_777_216.0);
            let mut config = RobotConfig::default();
            let between = parameter.write(&mut config, parameter.min + 0.5);
            assert_eq!(between, Err(Refusal::OutOfRange));
        }
    }
}

#[test]
fn a_direction_is_forward_or_backward() {
    let mut config = RobotConfig::default();
    for value in [0.0, 0.5, -0.999] {
        let written = find(16, 0).unwrap().write(&mut config, value);
        assert_eq!(written, Err(Refusal::OutOfRange));
    }
}

/// Group and index as known to robots in the field.
#[test]
fn wire_numbers_do_not_change() {
    let default = RobotConfig::default();
    let read = |group, index| find(group, index).unwrap().read(&default);
    assert_eq!(read(1, 0), 0.075);
    assert_eq!(read(1, 4), -1.0);
    assert_eq!(read(2, 3), 8_000.0);
    assert_eq!(read(3, 0), 20.0);
    assert_eq!(read(3, 2), 0.0);
    assert_eq!(read(4, 9), 0.9);
    assert_eq!(read(4, 12), 21.0);
    assert_eq!(read(4, 16), 100_000.0);
    assert_eq!(read(4, 18), 0.7);
    assert_eq!(read(7, 0), 40.0);
    assert_eq!(read(8, 0), 0.0);
    assert_eq!(read(8, 1), 24.0);
    assert_eq!(read(9, 14), 7.0);
    assert_eq!(read(9, 17), 10.0);
    assert_eq!(read(11, 0), 3_000_000.0);
    assert_eq!(read(16, 0), 1.0);
    assert_eq!(read(18, 0), -1.0);
    assert_eq!(read(19, 3), 1.35);
}

#[test]
fn the_soft_iron_matrix_stays_symmetric() {
    for (index, row, column) in [(6, 0, 1), (7, 0, 2), (8, 1, 2)] {
        let mut config = RobotConfig::default();
        find(6, index).unwrap().write(&mut config, 0.25).unwrap();
        let matrix = config.mag.soft_iron;
        assert_eq!((matrix[row][column], matrix[column][row]), (0.25, 0.25));
    }
}

/// A reply has one bit for each (docs/tuning.md, `32`).
#[test]
fn group_numbers_are_below_32() {
    assert!(PARAMETERS.iter().all(|group| group.number < 32));
}

/// Each name has the number that the firmware uses for it.
#[test]
fn a_choice_has_a_name_for_every_number() {
    for (_, parameter) in all() {
        if let ParameterKind::Choice(names) = parameter.kind {
            assert_eq!(
                (parameter.min, parameter.max),
                (0.0, (names.len() - 1) as f32)
            );
            let mut config = RobotConfig::default();
            let between = parameter.write(&mut config, 0.5);
            assert_eq!(between, Err(Refusal::OutOfRange));
        }
    }
    let [board, mag] = [0, 1].map(|index| find(8, index).unwrap());
    let (ParameterKind::Choice(boards), ParameterKind::Choice(mags)) = (board.kind, mag.kind)
    else {
        panic!("both are choices");
    };
    assert_eq!(boards[13], "x-right-z-down");
    assert_eq!(mags, [boards, &["unset"]].concat());
    let mut config = RobotConfig::default();
    assert_eq!(config.mounting.mag, None);
    for (number, name) in boards.iter().enumerate() {
        board.write(&mut config, number as f32).unwrap();
        mag.write(&mut config, number as f32).unwrap();
        assert_eq!(config.mounting.board.name(), *name);
        assert_eq!(config.mounting.mag.map(|mag| mag.name()), Some(*name));
    }
    mag.write(&mut config, 24.0).unwrap();
    assert_eq!(config.mounting.mag, None);
}
