//! `robotctl mounting`: guides the user through some poses and finds how the sensors are mounted.

use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use robot_app::domain::Orientation;
use robotctl::{
    mounting::{self, BoardMounting, FieldSample, MagMounting, Poses, Watch, WatchError},
    settings,
    tuning::TuningClient,
};

use super::{
    answer::ask,
    connection::{Connection, examples},
    output::say,
    tune::confirm_saved,
};

/// Longest time for turning the robot by hand.
const TURNING: Duration = Duration::from_secs(90);
/// Time after which the gyro is calibrated and the attitude has settled.
const SETTLING: Duration = Duration::from_secs(30);

#[derive(clap::Args)]
#[command(after_help = examples!("mounting"))]
pub struct Mounting {
    #[command(flatten)]
    connection: Connection,
    /// Write the result to the robot; without this option the robot's settings are only checked
    #[arg(long)]
    write: bool,
    /// Find out also how the magnetometer is mounted on the board
    #[arg(long)]
    mag: bool,
}

impl Mounting {
    pub fn run(self) -> Result<()> {
        let mut client = self.connection.open()?;
        say!("Disarm the robot and take its weight: it is tilted by hand, motors off.\n")?;
        let found = find_board(&mut client)?;
        self.conclude(&mut client, "mounting.board", found.orientation)?;
        if !self.mag {
            return Ok(());
        }
        let board = Watch::new(&mut client)?.board();
        if board != found.orientation {
            bail!("the magnetometer can be found only once mounting.board is right: add --write");
        }
        self.forget_mag(&mut client)?;
        let mag = find_mag(&mut client, board)?;
        self.conclude(&mut client, "mounting.mag", mag.orientation)
    }

    /// Removes the magnetometer's mounting. A wrong one would turn the heading, which must be right for the
    /// measurement.
    fn forget_mag(&self, client: &mut TuningClient) -> Result<()> {
        if Watch::new(client)?.mag().is_none() {
            return Ok(());
        }
        if !self.write {
            bail!("mounting.mag is set, so the heading follows it; add --write to find it anew");
        }
        let named = settings::find("mounting.mag")?;
        client.write(named, named.parse("unset")?)?;
        Ok(())
    }

    fn conclude(&self, client: &mut TuningClient, name: &str, found: Orientation) -> Result<()> {
        let named = settings::find(name)?;
        let (is, found_name) = (client.read(named)?, found.name());
        let wanted = named.parse(found_name)?;
        if is == wanted {
            say!("{name} is {found_name} already: right.\n")?;
        } else if self.write {
            client.write(named, wanted)?;
            say!("{name} = {found_name} (was {})", named.in_words(is))?;
            confirm_saved(client)?;
            say!(
                "A stop `tilt` from before goes with enable off and e-stop thrown for a second.\n"
            )?;
        } else {
            say!("{name} is {}: WRONG.", named.in_words(is))?;
            say!(
                "next:   the same with --write, or robotctl tune {} set {name} {found_name}\n",
                self.connection.words()
            )?;
        }
        Ok(())
    }
}

fn find_board(client: &mut TuningClient) -> Result<BoardMounting> {
    let mut watch = Watch::new(client)?;
    let mut pose = |what: &str| -> Result<_> {
        loop {
            ask(what)?;
            match watch.still_force() {
                Err(moved @ WatchError::Moved(_)) => say!("{moved}")?,
                force => return Ok(force?),
            }
        }
    };
    let poses = Poses {
        level: pose("Put it level, as it drives, and let go.")?,
        nose_up: pose("Lift its nose by 30 to 90 degrees and hold it still.")?,
        left_up: pose(
            "Level again, then lift its left side by 30 to 90 degrees and hold it still.",
        )?,
    };
    let found = mounting::find_board(&poses)?;
    let BoardMounting {
        orientation,
        up,
        nose,
        left,
    } = found;
    say!(
        "\nLevel, the board's {} axis pointed up ({:.0} degrees off).",
        up.0,
        up.1
    )?;
    say!(
        "Nose up by {:.0} degrees, its {} axis rose.",
        nose.1,
        nose.0
    )?;
    say!(
        "Left side up by {:.0} degrees, its {} axis rose.",
        left.1,
        left.0
    )?;
    say!(
        "So on the board {}: {}.",
        mounting::describe(orientation),
        orientation.name()
    )?;
    Ok(found)
}

fn find_mag(client: &mut TuningClient, board: Orientation) -> Result<MagMounting> {
    ask("Put it level and leave it alone until it is calibrated, away from iron.")?;
    let mut watch = Watch::new(client)?;
    let deadline = Instant::now() + SETTLING;
    while let Err(error) = watch.check_attitude() {
        if Instant::now() > deadline {
            return Err(error.into());
        }
    }
    say!(
        "Now turn it slowly in your hands: left, nose up, left side up, upside down, for half a minute."
    )?;
    let samples = turn(&mut watch)?;
    watch.check_attitude()?;
    let found = mounting::find_mag(board, &samples)?;
    let MagMounting {
        orientation,
        earth_ut,
        dip_deg,
        residual_ut,
        second_residual_ut,
    } = found;
    say!(
        "\nThe earth's field is {earth_ut:.0} µT; this orientation leaves {residual_ut:.1} µT, the next best \
         {second_residual_ut:.1}."
    )?;
    let (part, where_) = if dip_deg < 0.0 {
        ("out of", "south")
    } else {
        ("into", "north")
    };
    say!(
        "It points {part} the ground by {:.0} degrees, as {where_} of the equator.",
        dip_deg.abs()
    )?;
    say!(
        "If you are on the other side, its axes are a mirror image: do not use it, and report that."
    )?;
    say!(
        "So on the magnetometer, with forward, left, up for the board's x, y, z: {}: {}.",
        mounting::describe(orientation),
        orientation.name()
    )?;
    Ok(found)
}

/// Collects samples until the robot was turned enough, and then for as long again.
fn turn(watch: &mut Watch<'_>) -> Result<Vec<FieldSample>> {
    let start = Instant::now();
    let mut samples = Vec::new();
    let mut enough_at = None;
    while start.elapsed() < TURNING {
        samples.push(watch.field()?);
        if enough_at.is_none() && mounting::enough_turned(&samples) {
            say!("Good; go on for a while.")?;
            enough_at = Some(2 * samples.len());
        }
        if enough_at.is_some_and(|count| samples.len() >= count) {
            break;
        }
    }
    Ok(samples)
}
