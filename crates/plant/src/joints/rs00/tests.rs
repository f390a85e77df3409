//! Frames written by hand from the maker's MIT reference and docs/hardware.md#test-vectors.

use super::*;
use crate::{
    physics::physics_step_s,
    time::{MS, US},
};

const ENABLE: [u8; 8] = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC];
const STOP: [u8; 8] = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD];
const CLEAR: [u8; 8] = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFB];
const READ_FAULTS: [u8; 8] = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0xFB];
/// p = 1, v = 0, kp = 20, kd = 1, t = 0.5.
const ONE: [u8; 8] = [0x8A, 0x2E, 0x7F, 0xF0, 0xA3, 0x33, 0x38, 0x48];

fn set_mode(mode: u8) -> [u8; 8] {
    [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, mode, 0xFC]
}

fn two(first: f32, second: f32) -> [u8; 8] {
    let [a, b, c, d] = first.to_le_bytes();
    let [e, f, g, h] = second.to_le_bytes();
    [a, b, c, d, e, f, g, h]
}

struct Bench {
    motor: Rs00,
    shaft: Shaft,
    now: Ps,
}

fn bench() -> Bench {
    Bench {
        motor: Rs00::new(3, 0xFD, 0),
        shaft: Shaft::default(),
        now: MS,
    }
}

impl Bench {
    fn ask(&mut self, id: u32, data: [u8; 8]) -> Option<[u8; 8]> {
        let frame = CanFrame::with_data(id, data);
        if self.motor.receive(&frame, self.shaft, self.now) != Reception::Accepted {
            return None;
        }
        self.wait(1);
        let reply = self.motor.replies().pending(self.now)?;
        self.motor.replies_mut().sent();
        assert_eq!((reply.id, reply.data[0]), (0xFD, 3));
        Some(reply.data)
    }

    fn wait(&mut self, ms: u64) {
        for _ in 0..4 * ms {
            self.now += 250 * US;
            self.motor
                .step(self.shaft, 24.0, self.now, physics_step_s());
        }
    }

    fn torque_nm(&self) -> f64 {
        self.motor.actuator().torque_nm()
    }
}

/// Parameter 0x7028: 0 as shipped, 2000 for 100 ms; a trip is reset mode.
#[test]
fn it_holds_for_ever_unless_its_timeout_was_set() {
    for (can_timeout, lets_go) in [(0, false), (100 * MS, true)] {
        let mut bench = bench();
        bench.motor = Rs00::new(3, 0xFD, can_timeout);
        bench.ask(3, ENABLE);
        bench.ask(3, ONE);
        for _ in 0..5 {
            bench.wait(90);
            bench.ask(3, ONE);
            assert!(bench.motor.enabled());
        }
        bench.wait(110);
        assert_eq!(!bench.motor.enabled(), lets_go);
        assert_eq!(bench.torque_nm() == 0.0, lets_go);
        bench.ask(3, ENABLE);
        assert!(bench.motor.enabled());
    }
}

#[test]
fn it_runs_the_flow_of_the_manual() {
    let mut bench = bench();
    // 30.0 °C = 300 = 0x12C; state 0 in the top bits.
    let reply = bench.ask(3, set_mode(0)).expect("a reply");
    assert_eq!(reply, [3, 0x7F, 0xFF, 0x7F, 0xF7, 0xFF, 0x01, 0x2C]);
    bench.ask(3, ONE);
    assert_eq!(bench.torque_nm(), 0.0);
    // State 2, running.
    assert_eq!(bench.ask(3, ENABLE).expect("a reply")[6..], [0x81, 0x2C]);
    bench.shaft = Shaft {
        pos_rad: 0.8,
        vel_rps: 0.5,
    };
    bench.ask(3, ONE);
    // 20·(1 − 0.8) + 1·(0 − 0.5) + 0.5.
    assert!(
        (bench.torque_nm() - 4.0).abs() < 0.05,
        "{}",
        bench.torque_nm()
    );
    bench.wait(5_000);
    assert!(bench.torque_nm() > 3.9, "no timeout as shipped");
    assert_eq!(bench.ask(3, STOP).expect("a reply")[6] >> 6, 0);
    assert_eq!((bench.torque_nm(), bench.motor.stop_frames()), (0.0, 1));
}

#[test]
fn mode_is_set_while_stopped_and_other_modes_commands_do_nothing() {
    let mut bench = bench();
    bench.ask(3, set_mode(2));
    bench.ask(3, ENABLE);
    bench.ask(3, set_mode(0));
    bench.ask(3, ONE);
    bench.ask(0x103, two(1.0, 5.0));
    assert_eq!(bench.torque_nm(), 0.0);
    // 1 A of 1.48 N·m: the limit of the speed loop.
    bench.ask(0x203, two(10.0, 1.0));
    assert!(
        (bench.torque_nm() - 1.48).abs() < 1e-9,
        "{}",
        bench.torque_nm()
    );
    bench.ask(3, STOP);
    bench.ask(3, set_mode(1));
    bench.ask(3, ENABLE);
    bench.ask(0x103, two(-0.5, 2.0));
    assert!(bench.torque_nm() < -1.0);
}

#[test]
fn a_fault_sets_its_bit_and_cuts_the_torque_until_it_is_cleared() {
    let mut bench = bench();
    bench.ask(3, ENABLE);
    bench.ask(3, ONE);
    let tripped = DriveFaults {
        tripped: true,
        ..DriveFaults::default()
    };
    bench.motor.set_faults(tripped, bench.now);
    assert_eq!(bench.torque_nm(), 0.0);
    // Bit 5 of byte 6, state 0.
    assert_eq!(bench.ask(3, ONE).expect("a reply")[6], 0x21);
    let word = bench.ask(3, READ_FAULTS).expect("a reply");
    assert_eq!(word[..5], [3, 0x02, 0, 0, 0]);
    bench.motor.set_faults(DriveFaults::default(), bench.now);
    assert_eq!(bench.ask(3, ENABLE).expect("a reply")[6], 0x21);
    assert_eq!(bench.ask(3, CLEAR).expect("a reply")[6], 0x01);
    assert_eq!(bench.ask(3, ENABLE).expect("a reply")[6], 0x81);
}

#[test]
fn heat_reads_in_tenths_and_trips_above_145_degrees() {
    let mut bench = bench();
    bench.ask(3, ENABLE);
    let hot = DriveFaults {
        hot: true,
        ..DriveFaults::default()
    };
    bench.motor.set_faults(hot, bench.now);
    // 1200 = 0x4B0.
    assert_eq!(bench.ask(3, STOP).expect("a reply")[6..], [0x04, 0xB0]);
    bench.motor.set_faults(DriveFaults::default(), bench.now);
    bench.ask(3, ENABLE);
    bench.ask(3, [0x7F, 0xFF, 0x7F, 0xF0, 0, 0, 0x0F, 0xFF]);
    assert_eq!(bench.torque_nm(), 14.0);
    for _ in 0..600 {
        bench.motor.step(bench.shaft, 24.0, bench.now, 1.0);
    }
    assert_eq!(bench.ask(3, READ_FAULTS).expect("a reply")[1], 0x01);
}

#[test]
fn zero_moves_the_goal_with_it() {
    let mut bench = bench();
    bench.shaft.pos_rad = 1.0;
    bench.ask(3, ENABLE);
    bench.ask(3, ONE);
    let reply = bench.ask(3, [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE]);
    assert_eq!(reply.expect("a reply")[1..3], [0x7F, 0xFF]);
    // Feed-forward alone.
    assert!(
        (bench.torque_nm() - 0.5).abs() < 0.02,
        "{}",
        bench.torque_nm()
    );
}

#[test]
fn another_motors_frames_are_ignored_and_services_beyond_the_model_reported() {
    let mut bench = bench();
    assert_eq!(bench.ask(2, ENABLE), None);
    assert_eq!(bench.ask(0x303, ENABLE), None);
    let rename = CanFrame::with_data(3, [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x05, 0xFA]);
    let heard = bench.motor.receive(&rename, bench.shaft, bench.now);
    assert!(matches!(heard, Reception::NotModelled(_)));
}
