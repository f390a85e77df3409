//! A robot that drives and then fails; its reaction is measured on the wires.

use robot_plant::{
    time::{MS, Ps, US, from_seconds},
    world::{RemoteInput, WireEvent},
};
use robot_sim::{machine::Machine, scenario::Scenario, simulation::Simulation};

use crate::support;

const QUIET: &str = "name = \"own failure\"\nseconds = 5.0\nplant = \"stand\"\n";
/// Resolution at which a reset is noticed.
const STEP: Ps = 50 * US;
const INDEPENDENT_WATCHDOG: f64 = 5.0;
const DISARMED: f64 = 0.0;

/// Times after the failure; the last two count from the reset.
#[derive(Debug)]
pub struct Reaction {
    pub zero: [Option<Ps>; 2],
    pub reset: Ps,
    pub zero_after_reset: [Option<Ps>; 2],
}

/// State that a debug probe has left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Debugger {
    Never,
    /// The probe has flashed and started the image, and still catches what it catches by default.
    Attached,
    AttachedWhileArmed,
    /// The probe came and went by this fault, a while after the boot.
    LeftBehind(&'static str),
}

/// A board that drives a little after `t = 4 s`, and what it has sent since.
struct Run {
    machine: Machine,
    /// Positions of the two wheel currents.
    currents: Vec<usize>,
    /// Positions of each joint's count of disable frames, and of whether it is enabled.
    joint_stops: Vec<usize>,
    joint_enabled: Vec<usize>,
    events: Vec<WireEvent>,
}

impl Run {
    fn driving(debugger: Debugger) -> Self {
        let mut job = support::job(Scenario::parse(QUIET, "own_failures").expect("it parses"));
        job.probe = debugger == Debugger::Attached;
        let mut machine = job.machine().expect("the machine starts");
        let names = machine.world_names();
        let place = |name: &str| names.iter().position(|n| n == name).expect(name);
        let joints = |what| (0..4).map(move |joint| format!("can.joint.{joint}.{what}"));
        let mut run = Self {
            currents: vec![
                place("can.m3508.0.current_ma"),
                place("can.m3508.1.current_ma"),
            ],
            joint_stops: joints("stop_frames").map(|name| place(&name)).collect(),
            joint_enabled: joints("enabled").map(|name| place(&name)).collect(),
            machine,
            events: Vec::new(),
        };
        run.until(from_seconds(1.0));
        if let Debugger::LeftBehind(fault) = debugger {
            run.set_fault(fault, true);
            run.set_fault(fault, false);
        }
        run.until(from_seconds(2.5));
        run.pilot(RemoteInput {
            enable: Some(true),
            ..RemoteInput::default()
        });
        run.until(from_seconds(3.0));
        run.pilot(RemoteInput {
            vx: Some(0.4),
            ..RemoteInput::default()
        });
        run.until(from_seconds(3.8));
        if debugger == Debugger::AttachedWhileArmed {
            run.set_fault("probe-attached", true);
        }
        run.until(from_seconds(4.0));
        assert!(run.events.iter().any(|e| run.is_torque(e)), "it drives");
        let holds = |place: &usize| run.events.iter().rfind(|e| e.signal == *place);
        assert!(
            run.joint_enabled
                .iter()
                .all(|place| holds(place).is_some_and(|e| e.value == 1.0)),
            "every joint holds"
        );
        run.events.clear();
        run
    }

    fn pilot(&mut self, input: RemoteInput) {
        self.machine.with_world(|world| world.set_remote(input));
    }

    fn set_fault(&mut self, name: &str, active: bool) {
        let set = self.machine.set_fault(name, active);
        set.expect("the fault exists");
    }

    fn until(&mut self, at: Ps) {
        self.machine.run_until(at).expect("the run goes on");
        let events = &mut self.events;
        self.machine
            .with_world(|world| world.drain_wire_events(events));
    }

    /// A wheel's current, or a joint that begins to hold.
    fn is_torque(&self, event: &WireEvent) -> bool {
        let motor =
            self.currents.contains(&event.signal) || self.joint_enabled.contains(&event.signal);
        motor && event.value != 0.0
    }

    /// Time from which each bus has zero torque, between `from` and `to`. By then, after the last frame with torque, every
    /// wheel has received its zero current and every joint its disable frame.
    fn zero_from(&self, from: Ps, to: Ps) -> [Option<Ps>; 2] {
        let seen = || self.events.iter().filter(|e| (from..to).contains(&e.at));
        let last_torque = seen().filter(|e| self.is_torque(e)).map(|e| e.at).max();
        let calm = |signal: &usize| {
            seen()
                .filter(|e| e.signal == *signal && Some(e.at) > last_torque)
                .map(|e| e.at)
                .min()
        };
        let all_calm = |signals: &[usize]| {
            let each = signals.iter().map(calm).collect::<Option<Vec<_>>>();
            each.and_then(|at| at.into_iter().max())
        };
        [all_calm(&self.currents), all_calm(&self.joint_stops)].map(|at| at.map(|at| at - from))
    }
}

/// Lets the robot fail in this way while it drives.
pub fn reaction(fault: &str, debugger: Debugger) -> Reaction {
    let mut run = Run::driving(debugger);
    run.set_fault(fault, true);
    let mut now = from_seconds(4.0);
    let started = now;
    while run.machine.resets() == 0 {
        now += STEP;
        assert!(
            now < started + 200 * MS,
            "{fault}, {debugger:?}: no reset came"
        );
        run.until(now);
    }
    let reset = now;
    run.until(from_seconds(5.0));
    let failed = run.machine.fault_struck_at().unwrap_or(started);
    assert_eq!(run.machine.resets(), 1, "{fault}");
    let mut diag = Vec::new();
    let runs = run.machine.sample_diag(&mut diag);
    assert!(runs, "{fault}, {debugger:?}: it does not run again");
    let value = |name: &str| {
        let names = run.machine.diag_names();
        diag[names.iter().position(|n| n == name).expect(name)]
    };
    assert_eq!(value("diag.reset_cause"), INDEPENDENT_WATCHDOG, "{fault}");
    assert_eq!(value("diag.arming.state"), DISARMED, "{fault}");
    let end = from_seconds(5.0);
    assert!(
        !run.events.iter().any(|e| e.at > reset && run.is_torque(e)),
        "{fault}: it moves after the reset, though nobody armed it"
    );
    Reaction {
        zero: run.zero_from(failed, reset),
        reset: reset - failed,
        zero_after_reset: run.zero_from(reset - STEP, end),
    }
}

impl Reaction {
    /// docs/safety.md#reaction-times: a hang ends in a reset within 60 ms, and zero torque follows within 20 ms.
    pub fn resets_to_zero(&self) -> bool {
        let zero = self.zero_after_reset.map(|at| within(at, 20 * MS));
        self.reset <= 60 * MS && zero == [true; 2]
    }

    /// docs/safety.md#reaction-times: zero torque within 1 ms of a panic.
    pub fn is_zero_at_once(&self) -> bool {
        self.zero.map(|at| within(at, MS)) == [true; 2]
    }
}

fn within(time: Option<Ps>, limit: Ps) -> bool {
    time.is_some_and(|time| time <= limit)
}
