//! The PC's programs against the shipped image: settings over an slcan adapter or a gateway, and calibration from recording to effect.

#[path = "../support/mod.rs"]
mod support;

mod black_box;
mod every_way;
mod link;
mod mounting;
mod policy;
mod saving;
mod tool;
mod trial;

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use anyhow::Context;
use robot_plant::{recording::run_length, world::CanBusId};
use robot_sim::{job::Job, scenario::Scenario};
use robotctl::{
    calibration::{accel, mag},
    parameter_file::ParameterFile,
    recorder::{self, RecordTimeouts},
    recording::{self, Sample, Sensor},
    settings,
    tuning::{self, TuningClient},
};
use tool::Tool;
use trial::SensorErrors;

/// Length of the recording, nearly the whole trial.
const RECORDED_S: u16 = 24;
/// In time of the computer, on which the board may run slowly.
const TIMEOUT: RecordTimeouts = RecordTimeouts {
    look: Duration::from_millis(50),
    silence: Duration::from_secs(60),
};

fn job() -> Job {
    let text = "name = \"tool\"\nseconds = 2\nplant = \"stand\"\n";
    let mut job = support::job(Scenario::parse(text, "tool").expect("it parses"));
    job.pc.can_on_pty = vec![CanBusId::Can1];
    job
}

#[test]
fn settings_of_the_running_image_are_read_and_changed() {
    let mut tool = Tool::new(|client| {
        for named in settings::all() {
            let value = client.read(named)?;
            let allowed = named.parameter.min..=named.parameter.max;
            assert!(allowed.contains(&value), "{} = {value}", named.full_name());
        }
        client.write(settings::find("wheel-geometry.track-m")?, 0.37)?;
        let arming = client.live(tuning::live_page("arming"), 0)?;
        let joint = client.live(tuning::live_page("joint"), 3)?;
        // One of each side: they turn in opposite directions.
        client.zero_joint(1, 0.5)?;
        client.zero_joint(2, -0.25)?;
        let zeros = (joint_angle(client, 1)?, joint_angle(client, 2)?);
        let accel = client.live(tuning::live_page("accel"), 0)?;
        let live = [arming, joint, accel].map(|page| page.expect("this firmware has it"));
        Ok((client.read_geometry()?, live, zeros))
    });
    let mut job = job();
    let flash = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("settings.bin");
    std::fs::write(&flash, clean_flash()).expect("a file for its flash");
    job.flash_file = Some(flash);
    let outcome = job.run(&mut [&mut tool]).expect("the machine starts");
    let (geometry, [arming, joint, accel], zeros) = tool.result().expect("the robot answers");
    assert!(
        (zeros.0 - 0.5).abs() < 0.002 && (zeros.1 + 0.25).abs() < 0.002,
        "{zeros:?}"
    );
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
    assert_eq!(outcome.result.value("diag.tuning.revision"), Some(3.0));
}

/// A disabled joint reports every other tick, and no reply comes within the tick of its request.
fn joint_angle(client: &mut TuningClient, joint: usize) -> anyhow::Result<f64> {
    let page = tuning::live_page("joint");
    client.live(page, joint)?;
    let reading = client.live(page, joint)?.context("this firmware has it")?;
    reading.number("angle-rad").context("the joint is heard")
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

/// What the tool did while the trial played.
fn play<T: Send + 'static>(
    trial: &Path,
    out: &Path,
    work: impl FnOnce(&mut TuningClient) -> anyhow::Result<T> + Send + 'static,
) -> T {
    let mut job = job();
    std::fs::create_dir_all(out).expect("a folder for the run");
    let flash = out.join("flash.bin");
    std::fs::write(&flash, clean_flash()).expect("a file for its flash");
    job.flash_file = Some(flash);
    job.scenario.length = run_length(trial).expect("a trial");
    job.imu_trial = Some(trial.to_owned());
    let mut tool = Tool::new(work);
    let outcome = job.run_into(out, &mut tool).expect("the machine starts");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    tool.result().expect("the robot does as it is told")
}

/// A robot whose sensors are wrong is recorded over CAN on all sides, calibrated from that, and measures right after the
/// values were written to it.
#[test]
fn a_recording_of_the_image_corrects_its_sensors() {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("calibration");
    let errors = SensorErrors::default();
    let trial = trial::write(&directory, &errors);
    let (before, after) = (directory.join("before"), directory.join("after"));

    let recorded = play(&trial, &before, |client| {
        Ok(recorder::record(client, RECORDED_S, TIMEOUT, |_| {})?)
    });
    let (imu, field) = recorded.samples.counts();
    assert!(imu >= 199 * u32::from(RECORDED_S), "{imu}");
    assert!(field >= 49 * u32::from(RECORDED_S), "{field}");
    let table = before.join("sides.csv");
    std::fs::write(&table, recorded.samples.table()).expect("a table");
    let load = |sensor| recording::load(&table, sensor).expect("a recording");
    let accel = accel::calibrate(&[load(Sensor::Accelerometer)]).expect("a good fit");
    let mag = mag::calibrate(&[load(Sensor::Magnetometer)], None).expect("a good fit");
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

    play(&trial, &after, move |client| {
        Ok(tuning::apply(client, &parameters)?.len())
    });
    let accel = accel::calibrate(&[samples(&after, Sensor::Accelerometer)]).expect("a good fit");
    let mag = mag::calibrate(&[samples(&after, Sensor::Magnetometer)], None).expect("a good fit");
    assert!(accel.residual_before_mps2 < 0.01, "{accel:?}");
    assert!(mag.residual_before_ut < 1.0, "{}", mag.residual_before_ut);
}
