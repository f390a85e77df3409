//! The report: a TOML file that is written after each check, so that nothing is lost when the walk is interrupted.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::{CHECKS, Measured};

const HEADING: &str = "\
# Checks of a first board, written by `robotctl first-board` (docs/first-board.md).
# Please send this file back with an issue of the project.
";

/// How a check ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    AsItMustBe,
    Wrong,
    Skipped,
}

impl Outcome {
    const ALL: [Self; 3] = [Self::AsItMustBe, Self::Wrong, Self::Skipped];

    const fn word(self) -> &'static str {
        match self {
            Self::AsItMustBe => "as it must be",
            Self::Wrong => "wrong",
            Self::Skipped => "skipped",
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    pub outcome: Outcome,
    pub note: String,
    /// The values that the tool measured.
    pub measured: Table,
}

impl Entry {
    pub fn new(outcome: Outcome, note: String, measured: Option<&Measured>) -> Self {
        let mut table = Table::new();
        if let Some(measured) = measured {
            let numbers = measured.values.iter();
            table.extend(numbers.map(|(name, value)| (name.clone(), Value::Float(*value))));
            let words = measured.words.iter();
            table.extend(words.map(|(name, word)| (name.clone(), Value::String(word.clone()))));
        }
        Self {
            outcome,
            note,
            measured: table,
        }
    }
}

#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    #[error("cannot read {path}")]
    Read {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("cannot write {path}")]
    Write {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{path} is no report of first-board: {why}; name another with --report")]
    Wrong { path: PathBuf, why: FormatError },
}

/// A text is no report.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormatError {
    #[error(transparent)]
    Toml(#[from] toml::de::Error),
    #[error("[{0}] has no outcome")]
    NoOutcome(&'static str),
}

/// The outcomes of the checks, in a file.
#[derive(Debug)]
pub struct Report {
    path: PathBuf,
    /// The robot's status after the last check, as JSON.
    status: Option<String>,
    entries: Vec<(&'static str, Entry)>,
}

impl Report {
    /// Reads the report of an earlier walk, or begins an empty one.
    pub fn load_or_new(path: &Path) -> Result<Self, ReportError> {
        let mut report = Self {
            path: path.to_owned(),
            status: None,
            entries: Vec::new(),
        };
        match std::fs::read_to_string(path) {
            Ok(text) => report.parse(&text).map_err(|why| ReportError::Wrong {
                path: path.to_owned(),
                why,
            })?,
            Err(source) if source.kind() == std::io::ErrorKind::NotFound => {}
            Err(source) => {
                return Err(ReportError::Read {
                    path: path.to_owned(),
                    source,
                });
            }
        }
        Ok(report)
    }

    fn parse(&mut self, text: &str) -> Result<(), FormatError> {
        let table: Table = text.parse()?;
        let status = table.get("status").and_then(Value::as_str);
        self.status = status.map(str::to_owned);
        for check in &CHECKS {
            let Some(value) = table.get(check.id) else {
                continue;
            };
            let field = |name: &str| value.get(name).and_then(Value::as_str);
            let word = field("outcome");
            let mut outcomes = Outcome::ALL.into_iter();
            let outcome = outcomes.find(|outcome| Some(outcome.word()) == word);
            let outcome = outcome.ok_or(FormatError::NoOutcome(check.id))?;
            let measured = value.get("measured").and_then(Value::as_table);
            let entry = Entry {
                outcome,
                note: field("note").unwrap_or_default().to_owned(),
                measured: measured.cloned().unwrap_or_default(),
            };
            self.entries.push((check.id, entry));
        }
        Ok(())
    }

    pub fn entry(&self, id: &str) -> Option<&Entry> {
        let found = self.entries.iter().find(|(of, _)| *of == id);
        found.map(|(_, entry)| entry)
    }

    pub fn set_status(&mut self, status: String) {
        self.status = Some(status);
    }

    /// Replaces an older entry of the check, and writes the file.
    pub fn put(&mut self, id: &'static str, entry: Entry) -> Result<(), ReportError> {
        self.entries.retain(|(of, _)| *of != id);
        self.entries.push((id, entry));
        std::fs::write(&self.path, self.text()).map_err(|source| ReportError::Write {
            path: self.path.clone(),
            source,
        })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns how many checks ended in this way.
    pub fn count(&self, outcome: Outcome) -> usize {
        let ended = self
            .entries
            .iter()
            .filter(|(_, entry)| entry.outcome == outcome);
        ended.count()
    }

    fn text(&self) -> String {
        let mut text = format!("{HEADING}robotctl = \"{}\"\n", env!("CARGO_PKG_VERSION"));
        if let Some(status) = &self.status {
            text.push_str(&format!("status = {}\n", Value::String(status.clone())));
        }
        for check in &CHECKS {
            let Some(entry) = self.entry(check.id) else {
                continue;
            };
            let title = Value::String(check.title.to_owned());
            let note = Value::String(entry.note.clone());
            text.push_str(&format!("\n[{}]\ntitle = {title}\n", check.id));
            text.push_str(&format!("outcome = \"{}\"\n", entry.outcome.word()));
            text.push_str(&format!("note = {note}\n"));
            if !entry.measured.is_empty() {
                let measured = Value::Table(entry.measured.clone());
                text.push_str(&format!("measured = {measured}\n"));
            }
        }
        text
    }
}
