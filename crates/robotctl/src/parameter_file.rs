//! Parameters by name in a TOML file. `calibrate` writes such a file, and `tune` applies it to the robot.
//!
//! The parts of a name are tables: `imu.accel-scale-x` is `accel-scale-x` in `[imu]`.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use toml::{Table, Value};

use crate::settings::{self, UnknownName, ValueError};

const HEADING: &str =
    "# Parameters of the robot: `robotctl tune --can … apply FILE` writes them.\n";

/// Values by full name, in the robot's precision.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParameterFile(BTreeMap<String, f32>);

#[derive(Debug, thiserror::Error)]
pub enum ParameterFileError {
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
    #[error("{path}: {why}")]
    Wrong { path: PathBuf, why: FormatError },
}

/// A text is no parameter file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormatError {
    #[error(transparent)]
    Toml(#[from] toml::de::Error),
    #[error(transparent)]
    Name(#[from] UnknownName),
    #[error("{name}: {why}")]
    Value { name: String, why: ValueError },
    #[error("`{0}` is no number")]
    NoNumber(String),
}

impl ParameterFile {
    pub fn load(path: &Path) -> Result<Self, ParameterFileError> {
        let text = std::fs::read_to_string(path).map_err(|source| ParameterFileError::Read {
            path: path.to_owned(),
            source,
        })?;
        Self::parse(&text).map_err(|why| ParameterFileError::Wrong {
            path: path.to_owned(),
            why,
        })
    }

    /// Loads a file. One that does not exist counts as empty.
    pub fn load_or_new(path: &Path) -> Result<Self, ParameterFileError> {
        match Self::load(path) {
            Err(ParameterFileError::Read { source, .. })
                if source.kind() == std::io::ErrorKind::NotFound =>
            {
                Ok(Self::default())
            }
            loaded => loaded,
        }
    }

    pub fn save(&self, path: &Path) -> Result<(), ParameterFileError> {
        std::fs::write(path, self.text()).map_err(|source| ParameterFileError::Write {
            path: path.to_owned(),
            source,
        })
    }

    pub fn set(&mut self, name: &str, value: f32) {
        self.0.insert(name.to_owned(), value);
    }

    pub fn get(&self, name: &str) -> Option<f32> {
        self.0.get(name).copied()
    }

    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&str, f32)> {
        self.0.iter().map(|(name, value)| (name.as_str(), *value))
    }

    fn parse(text: &str) -> Result<Self, FormatError> {
        let table: Table = text.parse()?;
        let mut file = Self::default();
        file.add_table("", &table)?;
        Ok(file)
    }

    fn add_table(&mut self, prefix: &str, table: &Table) -> Result<(), FormatError> {
        for (key, value) in table {
            let name = format!("{prefix}{key}");
            match value {
                Value::Table(inner) => self.add_table(&format!("{name}."), inner)?,
                Value::Float(number) if (*number as f32).is_finite() => {
                    self.set(&name, *number as f32);
                }
                Value::Integer(number) => self.set(&name, *number as f32),
                Value::String(word) => {
                    let named = settings::find(&name)?;
                    match named.parse(word) {
                        Ok(value) => self.set(&name, value),
                        Err(why) => return Err(FormatError::Value { name, why }),
                    }
                }
                _ => return Err(FormatError::NoNumber(name)),
            }
        }
        Ok(())
    }

    fn text(&self) -> String {
        let mut tables: BTreeMap<&str, String> = BTreeMap::new();
        for (name, value) in self.iter() {
            let (table, key) = name.rsplit_once('.').unwrap_or(("", name));
            let words = settings::find(name).map(|named| named.in_words(value));
            let word = words.ok().filter(|words| words.parse::<f32>().is_err());
            let line = match word {
                Some(word) => format!("{key} = {word:?}\n"),
                None => format!("{key} = {value:?}\n"),
            };
            tables.entry(table).or_default().push_str(&line);
        }
        let mut text = String::from(HEADING);
        for (table, lines) in tables {
            if !table.is_empty() {
                text.push_str(&format!("\n[{table}]\n"));
            }
            text.push_str(&lines);
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_tables_and_keys() {
        let file = ParameterFile::parse("[joint.0]\ndirection = -1\n[imu]\naccel-scale-x = 1.25\n");
        let file = file.unwrap();
        assert_eq!(file.get("joint.0.direction"), Some(-1.0));
        assert_eq!(file.get("imu.accel-scale-x"), Some(1.25));
        assert_eq!(file.iter().len(), 2);
    }

    #[test]
    fn a_saved_file_is_read_back() {
        let mut file = ParameterFile::default();
        file.set("imu.accel-bias-x-mps2", -0.187_500_1);
        file.set("joint.0.direction", 1.0);
        file.set("safety.clear-hold-us", 1e6);
        assert_eq!(ParameterFile::parse(&file.text()).unwrap(), file);
    }

    /// These choices have the numbers 13 and 24.
    #[test]
    fn choices_are_words() {
        let text = "[mounting]\nboard = \"x-right-z-down\"\nmag = 24\n";
        let file = ParameterFile::parse(text).unwrap();
        assert_eq!(file.get("mounting.board"), Some(13.0));
        assert_eq!(file.get("mounting.mag"), Some(24.0));
        let text = file.text();
        assert!(
            text.contains("board = \"x-right-z-down\"\nmag = \"unset\"\n"),
            "{text}"
        );
        assert_eq!(ParameterFile::parse(&text).unwrap(), file);
    }

    #[test]
    fn a_value_that_is_no_number_is_named() {
        let why = |text| ParameterFile::parse(text).unwrap_err().to_string();
        let found = why("[heater]\nkp = \"one\"\n");
        assert_eq!(found, "heater.kp: `one` is no number");
        assert_eq!(why("[heater]\nkp = true\n"), "`heater.kp` is no number");
        let found = why("[mounting]\nboard = \"unset\"\n");
        assert!(
            found.starts_with("mounting.board: `unset` is not a value"),
            "{found}"
        );
        assert!(ParameterFile::parse("[imu]\nscale = nan\n").is_err());
    }
}
