//! Who drives, and how: the pilot's sticks, or a PC on the serial link.

use robot_plant::world::{PcDrive, PcInput, PcJoints, RemoteInput};
use robot_sim::scenario::Event;

use crate::observed::Phase;

/// Who drives while the fault comes and goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// Mode manual, and nothing is plugged into the link.
    Pilot,
    /// Mode manual, while a PC asks for full speed all the time.
    PilotBesidePc,
    /// Mode PC.
    Pc,
}

/// Speed that the PC asks of both wheels, and the angle that it asks of every joint, to which friction does not hold a leg
/// that is let go.
pub const PC_WHEEL_RPS: f64 = 8.0;
pub const PC_JOINT_RAD: f64 = 0.5;
pub const PC_WHEEL_KD: f64 = 1.0;
pub const PC_JOINT_KP: f64 = 20.0;
pub const PC_JOINT_KD: f64 = 1.0;

impl Driver {
    /// Before arming. A PC that drives starts from rest.
    pub fn prepare(self, phase: Phase) -> Vec<Event> {
        match self {
            Self::Pilot => Vec::new(),
            Self::PilotBesidePc => vec![Event::Pc(PcInput {
                on: Some(true),
                wheels_rps: Some([200.0; 2]),
                joints: Some(PcJoints::At([1.0; 4])),
                ..PcInput::default()
            })],
            Self::Pc => {
                let mode = Event::Remote(RemoteInput {
                    mode: Some(1),
                    ..RemoteInput::default()
                });
                if phase == Phase::Balancing {
                    return vec![mode, drive(0.0)];
                }
                let gains = PcInput {
                    wheel_kd: Some(PC_WHEEL_KD),
                    joint_kp: Some(PC_JOINT_KP),
                    joint_kd: Some(PC_JOINT_KD),
                    ..PcInput::rest()
                };
                vec![mode, Event::Pc(gains)]
            }
        }
    }

    /// Armed, the wheels stand still. A PC lifts the legs a little.
    pub fn idle(self) -> Option<Event> {
        (self == Self::Pc).then_some(Event::Pc(pc([0.0; 2])))
    }

    /// The wheels turn, the legs are held. A robot that balances drives at 0.4 of its speed.
    pub fn push(self, phase: Phase) -> Event {
        match self {
            Self::Pilot | Self::PilotBesidePc => stick(0.4),
            Self::Pc if phase == Phase::Balancing => drive(0.4),
            Self::Pc => Event::Pc(pc([PC_WHEEL_RPS; 2])),
        }
    }

    /// Nothing is asked to move.
    pub fn rest(self, phase: Phase) -> Event {
        match self {
            Self::Pilot | Self::PilotBesidePc => stick(0.0),
            Self::Pc if phase == Phase::Balancing => drive(0.0),
            Self::Pc => Event::Pc(PcInput::rest()),
        }
    }
}

fn pc(wheels_rps: [f64; 2]) -> PcInput {
    PcInput {
        wheels_rps: Some(wheels_rps),
        joints: Some(PcJoints::At([PC_JOINT_RAD; 4])),
        ..PcInput::default()
    }
}

/// A PC steers a robot that stands in place of the sticks.
fn drive(vx: f64) -> Event {
    Event::Pc(PcInput {
        on: Some(true),
        drive: Some(PcDrive {
            vx,
            ..PcDrive::default()
        }),
        ..PcInput::default()
    })
}

fn stick(vx: f64) -> Event {
    Event::Remote(RemoteInput {
        vx: Some(vx),
        ..RemoteInput::default()
    })
}
