//! `sim --flash FILE`: the contents of the parameter sectors are kept from run to run.

mod support;

use robot_sim::{job::Job, machine::flash::PARAMETER_FLASH_BYTES, scenario::Scenario};

/// Long enough for a new chip to erase a sector once the robot has rested.
const QUIET: &str = "name = \"kept\"\nseconds = 1.5\nplant = \"stand\"\n";

fn job(name: &str) -> Job {
    let file = std::env::temp_dir().join(format!("robot-{name}-{}.bin", std::process::id()));
    let mut job = support::job(Scenario::parse(QUIET, "kept").expect("it parses"));
    job.flash_file = Some(file);
    job
}

#[test]
fn the_next_run_starts_with_what_the_last_one_left() {
    let job = job("kept");
    let file = job.flash_file.clone().expect("just set");
    let outcome = job.run(&mut []).expect("the first run");
    assert_eq!(outcome.summary.flash.erases, 1, "a new chip");
    let left = std::fs::read(&file).expect("the run wrote it");
    assert_eq!(left.len(), PARAMETER_FLASH_BYTES);
    assert!(left.iter().any(|byte| *byte != 0xFF));
    let mut machine = job.machine().expect("the second run");
    assert!(machine.parameter_flash() == left);
    let outcome = job.run(&mut []).expect("the second run");
    assert_eq!(outcome.summary.flash.erases, 0, "not a new chip");
    std::fs::remove_file(file).expect("it is there");
}

#[test]
fn a_file_of_another_size_is_refused_by_name() {
    let job = job("short");
    let file = job.flash_file.clone().expect("just set");
    std::fs::write(&file, [0; 100]).expect("a writable folder");
    let error = job.machine().err().expect("it is no flash").to_string();
    assert!(
        error.contains("100 bytes") && error.contains("robot-short"),
        "{error}"
    );
    std::fs::remove_file(file).expect("it is there");
}
