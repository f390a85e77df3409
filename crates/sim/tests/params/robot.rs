//! A board that runs the shipped image, with a PC's adapter on both buses and a pilot.

use std::collections::HashMap;

use robot_app::tuning::{READ_ID, REPLY_ID, WRITE_ID, opcode};
use robot_plant::{
    can_adapter::AdapterMode,
    time::{MS, Ps},
    wire::CanFrame,
    world::{CanBusId, RemoteInput, WireEvent},
};
use robot_sim::{
    faults,
    machine::{Machine, diagnostics::meaning::Meaning},
    scenario::{Event, Scenario},
    simulation::Simulation,
};

use crate::{
    flash_image::{Image, SectorState, states},
    settings::{COUNT, Make, Setting, Settings, calibrated},
    support,
};

const BUSES: [CanBusId; 2] = [CanBusId::Can1, CanBusId::Can2];
/// Time within which the robot answers a request.
const REPLY_WITHIN: Ps = 50 * MS;
/// Time limit for a reply when the robot may stall for half a second.
const TRIES: usize = 14;

/// A request to a board without power is lost.
const ASK_AGAIN: Ps = 25 * MS;

/// `diag.params.state`.
pub mod state {
    pub const WAITING_FOR_REST: f64 = 2.0;
    pub const BACKING_OFF: f64 = 5.0;
}

pub struct Robot {
    pub machine: Machine,
    now: Ps,
    places: HashMap<String, usize>,
    meanings: Vec<Option<Meaning>>,
    diag: Vec<f64>,
    /// When `diag` was read, and whether there was something to read.
    sampled_at: Ps,
    known: bool,
    /// Frames received on CAN1 and CAN2 that no one has waited for yet.
    replies: [Vec<[u8; 8]>; 2],
    pub events: Vec<WireEvent>,
}

/// The image with motors of this make, if the tests were given one.
pub fn has_image_for(make: Make) -> bool {
    make == Make::Dm4310 || std::env::var_os("ROBOT_ELF_DBUS_RS00").is_some()
}

fn to_set((group, index): Setting, value: f32) -> [u8; 8] {
    let [a, b, c, d] = value.to_le_bytes();
    [opcode::WRITE_PARAMETER, group, index, 0, a, b, c, d]
}

impl Robot {
    /// A robot at power-on with these contents of the parameter sectors.
    pub fn with_flash(make: Make, flash: &Image) -> Self {
        let parts = match make {
            Make::Dm4310 => "",
            Make::Rs00 => "radio = \"dbus\"\njoints = \"rs00\"\n",
        };
        let text = format!("name = \"parameters\"\nseconds = 1.0\nplant = \"stand\"\n{parts}");
        let mut job = support::job(Scenario::parse(&text, "params").expect("it parses"));
        if make == Make::Rs00 {
            let elf = std::env::var_os("ROBOT_ELF_DBUS_RS00");
            job.elf = elf.expect("asked for before").into();
        }
        let mut machine = job.machine().expect("the machine starts");
        machine.set_parameter_flash(flash.bytes());
        machine.with_world(|world| {
            for bus in BUSES {
                world.can_adapter(bus).set_mode(AdapterMode::Active);
            }
        });
        let names = machine.diag_names().iter().cloned();
        Self {
            meanings: machine.diag_meanings(),
            places: names.zip(0..).collect(),
            machine,
            now: 0,
            diag: Vec::new(),
            sampled_at: 0,
            known: false,
            replies: Default::default(),
            events: Vec::new(),
        }
    }

    pub fn now(&self) -> Ps {
        self.now
    }

    /// Runs on to the next whole millisecond.
    pub fn step(&mut self) {
        self.now = (self.now / MS + 1) * MS;
        self.machine.run_until(self.now).expect("the run goes on");
        let Self {
            replies, events, ..
        } = self;
        self.machine.with_world(|world| {
            for (bus, replies) in BUSES.into_iter().zip(replies) {
                while let Some((_, frame)) = world.can_adapter(bus).take() {
                    if frame.id == u32::from(REPLY_ID.raw()) {
                        replies.push(frame.data);
                    }
                }
            }
            world.drain_wire_events(events);
        });
    }

    pub fn until(&mut self, at: Ps) {
        while self.now < at {
            self.step();
        }
    }

    pub fn run_for(&mut self, time: Ps) {
        self.until(self.now + time);
    }

    /// How long it took until `seen`; `None` if it took longer than `limit`.
    pub fn wait(&mut self, limit: Ps, mut seen: impl FnMut(&mut Self) -> bool) -> Option<Ps> {
        let from = self.now;
        while !seen(self) {
            if self.now >= from + limit {
                return None;
            }
            self.step();
        }
        Some(self.now - from)
    }

    /// A value of the firmware's diagnostics; `None` before they can be read.
    pub fn diag(&mut self, name: &str) -> Option<f64> {
        let place = self.places[&format!("diag.{name}")];
        if self.sampled_at != self.now {
            self.sampled_at = self.now;
            self.known = self.machine.sample_diag(&mut self.diag);
        }
        self.known.then(|| self.diag[place])
    }

    /// Names of the flags that are set in a diagnostic.
    pub fn names_in(&mut self, name: &str) -> Vec<String> {
        let Some(bits) = self.diag(name) else {
            return Vec::new();
        };
        let place = self.places[&format!("diag.{name}")];
        let meaning = self.meanings[place].as_ref().expect("the image names them");
        let set = (0..32).filter(|bit| bits as u32 >> bit & 1 == 1);
        set.map(|bit| meaning.bit(bit).unwrap_or("unnamed").to_owned())
            .collect()
    }

    /// A value of the world.
    pub fn world(&mut self, name: &str) -> f64 {
        self.machine
            .with_world(|world| world.signal(name).expect(name))
    }

    /// Both wheels turn forward.
    pub fn drives(&mut self) -> bool {
        (0..2).all(|wheel| self.world(&format!("truth.wheel.{wheel}.speed_mps")) > 0.1)
    }

    /// Whether the robot has seen this many changes since it booted, and has saved all.
    pub fn is_saved(&mut self, changes: usize) -> bool {
        let seen = self.diag("params.seen");
        seen.is_some_and(|seen| seen >= changes as f64) && self.diag("params.unsaved") == Some(0.0)
    }

    /// Whether a sector is clean and ready to be used.
    pub fn is_tidy(&mut self) -> bool {
        states(&self.machine.parameter_flash()).contains(&SectorState::Clean)
    }

    /// Board errors of the run.
    pub fn board_errors(&self) -> Vec<String> {
        let errors = Machine::board_errors(&self.machine).into_iter();
        errors.map(|error| error.message).collect()
    }

    pub fn armed(&mut self) -> bool {
        self.diag("arming.state") == Some(1.0)
    }

    pub fn pilot(&mut self, input: RemoteInput) {
        Simulation::apply(&mut self.machine, &Event::Remote(input))
            .expect("a pilot can always act");
    }

    pub fn enable(&mut self, on: bool) {
        self.pilot(RemoteInput {
            enable: Some(on),
            ..RemoteInput::default()
        });
    }

    pub fn stick(&mut self, vx: f64) {
        self.pilot(RemoteInput {
            vx: Some(vx),
            ..RemoteInput::default()
        });
    }

    pub fn fault(&mut self, name: &str, on: bool) {
        faults::set(&mut self.machine, name, on).expect("the fault exists");
    }

    /// Requests a change and does not wait for the reply.
    pub fn ask_to_set(&mut self, setting: Setting, value: f32) {
        self.send(0, WRITE_ID.raw().into(), to_set(setting, value));
    }

    /// Changes a setting. The robot must accept it.
    pub fn set(&mut self, setting: Setting, value: f32) {
        let reply = self.exchange(WRITE_ID.raw().into(), to_set(setting, value));
        assert_eq!(
            reply[..3],
            [opcode::WRITE_PARAMETER, setting.0, setting.1],
            "{reply:?}"
        );
    }

    /// The robot's reply to the request for the store's status: state, error, unsaved groups.
    pub fn store_state(&mut self) -> [u8; 3] {
        let question = [opcode::READ_STORE, 0, 0, 0, 0, 0, 0, 0];
        let [_, state, error, unsaved, ..] = self.exchange(READ_ID.raw().into(), question);
        [state, error, unsaved]
    }

    /// All settings as the robot has them in use, over both buses.
    pub fn settings(&mut self) -> Settings {
        let mut read = Settings::new();
        let mut left: Vec<Setting> = calibrated().into_keys().collect();
        self.replies = Default::default();
        let mut asked = [None; 2];
        let deadline = self.now + 2_000 * MS;
        while read.len() < COUNT {
            assert!(self.now < deadline, "{read:?}");
            for (bus, asked) in asked.iter_mut().enumerate() {
                for reply in std::mem::take(&mut self.replies[bus]) {
                    let [command, group, index, _, a, b, c, d] = reply;
                    assert_ne!(command, opcode::REFUSED, "{reply:?}");
                    read.insert((group, index), u32::from_le_bytes([a, b, c, d]));
                    *asked = None;
                }
                let waits = asked.is_some_and(|(_, at)| self.now < at + ASK_AGAIN);
                let next = asked.map(|(setting, _)| setting).or_else(|| left.pop());
                if let Some((group, index)) = next.filter(|_| !waits) {
                    self.send(
                        bus,
                        READ_ID.raw().into(),
                        [opcode::READ_PARAMETER, group, index, 0, 0, 0, 0, 0],
                    );
                    *asked = Some(((group, index), self.now));
                }
            }
            self.step();
        }
        read
    }

    fn send(&mut self, bus: usize, id: u32, data: [u8; 8]) {
        let frame = CanFrame {
            id,
            extended: false,
            remote: false,
            dlc: 8,
            data,
        };
        let taken = self
            .machine
            .with_world(|world| world.can_adapter(BUSES[bus]).send(frame));
        assert!(taken, "the adapter has room");
    }

    /// The answer on CAN1. The robot drops what arrives during the stall of an erase, so the request is repeated.
    fn exchange(&mut self, id: u32, data: [u8; 8]) -> [u8; 8] {
        self.replies[0].clear();
        for _ in 0..TRIES {
            self.send(0, id, data);
            let came = self.wait(REPLY_WITHIN, |robot| !robot.replies[0].is_empty());
            if came.is_some() {
                return self.replies[0].remove(0);
            }
        }
        panic!("no reply");
    }
}
