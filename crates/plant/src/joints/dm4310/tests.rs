//! Frames written by hand from docs/hardware.md#dm4310-frames and docs/hardware.md#test-vectors.

use super::*;
use crate::{joints::actuator::Actuator, physics::physics_step_s, time::MS};

const ENABLE: [u8; 8] = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC];
const DISABLE: [u8; 8] = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD];
const ZERO_HERE: [u8; 8] = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE];
const CLEAR: [u8; 8] = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFB];
/// p = 1, v = 0, kp = 20, kd = 1, t = 0.5.
const ONE: [u8; 8] = [0x8A, 0x3C, 0x7F, 0xF0, 0xA3, 0x33, 0x38, 0x65];

struct Bench {
    motor: Dm4310,
    shaft: Shaft,
    now: Ps,
}

fn bench() -> Bench {
    Bench {
        motor: Dm4310::new(1, 0x11),
        shaft: Shaft::default(),
        now: MS,
    }
}

impl Bench {
    fn send(&mut self, id: u32, data: [u8; 8]) -> Reception {
        let frame = CanFrame::with_data(id, data);
        self.motor.receive(&frame, self.shaft, self.now)
    }

    /// Advances the time while the shaft is held.
    fn wait(&mut self, ms: u64) {
        for _ in 0..4 * ms {
            self.now += 250 * US;
            self.motor
                .step(self.shaft, 24.0, self.now, physics_step_s());
        }
    }

    fn reply(&mut self) -> Option<CanFrame> {
        let frame = self.motor.replies().pending(self.now)?;
        self.motor.replies_mut().sent();
        Some(frame)
    }

    /// The reply to a frame, a millisecond later.
    fn ask(&mut self, id: u32, data: [u8; 8]) -> Option<[u8; 8]> {
        self.send(id, data);
        self.wait(1);
        let reply = self.reply()?;
        assert_eq!((reply.id, reply.dlc), (0x11, 8));
        Some(reply.data)
    }
}

#[test]
fn an_enabled_motor_follows_the_reference_command() {
    let mut bench = bench();
    // Disabled at zero: ERR 0, id 1, codes of zero truncated, 30 °C.
    let first = bench
        .ask(1, ONE)
        .expect("a motor replies while disabled too");
    assert_eq!(first, [0x01, 0x7F, 0xFF, 0x7F, 0xF7, 0xFF, 30, 30]);
    assert_eq!(bench.motor.actuator().torque_nm(), 0.0);
    assert_eq!(bench.ask(1, ENABLE).expect("a reply")[0], 0x11);
    assert_eq!(bench.motor.commanded_nm(bench.shaft), 0.0);
    bench.shaft = Shaft {
        pos_rad: 0.8,
        vel_rps: 0.5,
    };
    let reply = bench.ask(1, ONE).expect("a reply");
    // 20·(1 − 0.8) + 1·(0 − 0.5) + 0.5 = 4 N·m, to within the codes' steps.
    assert!((bench.motor.commanded_nm(bench.shaft) - 4.0).abs() < 0.05);
    assert!((bench.motor.actuator().torque_nm() - 4.0).abs() < 0.05);
    // 0.8 rad: 13.3/25·65535 = 34864.6; 0.5 rad/s: 30.5/60·4095 = 2081.6.
    assert_eq!(reply[..4], [0x11, 0x88, 0x30, 0x82]);
    assert_eq!(bench.ask(1, DISABLE).expect("a reply")[0], 0x01);
    assert_eq!(bench.motor.actuator().torque_nm(), 0.0);
    assert_eq!(bench.motor.stop_frames(), 1);
    // Enabled again, it waits for a command.
    bench.ask(1, ENABLE);
    assert_eq!(bench.motor.commanded_nm(bench.shaft), 0.0);
}

#[test]
fn it_replies_once_and_150_us_after_the_frame() {
    let mut bench = bench();
    bench.send(1, DISABLE);
    assert_eq!(bench.motor.replies().ready_at(), Some(bench.now + 150 * US));
    assert!(bench.reply().is_none());
    bench.now += 150 * US;
    assert!(bench.reply().is_some());
    assert!(bench.reply().is_none());
    for foreign in [0, 2, 0x102, 0x200, 0x211, 0x7A0] {
        assert_eq!(bench.send(foreign, DISABLE), Reception::Ignored);
    }
}

/// Only the low byte of an identifier names the motor, so it replies to frames of other identifiers with the same low byte,
/// and obeys such service frames.
#[test]
fn every_identifier_with_its_low_byte_reaches_it() {
    let mut bench = bench();
    for id in [0x101, 0x201, 0x301, 0x501, 0x701] {
        assert_eq!(bench.ask(id, ENABLE).expect("a reply")[0], 0x11, "{id:#x}");
        assert_eq!(bench.ask(id, ONE).expect("a reply")[0], 0x11, "{id:#x}");
        assert_eq!(bench.motor.commanded_nm(bench.shaft), 0.0, "{id:#x}");
        assert_eq!(bench.ask(id, DISABLE).expect("a reply")[0], 0x01, "{id:#x}");
    }
}

#[test]
fn torque_ends_at_the_peak_and_the_no_load_speed() {
    let mut bench = bench();
    bench.send(1, ENABLE);
    // Torque code 0xFFF alone: 10 N·m asked.
    bench.send(1, [0x7F, 0xFF, 0x7F, 0xF0, 0, 0, 0x0F, 0xFF]);
    bench.wait(1);
    assert_eq!(bench.motor.commanded_nm(bench.shaft), 10.0);
    assert_eq!(bench.motor.actuator().torque_nm(), 7.0);
    bench.shaft.vel_rps = 20.94;
    bench.wait(1);
    let left_nm = bench.motor.actuator().torque_nm();
    assert!((left_nm - 0.15).abs() < 0.01, "friction alone: {left_nm}");
}

#[test]
fn parameters_are_read_and_written_at_once_and_storing_takes_150_ms_of_silence() {
    let mut bench = bench();
    let read = |register| [0x01, 0x00, 0x33, register, 0, 0, 0, 0];
    // 12.5, 30 and 10 as IEEE 754.
    for (register, value) in [
        (0x15, [0x00, 0x00, 0x48, 0x41]),
        (0x16, [0x00, 0x00, 0xF0, 0x41]),
        (0x17, [0x00, 0x00, 0x20, 0x41]),
        (7, [0x11, 0, 0, 0]),
        (8, [1, 0, 0, 0]),
        (9, [0; 4]),
        (10, [1, 0, 0, 0]),
    ] {
        let reply = bench.ask(0x7FF, read(register)).expect("a reply");
        assert_eq!(reply[..4], [0x01, 0x00, 0x33, register]);
        assert_eq!(reply[4..], value);
    }
    // 2000 · 50 µs = 100 ms.
    let write = [0x01, 0x00, 0x55, 9, 0xD0, 0x07, 0, 0];
    assert_eq!(bench.ask(0x7FF, write), Some(write));
    let store = [0x01, 0x00, 0xAA, 1, 0, 0, 0, 0];
    assert_eq!(bench.ask(0x7FF, store), None);
    assert_eq!(bench.ask(1, DISABLE), None);
    bench.wait(147);
    assert_eq!(bench.ask(1, DISABLE), None);
    bench.wait(1);
    let reply = bench.reply().expect("it is stored");
    assert_eq!(reply.data, store);
    let back = bench.ask(0x7FF, read(9)).expect("a reply");
    assert_eq!(back[4..], [0xD0, 0x07, 0, 0]);
    // Another motor's register, and one this model lacks.
    assert_eq!(
        bench.send(0x7FF, [2, 0, 0x33, 9, 0, 0, 0, 0]),
        Reception::Ignored
    );
    assert!(matches!(
        bench.send(0x7FF, read(0x40)),
        Reception::NotModelled(_)
    ));
}

#[test]
fn a_motor_that_is_slow_to_write_is_deaf_for_150_ms() {
    let mut bench = bench();
    let slow = DriveFaults {
        slow_writes: true,
        ..DriveFaults::default()
    };
    bench.motor.set_faults(slow, bench.now);
    let write = [0x01, 0x00, 0x55, 9, 0xD0, 0x07, 0, 0];
    assert_eq!(bench.ask(0x7FF, write), None);
    bench.wait(147);
    assert_eq!(bench.ask(1, DISABLE), None);
    bench.wait(2);
    assert_eq!(bench.reply().expect("it is written").data, write);
}

#[test]
fn only_what_was_stored_survives_a_power_cycle() {
    let mut bench = bench();
    let timeout = |bench: &mut Bench| {
        let data = bench.ask(0x7FF, [1, 0, 0x33, 9, 0, 0, 0, 0]);
        data.expect("a reply")[4]
    };
    let power_cycle = |bench: &mut Bench| {
        let gone = DriveFaults {
            gone: true,
            ..DriveFaults::default()
        };
        bench.motor.set_faults(gone, bench.now);
        assert!(!bench.motor.powered());
        assert_eq!(bench.send(1, ENABLE), Reception::Ignored);
        bench.motor.set_faults(DriveFaults::default(), bench.now);
    };
    bench.ask(0x7FF, [1, 0, 0x55, 9, 40, 0, 0, 0]);
    assert_eq!(timeout(&mut bench), 40);
    power_cycle(&mut bench);
    assert_eq!(timeout(&mut bench), 0);
    bench.ask(0x7FF, [1, 0, 0x55, 9, 40, 0, 0, 0]);
    bench.send(0x7FF, [1, 0, 0xAA, 1, 0, 0, 0, 0]);
    bench.wait(151);
    power_cycle(&mut bench);
    assert_eq!(timeout(&mut bench), 40);
}

#[test]
fn silence_trips_it_after_its_timeout_and_any_frame_counts() {
    let mut bench = bench();
    bench.ask(1, ENABLE);
    bench.wait(2_000);
    assert!(bench.motor.enabled(), "as shipped it waits for ever");
    // The write itself also counts as a frame.
    bench.ask(0x7FF, [1, 0, 0x55, 9, 0xD0, 0x07, 0, 0]);
    bench.wait(98);
    assert!(bench.motor.enabled());
    bench.wait(2);
    assert!(!bench.motor.enabled());
    assert_eq!(bench.ask(1, ENABLE).expect("a reply")[0], 0xD1);
    assert_eq!(bench.ask(1, ONE).expect("a reply")[0], 0xD1);
    assert_eq!(bench.ask(1, DISABLE).expect("a reply")[0], 0xD1);
    assert_eq!(bench.ask(1, CLEAR).expect("a reply")[0], 0x01);
    assert_eq!(bench.ask(1, ENABLE).expect("a reply")[0], 0x11);
    for _ in 0..10 {
        bench.wait(60);
        let refresh = bench.ask(0x7FF, [1, 0, 0xCC, 0, 0, 0, 0, 0]);
        assert_eq!(refresh.expect("a reply")[0], 0x11);
    }
}

#[test]
fn a_driver_fault_cuts_the_torque_until_it_is_cleared_after_its_end() {
    let mut bench = bench();
    bench.ask(1, ENABLE);
    bench.ask(1, ONE);
    let tripped = DriveFaults {
        tripped: true,
        ..DriveFaults::default()
    };
    bench.motor.set_faults(tripped, bench.now);
    assert_eq!(bench.motor.actuator().torque_nm(), 0.0);
    assert_eq!(bench.ask(1, ONE).expect("a reply")[0], 0xA1);
    assert_eq!(bench.ask(1, CLEAR).expect("a reply")[0], 0xA1);
    bench.motor.set_faults(DriveFaults::default(), bench.now);
    assert_eq!(bench.ask(1, ONE).expect("a reply")[0], 0xA1);
    assert_eq!(bench.ask(1, CLEAR).expect("a reply")[0], 0x01);
}

#[test]
fn only_commands_of_the_present_mode_have_an_effect() {
    let mut bench = bench();
    let towards = |pos: f32, most: f32| {
        let [a, b, c, d] = pos.to_le_bytes();
        let [e, f, g, h] = most.to_le_bytes();
        [a, b, c, d, e, f, g, h]
    };
    // CTRL_MODE 2, position and speed.
    bench.ask(0x7FF, [1, 0, 0x55, 10, 2, 0, 0, 0]);
    assert_eq!(bench.ask(1, ENABLE).expect("a reply")[0], 0x11);
    for (id, foreign) in [(1, ONE), (0x201, towards(1.0, 0.0))] {
        assert_eq!(bench.ask(id, foreign).expect("a reply")[0], 0x11);
        assert_eq!(bench.motor.commanded_nm(bench.shaft), 0.0);
    }
    assert!(bench.ask(0x101, towards(-0.5, 2.0)).is_some());
    bench.wait(2);
    assert!(bench.motor.actuator().torque_nm() < -1.0);
    // Speed mode.
    bench.ask(1, DISABLE);
    bench.ask(0x7FF, [1, 0, 0x55, 10, 3, 0, 0, 0]);
    bench.ask(1, ENABLE);
    assert!(bench.ask(0x201, towards(3.0, 0.0)).is_some());
    bench.wait(2);
    assert!(bench.motor.actuator().torque_nm() > 1.0);
    bench.ask(0x201, towards(f32::NAN, 0.0));
    assert!(bench.motor.commanded_nm(bench.shaft).is_finite());
}

#[test]
fn zero_moves_what_the_feedback_calls_zero() {
    let mut bench = bench();
    bench.shaft.pos_rad = 2.0;
    let before = bench.ask(1, DISABLE).expect("a reply");
    assert_eq!(before[1..3], [0x94, 0x7A]);
    bench.ask(1, ZERO_HERE);
    let after = bench.ask(1, DISABLE).expect("a reply");
    assert_eq!(after[1..3], [0x7F, 0xFF]);
}

#[test]
fn frozen_hot_and_renumbered_motors_reply_as_they_would() {
    let mut bench = bench();
    let before = bench.ask(1, DISABLE).expect("a reply");
    let frozen = DriveFaults {
        frozen: true,
        ..DriveFaults::default()
    };
    bench.motor.set_faults(frozen, bench.now);
    bench.shaft.pos_rad = 1.0;
    assert_eq!(bench.ask(1, ENABLE), Some(before));
    assert!(bench.motor.enabled());
    let hot = DriveFaults {
        hot: true,
        ..DriveFaults::default()
    };
    bench.motor.set_faults(hot, bench.now);
    assert_eq!(bench.ask(1, ENABLE).expect("a reply")[7], 120);
    bench.motor.set_faults(DriveFaults::default(), bench.now);
    assert_eq!(bench.ask(1, ENABLE).expect("a reply")[7], 30);
    let renamed = DriveFaults {
        wrong_id: true,
        ..DriveFaults::default()
    };
    bench.motor.set_faults(renamed, bench.now);
    assert!(!bench.motor.enabled());
    assert_eq!(bench.send(1, ENABLE), Reception::Ignored);
    assert_eq!(bench.send(9, DISABLE), Reception::Accepted);
    bench.wait(1);
    let reply = bench.reply().expect("under another name");
    assert_eq!((reply.id, reply.data[0]), (0x19, 0x09));
}

/// Rated torque for a long time warms it towards 90 °C; the peak trips it at its own limit within minutes.
#[test]
fn heat_follows_the_square_of_the_torque() {
    let mut actuator = Actuator::new(&RATING);
    for _ in 0..2_000 {
        actuator.step(Some(3.0), 0.0, 24.0, 1.0);
    }
    assert!((actuator.winding_c() - 90.3).abs() < 0.5);
    let mut bench = bench();
    bench.ask(1, ENABLE);
    bench.ask(1, [0x7F, 0xFF, 0x7F, 0xF0, 0, 0, 0x0F, 0xFF]);
    for _ in 0..300 {
        bench.now += 1_000 * MS;
        bench.motor.step(bench.shaft, 24.0, bench.now, 1.0);
    }
    assert_eq!(bench.ask(1, DISABLE).expect("a reply")[0], 0xC1);
}
