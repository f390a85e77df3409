//! Programs that know nothing of this project find servos behind the pseudo-terminal.

#![cfg(unix)]

use std::{
    fs,
    io::{BufRead, BufReader, Lines, Write},
    path::{Path, PathBuf},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
    sync::{Mutex, MutexGuard, PoisonError},
    thread,
    time::Duration,
};

use robot_servo_model::{Bus, Fault, Load, Port, Servo, Version};
use robot_test_support::Python;

/// Shafts of the arm before its calibration, steps from each encoder's zero.
const ASSEMBLED: [f64; 6] = [2048.0, 1200.0, 3100.0, 2500.0, 700.0, 2048.0];

fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/clients")
        .join(name)
}

/// The clients have time-outs of some 40 ms by the computer's clock, and spin until then: each has the computer for itself.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A script that talks to the test over its input and output.
struct Client {
    child: Child,
    input: ChildStdin,
    output: Lines<BufReader<ChildStdout>>,
}

impl Client {
    fn start(mut command: Command) -> Self {
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().expect("it starts");
        let input = child.stdin.take().expect("a pipe");
        let output = BufReader::new(child.stdout.take().expect("a pipe")).lines();
        Self {
            child,
            input,
            output,
        }
    }

    /// Returns the first line for which `is_it` says yes.
    fn line(&mut self, is_it: impl Fn(&str) -> bool) -> String {
        let mut lines = self.output.by_ref().map(|line| line.expect("text"));
        let found = lines.find(|line| is_it(line));
        found.expect("the script has ended before")
    }

    fn says(&mut self, what: &str) {
        self.line(|line| line == what);
    }

    fn go(&mut self, line: &str) {
        writeln!(self.input, "{line}").expect("it reads");
    }

    fn ends(mut self) {
        self.says("done");
        assert!(self.child.wait().expect("it ran").success());
    }
}

fn arm() -> Port {
    let servos = (1..=6).zip(ASSEMBLED);
    let servos = servos.map(|(id, angle)| Servo::new(Version::Volts12, angle).with_id(id));
    Port::open(Bus::new(servos.collect(), 1)).expect("a pseudo-terminal")
}

#[test]
fn the_manufacturers_sdk_reads_and_writes() {
    let Some(python) = Python::with_servo_clients() else {
        return;
    };
    let _alone = alone();
    let servos = (1..=6).map(|id| Servo::new(Version::Volts12, 2048.0).with_id(id));
    let port = Port::open(Bus::new(servos.collect(), 1)).expect("a pseudo-terminal");
    let mut command = python.command(script("sdk.py"));
    command.arg(port.path());
    Client::start(command).ends();
    let goals: Vec<i32> = port.bus().view().iter().map(|v| v.goal_steps).collect();
    assert_eq!(goals, [0x700, 2068, 2078, 2088, 2098, 2108]);
}

#[test]
fn lerobots_driver_calibrates_and_moves_an_arm() {
    let Some(python) = Python::with_servo_clients() else {
        return;
    };
    let _alone = alone();
    let port = arm();
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("calibration.json");
    let mut command = python.command(script("lerobot_arm.py"));
    command.arg(port.path()).arg(&file);
    let mut client = Client::start(command);

    // Each joint is turned by hand to both ends, and LeRobot's own table shows when it has seen that.
    client.says("turn");
    for (by, column) in [(-700.0, 1), (900.0, 3)] {
        for (place, angle) in ASSEMBLED
            .iter()
            .enumerate()
            .filter(|(place, _)| *place != 4)
        {
            let mut bus = port.bus();
            bus.servo_mut(place).expect("six").turn_to(angle + by);
        }
        let wanted = format!("{}", 2047 + by as i32);
        client.line(|line| {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            cells[0] == "gripper" && cells[column] == wanted
        });
    }
    client.go("");

    client.says("calibrated");
    let text = fs::read_to_string(&file).expect("a file");
    for wanted in [
        "\"range_min\": 1347",
        "\"range_max\": 2947",
        "\"homing_offset\": -847",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    let off = port.bus().start(Fault::BrownOut);
    wait_for(&port, |bus| bus.view().iter().all(|v| v.supply_v == 0.0));
    port.bus().end(off);
    wait_for(&port, |bus| bus.view().iter().all(|v| v.supply_v > 0.0));
    for (place, angle) in ASSEMBLED.iter().enumerate() {
        port.bus().servo_mut(place).expect("six").turn_to(*angle);
    }
    client.go("go");

    client.says("moved");
    let goal = port.bus().view()[5].shaft_steps;
    assert!((goal - (ASSEMBLED[5] + 120.0)).abs() < 6.0, "{goal}");
    overload(&port, 5);
    client.go("go");

    client.says("overloaded");
    port.bus().start(Fault::Gone { servo: 2 });
    client.go("go");
    client.ends();
}

#[test]
fn lerobots_driver_gives_a_servo_from_the_factory_its_id() {
    let Some(python) = Python::with_servo_clients() else {
        return;
    };
    let _alone = alone();
    let servo = Servo::new(Version::Volts12, 2048.0).with_baud_code(1);
    let port = Port::open(Bus::new(vec![servo], 1)).expect("a pseudo-terminal");
    let mut command = python.command(script("lerobot_setup.py"));
    command.arg(port.path());
    Client::start(command).ends();
    assert_eq!(port.bus().view()[0].id, 4);
    port.bus().servo_mut(0).expect("one").power_on();
    assert_eq!(port.bus().view()[0].id, 4, "it is kept");
}

/// Looks at the bus until it is as wanted; its thread lets time pass.
fn wait_for(port: &Port, is_so: impl Fn(&mut Bus) -> bool) {
    while !is_so(&mut port.bus()) {
        thread::sleep(Duration::from_millis(1));
    }
}

/// Pulls at a shaft, with nine tenths of what the servo can hold, until it gives up.
fn overload(port: &Port, place: usize) {
    let load = Load {
        torque_nm: 2.6,
        ..Load::default()
    };
    port.bus().servo_mut(place).expect("there").set_load(load);
    wait_for(port, |bus| bus.view()[place].status & 32 != 0);
}
