//! The shipped image in the emulated board.
//!
//! Each board has a thread of its own, as the emulator's engine cannot change threads, and works while its environment waits
//! for it. Frames go over the emulated cable in both directions.

use std::{
    path::{Path, PathBuf},
    sync::{
        Mutex, PoisonError,
        mpsc::{self, Receiver, Sender},
    },
    thread,
};

use robot_app::{
    link::{Heard, PcReceiver, Uplink},
    tuning::{PARAMETERS, Scope},
};
use robot_host_loop::layout_of;
use robot_plant::{
    time::{MS, Ps, to_seconds},
    world::{Push, RemoteInput, World},
};
use robot_sim::{
    image_robot,
    machine::Machine,
    parameter_sectors::{self, Record},
};

use crate::{
    GymError, Truth,
    power_on::PowerOn,
    simulated_robot::{Frame, SimulatedRobot},
    truth::Probes,
};

const ARMING: &str = "diag.arming.state";
const ARMED: f64 = 1.0;
/// The firmware logs what keeps it from being armed in a line that begins so.
const BLOCKED: &str = "arming blocked by";

/// An emulated board and the world around it.
pub(crate) struct Board {
    requests: Sender<Request>,
    /// Nothing locks it: Python wants all of a class to be `Sync`.
    answers: Mutex<Receiver<Result<State, GymError>>>,
    state: State,
}

enum Request {
    Send(Vec<u8>),
    Remote(RemoteInput),
    Push(Push),
    Run { ticks: u64 },
}

/// What is known of the robot after a request to run.
#[derive(Clone, Default)]
struct State {
    seconds: f64,
    uplink: Uplink,
    truth: Truth,
    /// What last kept it from being armed.
    said: String,
}

impl Board {
    /// Checks that the image is for the robot of the world, and powers the board on.
    ///
    /// # Errors
    /// The image cannot be read, or is for another robot.
    pub fn power_on(elf: &Path, setup: PowerOn) -> Result<Self, GymError> {
        image_robot::of_image(elf, Some(&setup.world.robot.name)).map_err(failed)?;
        let (requests, asked) = mpsc::channel();
        let (answer, answers) = mpsc::channel();
        let elf = elf.to_owned();
        thread::spawn(move || serve(elf, setup, &asked, &answer));
        let mut board = Self {
            requests,
            answers: Mutex::new(answers),
            state: State::default(),
        };
        board.run_ticks(0)?;
        Ok(board)
    }

    /// The thread ends only after an error, which the next request to run returns.
    fn ask(&self, request: Request) {
        let _ = self.requests.send(request);
    }
}

impl SimulatedRobot for Board {
    fn send(&mut self, frame: &Frame) {
        self.ask(Request::Send(frame.bytes()));
    }

    fn remote(&mut self, input: RemoteInput) {
        self.ask(Request::Remote(input));
    }

    fn push(&mut self, push: Push) {
        self.ask(Request::Push(push));
    }

    fn run_ticks(&mut self, ticks: u64) -> Result<(), GymError> {
        self.ask(Request::Run { ticks });
        let answers = self
            .answers
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner);
        let ended = |_| failed("its thread has ended");
        self.state = answers.recv().map_err(ended)??;
        Ok(())
    }

    fn seconds(&self) -> f64 {
        self.state.seconds
    }

    fn uplink(&self) -> Uplink {
        self.state.uplink
    }

    fn truth(&self) -> Truth {
        self.state.truth
    }

    fn obstacle(&self) -> String {
        self.state.said.clone()
    }
}

/// The part of a board that stays in its thread.
struct PoweredBoard {
    machine: Machine,
    now: Ps,
    probes: Probes,
    diag: Vec<f64>,
    arming: usize,
    receiver: PcReceiver,
    state: State,
}

/// Serves requests until the environment is dropped or the board stops.
fn serve(
    elf: PathBuf,
    setup: PowerOn,
    requests: &Receiver<Request>,
    answers: &Sender<Result<State, GymError>>,
) {
    let mut board = match PoweredBoard::new(&elf, setup) {
        Ok(board) => board,
        Err(error) => {
            // Nobody waits for the answer of a board that was dropped; so below.
            let _ = answers.send(Err(error));
            return;
        }
    };
    for request in requests {
        match request {
            Request::Send(frame) => board.send(&frame),
            Request::Remote(input) => board.machine.with_world(|world| world.set_remote(input)),
            Request::Push(push) => board.machine.with_world(|world| world.push(push)),
            Request::Run { ticks } => {
                let ran = board.run(ticks).map(|()| board.state.clone());
                let goes_on = ran.is_ok();
                if answers.send(ran).is_err() || !goes_on {
                    return;
                }
            }
        }
    }
}

impl PoweredBoard {
    fn new(elf: &Path, setup: PowerOn) -> Result<Self, GymError> {
        let flash = parameter_sectors::holding(&records(&setup));
        let world = World::new(setup.world).map_err(failed)?;
        let probes = Probes::new(&world);
        let mut machine = Machine::new(elf, world).map_err(failed)?;
        machine.set_parameter_flash(&flash);
        machine.with_world(|world| world.serial_adapter().set_plugged(true));
        let arming = machine.diag_names().iter().position(|name| name == ARMING);
        let arming = arming.ok_or_else(|| failed(format!("the image has no {ARMING}")))?;
        Ok(Self {
            machine,
            now: 0,
            probes,
            diag: Vec::new(),
            arming,
            receiver: PcReceiver::new(),
            state: State::default(),
        })
    }

    fn send(&mut self, frame: &[u8]) {
        let now = self.now;
        self.machine.with_world(|world| {
            // It holds more than the frames of a cycle.
            world.serial_adapter().send(frame, now);
        });
    }

    fn run(&mut self, ticks: u64) -> Result<(), GymError> {
        self.now += ticks * MS;
        self.machine.run_until(self.now).map_err(failed)?;
        if let Some(error) = self.machine.board_errors().first() {
            return Err(failed(&error.message));
        }
        let state = &mut self.state;
        let mut said = self.machine.take_log().into_iter();
        if let Some(line) = said.rfind(|line| line.text.starts_with(BLOCKED)) {
            state.said = line.text;
        }
        let armed =
            self.machine.sample_diag(&mut self.diag) && self.diag.get(self.arming) == Some(&ARMED);
        let (probes, receiver) = (&self.probes, &mut self.receiver);
        self.machine.with_world(|world| {
            let adapter = world.serial_adapter();
            let bytes: Vec<u8> = std::iter::from_fn(|| Some(adapter.take()?.1)).collect();
            receiver.feed(&bytes, |heard| {
                if let Heard::Uplink(uplink) = heard {
                    state.uplink = uplink;
                }
            });
            state.truth = Truth {
                armed,
                ..probes.read(world)
            };
        });
        state.seconds = to_seconds(self.now);
        Ok(())
    }
}

/// The settings that are not the defaults, as they stand in flash.
fn records(setup: &PowerOn) -> Vec<Record> {
    let layout =
        layout_of(&setup.world.robot).expect("this program was built with the robot's file");
    let defaults = layout.default_config();
    let changed = PARAMETERS
        .iter()
        .filter(|group| group.scope == Scope::Robot && !group.is_same(&setup.settings, &defaults));
    changed
        .map(|group| Record {
            group: group.number,
            version: group.version,
            variant: 0,
            values: group
                .parameters
                .iter()
                .map(|it| it.read(&setup.settings))
                .collect(),
        })
        .collect()
}

fn failed(error: impl std::fmt::Display) -> GymError {
    GymError::Board(error.to_string())
}
