//! Choices at build time.

use robot_app::domain::{BusId, CanFrame};
use robot_app::input::RemoteFormat;
use robot_app::motor::layout::{MotorLayout, ROBOT_LAYOUT, RS00_LAYOUT};

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

/// The layout with DM4310 joints, unless the environment variable `ROBOT_JOINTS` names another motor.
const CHOSEN_LAYOUT: MotorLayout = match option_env!("ROBOT_JOINTS") {
    None => ROBOT_LAYOUT,
    Some(name) => layout(name),
};

/// Place, number and direction of each motor.
pub static LAYOUT: MotorLayout = CHOSEN_LAYOUT;

/// The frames that stop every motor. Boot and the fault handlers send them.
pub static SAFE_FRAMES: [(BusId, CanFrame); 5] = CHOSEN_LAYOUT.safe_frames();

const fn layout(name: &str) -> MotorLayout {
    match name.as_bytes() {
        b"dm4310" => ROBOT_LAYOUT,
        b"rs00" => RS00_LAYOUT,
        _ => wrong_joints(),
    }
}

#[expect(clippy::panic, reason = "stops the build, not the robot")]
const fn wrong_joints() -> MotorLayout {
    panic!(
        "ROBOT_JOINTS must be dm4310 or rs00: `ROBOT_JOINTS=rs00 cargo run --release`, or unset it for DM4310"
    )
}

#[expect(clippy::panic, reason = "stops the build, not the robot")]
const fn wrong_remote() -> RemoteFormat {
    panic!(
        "ROBOT_REMOTE must be sbus or dbus: `ROBOT_REMOTE=dbus cargo run --release`, or unset it for SBUS"
    )
}
