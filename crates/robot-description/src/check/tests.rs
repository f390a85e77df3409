//! Every check has a file that fails it: `fivebar.toml` with a change.

use crate::{Examined, Located, RobotError};

mod balance;
mod bodies;
mod buses;
mod legs;
mod motors;

const FIVEBAR: &str = include_str!("../../../../robots/fivebar.toml");
const RS00: &str = include_str!("../../../../robots/fivebar-rs00.toml");

/// Fields with other values, and what is said of the file then, as `field: message`.
struct Case {
    changes: &'static [(&'static str, &'static str)],
    says: &'static [&'static str],
}

impl Case {
    fn text(&self) -> String {
        let mut lines: Vec<_> = FIVEBAR.lines().map(str::to_owned).collect();
        for (field, value) in self.changes {
            let key = field.rsplit_once('.').map_or(*field, |(_, key)| key);
            lines[line_of(FIVEBAR, field) - 1] = format!("{key} = {value}");
        }
        lines.join("\n")
    }

    fn expected(&self) -> Vec<String> {
        let text = self.text();
        let lines = self.says.iter().map(|said| {
            let (field, _) = said.split_once(": ").expect("a field");
            format!("r.toml:{}: {said}", line_of(&text, field))
        });
        lines.collect()
    }
}

/// The line of a field, found by table header and key, or that of its table's header.
fn line_of(text: &str, field: &str) -> usize {
    let mut table = "";
    for (number, line) in (1..).zip(text.lines()) {
        if let Some(header) = line.strip_prefix('[') {
            table = header.trim_end_matches(']');
            if table == field {
                return number;
            }
        }
        let key = line.split(' ').next().unwrap_or_default();
        if format!("{table}.{key}").trim_start_matches('.') == field {
            return number;
        }
    }
    panic!("no {field}");
}

fn printed(complaints: &[Located]) -> Vec<String> {
    complaints.iter().map(ToString::to_string).collect()
}

fn assert_refused(cases: &[Case]) {
    for case in cases {
        let error = Examined::parse(&case.text(), "r.toml").expect_err("refused");
        let RobotError::Unsound(complaints) = &error else {
            panic!("{error}");
        };
        assert_eq!(printed(complaints), case.expected());
        assert_eq!(error.to_string(), case.expected().join("\n"));
    }
}

fn assert_warned(cases: &[Case]) {
    for case in cases {
        let examined = Examined::parse(&case.text(), "r.toml").expect("read");
        assert_eq!(printed(&examined.warnings), case.expected());
    }
}

/// The name stands in names of files and in generated code.
#[test]
fn a_name_that_would_leave_its_folder_or_line_is_refused() {
    assert_refused(&[
        Case {
            changes: &[("name", "\"../ours\"")],
            says: &[
                "name: \"../ours\"; allowed: letters, digits, hyphens and underscores. Enter the file's name without .toml.",
            ],
        },
        Case {
            changes: &[("name", "\"\"")],
            says: &[
                "name: \"\"; allowed: letters, digits, hyphens and underscores. Enter the file's name without .toml.",
            ],
        },
    ]);
}

#[test]
fn nothing_is_said_of_the_robots_of_this_repository() {
    for text in [FIVEBAR, RS00] {
        let examined = Examined::parse(text, "r.toml").expect("sound");
        assert_eq!(printed(&examined.warnings), [""; 0]);
    }
}
