//! Says what to do about each blocker and flag, by the firmware's names.

/// Returns `None` for a name that this tool does not know because the firmware is newer.
pub(super) fn for_blocker(name: &str) -> Option<&'static str> {
    Some(match name {
        "remote-not-fresh" => {
            "switch the transmitter on; is the receiver bound and plugged into DBUS?"
        }
        "enable-off" => "nothing is wrong: the enable switch arms",
        "enable-not-cycled" => "switch enable off and on again",
        "sticks-not-centred" => "let go of the sticks; if that is not enough, trim them",
        "estimate-invalid" => "leave the robot still for a second; see the flags",
        "calibration-pending" => "leave the robot still until the gyro is calibrated",
        "safety-stop" => "see the flags below",
        "joints-not-ready" => "power the joints; see their states below",
        "bring-up-read-only" => {
            "`robotctl tune bring-up zero-torque` or `off`, when all directions are right"
        }
        "battery-low" => "charge or connect the battery",
        "flash-busy" => "wait: settings are being saved",
        "settings-refused" => {
            "`robotctl tune status` names the group: set its values, or accept the defaults with `robotctl tune defaults \
             GROUP --yes`"
        }
        "debugger-catches" => {
            "a debug probe would halt the core instead of letting it stop the motors: end it, then power the robot off and on"
        }
        "wheel-never-heard" => "power the wheels' C620; each needs its number and this bus",
        "wheel-doubtful" => {
            "two speed controllers with one number, or one whose reports contradict each other"
        }
        "joint-out-of-limits" => {
            "move the joint into its limits by hand; if it is there, its zero is wrong: `robotctl joint zero`"
        }
        "attitude-unsettled" => "leave the robot still for a second",
        "joint-timeout-unset" => "set the motors' own time-out first: docs/motors.md",
        _ => return None,
    })
}

pub(super) fn for_flag(name: &str) -> Option<&'static str> {
    Some(match name {
        "remote-lost" => "no radio frames: transmitter on, in range, receiver bound?",
        "remote-failsafe" => "the receiver itself says that it has lost the transmitter",
        "remote-quality" => "too many radio frames are lost: antennas, distance, wiring",
        "e-stop" => "release the e-stop switch",
        "estimate-invalid" => {
            "the attitude is not known: leave the robot still; if it stays, see the IMU"
        }
        "imu-stale" => "no samples of the IMU",
        "imu-errors" => "errors on the IMU's SPI or impossible samples; clear when it is mended",
        "mag-errors" => "errors on the magnetometer's I2C; clear when it is mended",
        "can1-fault" | "can2-fault" => "bus off: wiring, termination, 1 Mbit/s, a second sender?",
        "can1-congested" | "can2-congested" => {
            "frames do not leave: is any motor powered on that bus, is it terminated?"
        }
        "wheel-left-silent" | "wheel-right-silent" => {
            "no reports: is its C620 powered, on this bus, with the right number?"
        }
        "command-stale" => "the firmware's logic task does not decide: a fault of the firmware",
        "task-late" => "a task is late and the watchdog resets: a fault of the firmware",
        "tilt" => "the robot fell: put it on its wheels and clear, or stand switch down and up",
        "balance-lost" => {
            "it stood and fell, or a motor or bus failed: look, then clear, or stand switch down and up"
        }
        "stand-up-failed" => {
            "it lies on a side or its top, or still lies after its time: put it on its wheels, then clear"
        }
        "wheel-hot" | "joint-hot" => "let the motor cool down",
        "battery-low" => "charge or connect the battery",
        "battery-empty" => "change the battery, then clear",
        "joint-fault" => "the joint's motor reports a fault, see its code; mend, then clear",
        "joint-silent" => "a joint's motor does not reply: power, wiring, its identifier?",
        "wheel-frozen" | "joint-frozen" => {
            "a motor repeats an old report: power it off and on, then clear"
        }
        "joint-not-ready" => {
            "a joint's motor replies but cannot be set up: its ranges, mode or make are not those of this firmware"
        }
        "pc-lost" => {
            "no fresh command of the PC, or always the same one: is its program running, the cable in?"
        }
        "pc-awaited" => {
            "the PC must first ask for no motion: wheels at zero, joints where they are; then it may steer"
        }
        "sticks-awaited" => "centre the sticks: only then does what was stopped go on",
        _ => return None,
    })
}

/// What the pilot's request to stand waits for.
pub(super) fn for_request(name: &str) -> &'static str {
    match name {
        "switch-must-go-down" => "to stand, the stand switch must first be seen down",
        "ready" => "the stand switch is down",
        "requested" => "the stand switch is up: it stands up as soon as it is armed",
        "standing-up" => "it has seconds to stand up, with limits of its own",
        _ => "the stand switch is up",
    }
}

#[cfg(test)]
mod tests {
    use robot_app::safety::{ArmingBlockers, SafetyFlags};

    use super::*;

    /// If this fails, a blocker has no advice: add a line above.
    #[test]
    fn there_is_advice_for_everything_the_firmware_names() {
        for bit in 0..32 {
            if let Some(name) = ArmingBlockers::name_of_bit(bit) {
                assert!(for_blocker(name).is_some(), "blocker {name}");
            }
            if let Some(name) = SafetyFlags::name_of_bit(bit) {
                assert!(for_flag(name).is_some(), "flag {name}");
            }
        }
        assert_eq!(for_blocker("bit 31"), None);
    }
}
