//! docs/tuning.md lists the commands, refusals, settings and live values of the firmware with their numbers, units and
//! ranges.

use robot_app::tuning::{
    LIVE_PAGES, LiveField, LiveKind, LivePage, PARAMETERS, Parameter, ParameterGroup,
    ParameterKind, Refusal, opcode,
};

const DOCUMENT: &str = include_str!("../../../docs/tuning.md");

const FIRST_JOINT: u8 = 16;
const JOINTS: std::ops::RangeInclusive<u8> = FIRST_JOINT..=19;

fn row(group: &ParameterGroup, parameter: &Parameter) -> String {
    let (numbers, name) = if group.number == FIRST_JOINT {
        ("16 to 19".to_owned(), "joint-…")
    } else {
        (group.number.to_string(), group.name)
    };
    let Parameter {
        index,
        unit,
        min,
        max,
        ..
    } = parameter;
    let range = match parameter.kind {
        ParameterKind::Float => format!("{min} … {max}"),
        ParameterKind::Integer => format!("integer, {min} … {max}"),
        ParameterKind::Sign => "sign".to_owned(),
        ParameterKind::Choice(names) => format!("choice, 0 … {}", names.len() - 1),
    };
    let name = format!("{name}.{}", parameter.name);
    format!("| {numbers} | {index} | `{name}` | {unit} | {range} |")
}

#[test]
fn the_table_has_every_setting_and_no_other() {
    let groups = PARAMETERS
        .iter()
        .filter(|group| !JOINTS.contains(&group.number) || group.number == FIRST_JOINT);
    let expected: Vec<String> = groups
        .flat_map(|group| group.parameters.iter().map(move |p| row(group, p)))
        .collect();
    let documented: Vec<&str> = DOCUMENT
        .lines()
        .skip_while(|line| *line != "## Settings")
        .filter(|line| line.starts_with("| ") && line.contains('`'))
        .collect();
    assert_eq!(documented, expected, "expected:\n{}", expected.join("\n"));
}

#[test]
fn all_joints_have_the_same_settings() {
    let rows = |group: &ParameterGroup| -> Vec<String> {
        let representative = ParameterGroup {
            number: FIRST_JOINT,
            ..*group
        };
        let parameters = group.parameters.iter();
        parameters.map(|p| row(&representative, p)).collect()
    };
    let joints: Vec<_> = PARAMETERS
        .iter()
        .filter(|group| JOINTS.contains(&group.number))
        .map(rows)
        .collect();
    assert_eq!(joints.len(), 4);
    assert!(joints.iter().all(|joint| joint == &joints[0]));
}

fn field(field: &LiveField) -> String {
    let LiveField { name, bits, .. } = field;
    match field.kind {
        LiveKind::Count(_) => format!("`{name}` u{bits}"),
        LiveKind::Measure { steps: 1, .. } => format!("`{name}` i{bits}"),
        LiveKind::Measure { steps, .. } => format!("`{name}` i{bits}/{steps}"),
        LiveKind::Choice { .. } => format!("`{name}` choice{bits}"),
        LiveKind::Set { .. } => format!("`{name}` set{bits}"),
    }
}

fn page_row(page: &LivePage) -> String {
    let fields: Vec<String> = page.fields.iter().map(field).collect();
    let last = page.number(page.parts.len() - 1).unwrap();
    let numbers = match page.parts.len() {
        1 => format!("`{last:02X}`"),
        _ => format!("`{:02X}` … `{last:02X}`", page.first),
    };
    format!("| {numbers} | {} | {} |", page.name, fields.join(", "))
}

#[test]
fn the_table_has_every_live_page_and_no_other() {
    let expected: Vec<String> = LIVE_PAGES.iter().map(page_row).collect();
    let documented: Vec<&str> = DOCUMENT
        .lines()
        .skip_while(|line| *line != "| page | about | fields |")
        .take_while(|line| *line != "## Settings")
        .filter(|line| line.starts_with("| `"))
        .collect();
    assert_eq!(documented, expected, "expected:\n{}", expected.join("\n"));
}

/// Returns the rows of a table of the document, without its head.
fn rows_below(head: &str) -> Vec<&'static str> {
    let lines = DOCUMENT.lines().skip_while(|line| !line.starts_with(head));
    lines
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .collect()
}

/// Each row begins with the identifier, then the command in backticks.
#[test]
fn the_table_of_frames_has_every_command_and_no_other() {
    let command = |row: &&str| u8::from_str_radix(row.split('`').nth(1)?.get(..2)?, 16).ok();
    let mut documented: Vec<u8> = rows_below("| to | bytes |")
        .iter()
        .filter_map(command)
        .collect();
    documented.sort_unstable();
    assert_eq!(documented, opcode::ALL);
}

#[test]
fn the_table_of_refusals_has_every_reason_and_no_other() {
    let code = |row: &&str| row.split('|').nth(1)?.trim().parse().ok();
    let documented: Vec<u8> = rows_below("| reason | means |")
        .iter()
        .filter_map(code)
        .collect();
    let known: Vec<u8> = (0..=u8::MAX)
        .filter(|code| Refusal::from_code(*code).is_some())
        .collect();
    assert_eq!(documented, known);
}
