//! Counts what test runners report.

use std::{
    fmt,
    io::{BufRead, BufReader},
    ops::AddAssign,
    process::{Command, Stdio},
};

use anyhow::Context;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    pub passed: u32,
    pub failed: u32,
    pub skipped: u32,
}

impl Totals {
    pub const PASSED: Self = Self {
        passed: 1,
        failed: 0,
        skipped: 0,
    };
    pub const FAILED: Self = Self {
        passed: 0,
        failed: 1,
        skipped: 0,
    };
    pub const SKIPPED: Self = Self {
        passed: 0,
        failed: 0,
        skipped: 1,
    };
}

impl AddAssign for Totals {
    fn add_assign(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
    }
}

impl fmt::Display for Totals {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            passed,
            failed,
            skipped,
        } = self;
        write!(to, "{passed} passed, {failed} failed, {skipped} skipped")
    }
}

/// Runs a command that either succeeds or not; its output goes to the terminal.
pub fn of_command(mut command: Command) -> anyhow::Result<Totals> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command
        .status()
        .with_context(|| format!("cannot start {name}"))?;
    Ok(if status.success() {
        Totals::PASSED
    } else {
        Totals::FAILED
    })
}

/// Runs `cargo test … -- --show-output` and adds up the results of its test binaries.
///
/// The output of passing tests stays hidden, except lines that begin with `skipped:`.
pub fn of_test_runner(mut command: Command) -> anyhow::Result<Totals> {
    let mut child = command
        .stdout(Stdio::piped())
        .spawn()
        .context("cannot start cargo test")?;
    let output = child.stdout.take().context("cargo test has no output")?;
    let mut parser = LibtestParser::default();
    for line in BufReader::new(output).lines() {
        let line = line.context("cannot read what cargo test prints")?;
        if parser.take(&line) {
            println!("{line}");
        }
    }
    let succeeded = child.wait().context("cargo test vanished")?.success();
    let mut totals = parser.totals;
    if !succeeded && totals.failed == 0 {
        // It did not compile, or a test binary crashed before it could count.
        totals += Totals::FAILED;
    }
    Ok(totals)
}

/// Follows the output of libtest.
#[derive(Default)]
struct LibtestParser {
    totals: Totals,
    in_output_of_passed_tests: bool,
    this_test_skipped: bool,
    /// Tests of the current binary that returned early. libtest counts them as passed.
    skips: u32,
}

impl LibtestParser {
    /// Takes in one line and says whether to show it.
    fn take(&mut self, line: &str) -> bool {
        if let Some(mut totals) = result_line(line) {
            totals.passed = totals.passed.saturating_sub(self.skips);
            totals.skipped += self.skips;
            self.totals += totals;
            *self = Self {
                totals: self.totals,
                ..Self::default()
            };
        } else if line == "successes:" {
            self.in_output_of_passed_tests = true;
        } else if line == "failures:" {
            self.in_output_of_passed_tests = false;
        } else if line.starts_with("---- ") {
            self.this_test_skipped = false;
        } else if self.in_output_of_passed_tests && line.starts_with("skipped:") {
            self.skips += u32::from(!self.this_test_skipped);
            self.this_test_skipped = true;
            return true;
        }
        !self.in_output_of_passed_tests
    }
}

/// `test result: ok. 5 passed; 0 failed; 1 ignored; …`
fn result_line(line: &str) -> Option<Totals> {
    let counts = line.strip_prefix("test result: ")?;
    let count = |word: &str| -> Option<u32> {
        let before = counts.split(word).next()?;
        before.split_whitespace().next_back()?.parse().ok()
    };
    Some(Totals {
        passed: count(" passed")?,
        failed: count(" failed")?,
        skipped: count(" ignored")?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTPUT: &str = "\
running 3 tests
test a ... ok
test recorded ... ok

successes:

---- recorded stdout ----
noise
skipped: no recordings in ../shared/data
skipped: nor elsewhere

successes:
    a
    recorded

test result: ok. 2 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.06s
running 1 test
test b ... FAILED

failures:

---- b stdout ----
reason

test result: FAILED. 0 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s";

    #[test]
    fn results_of_all_binaries_add_up_and_skips_do_not_pass() {
        let mut parser = LibtestParser::default();
        let shown: Vec<_> = OUTPUT.lines().filter(|line| parser.take(line)).collect();
        let expected = Totals {
            passed: 1,
            failed: 1,
            skipped: 2,
        };
        assert_eq!(parser.totals, expected);
        assert!(shown.contains(&"skipped: no recordings in ../shared/data"));
        assert!(shown.contains(&"reason"));
        assert!(!shown.contains(&"noise"));
    }

    fn failing() -> Command {
        let mut command = Command::new("rustc");
        command.arg("no-such-file.rs").stderr(Stdio::null());
        command
    }

    #[test]
    fn a_failing_command_is_one_failure() {
        let totals = of_command(failing()).expect("it starts");
        assert_eq!(totals, Totals::FAILED);
    }

    #[test]
    fn a_runner_that_dies_without_a_count_is_one_failure() {
        let totals = of_test_runner(failing()).expect("it starts");
        assert_eq!(totals, Totals::FAILED);
    }
}
