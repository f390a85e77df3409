//! Manual driving: sticks → high-level command.

use crate::{
    domain::{HighLevelCommand, RemoteState},
    math::scalar,
};

/// Maps the sticks to a drive command. `stick_centre` is the limit up to which `Arming` takes a stick for centred, so
/// a stick that permits arming moves nothing.
pub(super) fn drive(remote: &RemoteState, stick_centre: f32) -> HighLevelCommand {
    HighLevelCommand {
        vx: outside_dead_band(remote.vx, stick_centre),
        wz: outside_dead_band(remote.wz, stick_centre),
        ..HighLevelCommand::default()
    }
}

/// Removes the dead band. The output starts from 0 at `dead_band` and rises twice as steeply as the stick until it
/// meets it, so full stick stays full. NaN gives 0.
fn outside_dead_band(stick: f32, dead_band: f32) -> f32 {
    let beyond = stick.abs() - dead_band;
    if beyond <= 0.0 || beyond.is_nan() {
        0.0
    } else {
        scalar::min(2.0 * beyond, stick.abs()).copysign(stick)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vx(stick: f32, stick_centre: f32) -> f32 {
        let remote = RemoteState {
            vx: stick,
            wz: -stick,
            ..RemoteState::default()
        };
        let command = drive(&remote, stick_centre);
        assert_eq!(command.wz, -command.vx);
        command.vx
    }

    #[test]
    fn a_stick_that_is_centred_for_arming_moves_nothing() {
        for limit in [0.01, 0.05, 0.3] {
            assert_eq!(vx(limit, limit), 0.0);
            assert_eq!(vx(-limit, limit), 0.0);
        }
        assert_eq!(vx(f32::NAN, 0.05), 0.0);
    }

    #[test]
    fn beyond_the_dead_band_the_command_rises_from_zero_to_full() {
        for limit in [0.01, 0.05, 0.3] {
            assert!((vx(limit + 0.001, limit) - 0.002).abs() < 1e-6);
            assert!((vx(-limit - 0.001, limit) + 0.002).abs() < 1e-6);
            let mut last = 0.0;
            for step in 0..=1_000u16 {
                let now = vx(f32::from(step) * 1e-3, limit);
                assert!((0.0..=0.002_01).contains(&(now - last)), "{step}");
                last = now;
            }
            assert_eq!(last, 1.0);
        }
        assert_eq!(vx(0.4, 0.05), 0.4);
        assert_eq!(vx(-0.4, 0.05), -0.4);
    }
}
