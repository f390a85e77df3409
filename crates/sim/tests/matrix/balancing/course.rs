//! Lets the robot stand up and drive, breaks something, and looks whether it balances or lies.

use robot_plant::{
    time::{MS, Ps},
    world::RemoteInput,
};

use crate::{
    balancing_expected::Outcome,
    drive::{Drive, PC_STARTS, READY, enable},
    observed::{Observed, Phase, UPRIGHT_M},
    row::Row,
};

pub const WORLD: &str = "name = \"matrix\"\nseconds = 20.0\nplant = \"free\"\n";

const ASKS_TO_STAND: Ps = READY + 200 * MS;
/// By this time it has stood up.
const STANDS: Ps = ASKS_TO_STAND + 2_000 * MS;
/// Start of the fault, not synchronous to the control tick. The robot has reached its speed.
const FAULT: Ps = STANDS + 800 * MS + 370_000_000;
/// A PC at rest, and then the time to reach half of its speed.
const RESTS: Ps = 500 * MS;
const STARTS: Ps = 700 * MS;

/// The run of one row.
pub fn run(row: &Row) -> Observed {
    let (fault, driver) = (row.fault, row.driver);
    let over = FAULT + row.lasts;
    let back = over + (row.back_within_ms * MS as f64) as Ps;
    let mut drive = Drive::new(row, Phase::Balancing);
    drive.until(PC_STARTS);
    for event in driver.prepare(Phase::Balancing) {
        drive.act(&event);
    }
    drive.until(READY);
    drive.pilot(enable(true));
    drive.until(ASKS_TO_STAND);
    drive.pilot(RemoteInput {
        stand: Some(true),
        ..RemoteInput::default()
    });
    drive.until(STANDS);
    assert!(drive.height_m() > UPRIGHT_M, "{fault}: it has not stood up");
    drive.act(&driver.push(Phase::Balancing));
    drive.until(FAULT);
    assert!(drive.armed(), "{fault}: not armed");
    drive.begin(fault);
    if let Some(wheel) = row.balancing.deaf_wheel {
        drive.goes_deaf(wheel);
    }
    drive.until(over);
    drive.end(fault);
    drive.until(back);
    drive.note_back();
    if drive.height_m() < UPRIGHT_M {
        drive.try_to_arm();
    } else if row.balancing.outcome == Outcome::OnTheSpot {
        drive.centre(&driver.rest(Phase::Balancing));
        drive.until(back + RESTS);
        drive.act(&driver.push(Phase::Balancing));
        drive.until(back + RESTS + STARTS);
    }
    drive.conclude()
}

impl Drive {
    /// Off and on, with centred sticks, while the stand switch stays up.
    fn try_to_arm(&mut self) {
        let off = self.now();
        self.pilot(enable(false));
        self.until(off + 300 * MS);
        self.pilot(enable(true));
        self.until(off + 600 * MS);
        self.note_arming();
    }
}
