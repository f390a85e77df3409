//! Programs that know nothing of this project find servos behind the pseudo-terminal.

#![cfg(unix)]

use std::{
    fs,
    io::{BufRead, BufReader, Lines, Write},
    path::{Path, PathBuf},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
    sync::{Mutex, PoisonError},
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

/// Longer than the port may stand still: the clients have time-outs of some 40 ms by the computer's clock.
const STALL: Duration = Duration::from_millis(10);

/// Lets a client talk to servos. A computer that had no time for the port proves nothing, so then it starts anew. The clients spin
/// while they wait: each has the computer for itself.
fn on_a_port(servos: impl Fn() -> Vec<Servo>, client: impl Fn(&Port) -> Result<(), String>) {
    static ALONE: Mutex<()> = Mutex::new(());
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    for _ in 0..10 {
        let port = Port::open(Bus::new(servos(), 1)).expect("a pseudo-terminal");
        match client(&port) {
            Ok(()) => return,
            Err(_) if port.longest_stall() > STALL => {
                println!(
                    "once more: the port stood still for {:?}",
                    port.longest_stall()
                );
            }
            Err(why) => panic!("{why}"),
        }
    }
    panic!("this computer has no time for the port");
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

    /// Reads up to a line for which `is_it` says yes.
    fn line(&mut self, is_it: impl Fn(&str) -> bool) -> Result<(), String> {
        let mut lines = self.output.by_ref().map(|line| line.expect("text"));
        let found = lines.find(|line| is_it(line));
        found
            .map(|_| ())
            .ok_or_else(|| "the script has ended before".to_owned())
    }

    fn says(&mut self, what: &str) -> Result<(), String> {
        self.line(|line| line == what)
    }

    fn go(&mut self, line: &str) {
        // A script that has ended says so at the next line that is read.
        let _ = writeln!(self.input, "{line}");
    }

    fn ends(mut self) -> Result<(), String> {
        self.says("done")?;
        assert!(self.child.wait().expect("it ran").success());
        Ok(())
    }
}

fn servos(angles: [f64; 6]) -> Vec<Servo> {
    let servos = (1..=6).zip(angles);
    let servos = servos.map(|(id, angle)| Servo::new(Version::Volts12, angle).with_id(id));
    servos.collect()
}

#[test]
fn the_manufacturers_sdk_reads_and_writes() {
    let Some(python) = Python::with_servo_clients() else {
        return;
    };
    on_a_port(
        || servos([2048.0; 6]),
        |port| {
            let mut command = python.command(script("sdk.py"));
            command.arg(port.path());
            Client::start(command).ends()?;
            let goals: Vec<i32> = port.bus().view().iter().map(|v| v.goal_steps).collect();
            assert_eq!(goals, [0x700, 2068, 2078, 2088, 2098, 2108]);
            Ok(())
        },
    );
}

#[test]
fn lerobots_driver_calibrates_and_moves_an_arm() {
    let Some(python) = Python::with_servo_clients() else {
        return;
    };
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("calibration.json");
    on_a_port(
        || servos(ASSEMBLED),
        |port| {
            let mut command = python.command(script("lerobot_arm.py"));
            command.arg(port.path()).arg(&file);
            let mut client = Client::start(command);
            client.says("turn")?;
            turn_all(port, &mut client)?;
            client.says("calibrated")?;
            let text = fs::read_to_string(&file).expect("a file");
            for wanted in [
                "\"range_min\": 1347",
                "\"range_max\": 2947",
                "\"homing_offset\": -847",
            ] {
                assert!(text.contains(wanted), "{wanted}: {text}");
            }
            cut_the_power(port);
            client.go("go");
            client.says("moved")?;
            let goal = port.bus().view()[5].shaft_steps;
            assert!((goal - (ASSEMBLED[5] + 120.0)).abs() < 6.0, "{goal}");
            overload(port, 5);
            client.go("go");
            client.says("overloaded")?;
            port.bus().start(Fault::Gone { servo: 2 });
            client.go("go");
            client.ends()
        },
    );
}

#[test]
fn lerobots_driver_gives_a_servo_from_the_factory_its_id() {
    let Some(python) = Python::with_servo_clients() else {
        return;
    };
    on_a_port(
        || vec![Servo::new(Version::Volts12, 2048.0).with_baud_code(1)],
        |port| {
            let mut command = python.command(script("lerobot_setup.py"));
            command.arg(port.path());
            Client::start(command).ends()?;
            assert_eq!(port.bus().view()[0].id, 4);
            port.bus().servo_mut(0).expect("one").power_on();
            assert_eq!(port.bus().view()[0].id, 4, "it is kept");
            Ok(())
        },
    );
}

/// Turns each joint by hand to both ends, until LeRobot's own table shows that it has seen that, and presses Enter.
fn turn_all(port: &Port, client: &mut Client) -> Result<(), String> {
    let joints = ASSEMBLED.iter().enumerate();
    let turned = joints.filter(|(place, _)| *place != 4);
    for (by, column) in [(-700.0, 1), (900.0, 3)] {
        for (place, angle) in turned.clone() {
            let mut bus = port.bus();
            bus.servo_mut(place).expect("six").turn_to(angle + by);
        }
        let wanted = format!("{}", 2047 + by as i32);
        client.line(|line| {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            cells[0] == "gripper" && cells[column] == wanted
        })?;
    }
    client.go("");
    Ok(())
}

/// Takes the power away for a moment, and leaves the joints where they were before the calibration.
fn cut_the_power(port: &Port) {
    let off = port.bus().start(Fault::BrownOut);
    wait_for(port, |bus| bus.view().iter().all(|v| v.supply_v == 0.0));
    port.bus().end(off);
    wait_for(port, |bus| bus.view().iter().all(|v| v.supply_v > 0.0));
    for (place, angle) in ASSEMBLED.iter().enumerate() {
        port.bus().servo_mut(place).expect("six").turn_to(*angle);
    }
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
