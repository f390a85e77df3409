//! Six servos with the weight of an SO-101 on them.

use robot_servo_model::{Bus, So101, Version, VirtualWire, so101_servos};

use crate::host::{Host, frame};

fn arm() -> Host {
    let bus = Bus::new(so101_servos(Version::Volts12), 1).with_body(So101);
    Host {
        wire: VirtualWire::new(bus),
    }
}

/// Sends all joints to one position, as the manufacturer's SDK does: acceleration, position, time, speed.
fn send_all_to(host: &mut Host, steps: u16) {
    let [low, high] = steps.to_le_bytes();
    let records = (1..=6).flat_map(|id| [id, 30, low, high, 0, 0, 0xE8, 3]);
    let records: Vec<u8> = records.collect();
    host.raw(&frame(0xFE, 0x83, &[&[41, 7][..], &records].concat()));
}

// With all joints at zero the lift carries 0.535 N·m, of the 2.94 that it has at full output.
#[test]
fn it_holds_its_weight_and_falls_without_torque() {
    let mut host = arm();
    host.raw(&frame(0xFE, 3, &[40, 1]));
    send_all_to(&mut host, 2048);
    host.wait_s(3.0);
    let held = host.wire.bus().view();
    let worst = held.iter().map(|view| (view.position_steps - 2048).abs());
    assert!(worst.max() < Some(20), "{held:?}");
    let lift = held[1].duty;
    assert!((-0.21..-0.16).contains(&lift), "{lift}");
    assert!(held[5].duty.abs() < 0.01, "{held:?}");

    host.raw(&frame(0xFE, 3, &[40, 0]));
    host.wait_s(2.0);
    let fallen = host.wire.bus().view();
    // The lift ends at 1.745 rad, 1,137.7 steps from its zero.
    assert_eq!(fallen[1].position_steps, 2048 + 1137, "{fallen:?}");
}
