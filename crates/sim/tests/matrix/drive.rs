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
    balancing_course,
    driver::{Driver, PC_WHEEL_RPS},
    observed::{ARMED_SLACK, Observed, Phase, Pose, Wire},
    pc_law,
    row::{After, Row},
    support,
};

const QUIET: &str = "name = \"matrix\"\nseconds = 10.0\nplant = \"stand\"\n";

/// A PC is plugged in and sends.
pub const PC_STARTS: Ps = 500 * MS;
/// By this time calibration and set-up of the motors are over.
pub const READY: Ps = 2_500 * MS;
const DRIVES: Ps = 2_700 * MS;
/// Start of the fault. It is not a whole millisecond, because faults are not synchronous to the control tick.
const FAULT: Ps = 3_300 * MS + 370_000_000;
const SAMPLE: Ps = MS;
/// A stick that has been centred for 0.2 s is at rest; what moves after that is seen in the last 0.2 s.
const CENTRED: Ps = 300 * MS;
const PUSHED: Ps = 500 * MS;

/// Faults that the pilot causes, not a device.
pub const E_STOP: &str = "e-stop";

/// The run of one cell.
pub fn run(row: &Row, phase: Phase) -> Observed {
    if phase == Phase::Balancing {
        return balancing_course::run(row);
    }
    let fault = row.fault;
    let over = FAULT + row.lasts;
    let back = over + (row.back_within_ms * MS as f64) as Ps;
    let mut drive = Drive::new(row, phase);
    drive.until(PC_STARTS);
    for event in row.driver.prepare(phase) {
        drive.act(&event);
    }
    drive.until(READY);
    if phase != Phase::Disarmed {
        drive.pilot(enable(true));
    }
    drive.until(DRIVES);
    match phase {
        Phase::Driving => drive.act(&row.driver.push(phase)),
        // Nothing moves, whatever a PC asks for.
        Phase::Disarmed if row.driver == Driver::Pc => drive.act(&row.driver.push(phase)),
        Phase::Idle => row.driver.idle().iter().for_each(|event| drive.act(event)),
        Phase::Disarmed | Phase::Balancing => {}
    }
    drive.until(FAULT);
    assert_eq!(drive.armed(), phase != Phase::Disarmed, "{fault}, {phase}");
    drive.begin(fault);
    match phase {
        Phase::Disarmed => drive.try_to_arm_twice(fault, over, back),
        Phase::Idle => {
            drive.until(over);
            drive.end(fault);
            drive.until(back - PUSHED);
            drive.act(&row.driver.push(phase));
            drive.until(back);
        }
        Phase::Driving | Phase::Balancing => {
            drive.until(over);
            drive.end(fault);
            drive.until(back);
            let waits = matches!(
                row.driving.after,
                After::WheelsWait | After::JointsWait | After::PcWaits
            );
            if waits {
                drive.centre(&row.driver.rest(phase));
                drive.until(back + CENTRED);
                drive.act(&row.driver.push(phase));
                drive.until(back + CENTRED + PUSHED);
            }
        }
    }
    drive.conclude()
}

pub fn enable(on: bool) -> RemoteInput {
    RemoteInput {
        enable: Some(on),
        vx: Some(0.0),
        ..RemoteInput::default()
    }
}

/// Positions of signals.
struct Places {
    currents: [usize; 2],
    joints: [usize; 4],
    wheel_rps: [usize; 2],
    joint_pos_rad: [usize; 4],
    joint_vel_rps: [usize; 4],
    /// Pitch, roll, height, speed.
    pose: [usize; 4],
    arming: usize,
    flags: usize,
}

pub struct Drive {
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
    /// What the PC asks of the wheels during the fault, if all torques must follow from that.
    asked_rps: Option<f64>,
    observed: Observed,
}

impl Drive {
    pub fn new(row: &Row, phase: Phase) -> Self {
        let balances = phase == Phase::Balancing;
        let world = if balances {
            balancing_course::WORLD
        } else {
            QUIET
        };
        let job = support::job(Scenario::parse(world, "matrix").expect("it parses"));
        let mut machine = job.machine().expect("the machine starts");
        let names = machine.world_names();
        let world = |name: &str| names.iter().position(|n| n == name).expect(name);
        let diag_names = machine.diag_names().to_vec();
        let diag = |name: &str| diag_names.iter().position(|n| n == name).expect(name);
        // A PC that is lost leaves the joints enabled, without torque.
        let joint_part = match row.driver {
            Driver::Pc if !balances => "torque_nm",
            Driver::Pc | Driver::Pilot | Driver::PilotBesidePc => "enabled",
        };
        let places = Places {
            currents: [0, 1].map(|n| world(&format!("can.m3508.{n}.current_ma"))),
            joints: [0, 1, 2, 3].map(|n| world(&format!("can.joint.{n}.{joint_part}"))),
            wheel_rps: [0, 1].map(|n| world(&format!("truth.wheel.{n}.speed_rps"))),
            joint_pos_rad: [0, 1, 2, 3].map(|n| world(&format!("truth.joint.{n}.pos_rad"))),
            joint_vel_rps: [0, 1, 2, 3].map(|n| world(&format!("truth.joint.{n}.vel_rps"))),
            pose: ["pitch", "roll", "z", "vx"].map(|name| world(&format!("truth.body.{name}"))),
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
            asked_rps: (row.keeps_law && !balances).then_some(match phase {
                Phase::Driving => PC_WHEEL_RPS,
                Phase::Idle | Phase::Disarmed | Phase::Balancing => 0.0,
            }),
            observed: Observed::default(),
        }
    }

    pub fn act(&mut self, event: &Event) {
        Simulation::apply(&mut self.machine, event).expect("pilot and PC can always act");
    }

    pub fn pilot(&mut self, input: RemoteInput) {
        self.act(&Event::Remote(input));
    }

    pub fn centre(&mut self, rest: &Event) {
        self.centred_at = Some(self.now);
        self.act(rest);
    }

    pub fn begin(&mut self, fault: &str) {
        self.fault_since = Some(self.now);
        self.flags_before = self.flags_now;
        self.switch(fault, true);
    }

    pub fn end(&mut self, fault: &str) {
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
    fn try_to_arm_twice(&mut self, fault: &str, over: Ps, end: Ps) {
        self.until(over - 500 * MS);
        self.pilot(enable(true));
        self.until(over - 200 * MS);
        self.observed.armed_during_fault = self.armed();
        self.pilot(enable(false));
        self.until(over);
        self.end(fault);
        self.until(end - 400 * MS);
        self.pilot(enable(true));
        self.until(end);
        self.observed.armed_after_fault = self.armed();
    }

    pub fn armed(&self) -> bool {
        self.last_armed == Some(self.now)
    }

    pub fn until(&mut self, end: Ps) {
        while self.now < end {
            let next = ((self.now / SAMPLE + 1) * SAMPLE).min(end);
            self.machine.run_until(next).expect("the run goes on");
            self.now = next;
            self.hear();
            self.ask();
            self.look();
        }
    }

    pub fn now(&self) -> Ps {
        self.now
    }

    /// Height of the middle of the hips.
    pub fn height_m(&self) -> f64 {
        let [_, _, height, _] = self.places.pose;
        self.world[height]
    }

    /// What a motor was told last no longer counts.
    pub fn goes_deaf(&mut self, motor: usize) {
        self.says(motor, self.now, 0.0);
    }

    /// Everything works again.
    pub fn note_back(&mut self) {
        let since = self.fault_since.expect("the fault began");
        self.observed.back = self.now - since;
    }

    /// After the fault, the enable switch went off and on.
    pub fn note_arming(&mut self) {
        self.observed.armed_after_fault = self.armed();
    }

    fn look(&mut self) {
        let Some(since) = self.fault_since else {
            return;
        };
        let [pitch_rad, roll_rad, height_m, speed_mps] =
            self.places.pose.map(|place| self.world[place]);
        self.observed.poses.push(Pose {
            at: self.now - since,
            tilt_rad: pitch_rad.abs().max(roll_rad.abs()),
            height_m,
            speed_mps,
        });
    }

    /// Takes the events on the wires.
    fn hear(&mut self) {
        let mut events = std::mem::take(&mut self.events);
        self.machine.drain_wire_events(&mut events);
        for event in events.drain(..) {
            if let Some(motor) = self.places.motor(event.signal) {
                self.says(motor, event.at, settled(event.value));
            }
        }
        self.events = events;
        // A joint that loses its supply reports nothing.
        self.machine.sample_world(&mut self.world);
        for joint in 0..4 {
            let value = settled(self.world[self.places.joints[joint]]);
            if value != self.wire(2 + joint).last() {
                self.says(2 + joint, self.now, value);
            }
        }
    }

    /// Compares a torque with the PC's law at the present speeds.
    fn check_law(&mut self, motor: usize, value: f64) {
        let Some(asked_rps) = self.asked_rps.filter(|_| self.is_faulty()) else {
            return;
        };
        let obeys = match motor.checked_sub(2) {
            None => {
                let speed_rps = self.world[self.places.wheel_rps[motor]];
                pc_law::wheel_obeys(value, asked_rps, speed_rps)
            }
            Some(joint) => {
                let pos_rad = self.world[self.places.joint_pos_rad[joint]];
                let vel_rps = self.world[self.places.joint_vel_rps[joint]];
                pc_law::joint_obeys(value, pos_rad, vel_rps)
            }
        };
        if !obeys {
            let wrong = format!("motor {motor} is told {value}, which the PC never asked for");
            self.observed.wrong_torques.push(wrong);
        }
    }

    fn is_faulty(&self) -> bool {
        self.fault_since.is_some() && self.fault_until.is_none()
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
        self.check_law(motor, value);
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
            let faulty = self.is_faulty();
            // What rises after a reset are the flags of a boot.
            if faulty && self.machine.resets() == 0 {
                self.flags_during |= self.flags_now;
            }
        }
    }

    pub fn conclude(self) -> Observed {
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

/// The value of a wire. An MIT frame has no code for zero torque; the nearest is less than this.
fn settled(value: f64) -> f64 {
    if value.abs() < 0.01 { 0.0 } else { value }
}

impl Places {
    /// 0 and 1 = wheels, 2 to 5 = joints.
    fn motor(&self, signal: usize) -> Option<usize> {
        let all = self.currents.iter().chain(&self.joints);
        all.into_iter().position(|place| *place == signal)
    }
}
