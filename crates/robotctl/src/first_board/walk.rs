//! Takes the user through the list of checks.

use super::{CHECKS, Check, Entry, Measured, Method, Outcome, Report, ReportError, Verdict};
use crate::{
    status::Status,
    tuning::{TuningClient, TuningError},
};

/// The channel to the user: a terminal, or a script in tests.
pub trait Dialogue {
    fn show(&mut self, text: &str) -> std::io::Result<()>;
    /// Returns the answer without the spaces around it, or `None` at the end of input.
    fn ask(&mut self, question: &str) -> std::io::Result<Option<String>>;
}

/// Says which checks are made and how.
#[derive(Clone, Copy, Debug)]
pub struct WalkOptions {
    /// Number of the first check, counted from 1. `None` means all that are not in the report.
    pub from: Option<usize>,
    /// True to make only the checks that need no user and skip the others.
    pub alone: bool,
}

#[derive(Debug, thiserror::Error)]
pub enum WalkError {
    #[error(transparent)]
    Robot(#[from] TuningError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error("cannot talk to the user")]
    User(#[from] std::io::Error),
    #[error("there are checks 1 to {}", CHECKS.len())]
    NoSuchCheck,
}

/// What to do after a check.
enum Next {
    Done(Entry),
    Again,
    Quit,
}

/// Makes the checks until the last one, or until the user stops.
pub fn walk(
    client: &mut TuningClient,
    report: &mut Report,
    user: &mut dyn Dialogue,
    walk: WalkOptions,
) -> Result<(), WalkError> {
    if walk
        .from
        .is_some_and(|from| !(1..=CHECKS.len()).contains(&from))
    {
        return Err(WalkError::NoSuchCheck);
    }
    for (number, check) in (1..).zip(&CHECKS) {
        let is_wanted = match walk.from {
            Some(from) => number >= from,
            None => report.entry(check.id).is_none(),
        };
        if !is_wanted {
            continue;
        }
        user.show(&format!("\n{}", heading(number, check)))?;
        loop {
            let next = match walk.alone {
                true => alone(client, check, user)?,
                false => with_user(client, check, user)?,
            };
            match next {
                Next::Done(entry) => {
                    report.set_status(Status::read(client)?.to_json().to_string());
                    report.put(check.id, entry)?;
                    break;
                }
                Next::Again => {}
                Next::Quit => return Ok(()),
            }
        }
    }
    Ok(())
}

fn heading(number: usize, check: &Check) -> String {
    let mut text = format!("{number} of {}: {}\n", CHECKS.len(), check.title);
    for (what, words) in [
        ("connect", check.connect),
        ("do", check.act),
        ("see", check.see),
        ("note", check.note),
    ] {
        if !words.is_empty() {
            text.push_str(&format!("  {what:<8} {words}\n"));
        }
    }
    text
}

fn alone(
    client: &mut TuningClient,
    check: &Check,
    user: &mut dyn Dialogue,
) -> Result<Next, WalkError> {
    let Method::Alone(measure) = check.how else {
        user.show("  skipped: it needs somebody at the robot\n")?;
        return Ok(Next::Done(Entry::new(
            Outcome::Skipped,
            String::new(),
            None,
        )));
    };
    let measured = measure(client)?;
    user.show(&shown(&measured))?;
    let outcome = match measured.verdict {
        Verdict::AsItMustBe => Outcome::AsItMustBe,
        Verdict::Wrong(_) => Outcome::Wrong,
        Verdict::ForTheUser => Outcome::Skipped,
    };
    Ok(Next::Done(Entry::new(
        outcome,
        String::new(),
        Some(&measured),
    )))
}

fn with_user(
    client: &mut TuningClient,
    check: &Check,
    user: &mut dyn Dialogue,
) -> Result<Next, WalkError> {
    let Some(begin) = user.ask("  Enter when it is ready, s to skip, q to stop here: ")? else {
        return Ok(Next::Quit);
    };
    match begin.as_str() {
        "q" => return Ok(Next::Quit),
        "s" => {
            let why = user.ask("  why? ")?.unwrap_or_default();
            return Ok(Next::Done(Entry::new(Outcome::Skipped, why, None)));
        }
        _ => {}
    }
    let measured = match check.how {
        Method::Asked => None,
        Method::Prepared(measure) | Method::Alone(measure) => Some(measure(client)?),
    };
    let verdict = measured
        .as_ref()
        .map_or(Verdict::ForTheUser, |m| m.verdict.clone());
    if let Some(measured) = &measured {
        user.show(&shown(measured))?;
    }
    let outcome = match verdict {
        Verdict::AsItMustBe => Outcome::AsItMustBe,
        Verdict::Wrong(_) => match user.ask("  again? y, or Enter to note it as wrong: ")? {
            Some(answer) if answer == "y" => return Ok(Next::Again),
            _ => Outcome::Wrong,
        },
        Verdict::ForTheUser => match user.ask("  is it as it must be? y or n: ")?.as_deref() {
            Some("y") => Outcome::AsItMustBe,
            Some("n") => Outcome::Wrong,
            None => return Ok(Next::Quit),
            Some(_) => return Ok(Next::Again),
        },
    };
    let note = user.ask("  your note, or Enter: ")?.unwrap_or_default();
    Ok(Next::Done(Entry::new(outcome, note, measured.as_ref())))
}

fn shown(measured: &Measured) -> String {
    let mut text = String::new();
    for (name, value) in &measured.values {
        text.push_str(&format!("  {name:<22} {value}\n"));
    }
    for (name, word) in &measured.words {
        text.push_str(&format!("  {name:<22} {word}\n"));
    }
    match &measured.verdict {
        Verdict::AsItMustBe => text.push_str("  as it must be\n"),
        Verdict::Wrong(why) => text.push_str(&format!("  WRONG: {why}\n")),
        Verdict::ForTheUser => {}
    }
    text
}
