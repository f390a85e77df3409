//! The board in other orientations. With the right setting the robot behaves the same; with another it does not arm.

mod support;

use robot_sim::{job::Outcome, scenario::Scenario};

/// Drives ahead, turns left, and falls on its nose.
const DRIVE: &str = "
[[at]]
t = 2.5
remote = { enable = true }
[[at]]
t = 2.8
remote = { vx = 0.4 }
[[at]]
t = 3.8
remote = { vx = 0.0, wz = 0.3 }
[[at]]
t = 4.6
fault = \"tilted\"

[[expect]]
signal = \"diag.arming.state\"
from = 2.6
to = 4.6
equals = 1
[[expect]]
signal = \"truth.body.x\"
at = 3.8
min = 0.4
because = \"stick forward drives forward\"
[[expect]]
signal = \"truth.body.yaw\"
at = 4.6
min = 0.5
because = \"stick left turns left\"
[[expect]]
signal = \"emu.att_error.total_deg\"
from = 2.5
to = 5.5
max = 6.0
because = \"pitch, roll and heading are those of the robot, on the way and in the fall\"
[[expect]]
signal = \"diag.estimate.rpy_rad.1\"
at = 5.5
min = 1.0
because = \"nose down is positive pitch\"
[[expect]]
signal = \"diag.safety.flags\"
at = 5.5
has_flag = \"tilt\"
";

/// `mag` is the setting, if any, and `mag_sits` the true orientation of the magnetometer on the board.
fn run(board: &str, mag_sits: &str, settings: [u8; 2], body: &str) -> Outcome {
    let [board_number, mag_number] = settings;
    let text = format!(
        "name = \"mounting\"\nseconds = 5.5\nplant = \"rolling\"\nmounting = \"{board}\"\n\
         mag_mounting = \"{mag_sits}\"\n\
         [[flash.record]]\ngroup = 8\nvalues = [{board_number}, {mag_number}]\n{body}"
    );
    let job = support::job(Scenario::parse(&text, "mounting").expect("it parses"));
    job.run(&mut []).expect("the machine starts")
}

const UNSET: u8 = 24;

/// Names, and their numbers in docs/mounting.md: each axis of board and magnetometer points each way at least once.
#[test]
fn a_robot_that_knows_how_its_sensors_sit_drives_as_before() {
    for (board, number, mag, mag_number) in [
        ("x-backward-z-down", 5, "x-left-z-up", 8),
        ("x-right-z-up", 12, "x-down-z-right", 23),
        ("x-up-z-left", 18, "x-forward-z-down", 1),
        ("x-down-z-forward", 20, "x-up-z-backward", 17),
        // The magnetometer's orientation is not set, so the gyro alone provides the heading.
        ("x-left-z-backward", 11, "x-right-z-backward", UNSET),
        ("x-forward-z-right", 3, "x-backward-z-up", UNSET),
    ] {
        let outcome = run(board, mag, [number, mag_number], DRIVE);
        let failed = &outcome.summary.failed_expectations;
        assert!(outcome.summary.ok, "{board}, {mag}: {failed:#?}");
    }
}

/// Every other setting that leaves the board's z axis level shows the robot on its side or its head.
#[test]
fn a_robot_with_wrong_sensor_mountings_does_not_arm() {
    let body = "
[[at]]
t = 2.5
remote = { enable = true }
[[expect]]
signal = \"diag.arming.state\"
from = 0.1
to = 5.5
equals = 0
[[expect]]
signal = \"diag.arming.blockers\"
from = 2.6
to = 5.5
has_flag = \"safety-stop\"
[[expect]]
signal = \"diag.safety.flags\"
from = 2.6
to = 5.5
has_flag = \"tilt\"
";
    for (board, number) in [
        ("x-down-z-forward", 0),
        ("x-forward-z-down", 0),
        ("x-forward-z-up", 18),
    ] {
        let outcome = run(board, "x-forward-z-up", [number, UNSET], body);
        let failed = &outcome.summary.failed_expectations;
        assert!(outcome.summary.ok, "{board} as {number}: {failed:#?}");
    }
}
