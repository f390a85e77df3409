//! Reading a file and finding the line of each field.

use std::{fs, ops::Range, path::Path};

use toml::de::DeTable;

use crate::{
    Located, Robot, RobotError,
    check::{Finding, Severity},
};

/// A robot's file that can be used, with what is not as good as it could be.
#[derive(Clone, Debug, PartialEq)]
pub struct Examined {
    /// The robot.
    pub robot: Robot,
    /// What is not as good as it could be.
    pub warnings: Vec<Located>,
}

impl Robot {
    /// Reads a file and checks it.
    ///
    /// # Errors
    ///
    /// As for [`parse`](Self::parse), or if the file cannot be read.
    pub fn read(path: &Path) -> Result<Self, RobotError> {
        Ok(Examined::read(path)?.robot)
    }

    /// Reads the text of a file, which messages call `file`, and checks it.
    ///
    /// # Errors
    ///
    /// As for [`Examined::parse`].
    pub fn parse(text: &str, file: &str) -> Result<Self, RobotError> {
        Ok(Examined::parse(text, file)?.robot)
    }
}

impl Examined {
    /// Reads a file and checks it.
    ///
    /// # Errors
    ///
    /// As for [`parse`](Self::parse), or if the file cannot be read.
    pub fn read(path: &Path) -> Result<Self, RobotError> {
        let file = path.display().to_string();
        match fs::read_to_string(path) {
            Ok(text) => Self::parse(&text, &file),
            Err(error) => Err(RobotError::Unreadable { file, error }),
        }
    }

    /// Reads the text of a file, which messages call `file`, and checks it.
    ///
    /// # Errors
    ///
    /// If the text is no TOML, lacks a field, has an unknown one, a value of another type, or if a
    /// [check](Robot::check) finds an error.
    pub fn parse(text: &str, file: &str) -> Result<Self, RobotError> {
        let robot: Robot = toml::from_str(text).map_err(|error| {
            let at = error.span().unwrap_or(0..0);
            RobotError::Malformed(Located {
                file: file.to_owned(),
                line: line_at(text, at.start),
                field: field_at(text, &at),
                message: error.message().to_owned(),
            })
        })?;
        let locate = |finding: &Finding| Located {
            file: file.to_owned(),
            line: line_of(text, finding.field),
            field: finding.field.to_owned(),
            message: finding.to_string(),
        };
        let findings = robot.check();
        let of = |severity| {
            let such = findings.iter().filter(move |it| it.severity == severity);
            such.map(locate).collect::<Vec<_>>()
        };
        let errors = of(Severity::Error);
        if errors.is_empty() {
            let warnings = of(Severity::Warning);
            Ok(Self { robot, warnings })
        } else {
            Err(RobotError::Unsound(errors))
        }
    }
}

/// The line of a field's name, or of its innermost table that is there.
fn line_of(text: &str, field: &str) -> usize {
    let Ok(document) = DeTable::parse(text) else {
        return 1;
    };
    let mut table = document.get_ref();
    let mut at = 0;
    for word in field.split('.') {
        let Some((key, value)) = table.get_key_value(word) else {
            break;
        };
        at = key.span().start;
        match value.get_ref().as_table() {
            Some(inner) => table = inner,
            None => break,
        }
    }
    line_at(text, at)
}

/// The line of a byte, from 1.
fn line_at(text: &str, byte: usize) -> usize {
    let before = text.bytes().take(byte);
    1 + before.filter(|it| *it == b'\n').count()
}

/// The innermost field that holds a range of bytes, such as `legs.thigh.mass_kg`. It is empty for none.
fn field_at(text: &str, range: &Range<usize>) -> String {
    let mut path = Vec::new();
    if let Ok(table) = DeTable::parse(text) {
        descend(table.get_ref(), range, &mut path);
    }
    path.join(".")
}

fn descend(table: &DeTable<'_>, range: &Range<usize>, path: &mut Vec<String>) {
    for (key, value) in table {
        let inner = value.get_ref().as_table();
        if holds(key.span(), range) || holds(value.span(), range) {
            path.push(key.get_ref().to_string());
            if let Some(inner) = inner {
                descend(inner, range, path);
            }
            return;
        }
        // A table's span is that of its header, and inner tables have headers of their own.
        if let Some(inner) = inner {
            path.push(key.get_ref().to_string());
            let depth = path.len();
            descend(inner, range, path);
            if path.len() > depth {
                return;
            }
            path.pop();
        }
    }
}

fn holds(outer: Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

#[cfg(test)]
mod tests;
