//! What a user chooses at build time.

use robot_app::input::RemoteFormat;

/// The receiver plugged into the board's DBUS connector.
pub const REMOTE_FORMAT: RemoteFormat = RemoteFormat::Sbus;
