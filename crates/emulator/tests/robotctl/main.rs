//! The PC's tool against the shipped image: settings over an slcan adapter, and calibration from recording to effect.

#[path = "../support/mod.rs"]
mod support;

mod mounting;
mod saving;
mod tool;
mod trial;

use std::path::{Path, PathBuf};

use robot_emulator::sim::{job::Job, scenario::Scenario};
use robot_plant::{recording::run_length, world::CanBusId};
use robotctl::{
    calibration::{accel, mag},
    parameter_file::ParameterFile,
    recording::{self, Sample, Sensor},
    tuning,
};
use tool::Tool;
use trial::SensorErrors;

fn job() -> Job {
    let text = "name = \"tool\"\nseconds = 2\nplant = \"stand\"\n";
    let mut job = support::job(Scenario::parse(text, "tool").expect("it parses"));
    job.can_on_pty = vec![CanBusId::Can1];
    job
}

#[test]
fn settings_of_the_running_image_are_read_and_changed() {
    let mut tool = Tool::new(|client| {
        for named in tuning::all() {
            let value = client.read(named)?;
            let allowed = named.parameter.min..=named.parameter.max;
            assert!(allowed.contains(&value), "{} = {value}", named.full_name());
        }
        client.write(tuning::find("wheel-geometry.track-m")?, 0.37)?;
        let arming = client.live(tuning::live_page("arming"), 0)?;
        let joint = client.live(tuning::live_page("joint"), 3)?;
        let accel = client.live(tuning::live_page("accel"), 0)?;
        let live = [arming, joint, accel].map(|page| page.expect("this firmware has it"));
        Ok((client.read_geometry()?, live))
    });
    let mut job = job();
    let flash = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("settings.bin");
    std::fs::write(&flash, clean_flash()).expect("a file for its flash");
    job.flash_file = Some(flash);
    let outcome = job.run(&mut [&mut tool]).expect("the machine starts");
    let (geometry, [arming, joint, accel]) = tool.result().expect("the robot answers");
    assert_eq!(arming.choice("state"), "disarmed");
    assert!(
        arming.has("blockers", "enable-off"),
        "{:?}",
        arming.set("blockers")
    );
    assert_eq!(joint.choice("state"), "disabled");
    assert!(
        accel
            .number("z-mps2")
            .is_some_and(|up| (9.5..10.1).contains(&up))
    );
    assert_eq!(geometry.track_mm, 370);
    assert!(geometry.right_reversed && !geometry.left_reversed);
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    assert_eq!(outcome.summary.control.missed, 0);
    assert_eq!(outcome.result.value("diag.tuning.refused"), Some(0.0));
    assert_eq!(outcome.result.value("diag.tuning.revision"), Some(1.0));
}

/// What the firmware made of the trial, as `run.mcap` has it.
fn samples(run: &Path, sensor: Sensor) -> Vec<Sample> {
    recording::load(&run.join("run.mcap"), sensor).expect("a recording")
}

/// Three sectors that need no erase (docs/parameters.md): it would leave a gap in a recording, and what a PC asks in the
/// meantime is lost.
fn clean_flash() -> Vec<u8> {
    const SECTOR: usize = 16 * 1024;
    let mut flash = vec![0xFF; 3 * SECTOR];
    for sector in flash.chunks_exact_mut(SECTOR) {
        sector[..4].copy_from_slice(&0xD05E_EAC1_u32.to_le_bytes());
    }
    flash
}

fn play(trial: &Path, out: &Path, parameters: ParameterFile) {
    let mut job = job();
    std::fs::create_dir_all(out).expect("a folder for the run");
    let flash = out.join("flash.bin");
    std::fs::write(&flash, clean_flash()).expect("a file for its flash");
    job.flash_file = Some(flash);
    job.scenario.length = run_length(trial).expect("a trial");
    job.imu_trial = Some(trial.to_owned());
    let mut tool = Tool::new(move |client| Ok(tuning::apply(client, &parameters)?.len()));
    let outcome = job.run_into(out, &mut tool).expect("the machine starts");
    tool.result().expect("the values are applied");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
}

/// A robot whose sensors are wrong is recorded on all sides, calibrated from its own recording, and measures right after
/// the values were written to it.
#[test]
fn a_recording_of_the_image_corrects_its_sensors() {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("calibration");
    let errors = SensorErrors::default();
    let trial = trial::write(&directory, &errors);
    let (before, after) = (directory.join("before"), directory.join("after"));

    play(&trial, &before, ParameterFile::default());
    let accel = accel::calibrate(&[samples(&before, Sensor::Accelerometer)]).expect("a good fit");
    let mag = mag::calibrate(&[samples(&before, Sensor::Magnetometer)], None).expect("a good fit");
    let mut parameters = ParameterFile::default();
    accel.correction.write(&mut parameters);
    mag.correction.write(&mut parameters);

    // Half a count of the BMI088 at ±12 g is 0.0018 m/s², of the IST8310 0.15 µT.
    for axis in 0..3 {
        let bias_error = accel.correction.bias_mps2[axis] - errors.accel_offset_mps2[axis];
        assert!(bias_error.abs() < 0.01, "{:?}", accel.correction);
        let bias_error = mag.correction.bias_ut[axis] - errors.magnet_ut[axis];
        assert!(bias_error.abs() < 0.3, "{:?}", mag.correction);
    }

    play(&trial, &after, parameters);
    let accel = accel::calibrate(&[samples(&after, Sensor::Accelerometer)]).expect("a good fit");
    let mag = mag::calibrate(&[samples(&after, Sensor::Magnetometer)], None).expect("a good fit");
    assert!(accel.residual_before_mps2 < 0.01, "{accel:?}");
    assert!(mag.residual_before_ut < 1.0, "{}", mag.residual_before_ut);
}
