//! The identifiers of the tuning channel's frames (docs/tuning.md).

use crate::domain::StandardId;

/// Requests that change something.
pub const WRITE_ID: StandardId = id(0x7A0);
/// Requests that only ask.
pub const READ_ID: StandardId = id(0x7A1);
/// Replies to both.
pub const REPLY_ID: StandardId = id(0x7A2);
/// Recorded samples, one identifier a sensor.
pub(super) const ACCEL_ID: StandardId = id(0x7A3);
pub(super) const GYRO_ID: StandardId = id(0x7A4);
pub(super) const MAG_ID: StandardId = id(0x7A5);
/// Bytes of the black box.
pub(super) const BLOCK_ID: StandardId = id(0x7A6);

const fn id(raw: u16) -> StandardId {
    match StandardId::new(raw) {
        Some(id) => id,
        None => unreachable!(),
    }
}
