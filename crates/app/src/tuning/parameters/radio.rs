//! The channels of an SBUS transmitter. One group for each channel would hold more settings than fit into a record.

use crate::tuning::parameter::{Parameter, ParameterKind, integer};

/// Channel numbers from 0; 16 means no channel.
#[rustfmt::skip] // One line a setting.
pub static CHANNELS: [Parameter; 22] = [
    integer!(0, "steering-channel", "", 0.0, 16.0, radio.steering.index),
    integer!(1, "drive-channel", "", 0.0, 16.0, radio.drive.index),
    integer!(2, "select-channel", "", 0.0, 16.0, radio.select.index),
    integer!(3, "dead-man-channel", "", 0.0, 16.0, radio.dead_man.index),
    integer!(4, "enable-channel", "", 0.0, 16.0, radio.enable.index),
    integer!(5, "mode-channel", "", 0.0, 16.0, radio.mode.index),
    integer!(6, "e-stop-channel", "", 0.0, 16.0, radio.e_stop.index),
    integer!(7, "steering-reversed", "", 0.0, 1.0, radio.steering.reversed),
    integer!(8, "drive-reversed", "", 0.0, 1.0, radio.drive.reversed),
    integer!(9, "select-reversed", "", 0.0, 1.0, radio.select.reversed),
    integer!(10, "dead-man-reversed", "", 0.0, 1.0, radio.dead_man.reversed),
    integer!(11, "enable-reversed", "", 0.0, 1.0, radio.enable.reversed),
    integer!(12, "mode-reversed", "", 0.0, 1.0, radio.mode.reversed),
    integer!(13, "e-stop-reversed", "", 0.0, 1.0, radio.e_stop.reversed),
    integer!(14, "stand-channel", "", 0.0, 16.0, radio.stand.index),
    integer!(15, "jump-channel", "", 0.0, 16.0, radio.jump.index),
    integer!(16, "height-channel", "", 0.0, 16.0, radio.height.index),
    integer!(17, "roll-channel", "", 0.0, 16.0, radio.roll.index),
    integer!(18, "stand-reversed", "", 0.0, 1.0, radio.stand.reversed),
    integer!(19, "jump-reversed", "", 0.0, 1.0, radio.jump.reversed),
    integer!(20, "height-reversed", "", 0.0, 1.0, radio.height.reversed),
    integer!(21, "roll-reversed", "", 0.0, 1.0, radio.roll.reversed),
];

/// Counts as on the wire.
#[rustfmt::skip] // One line a setting.
pub static TRAVEL: [Parameter; 21] = [
    integer!(0, "steering-low", "counts", 0.0, 2_047.0, radio.steering.low),
    integer!(1, "steering-centre", "counts", 0.0, 2_047.0, radio.steering.centre),
    integer!(2, "steering-high", "counts", 0.0, 2_047.0, radio.steering.high),
    integer!(3, "drive-low", "counts", 0.0, 2_047.0, radio.drive.low),
    integer!(4, "drive-centre", "counts", 0.0, 2_047.0, radio.drive.centre),
    integer!(5, "drive-high", "counts", 0.0, 2_047.0, radio.drive.high),
    integer!(6, "select-low", "counts", 0.0, 2_047.0, radio.select.low),
    integer!(7, "select-centre", "counts", 0.0, 2_047.0, radio.select.centre),
    integer!(8, "select-high", "counts", 0.0, 2_047.0, radio.select.high),
    integer!(9, "dead-man-low", "counts", 0.0, 2_047.0, radio.dead_man.low),
    integer!(10, "dead-man-centre", "counts", 0.0, 2_047.0, radio.dead_man.centre),
    integer!(11, "dead-man-high", "counts", 0.0, 2_047.0, radio.dead_man.high),
    integer!(12, "enable-low", "counts", 0.0, 2_047.0, radio.enable.low),
    integer!(13, "enable-centre", "counts", 0.0, 2_047.0, radio.enable.centre),
    integer!(14, "enable-high", "counts", 0.0, 2_047.0, radio.enable.high),
    integer!(15, "mode-low", "counts", 0.0, 2_047.0, radio.mode.low),
    integer!(16, "mode-centre", "counts", 0.0, 2_047.0, radio.mode.centre),
    integer!(17, "mode-high", "counts", 0.0, 2_047.0, radio.mode.high),
    integer!(18, "e-stop-low", "counts", 0.0, 2_047.0, radio.e_stop.low),
    integer!(19, "e-stop-centre", "counts", 0.0, 2_047.0, radio.e_stop.centre),
    integer!(20, "e-stop-high", "counts", 0.0, 2_047.0, radio.e_stop.high),
];
