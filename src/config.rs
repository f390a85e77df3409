//! What a user chooses at build time.

use robot_app::input::RemoteFormat;

/// The receiver plugged into the board's DBUS connector: SBUS, or what the environment variable `ROBOT_REMOTE` says.
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

#[expect(clippy::panic, reason = "stops the build, not the robot")]
const fn wrong_remote() -> RemoteFormat {
    panic!(
        "ROBOT_REMOTE must be sbus or dbus: `ROBOT_REMOTE=dbus cargo run --release`, or unset it for SBUS"
    )
}
