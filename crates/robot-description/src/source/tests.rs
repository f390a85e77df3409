use super::*;

const FIVEBAR: &str = include_str!("../../../../robots/fivebar.toml");
const RS00: &str = include_str!("../../../../robots/fivebar-rs00.toml");

/// The complaint about the small robot's file after a change.
fn complaint(from: &str, to: &str) -> String {
    assert_eq!(FIVEBAR.matches(from).count(), 1, "{from}");
    let error = Robot::parse(&FIVEBAR.replace(from, to), "r.toml");
    error.expect_err("refused").to_string()
}

fn line_of(start: &str) -> usize {
    let at = FIVEBAR.lines().position(|line| line.starts_with(start));
    1 + at.expect("a line")
}

#[test]
fn both_robots_are_read() {
    let small = Robot::parse(FIVEBAR, "fivebar.toml").expect("sound");
    assert_eq!(small.name, "fivebar");
    // 4.30 + 4·(0.10 + 0.12) + 2·(0.32 + 0.365)
    assert!((small.total_mass_kg() - 6.55).abs() < 1e-9);
    let large = Robot::parse(RS00, "fivebar-rs00.toml").expect("sound");
    assert_eq!(large.name, "fivebar-rs00");
    assert_eq!(large.imu.mounting.name(), "x-forward-z-up");
}

#[test]
fn a_missing_field_names_its_table() {
    let table = line_of("[legs.thigh]");
    assert_eq!(
        complaint("length_m = 0.12\n", ""),
        format!("r.toml:{table}: legs.thigh: missing field `length_m`")
    );
}

#[test]
fn an_unknown_field_is_named() {
    let line = line_of("hip_gap_m");
    let said = complaint("hip_gap_m = 0.10", "hip_gap = 0.10");
    let start = format!("r.toml:{line}: legs.hip_gap: unknown field `hip_gap`, expected one of ");
    assert!(said.starts_with(&start), "{said}");
}

#[test]
fn a_value_of_another_type_is_named() {
    let line = line_of("escs");
    assert_eq!(
        complaint("escs = [1, 2]", "escs = [1, \"2\"]"),
        format!("r.toml:{line}: wheels.escs: invalid type: string \"2\", expected u8")
    );
}

#[test]
fn an_unknown_mounting_is_named() {
    let line = line_of("mounting");
    let said = complaint("x-forward-z-up", "upside-down");
    let start = format!("r.toml:{line}: imu.mounting: `upside-down` is no mounting; write where");
    assert!(said.starts_with(&start), "{said}");
}

#[test]
fn a_text_that_is_no_toml_has_a_line() {
    let line = line_of("hip_gap_m");
    let said = complaint("hip_gap_m = 0.10", "hip_gap_m = 0.1O");
    assert!(said.starts_with(&format!("r.toml:{line}: ")), "{said}");
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = Robot::read(Path::new("no-such.toml")).expect_err("none");
    assert!(
        error
            .to_string()
            .starts_with("no-such.toml: cannot be read: ")
    );
}
