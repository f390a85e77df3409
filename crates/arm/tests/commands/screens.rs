//! The screens of `joints` and `cartesian`: keys are typed at a terminal, and the servos move.

use std::{
    fs::OpenOptions,
    num::NonZero,
    path::{Path, PathBuf},
    process::{Child, Stdio},
    sync::MutexGuard,
    thread,
    time::{Duration, Instant},
};

use nalgebra::Vector3;
use robot_arm::{calibration::Calibration, kinematics::create_so101_5dof};
use robot_pseudo_terminal::Terminal;
use robot_servo_model::{Bus, Fault, Port, View};
use rustix::termios::{Winsize, tcsetwinsize};

use crate::{command, file, six_servos};

/// Far longer than anything here takes on a busy computer.
const AT_MOST: Duration = Duration::from_secs(20);
const ROWS: NonZero<u16> = NonZero::new(30).unwrap();
const COLUMNS: NonZero<u16> = NonZero::new(120).unwrap();
const SIZE: Winsize = Winsize {
    ws_row: ROWS.get(),
    ws_col: COLUMNS.get(),
    ws_xpixel: 0,
    ws_ypixel: 0,
};

/// A command with a terminal, and the arm that it moves.
struct Screen {
    arm: Option<Port>,
    link: PathBuf,
    terminal: Terminal,
    child: Child,
    shown: vt100::Parser,
}

impl Screen {
    /// Starts the command, and waits until it takes keys.
    fn start(name: &str) -> Self {
        let link = file(&format!(
            "{name}-{}",
            thread::current().name().unwrap().replace(':', "_")
        ));
        let arm = plugged_in(&link);
        let path = file(&format!("{name}.json"));
        Calibration::so101().save(&path).unwrap();
        let terminal = Terminal::open().unwrap();
        let theirs = OpenOptions::new()
            .read(true)
            .write(true)
            .open(terminal.path())
            .unwrap();
        tcsetwinsize(&theirs, SIZE).unwrap();
        let child = command(&link, &[name, "--arm", path.to_str().unwrap()])
            .stdin(Stdio::from(theirs.try_clone().unwrap()))
            .stdout(Stdio::from(theirs))
            .spawn()
            .unwrap();
        let mut screen = Self {
            arm: Some(arm),
            link,
            terminal,
            child,
            shown: vt100::Parser::new(ROWS, COLUMNS, 0),
        };
        screen.until("the screen", |screen| {
            screen.shows("torque on") && screen.views().iter().all(|servo| servo.has_torque)
        });
        screen
    }

    fn types(&mut self, keys: &str) {
        assert_eq!(self.terminal.write(keys.as_bytes()).unwrap(), keys.len());
    }

    fn views(&self) -> Vec<View> {
        self.bus().view()
    }

    fn bus(&self) -> MutexGuard<'_, Bus> {
        self.arm.as_ref().expect("it is plugged in").bus()
    }

    /// Pulls the plug of servos and adapter, and waits until that is said.
    fn pull(&mut self) {
        self.arm = None;
        self.until("a message", |screen| screen.shows("no longer works"));
    }

    /// Puts the plug back. Servos that had no power have no torque, and they are where they were.
    fn plug_in(&mut self) {
        self.arm = Some(plugged_in(&self.link));
    }

    fn position(&self, place: usize) -> i32 {
        self.views()[place].position_steps
    }

    fn shows(&self, text: &str) -> bool {
        self.shown.screen().contents().contains(text)
    }

    /// Takes what the command has drawn.
    fn look(&mut self) {
        let mut drawn = Vec::new();
        self.terminal.read(&mut drawn, u64::MAX).unwrap();
        self.shown.process(&drawn);
    }

    fn until(&mut self, what: &str, is_so: impl Fn(&Self) -> bool) {
        let begin = Instant::now();
        while !is_so(self) {
            assert!(
                begin.elapsed() < AT_MOST,
                "no {what}:\n{}",
                self.shown.screen().contents()
            );
            thread::sleep(Duration::from_millis(10));
            self.look();
        }
    }

    /// Ends the command with Esc.
    fn ends(mut self) -> Vec<View> {
        self.types("\x1b");
        let begin = Instant::now();
        let status = loop {
            // A program that ends waits until the last of what it wrote is taken.
            self.look();
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(begin.elapsed() < AT_MOST, "it does not end");
            thread::sleep(Duration::from_millis(10));
        };
        assert!(status.success());
        self.views()
    }
}

/// Six servos behind an adapter.
fn plugged_in(link: &Path) -> Port {
    Port::open_at(Bus::new(six_servos(), 1), link).expect("a pseudo-terminal")
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn joints_follow_their_keys_and_the_stop_keys() {
    let mut screen = Screen::start("joints");
    let before = screen.position(0);
    screen.types("qqq");
    screen.until("motion", |screen| {
        (screen.position(0) - before - 30).abs() < 4 && screen.views()[0].speed_steps_s == 0.0
    });
    screen.types("x");
    screen.until("release", |screen| {
        screen.views().iter().all(|servo| !servo.has_torque)
    });
    // A hand moves the arm meanwhile: it must not jump back when the torque comes.
    screen.bus().servo_mut(1).unwrap().turn_to(2200.0);
    screen.types("qq");
    screen.until("an answer", |screen| {
        screen.shows("Enter switches it on") && screen.shows("2200")
    });
    screen.types("\r");
    screen.until("torque", |screen| {
        screen.views().iter().all(|servo| servo.has_torque)
    });
    let views = screen.views();
    assert!((views[0].goal_steps - before - 30).abs() < 4, "{views:?}");
    assert!((views[1].goal_steps - 2200).abs() < 4, "{views:?}");
    screen.types("  ");
    screen.until("release", |screen| {
        screen.views().iter().all(|servo| !servo.has_torque)
    });
    screen.ends();
}

#[test]
fn joints_without_an_answer_are_named_and_the_others_go_on() {
    let mut screen = Screen::start("joints");
    let gone = screen.bus().start(Fault::Gone { servo: 2 });
    screen.until("a message", |screen| {
        screen.shows("servo 3 (elbow_flex), read present_position: no answer")
    });
    let before = screen.position(0);
    screen.types("a");
    screen.until("motion", |screen| {
        (screen.position(0) - before + 10).abs() < 4
    });
    screen.bus().end(gone);
    screen.ends();
}

/// What was typed meanwhile does not move the arm when its port is back.
#[test]
fn an_arm_that_is_plugged_in_again_does_not_jump() {
    for (name, keys) in [("joints", "qqqqq"), ("cartesian", "sssss")] {
        let mut screen = Screen::start(name);
        let before = screen.views();
        screen.pull();
        screen.types(keys);
        screen.plug_in();
        screen.until("a warning", |screen| screen.shows("has no torque"));
        screen.types("\r");
        screen.until("torque", |screen| {
            screen.views().iter().all(|servo| servo.has_torque)
        });
        for (before, after) in before.iter().zip(screen.ends()) {
            assert!(
                (after.goal_steps - before.position_steps).abs() < 4,
                "{name}: {after:?}"
            );
        }
    }
}

#[test]
fn the_tool_follows_its_keys() {
    let mut screen = Screen::start("cartesian");
    let before = tool(&screen.views());
    let gripper = screen.position(5);
    screen.types("ssssso");
    screen.until("motion", |screen| {
        let moved = tool(&screen.views()) - before;
        // A step of a servo moves the tool by up to 0.6 mm.
        (moved - Vector3::new(-0.010, 0.0, 0.0)).norm() < 0.002
            && (screen.position(5) - gripper - 20).abs() < 4
    });
    screen.types("x");
    screen.until("release", |screen| {
        screen.views().iter().all(|servo| !servo.has_torque)
    });
    screen.bus().servo_mut(0).unwrap().turn_to(2100.0);
    screen.types("\r");
    screen.until("torque", |screen| {
        screen.views().iter().all(|servo| servo.has_torque)
    });
    let views = screen.ends();
    assert!((views[0].goal_steps - 2100).abs() < 4, "{views:?}");
    assert!(
        views.iter().all(|servo| servo.has_torque),
        "it holds its place"
    );
}

/// Where the tool of an SO-101 is whose homes are in the middle, m.
fn tool(views: &[View]) -> Vector3<f64> {
    let robot = create_so101_5dof();
    let names: Vec<String> = robot.joint_names().map(str::to_owned).collect();
    let homes = names.iter().map(|name| (name.clone(), 2048)).collect();
    let positions = names
        .iter()
        .zip(views)
        .map(|(name, view)| (name.clone(), view.position_steps));
    let q = robot
        .read_joint_angles(&names, &homes, &positions.collect())
        .unwrap();
    robot.fkine(&q).unwrap().translation.vector
}
