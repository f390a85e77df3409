//! Robots that have booted, armed, and wait for their first command.

use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use robot_description::{Robot as Description, Wheels};
use robot_host_loop::{Robot, Robots};
use robot_plant::{
    attitude::Quaternion,
    free::{FreeBody, FreeSetup, FreeState, Hold, Start},
    robots,
    world::{PlantKind, RemoteInput, WorldConfig},
};
use robot_policy::{
    Drive, PolicyDescription,
    action::Target,
    machine::{Machine, Phase, Timing},
};

use crate::{
    GymError,
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
#[derive(Clone)]
pub(crate) struct Specimen {
    sitting: Robot,
    /// Held above its wheels.
    standing: Robot,
    held: FreeState,
    description: Arc<Description>,
    pub mass_kg: f64,
}

impl Specimen {
    /// Boots robot `seed` twice, sitting and standing. The one that sits has gone to the default pose, as the runner makes it
    /// do before the policy drives.
    pub fn boot(policy: &PolicyDescription, seed: u64, vary: bool) -> Result<Self, GymError> {
        let robots = Robots {
            robot: robots::with_joints(robot_description::JointMotor::Dm4310),
            vary,
        };
        let mut numbers = Pcg64Mcg::seed_from_u64(seed ^ 0x5eed_0b07);
        let latency_ms = numbers.random_range(LATENCY_MS[0]..=LATENCY_MS[1]);
        let mut between = |most: f64| numbers.random_range(-most..most);
        let tilt_rad = TILT_RAD.map(&mut between);
        let power_on = |start| power_on(&robots, policy, seed, start);
        let mut sitting = power_on(Start::Sitting);
        arm(&mut sitting, seed, latency_ms, None)?;
        take_default_pose(&mut sitting, policy)?;
        check_armed(&sitting, seed)?;
        let mut standing = power_on(Start::Standing);
        let held = tilted(&upright(&robots, seed), &robots.robot.wheels, tilt_rad);
        arm(&mut standing, seed, latency_ms, Some(&lifted(&held)))?;
        Ok(Self {
            sitting,
            standing,
            held,
            mass_kg: robots.mass_kg(seed),
            description: robots.robot,
        })
    }

    /// The robot's file.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The robot that sits in the default pose.
    pub fn sitting(&self) -> Robot {
        self.sitting.clone()
    }

    /// Angles of the hips of the robot that stands, in the link's order and sense.
    pub fn standing_rad(&self) -> [f64; 4] {
        self.held.joint_rad
    }

    /// The robot, let go upright with these velocities forward and up to the left in m/s, and this pitch rate in rad/s.
    pub fn standing(&self, velocity_mps: [f64; 2], pitch_rps: f64) -> Robot {
        let mut robot = self.standing.clone();
        let [forward_mps, left_mps] = velocity_mps;
        let state = FreeState {
            velocity_mps: [forward_mps, left_mps, 0.0],
            rate_rps: [0.0, pitch_rps, 0.0],
            wheel_rps: [forward_mps / self.description.wheels.radius_m; 2],
            ..self.held
        };
        robot.world_mut().place(&state, Hold::Free);
        robot
    }
}

/// Boots a robot whose wheels may have the current that the policy wants, as far as the robot's file allows it.
fn power_on(robots: &Robots, policy: &PolicyDescription, seed: u64, start: Start) -> Robot {
    let world = WorldConfig {
        plant: PlantKind::Free,
        robot: Arc::clone(&robots.robot),
        seed,
        start,
        variation: robots.variation(seed),
        ..WorldConfig::default()
    };
    let mut settings = robots.settings();
    let wheels = &robots.robot.wheels;
    let wanted_nm = policy.joints.iter().filter(|it| it.drive == Drive::Speed);
    let wanted_nm = wanted_nm.fold(0.0, |most, it| it.torque_limit_nm.max(most));
    let wanted_a = f64::from(wanted_nm) / wheels.torque_nm_per_a;
    let limit_a = wanted_a
        .max(wheels.current_limit_a)
        .min(wheels.max_current_a);
    settings.wheel_ctrl.current_limit_ma = (limit_a * 1e3) as f32;
    Robot::in_world(world, settings).expect("no recording is loaded")
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

/// Runs the robot until it is armed in mode PC. With a state, its body is held there.
fn arm(
    robot: &mut Robot,
    seed: u64,
    latency_ms: u64,
    held: Option<&FreeState>,
) -> Result<(), GymError> {
    robot.pc = Some(wire::at_rest());
    robot.remote(RemoteInput {
        mode: Some(MODE_PC),
        ..RemoteInput::default()
    });
    let run_until = |robot: &mut Robot, seconds: f64| {
        let Some(state) = held else {
            robot.run_until(seconds, |_| ());
            return;
        };
        while robot.seconds() < seconds {
            robot.world_mut().place(state, Hold::Clamped);
            let next = robot.seconds() + 1e-4;
            robot.run_until(next, |_| ());
        }
    };
    run_until(robot, ENABLE_AT_S);
    robot.remote(RemoteInput {
        enable: Some(true),
        ..RemoteInput::default()
    });
    let ready_ms = (READY_AT_S * 1e3) as u64 + COMMANDS_EVERY_MS - latency_ms;
    run_until(robot, ready_ms as f64 * 1e-3 - 1e-6);
    check_armed(robot, seed)
}

/// Goes from the pose in which the robot sits to the default pose, as the runner does.
fn take_default_pose(robot: &mut Robot, policy: &PolicyDescription) -> Result<(), GymError> {
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
                robot.pc = Some(wire.command(&targets));
            }
            Phase::Passive | Phase::GetDown => {}
        }
        robot.run_ticks((cycle_s * 1e3).round() as u64);
    }
    Ok(())
}

fn check_armed(robot: &Robot, seed: u64) -> Result<(), GymError> {
    if robot.armed() {
        return Ok(());
    }
    let report = robot.diagnostics();
    let why = format!("{:?}, {:?}", report.arming, report.safety.flags);
    Err(GymError::NotArmed { seed, why })
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
