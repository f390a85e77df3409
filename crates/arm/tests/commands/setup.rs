//! Finding, naming and calibrating servos.

use std::{
    io::{BufRead, BufReader, Write},
    process::Stdio,
    thread,
    time::Duration,
};

use robot_servo_model::{Servo, Version};

use crate::{armctl, command, complained, file, port, said, six};

#[test]
fn a_scan_lists_who_is_there() {
    let port = six();
    let text = said(&armctl(&port, &["scan", "--only-baud", "--ids", "1-7"]));
    assert_eq!(text.lines().count(), 7, "{text}");
    assert!(
        text.starts_with("id   1 at 1000000 b/s: model 777 (STS3215), firmware 3.10"),
        "{text}"
    );
    assert!(text.ends_with("6 servos\n"), "{text}");
}

#[test]
fn silence_and_a_missing_port_are_explained() {
    let port = port(vec![]);
    let text = complained(&armctl(&port, &["scan", "--only-baud", "--ids", "1-2"]));
    assert!(
        text.contains("not one byte came") && text.contains("supply on"),
        "{text}"
    );
    let gone = command(std::path::Path::new("/dev/no-such-port"), &["ping", "1"])
        .output()
        .unwrap();
    assert!(complained(&gone).contains("cannot open /dev/no-such-port"));
}

#[test]
fn registers_are_read_by_name() {
    let port = six();
    let text = said(&armctl(&port, &["read", "3", "model", "max_temperature"]));
    let words: Vec<&str> = text.split_whitespace().collect();
    assert_eq!(words, ["3", "model", "777", "13", "max_temperature", "70"]);
    let text = complained(&armctl(&port, &["read", "3", "modle"]));
    assert!(
        text.contains("no register is called modle; there are firmware_major"),
        "{text}"
    );
    let text = complained(&armctl(&port, &["ping", "3", "9"]));
    assert!(text.contains("1 servos did not answer"), "{text}");
}

#[test]
fn a_servo_gets_an_id_that_nobody_has() {
    let port = port(vec![Servo::new(Version::Volts12, 2048.0)]);
    said(&armctl(&port, &["set-id", "--from", "1", "--to", "6"]));
    assert_eq!(port.bus().view()[0].id, 6);
    let two = crate::port(
        [1, 2]
            .map(|id| Servo::new(Version::Volts12, 2048.0).with_id(id))
            .to_vec(),
    );
    let text = complained(&armctl(&two, &["set-id", "--from", "1", "--to", "2"]));
    assert!(text.contains("has the id 2 already"), "{text}");
}

/// The user's Enter, and hands that move the joints.
#[test]
fn an_arm_is_calibrated_by_hand() {
    let port = six();
    let out = file("calibrated.json");
    let words = [
        "calibrate",
        "--format",
        "lerobot",
        "--out",
        out.to_str().unwrap(),
    ];
    let mut child = command(port.path(), &words)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let mut until = |part: &str| {
        let said = lines
            .by_ref()
            .map(Result::unwrap)
            .find(|line| line.contains(part));
        said.unwrap_or_else(|| panic!("armctl never said {part}"))
    };
    until("middle of its travel");
    input.write_all(b"\n").unwrap();
    until("both of its stops");
    for offset in [0.0, -300.0, -600.0, -300.0, 0.0, 300.0, 500.0] {
        for place in 0..6 {
            let middle = 1940.0 + 40.0 * place as f64;
            port.bus()
                .servo_mut(place)
                .unwrap()
                .turn_to(middle + offset);
        }
        thread::sleep(Duration::from_millis(150));
    }
    input.write_all(b"\n").unwrap();
    until("stored offsets and limits");
    assert!(child.wait().unwrap().success());
    let text = std::fs::read_to_string(&out).unwrap();
    let made = robot_arm::calibration::Calibration::parse(&text, "made").unwrap();
    let pan = made.joint("shoulder_pan").unwrap();
    assert_eq!(
        (pan.homing_offset, pan.range_min, pan.range_max),
        (1940 - 2047, 1447, 2547)
    );
    let roll = made.joint("wrist_roll").unwrap();
    assert_eq!((roll.range_min, roll.range_max), (0, 4095));
    // The servo reports the middle as 2047 now; it stands 500 steps beyond.
    assert_eq!(port.bus().view()[0].position_steps, 2547);
    let plain = file("plain.json");
    let words = [
        "convert",
        out.to_str().unwrap(),
        "--format",
        "plain",
        "--out",
        plain.to_str().unwrap(),
    ];
    let converted = std::process::Command::new(env!("CARGO_BIN_EXE_armctl"))
        .args(words)
        .output()
        .unwrap();
    said(&converted);
    let made = robot_arm::calibration::Calibration::load(&plain).unwrap();
    assert_eq!(made.joint("shoulder_pan").unwrap().range_min, 1340);
}
