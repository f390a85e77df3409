//! The image fails while it drives: how long until zero torque on both buses, the reset, and zero torque after it.
//!
//! Limits: design, "panic → zero torque frames ≤ 1 ms; hang → watchdog reset ≤ 60 ms, zero torque ≤ 20 ms after reset".

mod support;

use std::{sync::Mutex, thread};

use robot_emulator::{
    machine::{Machine, faults},
    sim::{board::Board, scenario::Scenario},
};
use robot_plant::{
    time::{MS, Ps, US, from_seconds},
    world::{RemoteInput, WireEvent},
};

const QUIET: &str = "name = \"own failure\"\nseconds = 5.0\nplant = \"stand\"\n";
/// The instant of a reset is seen this exactly.
const STEP: Ps = 50 * US;
const INDEPENDENT_WATCHDOG: f64 = 5.0;
const DISARMED: f64 = 0.0;

/// Times after the failure; the last two after the reset.
#[derive(Debug)]
struct Reaction {
    zero: [Option<Ps>; 2],
    reset: Ps,
    zero_after_reset: [Option<Ps>; 2],
}

/// A board that drives at `t = 4 s` and a bit, and what it sent since.
struct Run {
    machine: Machine,
    /// Places of the two wheel currents.
    currents: Vec<usize>,
    /// Of each joint's count of disable frames, and of whether it is enabled.
    joint_stops: Vec<usize>,
    joint_enabled: Vec<usize>,
    events: Vec<WireEvent>,
}

impl Run {
    fn driving() -> Self {
        let job = support::job(Scenario::parse(QUIET, "own_failures").expect("it parses"));
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

    /// From when on each bus has zero torque, looked for from `from` to `to`: after the last frame with torque, every
    /// wheel has got its zero current and every joint its disable frame.
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

fn reaction(fault: &str) -> Reaction {
    let mut run = Run::driving();
    run.machine
        .set_fault(fault, true)
        .expect("the fault exists");
    let mut now = from_seconds(4.0);
    let started = now;
    while run.machine.resets() == 0 {
        now += STEP;
        assert!(now < started + 200 * MS, "{fault}: no reset came");
        run.until(now);
    }
    let reset = now;
    run.until(from_seconds(5.0));
    let failed = run.machine.fault_struck_at().unwrap_or(started);
    assert_eq!(run.machine.resets(), 1, "{fault}");
    let mut diag = Vec::new();
    assert!(run.machine.sample_diag(&mut diag), "{fault}: it runs again");
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

fn within(time: Option<Ps>, limit: Ps) -> bool {
    time.is_some_and(|time| time <= limit)
}

fn shown(time: Option<Ps>) -> String {
    time.map_or("–".into(), |t| format!("{:.2}", t as f64 / MS as f64))
}

#[test]
fn every_failure_of_the_image_ends_without_torque() {
    support::image();
    let names: Vec<&str> = faults::of_the_program().map(|fault| fault.name).collect();
    let queue = Mutex::new(names.iter());
    let reactions = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, |n| n.get()) {
            scope.spawn(|| {
                while let Some(name) = { queue.lock().unwrap().next() } {
                    let reaction = reaction(name);
                    reactions.lock().unwrap().push((*name, reaction));
                }
            });
        }
    });
    let mut reactions = reactions.into_inner().unwrap();
    reactions.sort_by_key(|(name, _)| names.iter().position(|n| n == name));
    println!("ms to:              zero CAN1  zero CAN2  reset   then zero CAN1  zero CAN2");
    for (name, r) in &reactions {
        let [can1, can2] = r.zero.map(shown);
        let [then1, then2] = r.zero_after_reset.map(shown);
        let reset = shown(Some(r.reset));
        println!("{name:<19} {can1:>9}  {can2:>9}  {reset:>5}   {then1:>14}  {then2:>9}");
    }
    assert_eq!(reactions.len(), names.len());
    for (name, r) in &reactions {
        assert!(r.reset <= 60 * MS, "{name}: {r:?}");
        for bus in 0..2 {
            assert!(within(r.zero_after_reset[bus], 20 * MS), "{name}: {r:?}");
            if !name.starts_with("task-") {
                assert!(within(r.zero[bus], MS), "{name}: {r:?}");
            }
        }
    }
}
