//! Commands from a file.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use crate::observation::Commands;

/// A file that gives no commands.
#[derive(Debug, thiserror::Error)]
pub enum CommandFileError {
    /// It cannot be read.
    #[error("cannot read the commands in {path}")]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A line has no four numbers.
    #[error(
        "{path}, line {line}: `{text}` is no command: write four numbers, the time in s, forward in m/s, left in m/s and the turn \
         to the left in rad/s, such as `2.0 0.3 0 0`"
    )]
    Line {
        /// The file.
        path: PathBuf,
        /// Number of the line, from 1.
        line: usize,
        /// The line.
        text: String,
    },
    /// Times do not grow.
    #[error(
        "{path}, line {line}: {time_s} s is not later than the line before: sort the lines by their times"
    )]
    Order {
        /// The file.
        path: PathBuf,
        /// Number of the line, from 1.
        line: usize,
        /// Its time.
        time_s: f64,
    },
}

/// Lines of `t vx vy wz`: from that time on, that command. Before the first it is 0, and the last stays. `#` begins a
/// comment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CommandFile {
    rows: Vec<(f64, Commands)>,
}

impl CommandFile {
    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, a line has no four numbers, or times do not grow.
    pub fn read(path: &Path) -> Result<Self, CommandFileError> {
        let text = fs::read_to_string(path).map_err(|source| CommandFileError::Read {
            path: path.to_owned(),
            source,
        })?;
        Self::parse(&text, path)
    }

    fn parse(text: &str, path: &Path) -> Result<Self, CommandFileError> {
        let mut rows: Vec<(f64, Commands)> = Vec::new();
        for (number, text) in text.lines().enumerate() {
            let line = number + 1;
            let numbers = text.split('#').next().unwrap_or("").trim();
            if numbers.is_empty() {
                continue;
            }
            let row = row(numbers).ok_or_else(|| CommandFileError::Line {
                path: path.to_owned(),
                line,
                text: text.to_owned(),
            })?;
            if rows.last().is_some_and(|(before_s, _)| *before_s >= row.0) {
                return Err(CommandFileError::Order {
                    path: path.to_owned(),
                    line,
                    time_s: row.0,
                });
            }
            rows.push(row);
        }
        Ok(Self { rows })
    }

    /// Returns the command at a time in s.
    pub fn at(&self, time_s: f64) -> Commands {
        let next = self.rows.partition_point(|(from_s, _)| *from_s <= time_s);
        let row = next.checked_sub(1).and_then(|last| self.rows.get(last));
        row.map_or_else(Commands::default, |(_, commands)| *commands)
    }
}

fn row(text: &str) -> Option<(f64, Commands)> {
    let numbers: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
    let numbers: [f64; 4] = numbers.ok()?.try_into().ok()?;
    let [time_s, forward, left, turn] = numbers;
    let commands = Commands {
        forward_mps: forward as f32,
        left_mps: left as f32,
        yaw_rps: turn as f32,
    };
    numbers
        .iter()
        .all(|it| it.is_finite())
        .then_some((time_s, commands))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<CommandFile, CommandFileError> {
        CommandFile::parse(text, Path::new("drive.txt"))
    }

    #[test]
    fn a_line_holds_until_the_next() {
        let file = parsed("# t vx vy wz\n1.0 0.3 0 0 # go\n\n2.0 0 0.1 -1\n").expect("commands");
        let forward = [0.0, 0.99, 1.0, 1.99].map(|at| file.at(at).forward_mps);
        assert_eq!(forward, [0.0, 0.0, 0.3, 0.3]);
        let last = file.at(100.0);
        assert_eq!(
            (last.forward_mps, last.left_mps, last.yaw_rps),
            (0.0, 0.1, -1.0)
        );
    }

    #[test]
    fn what_is_no_command_is_named_with_its_line() {
        for (text, said) in [
            (
                "0 0 0 0\n1 0.3 0\n",
                "drive.txt, line 2: `1 0.3 0` is no command",
            ),
            ("0 0 0 nan", "line 1"),
            ("0 0 0 0\n2 0 0 0\n1 0 0 0", "line 3: 1 s is not later"),
        ] {
            let error = parsed(text).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
