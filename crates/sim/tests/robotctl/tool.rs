//! `robotctl` in a thread of its own, on a bus of a running board.

use std::{thread, time::Duration};

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
    can_link::CanDevice,
    tuning::{Timeouts, TuningClient},
};

/// By this time the board has booted and receives frames.
const START: Ps = 200 * MS;
/// Pause of the board in each simulated millisecond while the tool works. The board runs faster than real time, and the tool
/// must end long before the run does.
const LET_THE_TOOL_WORK: Duration = Duration::from_micros(500);
/// On a busy computer a thread may rest for long.
const TIMEOUT: Timeouts = Timeouts {
    each_try: Duration::from_secs(20),
    tries: 2,
};

type Work<T> = Box<dyn FnOnce(&mut TuningClient) -> anyhow::Result<T> + Send>;

/// A user's single action with the tool.
pub struct Tool<T> {
    bus: CanBusId,
    work: Option<Work<T>>,
    device: Option<CanDevice>,
    running: Option<thread::JoinHandle<anyhow::Result<T>>>,
}

impl<T: Send + 'static> Tool<T> {
    pub fn new(work: impl FnOnce(&mut TuningClient) -> anyhow::Result<T> + Send + 'static) -> Self {
        Self {
            bus: CanBusId::Can1,
            work: Some(Box::new(work)),
            device: None,
            running: None,
        }
    }

    /// Lets it work on another bus than CAN1.
    pub fn on(self, bus: CanBusId) -> Self {
        Self { bus, ..self }
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
        if let Some(device) = self.device.take_if(|_| at >= START) {
            let work = self.work.take().expect("there is one device");
            self.running = Some(thread::spawn(move || {
                work(&mut TuningClient::new(device.open()?, TIMEOUT))
            }));
        }
        if self.running.as_ref().is_some_and(|r| !r.is_finished()) {
            thread::sleep(LET_THE_TOOL_WORK);
        }
    }

    fn log(&mut self, _: &LogLine) {}

    fn can_port(&mut self, bus: CanBusId, device: &can_port::CanDevice) {
        if bus == self.bus {
            self.device = device.to_string().parse().ok();
        }
    }
}
