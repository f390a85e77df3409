//! Robots that have booted, armed, and wait for their first command.

#[cfg(feature = "board")]
use std::path::Path;
use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use robot_description::{Robot as Description, Wheels};
use robot_host_loop::{Robot, Robots};
use robot_plant::{
    attitude::Quaternion,
    free::{FreeBody, FreeSetup, FreeState, Hold, Start},
    world::RemoteInput,
};
use robot_policy::{
    PolicyDescription,
    action::Target,
    machine::{Machine, Phase, Timing},
};

#[cfg(feature = "board")]
use crate::board::Board;
use crate::{
    GymError,
    power_on::{self, PowerOn},
    simulated_robot::{AppRobot, SimulatedRobot},
    wire::{self, Wire},
};

/// The pilot arms when sensors are calibrated and motors set up.
const ENABLE_AT_S: f64 = 3.0;
/// All joint motors are enabled by now.
const READY_AT_S: f64 = 3.2;
/// Place of the mode switch at PC.
const MODE_PC: u8 = 1;
/// Greatest roll and pitch of a robot that begins standing, rad.
const TILT_RAD: [f64; 2] = [0.05, 0.2];
const LIFTED_M: f64 = 0.05;
/// Times in ms from the reading to the arrival of the command made of it: frames on the cable, and the network.
const LATENCY_MS: [u64; 2] = [3, 8];
/// The robot takes commands at multiples of this time.
const COMMANDS_EVERY_MS: u64 = 10;

/// A robot of one seed, as it is when an episode begins.
pub(crate) struct Specimen {
    starts: Starts,
    description: Arc<Description>,
    pub mass_kg: f64,
}

/// The robot of an episode.
pub(crate) struct Beginning {
    pub robot: Box<dyn SimulatedRobot>,
    /// Angles of the hips of a robot that stands, in the link's order and sense.
    pub hips_rad: Option<[f64; 4]>,
}

/// Where episodes begin.
enum Starts {
    App {
        sitting: Box<AppRobot>,
        /// Held above its wheels.
        standing: Box<AppRobot>,
        held: FreeState,
    },
    #[cfg(feature = "board")]
    Board {
        /// Until an episode takes it: then the next one boots again.
        booted: Option<Board>,
        boot: Box<dyn Fn() -> Result<Board, GymError> + Send + Sync>,
    },
}

impl Specimen {
    /// Boots robot `seed` twice, sitting and standing. The one that sits has gone to the default pose, as the runner makes it
    /// do before the policy drives.
    pub fn boot(policy: &PolicyDescription, seed: u64, vary: bool) -> Result<Self, GymError> {
        let robots = power_on::robots(vary);
        let (latency_ms, tilt_rad) = beginning(seed);
        let boot = |start| {
            let PowerOn { world, settings } = PowerOn::of(&robots, policy, seed, start);
            let robot = Robot::in_world(world, settings).expect("no recording is loaded");
            AppRobot::new(robot)
        };
        let mut sitting = boot(Start::Sitting);
        arm(&mut sitting, seed, latency_ms, |_| ())?;
        take_default_pose(&mut sitting, policy)?;
        sitting.check_armed(seed)?;
        let mut standing = boot(Start::Standing);
        let held = tilted(&upright(&robots, seed), &robots.robot.wheels, tilt_rad);
        let hold = lifted(&held);
        arm(&mut standing, seed, latency_ms, |robot| {
            robot.place(&hold, Hold::Clamped);
        })?;
        Ok(Self {
            starts: Starts::App {
                sitting: Box::new(sitting),
                standing: Box::new(standing),
                held,
            },
            mass_kg: robots.mass_kg(seed),
            description: robots.robot,
        })
    }

    /// The same on the emulated board, where all episodes begin sitting.
    #[cfg(feature = "board")]
    pub fn boot_board(
        policy: &PolicyDescription,
        seed: u64,
        vary: bool,
        elf: &Path,
    ) -> Result<Self, GymError> {
        let robots = power_on::robots(vary);
        let (latency_ms, _) = beginning(seed);
        let setup = PowerOn::of(&robots, policy, seed, Start::Sitting);
        let (policy, elf) = (policy.clone(), elf.to_owned());
        let boot = move || {
            let mut board = Board::power_on(&elf, setup.clone())?;
            arm(&mut board, seed, latency_ms, |_| ())?;
            take_default_pose(&mut board, &policy)?;
            board.check_armed(seed)?;
            Ok(board)
        };
        Ok(Self {
            starts: Starts::Board {
                booted: Some(boot()?),
                boot: Box::new(boot),
            },
            mass_kg: robots.mass_kg(seed),
            description: robots.robot,
        })
    }

    /// The robot's file.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The robot that sits in the default pose.
    ///
    /// # Errors
    /// The emulated board does not boot again.
    pub fn sitting(&mut self) -> Result<Beginning, GymError> {
        let robot: Box<dyn SimulatedRobot> = match &mut self.starts {
            Starts::App { sitting, .. } => sitting.clone(),
            #[cfg(feature = "board")]
            Starts::Board { booted, boot } => Box::new(booted.take().map_or_else(boot, Ok)?),
        };
        Ok(Beginning {
            robot,
            hips_rad: None,
        })
    }

    /// The robot, let go upright with these velocities forward and to the left in m/s, and this pitch rate in rad/s. On
    /// the emulated board it sits.
    ///
    /// # Errors
    /// As [`sitting`](Self::sitting).
    pub fn standing(
        &mut self,
        velocity_mps: [f64; 2],
        pitch_rps: f64,
    ) -> Result<Beginning, GymError> {
        match &self.starts {
            Starts::App { standing, held, .. } => {
                let mut robot = standing.clone();
                let [forward_mps, left_mps] = velocity_mps;
                let state = FreeState {
                    velocity_mps: [forward_mps, left_mps, 0.0],
                    rate_rps: [0.0, pitch_rps, 0.0],
                    wheel_rps: [forward_mps / self.description.wheels.radius_m; 2],
                    ..*held
                };
                robot.place(&state, Hold::Free);
                Ok(Beginning {
                    robot,
                    hips_rad: Some(held.joint_rad),
                })
            }
            #[cfg(feature = "board")]
            Starts::Board { .. } => self.sitting(),
        }
    }
}

/// Time in ms from a reading to the command made of it, and the tilt in rad of a robot that begins standing.
fn beginning(seed: u64) -> (u64, [f64; 2]) {
    let mut numbers = Pcg64Mcg::seed_from_u64(seed ^ 0x5eed_0b07);
    let latency_ms = numbers.random_range(LATENCY_MS[0]..=LATENCY_MS[1]);
    let mut between = |most: f64| numbers.random_range(-most..most);
    (latency_ms, TILT_RAD.map(&mut between))
}

/// The robot on its wheels, legs at the middle of their range.
fn upright(robots: &Robots, seed: u64) -> FreeState {
    let setup = FreeSetup {
        variation: robots.variation(seed).body,
        start: Start::Standing,
        ..FreeSetup::default()
    };
    FreeBody::new(&robots.robot, &setup).state()
}

/// Runs the robot until it is armed in mode PC, with `hold` before each tick.
fn arm<R: SimulatedRobot>(
    robot: &mut R,
    seed: u64,
    latency_ms: u64,
    mut hold: impl FnMut(&mut R),
) -> Result<(), GymError> {
    robot.remote(RemoteInput {
        mode: Some(MODE_PC),
        ..RemoteInput::default()
    });
    run_at_rest(robot, ENABLE_AT_S, &mut hold)?;
    robot.remote(RemoteInput {
        enable: Some(true),
        ..RemoteInput::default()
    });
    let ready_ms = (READY_AT_S * 1e3) as u64 + COMMANDS_EVERY_MS - latency_ms;
    run_at_rest(robot, ready_ms as f64 * 1e-3 - 1e-6, hold)?;
    robot.check_armed(seed)
}

/// Runs until this time after power-on, with a PC that asks for no motion.
fn run_at_rest<R: SimulatedRobot>(
    robot: &mut R,
    until_s: f64,
    mut hold: impl FnMut(&mut R),
) -> Result<(), GymError> {
    for tick in 0_u64.. {
        if robot.seconds() >= until_s {
            break;
        }
        if tick.is_multiple_of(COMMANDS_EVERY_MS) {
            robot.send(&wire::at_rest());
        }
        hold(robot);
        robot.run_ticks(1)?;
    }
    Ok(())
}

/// Goes from the pose in which the robot sits to the default pose, as the runner does.
fn take_default_pose(
    robot: &mut impl SimulatedRobot,
    policy: &PolicyDescription,
) -> Result<(), GymError> {
    let mut wire = Wire::new(policy)?;
    let mut machine = Machine::new(policy, Timing::default());
    let mut targets: Vec<Target> = Vec::with_capacity(policy.joints.len());
    let cycle_s = f64::from(policy.control_period_s);
    for cycle in 0_u32.. {
        wire.read(&robot.uplink())?;
        let now_s = f64::from(cycle) * cycle_s;
        match machine.step(now_s, true, wire.reading()) {
            Phase::Policy => break,
            Phase::GetUp => {
                machine.pose(now_s, &mut targets);
                wire.aim(&targets);
                robot.send(&wire.command());
            }
            Phase::Passive | Phase::ToDefault | Phase::GetDown => robot.send(&wire::at_rest()),
        }
        robot.run_ticks((cycle_s * 1e3).round() as u64)?;
    }
    Ok(())
}

/// The same with its wheels above the ground, where nothing moves limp legs within a tick.
fn lifted(held: &FreeState) -> FreeState {
    let [x_m, y_m, height_m] = held.position_m;
    FreeState {
        position_m: [x_m, y_m, height_m + LIFTED_M],
        ..*held
    }
}

/// The upright robot turned about its axles, so that the lower wheel still touches the ground.
fn tilted(upright: &FreeState, wheels: &Wheels, [roll, pitch]: [f64; 2]) -> FreeState {
    let [x_m, y_m, height_m] = upright.position_m;
    let radius_m = wheels.radius_m;
    let above_m = height_m - radius_m;
    // Roll and pitch are small: they are turned one after the other.
    let [sr, cr] = [(roll / 2.0).sin(), (roll / 2.0).cos()];
    let [sp, cp] = [(pitch / 2.0).sin(), (pitch / 2.0).cos()];
    FreeState {
        position_m: [
            x_m + above_m * pitch.sin(),
            y_m - above_m * roll.sin(),
            radius_m + above_m * pitch.cos() * roll.cos() + wheels.track_m / 2.0 * roll.sin().abs(),
        ],
        attitude: Quaternion::from([cp * cr, cp * sr, sp * cr, -sp * sr]),
        ..*upright
    }
}
