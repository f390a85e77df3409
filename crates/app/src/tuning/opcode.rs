//! The first byte of each request and reply. This is the only table of these numbers; docs/tuning.md shows the bytes that
//! follow. The numbers are on the wire and never change.

/// Writes the wheel geometry, in the frame of ROBOT_CPP.
pub const WRITE_GEOMETRY: u8 = 0x10;
/// Reads the wheel geometry, in the frame of ROBOT_CPP.
pub const READ_GEOMETRY: u8 = 0x11;
/// Writes one setting.
pub const WRITE_PARAMETER: u8 = 0x20;
/// Reads one setting.
pub const READ_PARAMETER: u8 = 0x21;
/// Gives one group of settings, or all, their defaults.
pub const RESTORE_DEFAULTS: u8 = 0x30;
/// Asks whether flash holds all settings.
pub const READ_STORE: u8 = 0x31;
/// Asks what the last boot found in flash.
pub const READ_FINDINGS: u8 = 0x32;
/// Reads a page of live values.
pub const READ_LIVE: u8 = 0x33;
/// Begins a step of bring-up.
pub const BRING_UP: u8 = 0x40;
/// Makes the present angle of a joint the one given.
pub const ZERO_JOINT: u8 = 0x41;
/// Starts a recording of the sensors, or ends it.
pub const RECORD: u8 = 0x42;
/// Asks how the recording goes.
pub const READ_RECORDING: u8 = 0x43;
/// Asks what a bank of the black box holds.
pub const READ_BLACK_BOX: u8 = 0x44;
/// Reads bytes of a bank of the black box.
pub const READ_BLOCK: u8 = 0x45;
/// Releases an event of the black box.
pub const RELEASE_EVENT: u8 = 0x46;
/// Marks the reply to a request that was refused. No old client takes it for the answer to 0x10 or 0x11.
pub const REFUSED: u8 = 0xEE;

/// All of them, in order.
pub const ALL: [u8; 16] = [
    WRITE_GEOMETRY,
    READ_GEOMETRY,
    WRITE_PARAMETER,
    READ_PARAMETER,
    RESTORE_DEFAULTS,
    READ_STORE,
    READ_FINDINGS,
    READ_LIVE,
    BRING_UP,
    ZERO_JOINT,
    RECORD,
    READ_RECORDING,
    READ_BLACK_BOX,
    READ_BLOCK,
    RELEASE_EVENT,
    REFUSED,
];
