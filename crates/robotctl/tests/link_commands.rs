//! The commands of the PC link against a robot behind a pseudo-terminal.
#![cfg(target_os = "linux")]

#[path = "link_robot/mod.rs"]
mod link_robot;

use std::{
    fs::File,
    io::{BufRead, BufReader, Read, Write},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::Duration,
};

use link_robot::Robot;
use robot_app::{
    domain::{PcCommand, PcKind},
    link::Keys,
};

const PC_MODE: Keys = Keys::B;
const ARMED: Keys = Keys::B.union(Keys::F1).union(Keys::START);

/// After this time without a command, the test fails instead of waiting for ever.
const HANGS: Duration = Duration::from_secs(60);

fn robotctl(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_robotctl"));
    command.args(arguments).stdin(Stdio::null());
    command
}

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// A joystick of the test's own.
struct Pad(File);

impl Pad {
    fn pipe(name: &str) -> PathBuf {
        let pipe = path(name);
        let _ = std::fs::remove_file(&pipe);
        let made = Command::new("mkfifo").arg(&pipe).status();
        assert!(made.expect("mkfifo runs").success());
        pipe
    }

    fn plug_in(pipe: &Path) -> Self {
        // Opened for both, a pipe waits for nobody.
        let opened = File::options().read(true).write(true).open(pipe);
        Self(opened.expect("the pipe was made"))
    }

    fn event(&mut self, value: i16, kind: u8, number: u8) {
        let [low, high] = value.to_ne_bytes();
        let event = [0, 0, 0, 0, low, high, kind, number];
        self.0.write_all(&event).expect("robotctl reads on");
    }

    fn dead_man(&mut self, is_held: bool) {
        self.event(i16::from(is_held), 1, 4);
    }

    fn forward(&mut self) {
        self.event(-32_767, 2, 1);
    }
}

/// A drive whose output is read line by line.
struct Drive {
    child: Child,
    output: BufReader<std::process::ChildStdout>,
    said: String,
}

impl Drive {
    fn start(robot: &Robot, pipe: &Path, options: &[&str]) -> Self {
        let pipe = pipe.to_str().expect("a plain path");
        let mut command = robotctl(&["drive", "--link", &robot.port, "--joystick", pipe]);
        let spawned = command
            .args(options)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        let mut child = spawned.expect("it starts");
        let output = BufReader::new(child.stdout.take().expect("its output"));
        Self {
            child,
            output,
            said: String::new(),
        }
    }

    /// Reads on until a line has this text.
    fn until(&mut self, text: &str) {
        loop {
            let mut line = String::new();
            let read = self.output.read_line(&mut line).expect("lines of text");
            if read == 0 {
                let error = self.error();
                panic!("it ended without `{text}`: {}{error}", self.said);
            }
            self.said.push_str(&line);
            if line.contains(text) {
                return;
            }
        }
    }

    fn error(&mut self) -> String {
        let mut text = String::new();
        if let Some(error) = &mut self.child.stderr {
            error.read_to_string(&mut text).expect("text");
        }
        text
    }

    /// Waits for its end, and returns whether it succeeded and what it said on its error output.
    fn end(mut self) -> (bool, String) {
        let error = self.error();
        let status = self.child.wait().expect("it ends");
        (status.success(), error)
    }
}

fn turns(command: &PcCommand) -> bool {
    command
        .wheels
        .iter()
        .any(|wheel| wheel.speed_rps.abs() > 0.05)
}

fn until_command(robot: &Robot, is_met: impl Fn(&PcCommand) -> bool) {
    let next = || robot.commands.recv_timeout(HANGS);
    while !is_met(&next().expect("commands go on")) {}
}

#[test]
fn a_drive_says_why_nothing_moves_and_stops_with_its_joystick() {
    let robot = Robot::new(Keys::A);
    let pipe = Pad::pipe("drive.fifo");
    let mut pad = Pad::plug_in(&pipe);
    let mut drive = Drive::start(&robot, &pipe, &[]);
    drive.until("the radio's mode is manual, not PC");
    robot.press(PC_MODE);
    drive.until("not armed");
    pad.forward();
    pad.dead_man(true);
    robot.press(ARMED);
    drive.until("let go of the dead-man");
    assert!(robot.commands.try_iter().all(|command| !turns(&command)));
    pad.dead_man(false);
    drive.until("ready");
    pad.dead_man(true);
    drive.until("driving");
    until_command(&robot, turns);
    pad.dead_man(false);
    until_command(&robot, |command| !turns(command));
    pad.dead_man(true);
    until_command(&robot, turns);
    // The joints hold the angle that they had.
    let held = |command: &PcCommand| {
        command
            .joints
            .iter()
            .all(|j| (j.pos_rad - 0.25).abs() < 1e-3)
    };
    until_command(&robot, held);

    drop(pad);
    let (succeeded, error) = drive.end();
    assert!(!succeeded);
    assert!(error.contains("the joystick is gone"), "{error}");
    let last: Vec<_> = robot.commands.try_iter().collect();
    let rests = last.iter().rev().take_while(|command| !turns(command));
    assert!(rests.count() >= 5, "{last:?}");
}

/// Height goes up with the cross held up, and stays.
#[test]
fn in_place_of_the_sticks_a_joystick_drives_raises_and_jumps() {
    let robot = Robot::new(ARMED);
    let pipe = Pad::pipe("sticks.fifo");
    let mut pad = Pad::plug_in(&pipe);
    let mut drive = Drive::start(&robot, &pipe, &["--sticks", "--share", "0.3"]);
    drive.until("ready");
    pad.forward();
    pad.dead_man(true);
    drive.until("driving");
    let near = |value: f32, wanted: f32| (value - wanted).abs() < 1e-3;
    let drives = |command: &PcCommand| near(command.drive.vx, 0.3);
    until_command(&robot, drives);
    pad.event(-32_767, 2, 7);
    until_command(&robot, |command| near(command.drive.height, 1.0));
    pad.event(0, 2, 7);
    pad.event(1, 1, 0);
    until_command(&robot, |command| command.drive.jump && drives(command));
    pad.event(0, 1, 0);
    pad.dead_man(false);
    until_command(&robot, |command| {
        near(command.drive.vx, 0.0) && near(command.drive.height, 1.0) && !command.drive.jump
    });

    drop(pad);
    let (succeeded, error) = drive.end();
    assert!(!succeeded);
    assert!(error.contains("the joystick is gone"), "{error}");
    let last: Vec<_> = robot.commands.try_iter().collect();
    assert!(last.iter().all(|command| command.kind == PcKind::Drive));
    let rests =
        |command: &&PcCommand| near(command.drive.vx, 0.0) && near(command.drive.height, 0.0);
    assert!(last.iter().rev().take_while(rests).count() >= 5, "{last:?}");
}

#[test]
fn speeds_of_the_wheels_are_no_sticks() {
    let said = error_of(&["drive", "--link", "/dev/null", "--sticks", "--speed", "0.5"]);
    assert!(said.contains("cannot be used with"), "{said}");
    let said = error_of(&["drive", "--link", "/dev/null", "--sticks", "--share", "1.1"]);
    assert!(said.contains("--share must be above 0"), "{said}");
}

#[test]
fn a_drive_ends_when_the_robots_state_stops() {
    let robot = Robot::new(ARMED);
    let pipe = Pad::pipe("drive-silent.fifo");
    let _pad = Pad::plug_in(&pipe);
    let mut drive = Drive::start(&robot, &pipe, &[]);
    drive.until("ready");
    robot.world.lock().expect("nobody panics").is_connected = false;
    let (succeeded, error) = drive.end();
    assert!(!succeeded);
    assert!(error.contains("no longer comes"), "{error}");
}

#[test]
fn a_recording_that_is_terminated_is_complete() {
    let robot = Robot::new(ARMED);
    let file = path("link.mcap");
    let _ = std::fs::remove_file(&file);
    let name = file.to_str().expect("a plain path");
    let mut child = robotctl(&["record", "--link", &robot.port, "--force", name])
        .stdout(Stdio::piped())
        .spawn()
        .expect("it starts");
    // It has written something: what the file's buffer holds, and more.
    while child.try_wait().expect("it is ours").is_none()
        && std::fs::metadata(&file).map_or(0, |data| data.len()) < 100_000
    {
        std::thread::sleep(Duration::from_millis(10));
    }
    let killed = Command::new("kill").arg(child.id().to_string()).status();
    assert!(killed.expect("kill runs").success());
    let output = child.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("0 CRC errors"), "{said}");
    let page = robotctl(&["plot", name]).output().expect("it runs");
    assert!(page.status.success());
    let page = std::fs::read_to_string(file.with_extension("html")).expect("the page");
    assert!(page.contains("Attitude") && !page.contains("has no end"));
}

#[test]
fn settings_are_read_through_the_link() {
    let robot = Robot::new(ARMED);
    let arguments = [
        "tune",
        "--link",
        &robot.port,
        "get",
        "wheel-geometry.radius-m",
    ];
    let output = robotctl(&arguments).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(said, "wheel-geometry.radius-m = 0.5 m\n");
}

fn error_of(arguments: &[&str]) -> String {
    let output = robotctl(arguments).output().expect("it runs");
    assert!(!output.status.success(), "{arguments:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_wrong_way_to_the_robot_is_told_with_the_right_one() {
    let robot = Robot::new(ARMED);
    let port = &robot.port;
    let said = error_of(&["status", "--can", port]);
    let expected = format!("{port} speaks the PC link, not slcan: use --link {port}");
    assert!(said.contains(&expected), "{said}");
    let said = error_of(&["status", "--link", "tcp:192.168.0.7:20001"]);
    assert!(said.contains("use --can"), "{said}");
    let said = error_of(&["status", "--can", "192.168.0.7:20001"]);
    assert!(said.contains("write tcp:192.168.0.7:20001"), "{said}");
}

/// As pyserial does with `exclusive=True`.
#[test]
fn a_port_that_another_program_has_locked_is_refused() {
    let robot = Robot::new(ARMED);
    let port = File::open(&robot.port).expect("it is there");
    port.try_lock().expect("nobody else has it");
    let said = error_of(&["status", "--link", &robot.port]);
    assert!(said.contains("another program may have it open"), "{said}");
    port.unlock().expect("it was locked");
}
