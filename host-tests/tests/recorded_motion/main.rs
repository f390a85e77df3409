//! The estimator on recorded human motion with optical ground truth (BROAD). `cargo xtask replay` shows the same.
//!
//! The recordings are not part of the repository. They are in `../shared/data/broad`, or where `ROBOT_DATA` points when
//! this is built. Without them these tests count as ignored.

mod limits;
mod twelve_trials;

use robot_replay::Mode;
use twelve_trials::errors_of_all;

const NO_OFFSET: [f32; 3] = [0.0; 3];

#[test]
#[cfg_attr(
    not(recorded_motion),
    ignore = "no recorded motion: `cargo xtask data` says how to get it"
)]
fn attitude_follows_the_optical_reference() -> anyhow::Result<()> {
    let with = errors_of_all(Mode::NineAxis, NO_OFFSET)?;
    let without = errors_of_all(Mode::SixAxis, NO_OFFSET)?;
    println!("with magnetometer:\n{with}\nwithout:\n{without}");
    limits::WITH_MAGNETOMETER.hold(&with);
    limits::WITHOUT_MAGNETOMETER.hold(&without);
    for (with, without) in with.trials.iter().zip(&without.trials) {
        let name = &with.name;
        let (inclination, alone) = (
            with.every_tick.inclination_deg,
            without.every_tick.inclination_deg,
        );
        assert!(
            inclination <= limits::WORST_INCLINATION_DEG,
            "{name}: {inclination}°"
        );
        assert!(
            (inclination - alone).abs() <= limits::TILT_BY_MAGNETOMETER_DEG,
            "{name}: the magnetometer tilts the horizon from {alone}° to {inclination}°"
        );
    }
    Ok(())
}

fn a_start_up_bias_costs_next_to_nothing(mode: Mode) -> anyhow::Result<()> {
    let without = errors_of_all(mode, NO_OFFSET)?;
    for offset_dps in limits::START_UP_OFFSETS_DPS {
        let with = errors_of_all(mode, offset_dps)?;
        println!("{mode:?}, offset by {offset_dps:?} °/s:\n{with}");
        for (mean, calm) in [
            (with.mean_at_samples(), without.mean_at_samples()),
            (with.mean_every_tick(), without.mean_every_tick()),
        ] {
            let worse = limits::worse_deg(&mean, &calm);
            assert!(
                worse <= limits::WORSE_BY_OFFSET_DEG,
                "{mode:?}, offset by {offset_dps:?} °/s: {mean:?} instead of {calm:?}"
            );
        }
    }
    Ok(())
}

#[test]
#[cfg_attr(
    not(recorded_motion),
    ignore = "no recorded motion: `cargo xtask data` says how to get it"
)]
fn a_start_up_bias_is_found_with_magnetometer() -> anyhow::Result<()> {
    a_start_up_bias_costs_next_to_nothing(Mode::NineAxis)
}

#[test]
#[cfg_attr(
    not(recorded_motion),
    ignore = "no recorded motion: `cargo xtask data` says how to get it"
)]
fn a_start_up_bias_is_found_without_magnetometer() -> anyhow::Result<()> {
    a_start_up_bias_costs_next_to_nothing(Mode::SixAxis)
}
