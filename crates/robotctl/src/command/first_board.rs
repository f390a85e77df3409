//! `robotctl first-board`: makes the checks of a first board with the user.

use std::{
    io::{self, BufRead, Write},
    path::PathBuf,
};

use anyhow::Result;
use robotctl::first_board::{self, Dialogue, Outcome, Report, WalkOptions};

use super::{
    connection::{Connection, examples},
    output::say,
};

#[derive(clap::Args)]
#[command(after_help = examples!("first-board"))]
pub struct FirstBoard {
    #[command(flatten)]
    connection: Connection,
    /// Begin at this check; without this option, make the checks that are not in the report
    #[arg(long, value_name = "N")]
    from: Option<usize>,
    /// Ask nothing: make only the checks that need nobody at the robot, skip the others
    #[arg(long)]
    yes: bool,
    /// File of the report, which is read and written
    #[arg(long, default_value = "first-board.toml")]
    report: PathBuf,
}

impl FirstBoard {
    pub fn run(self) -> Result<()> {
        let mut report = Report::load_or_new(&self.report)?;
        let mut client = self.connection.open()?;
        let walk = WalkOptions {
            from: self.from,
            alone: self.yes,
        };
        first_board::walk(&mut client, &mut report, &mut Terminal, walk)?;
        let count = |outcome| report.count(outcome);
        say!(
            "\n{} as they must be, {} wrong, {} skipped, of {}: {}",
            count(Outcome::AsItMustBe),
            count(Outcome::Wrong),
            count(Outcome::Skipped),
            first_board::CHECKS.len(),
            report.path().display()
        )?;
        say!("please send that file back with an issue of the project")?;
        Ok(())
    }
}

struct Terminal;

impl Dialogue for Terminal {
    fn show(&mut self, text: &str) -> io::Result<()> {
        let mut output = io::stdout().lock();
        output.write_all(text.as_bytes())?;
        output.flush()
    }

    fn ask(&mut self, question: &str) -> io::Result<Option<String>> {
        self.show(question)?;
        let mut line = String::new();
        let read = io::stdin().lock().read_line(&mut line)?;
        Ok((read > 0).then(|| line.trim().to_owned()))
    }
}
