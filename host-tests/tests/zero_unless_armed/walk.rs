//! Robots that run through many phases, which are the same in each run.

use proptest::{strategy::ValueTree, test_runner::TestRunner};
use robot_app::domain::{JointCommand, JointMode};

use super::*;

const ROBOTS: usize = 15;
const STRETCHES: usize = 20;
/// A clock at its end would end the walk.
const LONGEST_JUMP_US: u64 = 1 << 40;

fn rogue() -> Rogue {
    Rogue {
        joint: JointCommand {
            mode: JointMode::Mit,
            pos_rad: 2.0,
            vel_rps: 40.0,
            kp: 60.0,
            kd: 3.0,
            tau_nm: 9.0,
        },
        ..Rogue::wheels(4_000.0)
    }
}

/// A pilot clears latched stops and starts again.
fn start(imu_errors: u32) -> [Phase; 3] {
    let [mut clear, off, on] = [good(2_500, false), good(300, false), good(100, true)];
    clear.e_stop = true;
    [clear, off, on].map(|phase| Phase {
        imu_errors,
        ..phase
    })
}

fn walk(make: Make) {
    let strategy = (phase::phase(), any::<bool>());
    let mut runner = TestRunner::deterministic();
    let (mut starts, mut driven, mut enabled) = (0, 0, 0);
    for _ in 0..ROBOTS {
        let mut bench = Bench::new(make, rogue());
        for _ in 0..STRETCHES {
            let tree = strategy.new_tree(&mut runner).expect("a stretch");
            let (mut phase, starts_anew) = tree.current();
            phase.time_jump_us %= LONGEST_JUMP_US;
            if starts_anew {
                starts += 1;
                bench.run(&start(phase.imu_errors));
            }
            bench.run(&[phase]);
        }
        let ticks = &bench.ticks;
        driven += ticks.iter().filter(|tick| tick.drives()).count();
        enabled += ticks.iter().filter(|tick| tick.enables_joints()).count();
    }
    println!("{starts} starts, {driven} ticks with wheel torque, {enabled} with joints enabled");
    // Half of the 100 ticks in which each start might drive.
    assert!(driven > 50 * starts && enabled > 50 * starts);
}

#[test]
fn a_long_walk_with_dm4310_joints_keeps_the_rules() {
    walk(Make::Dm4310);
}

#[test]
fn a_long_walk_with_rs00_joints_keeps_the_rules() {
    walk(Make::Rs00);
}
