//! Runs a scenario: applies its events, samples signals at 1 kHz and judges every expectation.

use std::path::Path;

use robot_plant::{
    time::{self, Ps},
    world::{CanBusId, WireEvent},
};

use super::{
    attitude_score::AttitudeScore,
    expectation::{self, Judge, Verdict},
    faults::EventError,
    run_signals::RunSignals,
    scenario::Scenario,
    signals::{SignalTable, Values},
    simulation::Simulation,
};
use crate::{
    can_port::{CanDevice, PortStats},
    machine::{LogLine, Stats},
    pc::PcPorts,
    pty::{LinkPort, LinkStats},
};
use robot_emulator::soc::board_errors::BoardError;

/// Signals are sampled and expectations judged this often.
pub const SAMPLE_PERIOD: Ps = time::MS;

/// Diagnostics older than this are ignored: the firmware hangs or restarts.
const DIAG_HOLD: Ps = 20 * time::MS;

/// Receives samples and log lines during a run: terminal, recording, traces.
pub trait Observer {
    fn sample(&mut self, at: Ps, table: &SignalTable, values: &Values);
    fn log(&mut self, line: &LogLine);

    /// Programs find a bus on `device`; the run begins.
    fn can_port(&mut self, _bus: CanBusId, _device: &CanDevice) {}

    /// Programs find the PC link on the serial device `device`; the run begins.
    fn link_port(&mut self, _device: &Path) {}

    /// Returns whether the user wants the run to end now.
    fn ends_run(&self) -> bool {
        false
    }
}

/// The result of a run.
pub struct RunResult {
    pub table: SignalTable,
    pub verdicts: Vec<Verdict>,
    /// Reason why the machine stopped before the end, if it did.
    pub stopped: Option<String>,
    /// Board errors that the scenario does not allow.
    pub board_errors: Vec<BoardError>,
    pub allowed_board_errors: Vec<BoardError>,
    /// Suspicious settings and accesses, which do not fail the run.
    pub suspicions: Vec<BoardError>,
    pub stats: Stats,
    /// Expectations that look past the time at which the user ended the run. They are not judged.
    pub left_out: usize,
    /// Time that was actually simulated.
    pub ran: Ps,
    pub last_values: Values,
    /// All bits that were set in `diag.safety.flags` at any sample.
    pub safety_flags_seen: u64,
    pub attitude: AttitudeScore,
    /// Buses in which a PC took part.
    pub ports: Vec<(CanBusId, PortStats)>,
    /// What a program exchanged with the board over the PC link, if it could.
    pub link: Option<LinkStats>,
}

impl RunResult {
    /// Whether the run reached its end, every expectation held, and there were no board errors other than suspicions and
    /// allowed ones.
    pub fn ok(&self) -> bool {
        self.stopped.is_none()
            && self.board_errors.is_empty()
            && self.verdicts.iter().all(|v| v.failure.is_none())
    }

    pub fn value(&self, signal: &str) -> Option<f64> {
        self.last_values[self.table.index(signal)?]
    }
}

/// Runs `scenario` from power-on to its end, or to where the machine stops. Programs on `ports` take part every sample.
pub fn run<B: Simulation>(
    board: &mut B,
    scenario: &Scenario,
    ports: &mut PcPorts,
    observers: &mut [&mut dyn Observer],
) -> Result<RunResult, EventError> {
    for port in &ports.can {
        for observer in observers.iter_mut() {
            observer.can_port(port.bus(), &port.device());
        }
    }
    if let Some(link) = &ports.link {
        for observer in observers.iter_mut() {
            observer.link_port(link.path());
        }
    }
    let mut run = Run::new(board, scenario);
    let mut events = scenario.events.iter().peekable();
    let mut now = 0;
    let mut stopped = None;
    let mut end = scenario.length;
    run.sample(now, scenario.length == 0, observers);
    while now < end {
        while let Some(timed) = events.next_if(|a| a.at <= now) {
            run.board.apply(&timed.event)?;
        }
        let next_sample = (now / SAMPLE_PERIOD + 1) * SAMPLE_PERIOD;
        let next_event_at = events.peek().map_or(Ps::MAX, |a| a.at);
        let until = next_sample.min(next_event_at).min(end);
        if let Err(why) = run.board.run_until(until) {
            stopped = Some(why.to_string());
            run.drain_log(observers);
            break;
        }
        now = until;
        if let Err(why) = run.board.serve(ports) {
            stopped = Some(format!("the way of a PC into the simulation failed: {why}"));
            run.drain_log(observers);
            break;
        }
        if observers.iter().any(|observer| observer.ends_run()) {
            end = now;
        }
        if now == next_sample || now == end {
            run.sample(now, now == end, observers);
        }
    }
    run.leave_out_after(end, scenario);
    let mut result = run.finish(scenario, now, stopped);
    result.ports = ports.can.iter().map(|p| (p.bus(), p.stats())).collect();
    result.link = ports.link.as_ref().map(LinkPort::stats);
    Ok(result)
}

/// One bound or flag of one expectation.
struct Watched {
    /// Position of the expectation in the scenario.
    expectation: usize,
    judged: Result<Judged, Unjudgeable>,
}

struct Judged {
    /// The signal's place in the table.
    place: usize,
    judge: Judge,
}

struct Unjudgeable {
    expected: String,
    why: String,
}

impl Watched {
    fn all(scenario: &Scenario, table: &SignalTable) -> Vec<Self> {
        let mut all = Vec::new();
        for (expectation, wanted) in scenario.expectations.iter().enumerate() {
            let place = table.index(&wanted.signal);
            let bounds = wanted.bounds.iter().map(|b| (b.to_string(), Ok(*b)));
            let meaning = place.and_then(|place| table.meaning(place));
            let flags = wanted.flags.iter();
            let flags = flags.map(|f| (f.to_string(), f.bound(&wanted.signal, meaning)));
            for (expected, bound) in bounds.chain(flags) {
                let judged = match (place, bound) {
                    (Some(place), Ok(bound)) => Ok(Judged {
                        place,
                        judge: Judge::new(bound, wanted.window),
                    }),
                    (Some(_), Err(error)) => Err(Unjudgeable {
                        expected,
                        why: error.to_string(),
                    }),
                    (None, _) => {
                        let why = table.missing(&wanted.signal);
                        Err(Unjudgeable { expected, why })
                    }
                };
                all.push(Self {
                    expectation,
                    judged,
                });
            }
        }
        all
    }

    fn verdict(self, scenario: &Scenario, end: Ps, table: &SignalTable) -> Verdict {
        let wanted = &scenario.expectations[self.expectation];
        match self.judged {
            Ok(Judged { place, judge }) => {
                let because = wanted.because.clone();
                judge.finish(&wanted.signal, because, end, table.meaning(place))
            }
            Err(Unjudgeable { expected, why }) => expectation::unjudgeable(wanted, expected, why),
        }
    }
}

struct Run<'a, B> {
    board: &'a mut B,
    table: SignalTable,
    signals: RunSignals,
    values: Values,
    world: Vec<f64>,
    diag: Vec<f64>,
    diag_seen: Option<Ps>,
    events: Vec<WireEvent>,
    watched: Vec<Watched>,
    left_out: usize,
    flags: Option<usize>,
    safety_flags_seen: u64,
    attitude: AttitudeScore,
}

impl<'a, B: Simulation> Run<'a, B> {
    fn new(board: &'a mut B, scenario: &Scenario) -> Self {
        let table = SignalTable::new(
            &board.world_names(),
            &board.diag_names(),
            RunSignals::names(),
        )
        .with_meanings(board.diag_meanings());
        Self {
            watched: Watched::all(scenario, &table),
            left_out: 0,
            signals: RunSignals::new(&table),
            flags: table.index("diag.safety.flags"),
            attitude: AttitudeScore::new(&table),
            board,
            table,
            values: Values::new(),
            world: Vec::new(),
            diag: Vec::new(),
            diag_seen: None,
            events: Vec::new(),
            safety_flags_seen: 0,
        }
    }

    fn sample(&mut self, now: Ps, last: bool, observers: &mut [&mut dyn Observer]) {
        self.drain_log(observers);
        self.judge_wire_events();
        self.read_values(now, last);
        for Judged { place, judge } in judged(&mut self.watched) {
            if let Some(value) = self.values[*place] {
                judge.see(now, value);
            }
        }
        if let Some(flags) = self.flags.and_then(|i| self.values[i]) {
            self.safety_flags_seen |= flags as u64;
        }
        self.attitude.see(&self.values);
        for observer in observers {
            observer.sample(now, &self.table, &self.values);
        }
    }

    /// Does not judge what looks past `end`, where the user ended the run.
    fn leave_out_after(&mut self, end: Ps, scenario: &Scenario) {
        let before = self.watched.len();
        let inside = |w: &Watched| scenario.expectations[w.expectation].window.end <= end;
        self.watched.retain(inside);
        self.left_out = before - self.watched.len();
    }

    fn drain_log(&mut self, observers: &mut [&mut dyn Observer]) {
        for line in self.board.take_log() {
            for observer in observers.iter_mut() {
                observer.log(&line);
            }
        }
    }

    fn judge_wire_events(&mut self) {
        self.events.clear();
        self.board.drain_wire_events(&mut self.events);
        for event in &self.events {
            for Judged { place, judge } in judged(&mut self.watched) {
                if *place == event.signal {
                    judge.see(event.at, event.value);
                }
            }
        }
    }

    fn read_values(&mut self, now: Ps, last: bool) {
        self.world.clear();
        self.board.sample_world(&mut self.world);
        self.values.clear();
        self.values.extend(self.world.iter().copied().map(Some));
        let mut fresh = std::mem::take(&mut self.diag);
        if self.board.sample_diag(&mut fresh) {
            self.diag_seen = Some(now);
        }
        self.diag = fresh;
        let known = self.diag_seen.is_some_and(|seen| now - seen <= DIAG_HOLD);
        let names = self.table.diag_range().len();
        self.values
            .extend((0..names).map(|i| self.diag.get(i).copied().filter(|_| known)));
        self.signals.append(self.board, now, last, &mut self.values);
    }

    fn finish(self, scenario: &Scenario, end: Ps, stopped: Option<String>) -> RunResult {
        let verdicts = self
            .watched
            .into_iter()
            .map(|watched| watched.verdict(scenario, end, &self.table))
            .collect();
        let allowed = |e: &BoardError| {
            let mut allowances = scenario.allow_board_errors.iter();
            allowances.any(|part| e.message.contains(part.as_str()))
        };
        let (allowed_board_errors, board_errors) =
            self.board.board_errors().into_iter().partition(allowed);
        RunResult {
            verdicts,
            stopped,
            board_errors,
            allowed_board_errors,
            suspicions: self.board.suspicions(),
            stats: self.board.stats(),
            left_out: self.left_out,
            ran: end,
            last_values: self.values,
            safety_flags_seen: self.safety_flags_seen,
            attitude: self.attitude,
            ports: Vec::new(),
            link: None,
            table: self.table,
        }
    }
}

fn judged(watched: &mut [Watched]) -> impl Iterator<Item = &mut Judged> {
    watched.iter_mut().filter_map(|w| w.judged.as_mut().ok())
}

#[cfg(test)]
mod tests;
