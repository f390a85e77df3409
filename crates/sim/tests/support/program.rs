//! A program on the PC, beside a running board.

use std::{
    io::{BufRead, BufReader},
    path::Path,
    process::{Child, Command, Stdio},
    sync::mpsc::{self, Receiver},
    thread,
    time::Duration,
};

use robot_plant::{
    time::{MS, Ps},
    world::CanBusId,
};
use robot_sim::{
    can_port::CanDevice,
    machine::LogLine,
    runner::Observer,
    signals::{SignalTable, Values},
};
use robot_test_support::Python;

/// By this time the board has booted and receives frames.
const START: Ps = 200 * MS;
/// Pause of the board in each simulated millisecond while the program works. The board runs faster than real time, and the
/// program must end long before the run does.
const LET_THE_PROGRAM_WORK: Duration = Duration::from_millis(1);
/// From here on the computer seems to be busy with other things, and the board waits longer.
const SLOW: Ps = START + 2_000 * MS;
const LET_A_BUSY_COMPUTER_WORK: Duration = Duration::from_millis(10);
/// The line by which a program says that it has opened its device.
const READY: &str = "ready";

/// A Python program. It gets its arguments and a device, prints `ready` when it has opened it, and then what it finds out.
pub struct Program {
    command: Option<Command>,
    wanted: Wanted,
    running: Option<(Child, Receiver<String>)>,
    said: Vec<String>,
}

/// The device that a program opens.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    Can(CanBusId),
    Link,
}

impl Program {
    /// Prepares `script`, whose last argument will be the device.
    pub fn new(python: &Python, script: &Path, arguments: &[&str], wanted: Wanted) -> Self {
        let mut command = python.command(script);
        command.args(arguments).stdout(Stdio::piped());
        Self {
            command: Some(command),
            wanted,
            running: None,
            said: Vec::new(),
        }
    }

    fn open(&mut self, device: &str) {
        let command = self.command.as_mut().expect("there is one device");
        command.arg(device);
    }

    /// Starts the program and lets the board wait until it is ready.
    fn start(&mut self, mut command: Command) {
        let mut child = command.spawn().expect("it starts");
        let (lines, said) = mpsc::channel();
        let output = child.stdout.take().expect("it is piped");
        thread::spawn(move || {
            let text = BufReader::new(output).lines().map_while(Result::ok);
            text.for_each(|line| drop(lines.send(line)));
        });
        let first = said.recv().unwrap_or_default();
        assert_eq!(first, READY, "the program does not open its device");
        self.running = Some((child, said));
    }

    /// What the program printed, without `ready`. It must have ended well before the run.
    pub fn said(mut self) -> Vec<String> {
        let (mut child, said) = self.running.take().expect("the run was long enough");
        let ended = child.try_wait().expect("it is our child");
        let Some(ended) = ended else {
            child.kill().expect("it runs");
            let so_far: Vec<_> = said.try_iter().collect();
            panic!("the run ended before the program, which said {so_far:?}");
        };
        self.said.extend(said.iter());
        assert!(ended.success(), "{ended}: {:?}", self.said);
        self.said
    }
}

impl Observer for Program {
    fn sample(&mut self, at: Ps, _: &SignalTable, _: &Values) {
        if let Some(command) = self.command.take_if(|_| at >= START) {
            self.start(command);
        }
        if let Some((child, _)) = &mut self.running
            && child.try_wait().is_ok_and(|ended| ended.is_none())
        {
            thread::sleep(if at < SLOW {
                LET_THE_PROGRAM_WORK
            } else {
                LET_A_BUSY_COMPUTER_WORK
            });
        }
    }

    fn log(&mut self, _: &LogLine) {}

    fn can_port(&mut self, bus: CanBusId, device: &CanDevice) {
        if self.wanted == Wanted::Can(bus) {
            self.open(&device.to_string());
        }
    }

    fn link_port(&mut self, device: &Path) {
        if self.wanted == Wanted::Link {
            self.open(&device.display().to_string());
        }
    }
}
