//! `robotctl` in a thread of its own, on a bus or at the PC link of a running board.

use std::{path::Path, thread, time::Duration};

use robot_plant::{
    time::{MS, Ps},
    world::CanBusId,
};
use robot_sim::{
    can_port,
    machine::LogLine,
    runner::Observer,
    signals::{SignalTable, Values},
};
use robotctl::{
    transport::Transport,
    tuning::{Timeouts, TuningClient},
};

/// By this time the board has booted and receives frames.
const START: Ps = 200 * MS;
/// Pause of the board in each simulated millisecond while the tool works. The board runs faster than real time, and the tool
/// must end long before the run does.
const LET_THE_TOOL_WORK: Duration = Duration::from_micros(500);
/// On a busy computer a thread may rest for long.
pub const TIMEOUT: Timeouts = Timeouts {
    each_try: Duration::from_secs(20),
    tries: 2,
};

type Work<T> = Box<dyn FnOnce(&Transport) -> anyhow::Result<T> + Send>;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Can(CanBusId),
    Link,
}

/// A user's single action with the tool.
pub struct Tool<T> {
    wanted: Wanted,
    /// It begins at this time.
    start: Ps,
    work: Option<Work<T>>,
    transport: Option<Transport>,
    running: Option<thread::JoinHandle<anyhow::Result<T>>>,
    ends_run: bool,
}

impl<T: Send + 'static> Tool<T> {
    pub fn new(work: impl FnOnce(&mut TuningClient) -> anyhow::Result<T> + Send + 'static) -> Self {
        Self::with(Wanted::Can(CanBusId::Can1), |transport| {
            work(&mut TuningClient::new(transport.open()?, TIMEOUT))
        })
    }

    /// Lets it work at the PC link. It gets the port.
    pub fn at_link(work: impl FnOnce(&str) -> anyhow::Result<T> + Send + 'static) -> Self {
        Self::with(Wanted::Link, |transport| match transport {
            Transport::Link(port) => work(port),
            Transport::Can(device) => panic!("{device} is no link"),
        })
    }

    fn with(
        wanted: Wanted,
        work: impl FnOnce(&Transport) -> anyhow::Result<T> + Send + 'static,
    ) -> Self {
        Self {
            wanted,
            start: START,
            work: Some(Box::new(work)),
            transport: None,
            running: None,
            ends_run: false,
        }
    }

    /// Lets it work on another bus than CAN1.
    pub fn on(self, bus: CanBusId) -> Self {
        Self {
            wanted: Wanted::Can(bus),
            ..self
        }
    }

    /// Lets it begin at this time.
    pub fn starting_at(self, start: Ps) -> Self {
        Self { start, ..self }
    }

    /// Ends the run with the work. A tool that drives the robot takes as much of the robot's time as the computer is busy.
    pub fn ending_the_run(self) -> Self {
        Self {
            ends_run: true,
            ..self
        }
    }

    fn is_done(&self) -> bool {
        self.running.as_ref().is_some_and(|r| r.is_finished())
    }

    /// Result of the work, which must have ended before the run.
    pub fn result(self) -> anyhow::Result<T> {
        let running = self.running.expect("the run was long enough to start it");
        assert!(running.is_finished(), "the run ended before the tool");
        running.join().expect("the tool does not panic")
    }
}

impl<T: Send + 'static> Observer for Tool<T> {
    fn sample(&mut self, at: Ps, _: &SignalTable, _: &Values) {
        if let Some(transport) = self.transport.take_if(|_| at >= self.start) {
            let work = self.work.take().expect("there is one device");
            self.running = Some(thread::spawn(move || work(&transport)));
        }
        if self.running.as_ref().is_some_and(|r| !r.is_finished()) {
            thread::sleep(LET_THE_TOOL_WORK);
        }
    }

    fn log(&mut self, _: &LogLine) {}

    fn ends_run(&self) -> bool {
        self.ends_run && self.is_done()
    }

    fn can_port(&mut self, bus: CanBusId, device: &can_port::CanDevice) {
        if Wanted::Can(bus) == self.wanted {
            self.transport = device.to_string().parse().ok().map(Transport::Can);
        }
    }

    fn link_port(&mut self, device: &Path) {
        if self.wanted == Wanted::Link {
            self.transport = Some(Transport::Link(device.display().to_string()));
        }
    }
}
