//! The robot of an episode. It is the whole app without a chip, here, or the shipped image in the emulated board, in `board`.

use robot_app::{
    domain::{PcCommand, PcKind},
    link::{Downlink, DriveFrame, Uplink},
};
use robot_host_loop::Robot;
use robot_plant::{
    free::{FreeState, Hold},
    world::{Push, RemoteInput},
};

use crate::{GymError, Truth, truth::Probes};

/// A robot on its PC link, with a pilot.
pub(crate) trait SimulatedRobot: Send + Sync {
    /// Sends a frame to the robot.
    fn send(&mut self, frame: &Frame);

    /// Moves sticks and switches.
    fn remote(&mut self, input: RemoteInput);

    fn push(&mut self, push: Push);

    /// Runs for so many ms.
    ///
    /// # Errors
    /// The emulated board stopped.
    fn run_ticks(&mut self, ticks: u64) -> Result<(), GymError>;

    /// Time since power-on.
    fn seconds(&self) -> f64;

    /// The last state frame.
    fn uplink(&self) -> Uplink;

    fn truth(&self) -> Truth;

    /// What keeps it from being armed.
    fn obstacle(&self) -> String;

    /// Checks that the motors may move.
    ///
    /// # Errors
    /// They may not; the error says why.
    fn check_armed(&self, seed: u64) -> Result<(), GymError> {
        if self.truth().armed {
            return Ok(());
        }
        let why = self.obstacle();
        Err(GymError::NotArmed { seed, why })
    }
}

/// The whole app without a chip. A clone goes on from the same moment on its own.
#[derive(Clone)]
pub(crate) struct AppRobot {
    robot: Robot,
    probes: Probes,
}

impl AppRobot {
    pub fn new(robot: Robot) -> Self {
        Self {
            probes: Probes::new(robot.world()),
            robot,
        }
    }

    /// Puts the body somewhere, and holds it there or lets it go.
    pub fn place(&mut self, state: &FreeState, hold: Hold) {
        self.robot.world_mut().place(state, hold);
    }
}

impl SimulatedRobot for AppRobot {
    fn send(&mut self, frame: &Frame) {
        self.robot.pc = Some(frame.command());
    }

    fn remote(&mut self, input: RemoteInput) {
        self.robot.remote(input);
    }

    fn push(&mut self, push: Push) {
        self.robot.world_mut().push(push);
    }

    fn run_ticks(&mut self, ticks: u64) -> Result<(), GymError> {
        self.robot.run_ticks(ticks);
        Ok(())
    }

    fn seconds(&self) -> f64 {
        self.robot.seconds()
    }

    fn uplink(&self) -> Uplink {
        self.robot.uplink()
    }

    fn truth(&self) -> Truth {
        Truth {
            armed: self.robot.armed(),
            ..self.probes.read(self.robot.world())
        }
    }

    fn obstacle(&self) -> String {
        let report = self.robot.diagnostics();
        format!("{:?}, {:?}", report.arming, report.safety.flags)
    }
}

/// A frame of the PC.
#[derive(Clone, Copy)]
pub(crate) enum Frame {
    Motors(Downlink),
    Drive(DriveFrame),
}

impl Frame {
    /// As the robot reads it.
    fn command(&self) -> PcCommand {
        match self {
            Self::Motors(frame) => {
                let frame = Downlink::decode(&frame.encode()).expect("its own frame");
                PcCommand {
                    kind: PcKind::Motors,
                    wheels: frame.wheels,
                    joints: frame.joints,
                    ..PcCommand::default()
                }
            }
            Self::Drive(frame) => PcCommand {
                kind: PcKind::Drive,
                drive: DriveFrame::decode(&frame.encode())
                    .expect("its own frame")
                    .0,
                ..PcCommand::default()
            },
        }
    }

    /// As it goes over the cable.
    #[cfg(feature = "board")]
    pub fn bytes(&self) -> Vec<u8> {
        match self {
            Self::Motors(frame) => frame.encode().to_vec(),
            Self::Drive(frame) => frame.encode().to_vec(),
        }
    }
}
