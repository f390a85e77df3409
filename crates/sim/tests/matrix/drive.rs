//! Drives the emulated board up to a fault, through it and past it.

use robot_plant::{
    time::{MS, Ps},
    world::{RemoteInput, WireEvent},
};
use robot_sim::{
    faults,
    machine::{Machine, diagnostics::meaning::Meaning},
    scenario::{Event, Scenario},
    simulation::Simulation,
};

use crate::{
    expected::{After, Row},
    observed::{ARMED_SLACK, Observed, Phase, Wire},
    support,
};

const QUIET: &str = "name = \"matrix\"\nseconds = 10.0\nplant = \"stand\"\n";

/// By this time calibration and set-up of the motors are over.
const READY: Ps = 2_500 * MS;
const DRIVES: Ps = 2_700 * MS;
/// Start of the fault. It is not a whole millisecond, because faults are not synchronous to the control tick.
const FAULT: Ps = 3_300 * MS + 370_000_000;
const FAULT_LASTS: Ps = 2_000 * MS;
const SAMPLE: Ps = MS;
/// A stick that has been centred for 0.2 s is at rest; what moves after that is seen in the last 0.2 s.
const CENTRED: Ps = 300 * MS;
const PUSHED: Ps = 500 * MS;

/// Faults that the pilot causes, not a device.
pub const E_STOP: &str = "e-stop";

/// The run of one cell.
pub fn run(row: &Row, phase: Phase) -> Observed {
    let fault = row.fault;
    let back = FAULT + FAULT_LASTS + (row.back_within_ms * MS as f64) as Ps;
    let mut drive = Drive::new();
    drive.until(READY);
    if phase != Phase::Disarmed {
        drive.pilot(enable(true));
    }
    drive.until(DRIVES);
    if phase == Phase::Driving {
        drive.pilot(stick(0.4));
    }
    drive.until(FAULT);
    assert_eq!(drive.armed(), phase != Phase::Disarmed, "{fault}, {phase}");
    drive.begin(fault);
    match phase {
        Phase::Disarmed => drive.try_to_arm_twice(fault, back),
        Phase::Idle => {
            drive.until(FAULT + FAULT_LASTS);
            drive.end(fault);
            drive.until(back - PUSHED);
            drive.pilot(stick(0.4));
            drive.until(back);
        }
        Phase::Driving => {
            drive.until(FAULT + FAULT_LASTS);
            drive.end(fault);
            drive.until(back);
            if matches!(row.driving.after, After::WheelsWait | After::JointsWait) {
                drive.centre();
                drive.until(back + CENTRED);
                drive.pilot(stick(0.4));
                drive.until(back + CENTRED + PUSHED);
            }
        }
    }
    drive.conclude()
}

fn enable(on: bool) -> RemoteInput {
    RemoteInput {
        enable: Some(on),
        vx: Some(0.0),
        ..RemoteInput::default()
    }
}

fn stick(vx: f64) -> RemoteInput {
    RemoteInput {
        vx: Some(vx),
        ..RemoteInput::default()
    }
}

/// Positions of signals.
struct Places {
    currents: [usize; 2],
    enabled: [usize; 4],
    arming: usize,
    flags: usize,
}

struct Drive {
    machine: Machine,
    places: Places,
    flag_names: Meaning,
    now: Ps,
    events: Vec<WireEvent>,
    world: Vec<f64>,
    diag: Vec<f64>,
    /// Times of torque for which the diagnostics have not yet shown an armed robot.
    suspects: Vec<Ps>,
    last_armed: Option<Ps>,
    flags_now: u64,
    flags_before: u64,
    flags_during: u64,
    fault_since: Option<Ps>,
    fault_until: Option<Ps>,
    centred_at: Option<Ps>,
    observed: Observed,
}

impl Drive {
    fn new() -> Self {
        let job = support::job(Scenario::parse(QUIET, "matrix").expect("it parses"));
        let mut machine = job.machine().expect("the machine starts");
        let names = machine.world_names();
        let world = |name: &str| names.iter().position(|n| n == name).expect(name);
        let diag_names = machine.diag_names().to_vec();
        let diag = |name: &str| diag_names.iter().position(|n| n == name).expect(name);
        let places = Places {
            currents: [0, 1].map(|n| world(&format!("can.m3508.{n}.current_ma"))),
            enabled: [0, 1, 2, 3].map(|n| world(&format!("can.joint.{n}.enabled"))),
            arming: diag("diag.arming.state"),
            flags: diag("diag.safety.flags"),
        };
        let meaning = machine.diag_meanings()[places.flags].clone();
        Self {
            flag_names: meaning.expect("the image names its safety flags"),
            machine,
            places,
            now: 0,
            events: Vec::new(),
            world: Vec::new(),
            diag: Vec::new(),
            suspects: Vec::new(),
            last_armed: None,
            flags_now: 0,
            flags_before: 0,
            flags_during: 0,
            fault_since: None,
            fault_until: None,
            centred_at: None,
            observed: Observed::default(),
        }
    }

    fn pilot(&mut self, input: RemoteInput) {
        let event = Event::Remote(input);
        Simulation::apply(&mut self.machine, &event).expect("a pilot can always act");
    }

    fn centre(&mut self) {
        self.centred_at = Some(self.now);
        self.pilot(stick(0.0));
    }

    fn begin(&mut self, fault: &str) {
        self.fault_since = Some(self.now);
        self.flags_before = self.flags_now;
        self.switch(fault, true);
    }

    fn end(&mut self, fault: &str) {
        self.observed.armed_at_fault_end = self.armed();
        self.fault_until = Some(self.now);
        self.switch(fault, false);
    }

    fn switch(&mut self, fault: &str, on: bool) {
        if fault == E_STOP {
            self.pilot(RemoteInput {
                e_stop: Some(on),
                ..RemoteInput::default()
            });
        } else {
            faults::set(&mut self.machine, fault, on).expect("the fault exists");
        }
    }

    /// On, too late to be still asking when the fault ends, off again; then off and on after the fault.
    fn try_to_arm_twice(&mut self, fault: &str, end: Ps) {
        self.until(FAULT + 1_500 * MS);
        self.pilot(enable(true));
        self.until(FAULT + 1_800 * MS);
        self.observed.armed_during_fault = self.armed();
        self.pilot(enable(false));
        self.until(FAULT + FAULT_LASTS);
        self.end(fault);
        self.until(end - 400 * MS);
        self.pilot(enable(true));
        self.until(end);
        self.observed.armed_after_fault = self.armed();
    }

    fn armed(&self) -> bool {
        self.last_armed == Some(self.now)
    }

    fn until(&mut self, end: Ps) {
        while self.now < end {
            let next = ((self.now / SAMPLE + 1) * SAMPLE).min(end);
            self.machine.run_until(next).expect("the run goes on");
            self.now = next;
            self.hear();
            self.ask();
        }
    }

    /// Takes the events on the wires.
    fn hear(&mut self) {
        let mut events = std::mem::take(&mut self.events);
        self.machine.drain_wire_events(&mut events);
        for event in events.drain(..) {
            if let Some(motor) = self.places.motor(event.signal) {
                self.says(motor, event.at, event.value);
            }
        }
        self.events = events;
        // A joint that loses its supply reports nothing.
        self.machine.sample_world(&mut self.world);
        for joint in 0..4 {
            let value = self.world[self.places.enabled[joint]];
            if value != self.wire(2 + joint).last() {
                self.says(2 + joint, self.now, value);
            }
        }
    }

    fn wire(&mut self, motor: usize) -> &mut Wire {
        match motor {
            0 | 1 => &mut self.observed.wheels[motor],
            joint => &mut self.observed.joints[joint - 2],
        }
    }

    fn says(&mut self, motor: usize, at: Ps, value: f64) {
        let surely_armed = self
            .last_armed
            .is_some_and(|armed| at <= armed + ARMED_SLACK);
        if value != 0.0 && !surely_armed {
            self.suspects.push(at);
        }
        let since = self.fault_since.filter(|since| at >= *since);
        let wire = self.wire(motor);
        match since {
            Some(since) => wire.changes.push((at - since, value)),
            None => wire.before = value,
        }
    }

    /// Takes the firmware's diagnostics.
    fn ask(&mut self) {
        let known = self.machine.sample_diag(&mut self.diag);
        let sure = self.now.saturating_sub(ARMED_SLACK);
        if known && self.diag[self.places.arming] == 1.0 {
            self.last_armed = Some(self.now);
            self.suspects.retain(|at| *at < sure);
        }
        let guilty = self.suspects.extract_if(.., |at| *at < sure);
        self.observed.torque_unarmed.extend(guilty);
        if known {
            self.flags_now = self.diag[self.places.flags] as u64;
            let faulty = self.fault_since.is_some() && self.fault_until.is_none();
            // What rises after a reset are the flags of a boot.
            if faulty && self.machine.resets() == 0 {
                self.flags_during |= self.flags_now;
            }
        }
    }

    fn conclude(self) -> Observed {
        let since = self.fault_since.expect("the fault began");
        let struck = self.machine.fault_struck_at();
        let mut observed = self.observed;
        let risen = self.flags_during & !self.flags_before;
        let bits = (0..64_u8).filter(|bit| risen >> bit & 1 == 1);
        let name = |bit| self.flag_names.bit(bit).map(str::to_owned);
        observed.flags = bits
            .map(|bit| name(bit).unwrap_or_else(|| format!("bit {bit}")))
            .collect();
        observed.struck = struck.map_or(0, |at| at - since);
        observed.fault_ended = self.fault_until.expect("the fault ended") - since;
        observed.ended = self.now - since;
        observed.centred = self.centred_at.map(|at| at - since);
        observed.armed_at_end = self.last_armed == Some(self.now);
        observed.resets = self.machine.resets();
        let errors = Machine::board_errors(&self.machine).into_iter();
        observed.board_errors = errors.map(|error| error.message).collect();
        observed
    }
}

impl Places {
    /// 0 and 1 = wheels, 2 to 5 = joints.
    fn motor(&self, signal: usize) -> Option<usize> {
        let all = self.currents.iter().chain(&self.enabled);
        all.into_iter().position(|place| *place == signal)
    }
}
