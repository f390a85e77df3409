//! `robotctl radio`: guides the pilot through the controls of an SBUS transmitter and finds their channels.

use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use robot_app::{domain::NO_CHANNEL, tuning::Refusal};
use robotctl::{
    radio::{self, Control, HeldPosition, MappedControl, Movement, Watch, WatchError},
    settings,
    tuning::{BringUpStep, TuningClient, TuningError},
};

use super::{
    answer::ask,
    connection::{Connection, examples},
    output::say,
    tune::confirm_saved,
};

/// Time for the pilot to move the sticks to all their ends.
const ROUND: Duration = Duration::from_secs(8);

#[derive(clap::Args)]
#[command(after_help = examples!("radio"))]
pub struct Radio {
    #[command(flatten)]
    connection: Connection,
    /// Write the result to the robot; without this option the robot's settings are only compared
    #[arg(long)]
    write: bool,
}

impl Radio {
    pub fn run(self) -> Result<()> {
        let mut client = self.connection.open()?;
        say!(
            "For SBUS; DBUS needs no settings. Robot disarmed, wheels off the ground, transmitter on."
        )?;
        Watch::new(&mut client).check_disarmed()?;
        let enable = settings::find(radio::ENABLE_CHANNEL)?;
        let enable_was = client.read(enable)?;
        bring_up(&mut client, BringUpStep::ReadOnly, enable_was)?;
        say!(
            "The robot is in bring-up, read only: it cannot be armed until this command has ended.\n"
        )?;
        if self.write {
            client.write(enable, NO_CHANNEL as f32)?;
        }
        let found = find(&mut Watch::new(&mut client));
        if self.write && found.is_err() {
            // Nothing else has changed. Once writing has begun, only a complete mapping may have an enable channel.
            client.write(enable, enable_was)?;
        }
        let done = found.and_then(|found| self.conclude(&mut client, &found, enable_was));
        // After an interruption the robot stays in a state in which it cannot be armed.
        done.with_context(|| {
            format!(
                "the robot stays in bring-up and cannot be armed: `robotctl tune {} bring-up off`",
                self.connection.words()
            )
        })?;
        bring_up(&mut client, BringUpStep::Off, enable_was)
    }

    fn conclude(
        &self,
        client: &mut TuningClient,
        found: &[MappedControl],
        enable_was: f32,
    ) -> Result<()> {
        say!("\nSo:")?;
        for control in found {
            say!("{}", control.in_words())?;
        }
        let differing = radio::differing(client, found, enable_was)?;
        if differing.is_empty() {
            say!("\nThe robot's settings are right.")?;
        } else {
            say!("\nThe robot's settings differ:")?;
        }
        for (named, is, wanted) in &differing {
            say!("{} = {wanted} (the robot had {is})", named.full_name())?;
        }
        if self.write {
            radio::write(client, found)?;
            confirm_saved(client)?;
        } else if !differing.is_empty() {
            say!(
                "next:   the same with --write, or robotctl tune {} set NAME VALUE",
                self.connection.words()
            )?;
        }
        Ok(())
    }
}

/// Requests a step of bring-up. While the robot reads its present enable switch as on, it asks the user to change that.
fn bring_up(client: &mut TuningClient, step: BringUpStep, enable: f32) -> Result<()> {
    loop {
        match client.bring_up(step) {
            Err(TuningError::Refused {
                reason: Ok(Refusal::Armed),
                ..
            }) => ask(&format!(
                "The robot reads channel {enable}, which its settings call enable, as on: put the control of \
                 that channel to its other end."
            ))?,
            done => return Ok(done?),
        };
    }
}

fn find(watch: &mut Watch<'_>) -> Result<Vec<MappedControl>> {
    let rest = loop {
        ask(
            "Enable off, e-stop thrown, mode at manual, stand switch at sit, knobs for height and roll in their middle, \
             sticks let go; one without a spring in its middle.",
        )?;
        if let Some(rest) = heard(watch.still())? {
            break rest;
        }
    };
    let mut found = Vec::new();
    let mut sticks = Vec::new();
    for control in Control::STICKS {
        let moved = find_moved(watch, control, &rest, &found)?;
        // The ends of a stick are found later. Its channel is taken from now on.
        found.push(moved.map_or(missing(control), |moved| MappedControl::switch(&moved)));
        sticks.extend(moved);
    }
    let ends = find_ends(watch, &sticks)?;
    for found in &mut found {
        let ends = ends.iter().find(|stick| stick.control == found.control);
        *found = *ends.unwrap_or(found);
    }
    for control in Control::BALANCE.into_iter().chain(Control::SWITCHES) {
        let moved = find_moved(watch, control, &rest, &found)?;
        found.push(moved.map_or(missing(control), |moved| MappedControl::switch(&moved)));
    }
    put_back(watch, &rest)?;
    Ok(found)
}

/// Returns `None` if the transmitter has no such control.
fn find_moved(
    watch: &mut Watch<'_>,
    control: Control,
    rest: &HeldPosition,
    found: &[MappedControl],
) -> Result<Option<Movement>> {
    if control.may_be_missing() {
        say!("(Without a {} control, type none.)", control.name())?;
    }
    loop {
        let answer = ask(control.request())?;
        if control.may_be_missing() && answer == "none" {
            return Ok(None);
        }
        let Some(held) = heard(watch.still())? else {
            continue;
        };
        match Movement::find(control, rest, &held, found) {
            Ok(moved) => {
                say!(
                    "Channel {} went from {} to {}: {}.",
                    moved.index,
                    moved.from,
                    moved.to,
                    control.name()
                )?;
                return Ok(Some(moved));
            }
            Err(error) => say!("{error}")?,
        }
    }
}

/// Asks until all controls are back, because the robot takes settings only with its enable switch off.
fn put_back(watch: &mut Watch<'_>, rest: &HeldPosition) -> Result<()> {
    loop {
        ask("Put the e-stop back to stop.")?;
        let Some(now) = heard(watch.still())? else {
            continue;
        };
        match rest.check_back(&now) {
            Ok(()) => return Ok(()),
            Err(error) => say!("{error}")?,
        }
    }
}

fn find_ends(watch: &mut Watch<'_>, sticks: &[Movement]) -> Result<Vec<MappedControl>> {
    'again: loop {
        ask(
            "Let go. After Enter, move both sticks slowly round all their ends for eight seconds.",
        )?;
        let start = Instant::now();
        let mut frames = Vec::new();
        while start.elapsed() < ROUND {
            let Some(frame) = heard(watch.frame())? else {
                continue 'again;
            };
            frames.push(frame);
        }
        let ends = sticks.iter().map(|moved| {
            let channel = radio::stick(moved, &frames)?;
            Ok(MappedControl {
                control: moved.control,
                channel: Some(channel),
            })
        });
        match ends.collect::<Result<Vec<_>, radio::MoveError>>() {
            Ok(ends) => return Ok(ends),
            Err(error) => say!("{error}")?,
        }
    }
}

/// Returns `None` and says so if the radio was not received, which the pilot can correct.
fn heard<T>(seen: Result<T, WatchError>) -> Result<Option<T>> {
    match seen {
        Ok(seen) => Ok(Some(seen)),
        Err(error @ WatchError::NotHeard) => {
            say!("{error}")?;
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}

fn missing(control: Control) -> MappedControl {
    MappedControl {
        control,
        channel: None,
    }
}
