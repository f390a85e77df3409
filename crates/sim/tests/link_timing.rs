//! Times of the PC link on the shipped image: from a command's last bit to the motors, the rate and jitter of the states, and
//! what a full or flooded line costs the control tick (docs/figures.md#the-pc-link).

mod support;

use robot_plant::{
    time::{MS, Ps, US},
    world::{PcInput, RemoteInput, WireEvent},
};
use robot_sim::{
    machine::Machine,
    scenario::{Event, Scenario},
    simulation::Simulation,
};

const ARMED: Ps = 2_700 * MS;
const SWINGS: Ps = 3_000 * MS;
const END: Ps = 9_000 * MS;
/// Frames come at every instant of a tick, not always at the same.
const PERIOD: Ps = 10 * MS + 137 * US;
/// The current of either direction is at its limit then.
const SWING_RPS: f64 = 12.0;

/// A command waits for an idle character (22 µs) and at most a tick; its frame on CAN1 takes 0.13 ms.
const MOST_LATENCY_US: f64 = 1_500.0;
const MEDIAN_LATENCY_US: f64 = 900.0;
const LEAST_RATE_HZ: f64 = 400.0;
/// A tenth of the interval.
const MOST_JITTER_US: f64 = 240.0;

struct Board {
    machine: Machine,
    events: Vec<WireEvent>,
    /// Positions of signals.
    down: usize,
    up: usize,
    left_ma: usize,
}

impl Board {
    fn new() -> Self {
        let quiet = "name = \"link timing\"\nseconds = 10.0\nplant = \"stand\"\n";
        let job = support::job(Scenario::parse(quiet, "timing").expect("it parses"));
        let mut machine = job.machine().expect("the machine starts");
        let names = machine.world_names();
        let place = |name: &str| names.iter().position(|n| n == name).expect(name);
        Self {
            machine,
            events: Vec::new(),
            down: place("link.down.frames"),
            up: place("link.up.frames"),
            left_ma: place("can.m3508.0.current_ma"),
        }
    }

    fn until(&mut self, end: Ps) {
        self.machine.run_until(end).expect("the run goes on");
        self.machine.drain_wire_events(&mut self.events);
    }

    fn act(&mut self, event: &Event) {
        Simulation::apply(&mut self.machine, event).expect("pilot and PC can always act");
    }

    fn pc(&mut self, input: PcInput) {
        self.act(&Event::Pc(input));
    }

    fn of(&self, signal: usize, from: Ps) -> Vec<(Ps, f64)> {
        let events = self.events.iter();
        let events = events.filter(|event| event.signal == signal && event.at >= from);
        events.map(|event| (event.at, event.value)).collect()
    }
}

/// Arms in mode PC, then swings the wheels: each frame asks for the other direction.
fn swinging() -> Board {
    let mut board = Board::new();
    board.pc(PcInput {
        wheel_kd: Some(1.0),
        rate_hz: Some(1e12 / PERIOD as f64),
        ..PcInput::rest()
    });
    board.act(&Event::Remote(RemoteInput {
        mode: Some(1),
        ..RemoteInput::default()
    }));
    board.until(2_500 * MS);
    board.act(&Event::Remote(RemoteInput {
        enable: Some(true),
        ..RemoteInput::default()
    }));
    board.until(ARMED);
    let mut direction = 1.0;
    // Half way between two frames.
    let mut at = SWINGS / PERIOD * PERIOD + PERIOD / 2;
    while at < END {
        board.until(at);
        board.pc(PcInput {
            wheels_rps: Some([direction * SWING_RPS; 2]),
            ..PcInput::default()
        });
        direction = -direction;
        at += PERIOD;
    }
    board
}

/// Values in ascending order, for percentiles.
struct Sorted(Vec<f64>);

impl Sorted {
    fn new(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        Self(values)
    }

    fn share(&self, share: f64) -> f64 {
        self.0[((self.0.len() - 1) as f64 * share).round() as usize]
    }
}

fn us(time: Ps) -> f64 {
    time as f64 / US as f64
}

/// From the end of each frame's last stop bit to the end of the first CAN frame that carries its direction.
fn latencies_us(board: &Board) -> Vec<f64> {
    let frames = board.of(board.down, SWINGS + 2 * PERIOD);
    let currents = board.of(board.left_ma, SWINGS);
    let before = |at: Ps| currents.iter().rfind(|(t, _)| *t <= at).map(|(_, ma)| *ma);
    let answers = frames.iter().filter_map(|(at, _)| {
        let before = before(*at)?;
        let mut after = currents.iter().filter(|(t, _)| t > at);
        let (changed, _) = after.find(|(_, ma)| ma.signum() != before.signum())?;
        Some(us(changed - at))
    });
    answers.collect()
}

#[test]
fn a_command_is_on_the_motors_bus_within_two_ticks_and_states_come_at_400_hz() {
    let board = swinging();
    let latencies = latencies_us(&board);
    assert!(latencies.len() > 550, "{} answers", latencies.len());
    let latency = Sorted::new(latencies);
    let [p50, p99, most] = [0.5, 0.99, 1.0].map(|share| latency.share(share));
    println!("last stop bit to CAN: p50 {p50:.0} µs, p99 {p99:.0} µs, max {most:.0} µs");
    assert!(p50 <= MEDIAN_LATENCY_US && most <= MOST_LATENCY_US);

    let states = board.of(board.up, ARMED);
    let intervals = states.windows(2).map(|pair| us(pair[1].0 - pair[0].0));
    let interval = Sorted::new(intervals.collect());
    let mean = interval.0.iter().sum::<f64>() / interval.0.len() as f64;
    let [least, p1, p50, p99, most] = [0.0, 0.01, 0.5, 0.99, 1.0].map(|s| interval.share(s));
    let rate_hz = 1e6 / mean;
    println!(
        "states: {rate_hz:.1} Hz, interval {mean:.0} µs in the mean, p1 {p1:.0}, p50 {p50:.0}, p99 {p99:.0}, \
         {least:.0} to {most:.0} µs"
    );
    assert!(rate_hz >= LEAST_RATE_HZ, "{rate_hz} Hz");
    let jitter = (most - mean).max(mean - least);
    assert!(jitter <= MOST_JITTER_US, "{jitter} µs");
}

/// A drive by PC with this rate of frames, and perhaps a fault for the last five seconds.
fn drive(rate_hz: u32, fault: &str) -> Scenario {
    let mut text = format!(
        r#"
        name = "link budgets"
        seconds = 10.0
        plant = "stand"
        [[at]]
        t = 0.5
        remote = {{ mode = 1 }}
        pc = {{ wheels = [0, 0], joints = "hold", rate_hz = {rate_hz} }}
        [[at]]
        t = 2.5
        remote = {{ enable = true }}
        [[at]]
        t = 3.0
        pc = {{ wheels = [5, 5], joints = [0.2, 0.2, 0.2, 0.2] }}
        [[expect]]
        signal = "truth.wheel.0.speed_rps"
        from = 4.0
        to = 5.0
        min = 4.5
        [[expect]]
        signal = "link.up.rate_hz"
        from = 3.0
        to = 5.0
        min = 400.0
        "#
    );
    if !fault.is_empty() {
        text += &format!("[[at]]\nt = 5.0\nfault = \"{fault}\"\nduration = 5.0\n");
    }
    Scenario::parse(&text, "budgets").expect("it parses")
}

#[test]
fn a_full_and_a_flooded_line_leave_time_to_spare() {
    let mut wrong = Vec::new();
    for (what, rate_hz, fault) in [
        ("100 frames a second", 100, ""),
        ("1,200 frames a second", 1_200, ""),
        ("link-flood", 100, "link-flood"),
        ("link-noise", 1_200, "link-noise"),
    ] {
        let outcome = support::job(drive(rate_hz, fault))
            .run(&mut [])
            .expect("the run goes through");
        let stats = &outcome.result.stats;
        println!(
            "{what}: tick {:.0} instructions in the mean, {} at most, jitter {:.2} µs, CPU load {:.1} %",
            stats.tick_instructions.mean,
            stats.tick_instructions.max,
            stats.release_jitter_us.max,
            stats.cpu_load * 100.0
        );
        let failed = outcome.summary.failed_expectations.iter();
        wrong.extend(failed.map(|failed| format!("{what}: {failed:?}")));
        let errors = outcome.summary.board_errors.iter();
        wrong.extend(errors.map(|error| format!("{what}: {error:?}")));
        let over = outcome.summary.budgets.iter().filter(|budget| !budget.ok);
        wrong.extend(over.map(|budget| format!("{what}: {budget:?}")));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
