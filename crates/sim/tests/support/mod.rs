//! Places of the image and the scenarios.

use robot_sim::{job::Job, pc::PcAccess, scenario::Scenario};
use robot_test_support::image;

pub fn job(scenario: Scenario) -> Job {
    Job {
        elf: image(),
        scenario,
        imu_trial: None,
        patches: Vec::new(),
        probe: false,
        pc: PcAccess::default(),
        flash_file: None,
    }
}
