//! What the tool calls saved is there after the robot was switched off.

use std::{path::PathBuf, time::Duration};

use anyhow::Context;
use robot_plant::world::CanBusId;
use robot_sim::scenario::Scenario;
use robotctl::{
    parameter_file::ParameterFile,
    settings,
    tuning::{self, SaveTimeouts, StoreReport, TuningClient},
};

use crate::{support, tool::Tool};

/// In time of the computer, on which the board may run slowly.
const TIMEOUT: SaveTimeouts = SaveTimeouts {
    pause: Duration::from_millis(2),
    looks: 20_000,
};
const TRACK: &str = "wheel-geometry.track-m";

fn track(client: &mut TuningClient) -> anyhow::Result<f32> {
    Ok(client.read(settings::find(TRACK)?)?)
}

fn saved(client: &mut TuningClient) -> anyhow::Result<StoreReport> {
    Ok(tuning::wait_until_saved(client, TIMEOUT)?)
}

/// One robot, switched off at the end of each run.
struct Robot {
    flash: PathBuf,
}

impl Robot {
    /// What the tool finds out while the robot is on.
    fn on<T: Send + 'static>(
        &self,
        work: impl FnOnce(&mut TuningClient) -> anyhow::Result<T> + Send + 'static,
    ) -> T {
        // A quick computer emulates several seconds while the tool waits for an answer.
        let text = "name = \"saving\"\nseconds = 8\nplant = \"stand\"\n";
        let mut job = support::job(Scenario::parse(text, "saving").expect("it parses"));
        job.pc.can_on_pty = vec![CanBusId::Can1];
        job.flash_file = Some(self.flash.clone());
        let mut tool = Tool::new(work);
        let outcome = job.run(&mut [&mut tool]).expect("the machine starts");
        assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
        tool.result().expect("the robot does as it is told")
    }
}

#[test]
fn saved_means_that_the_robot_may_be_switched_off() {
    let flash = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("saving.bin");
    std::fs::write(&flash, crate::clean_flash()).expect("a file for its flash");
    let robot = Robot { flash };

    let default = robot.on(|client| {
        let default = track(client)?;
        client.write(settings::find(TRACK)?, 0.37)?;
        let report = client.store()?.context("this firmware saves")?;
        anyhow::ensure!(!report.is_saved(), "not at once: {report}");
        let report = saved(client)?;
        anyhow::ensure!(report.save_ok == 1 && report.save_failed == 0, "{report}");
        Ok(default)
    });

    let (value, after) = robot.on(|client| {
        let value = track(client)?;
        let report = client.store()?.context("this firmware saves")?;
        anyhow::ensure!(report.is_saved() && report.save_ok == 0, "{report}");
        let mut file = ParameterFile::default();
        file.set(TRACK, 0.38);
        file.set("heater.target-c", 45.0);
        file.set("safety.battery-low-v", 20.0);
        tuning::apply(client, &file)?;
        Ok((value, saved(client)?))
    });
    assert_eq!(value, 0.37);
    assert_eq!((after.save_ok, after.save_failed), (3, 0), "{after}");

    let values = robot.on(|client| {
        let values = (
            track(client)?,
            client.read(settings::find("heater.target-c")?)?,
            client.read(settings::find("safety.battery-low-v")?)?,
        );
        client.restore_defaults(None)?;
        saved(client)?;
        Ok(values)
    });
    assert_eq!(values, (0.38, 45.0, 20.0));
    assert_eq!(robot.on(track), default);
}
