//! The pseudo-terminal as a program sees it.

#![cfg(unix)]

use std::{
    fs::{self, File, OpenOptions},
    io::{Read, Write},
    os::unix::fs::OpenOptionsExt,
    path::Path,
    time::Instant,
};

use robot_servo_model::{Bus, Port, PortError, Servo, Version};
use rustix::{
    fs::OFlags,
    termios::{OptionalActions, tcgetattr, tcsetattr},
};

const PING: [u8; 6] = [0xFF, 0xFF, 0x01, 0x02, 0x01, 0xFB];
const PONG: [u8; 6] = [0xFF, 0xFF, 0x01, 0x02, 0x00, 0xFC];

fn bus() -> Bus {
    Bus::new(vec![Servo::new(Version::Volts12, 2048.0)], 1)
}

fn open(path: &Path) -> File {
    let mut options = OpenOptions::new();
    options.read(true).write(true);
    options.custom_flags(OFlags::NOCTTY.bits().cast_signed());
    options.open(path).expect("the port is there")
}

#[test]
fn an_answer_never_comes_before_its_last_bit() {
    let port = Port::open(bus()).expect("a pseudo-terminal");
    let mut program = open(port.path());
    let start = Instant::now();
    program.write_all(&PING).expect("it is open");
    let mut answer = [0; 6];
    program.read_exact(&mut answer).expect("an answer");
    // 60 µs there, 500 µs of return delay as shipped, 60 µs back. A slow computer makes it later, and nothing earlier.
    assert!(start.elapsed().as_micros() >= 620);
    assert_eq!(answer, PONG);
}

#[test]
fn the_baud_rate_of_the_terminal_is_the_hosts() {
    let port = Port::open(bus()).expect("a pseudo-terminal");
    let mut program = open(port.path());
    let mut settings = tcgetattr(&program).expect("a terminal");
    for baud in [115_200, 250_000, 1_000_000] {
        settings.set_speed(baud).expect("a baud rate");
        tcsetattr(&program, OptionalActions::Now, &settings).expect("a terminal");
        program.write_all(&PING).expect("it is open");
        while port.bus().host_baud() != baud {
            std::thread::yield_now();
        }
    }
    let mut answer = [0; 6];
    program.read_exact(&mut answer).expect("an answer");
    assert_eq!(answer, PONG, "only that at 1 Mb/s has one");
}

#[test]
fn a_port_that_is_plugged_in_again_has_its_name_back() {
    let link = Path::new(env!("CARGO_TARGET_TMPDIR")).join("servos");
    for _ in 0..2 {
        let port = Port::open_at(bus(), &link).expect("a pseudo-terminal");
        assert_eq!(port.path(), link);
        let mut program = open(&link);
        program.write_all(&PING).expect("it is open");
        let mut answer = [0; 6];
        program.read_exact(&mut answer).expect("an answer");
        drop(port);
        assert!(fs::symlink_metadata(&link).is_err(), "the link is gone");
        assert!(
            !matches!(program.read(&mut answer), Ok(1..)),
            "so is the port"
        );
    }
}

#[test]
fn a_file_of_somebody_else_is_not_replaced_by_the_link() {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("somebodys-file");
    fs::write(&file, "precious").expect("a folder for it");
    let refused = Port::open_at(bus(), &file);
    assert!(matches!(refused, Err(PortError::Occupied(_))));
    assert_eq!(fs::read_to_string(&file).expect("it is there"), "precious");
}
