//! Choices at build time.

use robot_app::domain::{BusId, CanFrame};
use robot_app::input::RemoteFormat;
use robot_app::motor::layout::{CHOSEN_LAYOUT, MotorLayout};

/// The receiver on the board's DBUS connector: SBUS, unless the environment variable `ROBOT_REMOTE` names another.
pub const REMOTE_FORMAT: RemoteFormat = match option_env!("ROBOT_REMOTE") {
    None => RemoteFormat::Sbus,
    Some(name) => remote_format(name),
};

const fn remote_format(name: &str) -> RemoteFormat {
    match name.as_bytes() {
        b"sbus" => RemoteFormat::Sbus,
        b"dbus" => RemoteFormat::Dbus,
        _ => wrong_remote(),
    }
}

/// Place, number and direction of each motor of the robot in `robots/` that the environment variable `ROBOT` names, or of
/// `fivebar`.
pub static LAYOUT: MotorLayout = CHOSEN_LAYOUT;

/// The frames that stop every motor. Boot and the fault handlers send them.
pub static SAFE_FRAMES: [(BusId, CanFrame); 5] = CHOSEN_LAYOUT.safe_frames();

#[expect(clippy::panic, reason = "stops the build, not the robot")]
const fn wrong_remote() -> RemoteFormat {
    panic!(
        "ROBOT_REMOTE must be sbus or dbus: `ROBOT_REMOTE=dbus cargo run --release`, or unset it for SBUS"
    )
}
