//! The PC steers from rest only, and only while it is fresh.

use super::*;
use crate::domain::{JointTarget, PcDrive, PcKind, WheelTarget};

/// Time between two frames of the PC.
const PERIOD_MS: u32 = 10;

/// Angles of the joints of the robot.
const POSE_RAD: [f32; 4] = [0.3, -0.3, 0.2, -0.2];

/// Targets of the wheels and the joints, each with a gain.
fn command(speed_rps: f32, pose_rad: [f32; 4]) -> PcCommand {
    PcCommand {
        wheels: [WheelTarget {
            speed_rps,
            kp: 0.0,
            kd: 0.1,
        }; 2],
        joints: pose_rad.map(|pos_rad| JointTarget {
            pos_rad,
            kp: 20.0,
            kd: 1.0,
        }),
        ..PcCommand::default()
    }
}

fn rest() -> PcCommand {
    command(0.0, POSE_RAD)
}

fn motion() -> PcCommand {
    command(5.0, POSE_RAD)
}

/// What the PC may do after a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pc {
    Steers,
    Lost,
    Awaited,
    /// Mode PC is not chosen.
    Elsewhere,
}

impl Bench {
    /// An armed robot in mode PC with its joints enabled. No command has come yet.
    fn in_pc_mode() -> Self {
        let mut bench = Self::new();
        for (joint, pos_rad) in bench.motor.joints.iter_mut().zip(POSE_RAD) {
            joint.state = JointState::Enabled;
            joint.pos_rad = pos_rad;
        }
        bench.pc_mode = true;
        bench.pc_steering = true;
        bench
    }

    /// The PC sends this now.
    fn send(&mut self, command: PcCommand) {
        let same = PcCommand {
            ts_us: self.pc.ts_us,
            changed_us: self.pc.changed_us,
            ..command
        } == self.pc;
        self.pc = PcCommand {
            ts_us: self.now_us,
            changed_us: if same {
                self.pc.changed_us
            } else {
                self.now_us
            },
            ..command
        };
    }

    /// Lets the PC stream a command for some frames.
    fn stream(&mut self, command: PcCommand, frames: u32) -> Pc {
        let mut seen = Pc::Elsewhere;
        for _ in 0..frames {
            self.send(command);
            seen = self.pc_after(PERIOD_MS);
        }
        seen
    }

    fn pc_after(&mut self, milliseconds: u32) -> Pc {
        let status = self.run(milliseconds);
        let flags = status.flags.intersection(SafetyFlags::PC_STOP);
        assert_eq!(status.pc_stop, flags != SafetyFlags::NONE || !self.pc_mode);
        if flags == SafetyFlags::PC_LOST {
            Pc::Lost
        } else if flags == SafetyFlags::PC_AWAITED {
            Pc::Awaited
        } else if self.pc_mode {
            Pc::Steers
        } else {
            assert_eq!(flags, SafetyFlags::NONE);
            Pc::Elsewhere
        }
    }
}

#[test]
fn a_pc_steers_after_a_command_from_rest() {
    let mut bench = Bench::in_pc_mode();
    assert_eq!(bench.pc_after(1), Pc::Lost, "never heard");
    assert_eq!(bench.stream(motion(), 100), Pc::Awaited);
    assert_eq!(bench.stream(rest(), 1), Pc::Steers);
    assert_eq!(bench.stream(motion(), 100), Pc::Steers);
    assert_eq!(bench.stream(command(200.0, [3.0; 4]), 100), Pc::Steers);
}

/// Neither flag disarms, blocks arming, stops a part by itself or is latched.
#[test]
fn a_lost_or_awaited_pc_is_no_other_stop() {
    let mut bench = Bench::in_pc_mode();
    for command in [PcCommand::default(), motion()] {
        let lost = command == PcCommand::default();
        if !lost {
            bench.send(command);
        }
        let status = bench.run(1);
        assert_eq!(status.flags.intersects(SafetyFlags::PC_LOST), lost);
        assert_eq!(status.verdict, SafetyVerdict::Run);
        assert!(status.latched.is_empty() && !status.stops_wheels(BusId::Can1));
    }
}

#[test]
fn outside_of_mode_pc_no_flag_is_raised() {
    let mut bench = Bench::in_pc_mode();
    bench.pc_mode = false;
    assert_eq!(bench.pc_after(1), Pc::Elsewhere);
    assert_eq!(bench.stream(motion(), 3), Pc::Elsewhere);
    assert_eq!(bench.stream(rest(), 3), Pc::Elsewhere);
}

#[test]
fn a_command_counts_for_100_ms_and_its_successor_must_be_from_rest() {
    let mut bench = Bench::in_pc_mode();
    bench.stream(rest(), 1);
    assert_eq!(bench.stream(motion(), 10), Pc::Steers);
    assert_eq!(bench.pc_after(90), Pc::Steers, "100 ms old");
    bench.send(motion());
    assert_eq!(bench.pc_after(99), Pc::Steers, "a gap of 99 ms");
    bench.pc_after(1);
    assert_eq!(bench.pc_after(1), Pc::Lost, "101 ms old");
    assert_eq!(bench.stream(motion(), 20), Pc::Awaited);
    assert_eq!(bench.stream(rest(), 1), Pc::Steers);
}

#[test]
fn the_age_limit_is_a_setting() {
    let mut bench = Bench::in_pc_mode();
    bench.config.pc_timeout_us = 20_000;
    bench.send(rest());
    assert_eq!(bench.pc_after(20), Pc::Steers);
    assert_eq!(bench.pc_after(1), Pc::Lost);
}

/// No clock of the board gives a time ahead of the tick's.
#[test]
fn a_command_from_the_future_is_none() {
    let mut bench = Bench::in_pc_mode();
    bench.send(rest());
    bench.pc.ts_us += 1;
    assert_eq!(bench.pc_after(0), Pc::Lost);
    assert_eq!(bench.pc_after(1), Pc::Steers);
    bench.pc.ts_us = u64::MAX;
    assert_eq!(bench.pc_after(1_000), Pc::Lost);
}

#[test]
fn a_pc_that_repeats_a_motion_for_5_s_is_lost() {
    let mut bench = Bench::in_pc_mode();
    bench.stream(rest(), 1);
    assert_eq!(bench.stream(motion(), 499), Pc::Steers, "4.99 s");
    assert_eq!(bench.stream(motion(), 1), Pc::Lost);
    let mut other = motion();
    other.wheels[0].kp = 1.0;
    assert_eq!(
        bench.stream(other, 1),
        Pc::Awaited,
        "alive, but not at rest"
    );
    assert_eq!(bench.stream(rest(), 1), Pc::Steers);
}

#[test]
fn a_change_of_any_gain_shows_that_the_pc_is_alive() {
    let mut bench = Bench::in_pc_mode();
    bench.stream(rest(), 1);
    for second in 0..10_u8 {
        let mut alive = motion();
        alive.wheels[1].kp = second.into();
        assert_eq!(bench.stream(alive, 100), Pc::Steers, "{second} s");
    }
}

#[test]
fn a_repeated_command_without_motion_stays_in_force() {
    let mut free = motion();
    for wheel in &mut free.wheels {
        wheel.kd = 0.0;
    }
    for unmoving in [rest(), free, command(0.05, POSE_RAD)] {
        let mut bench = Bench::in_pc_mode();
        assert_eq!(bench.stream(unmoving, 2_000), Pc::Steers);
    }
    let mut bench = Bench::in_pc_mode();
    bench.config.pc_frozen_us = 0;
    bench.stream(rest(), 1);
    assert_eq!(bench.stream(motion(), 2_000), Pc::Steers, "switched off");
}

#[test]
fn rest_is_a_slow_target_near_the_measured_angle_or_no_gain() {
    let accepted = |command: PcCommand| {
        let mut bench = Bench::in_pc_mode();
        bench.stream(command, 1) == Pc::Steers
    };
    let near = |offset: f32| POSE_RAD.map(|angle| angle + offset);
    assert!(accepted(command(0.05, near(0.099))));
    assert!(accepted(command(-0.05, near(-0.099))));
    for (speed_rps, offset_rad) in [
        (0.051, 0.0),
        (-0.051, 0.0),
        (0.0, 0.101),
        (0.0, -0.101),
        (f32::NAN, 0.0),
        (0.0, f32::NAN),
        (f32::INFINITY, 0.0),
    ] {
        let moving = command(speed_rps, near(offset_rad));
        assert!(!accepted(moving), "{speed_rps} {offset_rad}");
        for part in 0..6 {
            let mut one = command(speed_rps, near(offset_rad));
            for (index, wheel) in one.wheels.iter_mut().enumerate() {
                wheel.kd = if part == index { 0.1 } else { 0.0 };
            }
            for (index, joint) in one.joints.iter_mut().enumerate() {
                joint.kp = if part == index + 2 { 20.0 } else { 0.0 };
            }
            let moves = if part < 2 {
                speed_rps.abs() > 0.05 || speed_rps.is_nan()
            } else {
                offset_rad != 0.0
            };
            assert_eq!(accepted(one), !moves, "{part}: {speed_rps} {offset_rad}");
        }
    }
}

#[test]
fn a_joint_without_a_known_angle_is_not_at_rest() {
    let mut bench = Bench::in_pc_mode();
    bench.motor.joints[2].pos_rad = f32::NAN;
    assert_eq!(bench.stream(rest(), 3), Pc::Awaited);
    let mut free = rest();
    free.joints[2].kp = 0.0;
    assert_eq!(bench.stream(free, 1), Pc::Steers);
}

/// The stream of a PC that drives goes on meanwhile.
#[test]
fn whatever_interrupts_a_motion_ends_it() {
    type Change = fn(&mut Bench, bool);
    let interruptions: [(&str, Change); 9] = [
        ("mode", |bench, on| bench.pc_mode = !on),
        ("disarmed", |bench, on| bench.pc_steering = !on),
        ("logic", |bench, on| {
            bench.command_age_us = if on { 60_000 } else { 10_000 };
        }),
        ("wheel hot", |bench, on| {
            bench.motor.wheels[0].temperature_c = if on { 95 } else { 30 };
        }),
        ("wheel frozen", |bench, on| {
            bench.motor.wheels[1].frozen = on;
            bench.gesture(!on);
        }),
        ("wheel silent", |bench, on| {
            bench.motor.wheels[0].age_us = if on { 60_000 } else { 1_000 };
        }),
        ("joint silent", |bench, on| {
            bench.motor.joints[3].age_us = if on { 60_000 } else { 2_000 };
        }),
        ("bus off", |bench, on| {
            bench.health.can[1].state = if on {
                BusErrorState::BusOff
            } else {
                BusErrorState::Active
            };
        }),
        ("congested", |bench, on| {
            bench.health.can[0].tx_failures_in_row = if on { 30 } else { 0 };
        }),
    ];
    for (name, interrupt) in interruptions {
        let mut bench = Bench::in_pc_mode();
        bench.stream(rest(), 1);
        assert_eq!(bench.stream(motion(), 5), Pc::Steers, "{name}");
        interrupt(&mut bench, true);
        bench.stream(motion(), 100);
        interrupt(&mut bench, false);
        // A latched stop takes a second to be cleared.
        assert_eq!(bench.stream(motion(), 105), Pc::Awaited, "{name}");
        assert_eq!(bench.stream(rest(), 1), Pc::Steers, "{name}");
        assert_eq!(bench.stream(motion(), 1), Pc::Steers, "{name}");
    }
}

/// One bus that fails stops its own actuators only (docs/safety.md#the-rules, 2).
#[test]
fn a_partial_stop_leaves_the_rest_to_the_pc() {
    let mut bench = Bench::in_pc_mode();
    bench.stream(rest(), 1);
    bench.health.can[1].state = BusErrorState::BusOff;
    assert_eq!(bench.stream(motion(), 100), Pc::Steers);
}

/// The leg may have sunk, or the PC may have moved its target, until the motor follows.
#[test]
fn a_joint_that_is_enabled_late_does_not_jump() {
    for (offset_rad, expected) in [(0.09, Pc::Steers), (0.11, Pc::Awaited)] {
        let mut bench = Bench::in_pc_mode();
        for joint in &mut bench.motor.joints {
            joint.state = JointState::Disabled;
        }
        bench.stream(rest(), 1);
        let mut pose_rad = POSE_RAD;
        pose_rad[1] += offset_rad;
        assert_eq!(bench.stream(command(5.0, pose_rad), 3), Pc::Steers);
        for (index, joint) in bench.motor.joints.iter_mut().enumerate() {
            if index != 1 {
                joint.state = JointState::Enabled;
            }
        }
        assert_eq!(
            bench.pc_after(1),
            Pc::Steers,
            "the others are where they shall be"
        );
        bench.motor.joints[1].state = JointState::Enabled;
        assert_eq!(bench.pc_after(1), expected, "{offset_rad}");
        assert_eq!(bench.stream(command(0.0, pose_rad), 3), expected);
        assert_eq!(bench.stream(rest(), 1), Pc::Steers);
    }
}

/// Before arming, the flag tells the pilot what the PC asks for.
#[test]
fn a_disarmed_robot_shows_whether_the_pc_is_at_rest() {
    let mut bench = Bench::in_pc_mode();
    bench.pc_steering = false;
    for _ in 0..2 {
        assert_eq!(bench.stream(rest(), 2), Pc::Steers);
        assert_eq!(bench.stream(motion(), 2), Pc::Awaited);
    }
    // In the tick that arms, the robot still counts as disarmed.
    bench.stream(rest(), 1);
    bench.send(motion());
    assert_eq!(bench.pc_after(0), Pc::Awaited);
    bench.pc_steering = true;
    assert_eq!(bench.stream(motion(), 10), Pc::Awaited);
}

/// A command in place of the sticks.
fn drive(vx: f32, wz: f32) -> PcCommand {
    PcCommand {
        kind: PcKind::Drive,
        drive: PcDrive {
            vx,
            wz,
            height: 1.0,
            ..PcDrive::default()
        },
        ..PcCommand::default()
    }
}

#[test]
fn a_pc_in_place_of_the_sticks_begins_at_rest() {
    for (vx, wz) in [(0.02, 0.0), (0.0, -0.02), (f32::NAN, 0.0), (0.0, f32::NAN)] {
        let mut bench = Bench::in_pc_mode();
        assert_eq!(bench.stream(drive(vx, wz), 20), Pc::Awaited);
        assert_eq!(bench.stream(drive(0.01, -0.01), 1), Pc::Steers);
        assert_eq!(bench.stream(drive(1.0, -1.0), 400), Pc::Steers);
        assert_eq!(bench.stream(drive(1.0, -1.0), 100), Pc::Lost, "frozen");
    }
    let mut bench = Bench::in_pc_mode();
    assert_eq!(bench.stream(drive(0.0, 0.0), 2_000), Pc::Steers);
}

/// Of the motors' targets, those of a standing robot would be the wrong ones, and the other way round.
#[test]
fn a_pc_that_changes_the_kind_of_its_commands_begins_at_rest() {
    let mut bench = Bench::in_pc_mode();
    bench.stream(drive(0.0, 0.0), 1);
    assert_eq!(bench.stream(drive(1.0, 0.0), 1), Pc::Steers);
    assert_eq!(bench.stream(motion(), 3), Pc::Awaited);
    assert_eq!(bench.stream(rest(), 1), Pc::Steers);
    assert_eq!(bench.stream(drive(1.0, 0.0), 3), Pc::Awaited);
    assert_eq!(bench.stream(drive(0.0, 0.0), 1), Pc::Steers);
}

#[test]
fn a_standing_robot_follows_no_targets_for_motors() {
    let mut bench = Bench::in_pc_mode();
    bench.stream(rest(), 1);
    bench.pc_stands = true;
    assert_eq!(bench.stream(rest(), 3), Pc::Awaited);
    assert_eq!(bench.stream(drive(0.0, 0.0), 1), Pc::Steers);
    assert_eq!(bench.stream(drive(0.5, 0.0), 3), Pc::Steers);
    assert_eq!(bench.stream(rest(), 1), Pc::Awaited);
    bench.pc_stands = false;
    assert_eq!(bench.stream(motion(), 1), Pc::Awaited);
    assert_eq!(bench.stream(rest(), 1), Pc::Steers);
}
