//! Sticks → high-level command.

use crate::domain::{HighLevelCommand, RemoteState};

/// Sticks closer to the centre than this mean zero: a hand-held stick never returns exactly.
const DEAD_BAND: f32 = 0.02;

pub(super) fn drive(remote: &RemoteState) -> HighLevelCommand {
    HighLevelCommand {
        vx: outside_dead_band(remote.vx),
        wz: outside_dead_band(remote.wz),
    }
}

fn outside_dead_band(stick: f32) -> f32 {
    if stick.abs() < DEAD_BAND { 0.0 } else { stick }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nearly_centred_stick_is_centred() {
        let command = drive(&RemoteState {
            vx: 0.019,
            wz: -0.021,
            ..RemoteState::default()
        });
        assert_eq!((command.vx, command.wz), (0.0, -0.021));
    }
}
