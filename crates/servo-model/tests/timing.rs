//! When bytes are on the wire. What is expected is arithmetic of 10 bits a byte, not the model's.

use robot_servo_model::{Bus, Servo, Version, VirtualWire};

const DEADLINE_NS: u64 = 20_000_000;

fn six(return_delay: u8) -> VirtualWire {
    let servos = (1..=6).map(|id| {
        Servo::new(Version::Volts12, 2048.0)
            .with_id(id)
            .with_return_delay(return_delay)
    });
    VirtualWire::new(Bus::new(servos.collect(), 1))
}

fn frame(id: u8, instruction: u8, parameters: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0xFF, 0xFF, id, parameters.len() as u8 + 2, instruction];
    bytes.extend_from_slice(parameters);
    let sum: u32 = bytes[2..].iter().map(|byte| u32::from(*byte)).sum();
    bytes.push(!(sum as u8));
    bytes
}

/// Sends and reads `answer` bytes, and returns the time that it took in microseconds.
fn exchange_us(wire: &mut VirtualWire, request: &[u8], answer: usize) -> f64 {
    let start_ns = wire.now_ns();
    wire.write(request);
    let mut bytes = vec![0; answer];
    assert_eq!(wire.read(&mut bytes, start_ns + DEADLINE_NS), answer);
    wire.flush();
    (wire.now_ns() - start_ns) as f64 / 1e3
}

// 14 bytes there and 6 × 8 back are 620 µs at 1 Mb/s; each servo adds its return delay of 2 µs.
#[test]
fn a_sync_read_of_six_positions_takes_620_us_and_six_return_delays() {
    let request = frame(0xFE, 0x82, &[56, 2, 1, 2, 3, 4, 5, 6]);
    assert_eq!(request.len(), 14);
    assert_eq!(exchange_us(&mut six(0), &request, 48), 620.0 + 6.0 * 2.0);
}

#[test]
fn a_sync_read_of_eight_bytes_takes_980_us_and_six_return_delays() {
    let request = frame(0xFE, 0x82, &[56, 8, 1, 2, 3, 4, 5, 6]);
    assert_eq!(exchange_us(&mut six(0), &request, 84), 980.0 + 6.0 * 2.0);
    // As shipped, register 7 is 250: 500 µs each.
    assert_eq!(
        exchange_us(&mut six(250), &request, 84),
        980.0 + 6.0 * 500.0
    );
}

#[test]
fn a_sync_write_of_six_positions_takes_260_us_and_has_no_answer() {
    let records: Vec<u8> = (1..=6).flat_map(|id| [id, 0, 8]).collect();
    let request = frame(0xFE, 0x83, &[&[42, 2][..], &records].concat());
    assert_eq!(request.len(), 26);
    let mut wire = six(0);
    assert_eq!(exchange_us(&mut wire, &request, 0), 260.0);
    let mut none = [0];
    assert_eq!(wire.read(&mut none, DEADLINE_NS), 0);
}

// 8 bytes there and 8 back at 115,200 b/s: 1,388.9 µs.
#[test]
fn a_slower_bus_takes_longer() {
    let servo = Servo::new(Version::Volts12, 2048.0)
        .with_return_delay(0)
        .with_baud_code(4);
    let mut wire = VirtualWire::new(Bus::new(vec![servo], 1));
    wire.set_baud(115_200);
    let us = exchange_us(&mut wire, &frame(1, 2, &[56, 2]), 8);
    assert!((us - (160e6 / 115_200.0 + 2.0)).abs() < 0.1, "{us}");
}

#[test]
fn no_byte_comes_before_its_time() {
    let mut wire = six(0);
    wire.write(&frame(1, 1, &[]));
    let mut bytes = [0; 6];
    // 60 µs of request, 2 of delay, then a byte every 10 µs.
    assert_eq!(wire.read(&mut bytes, 71_999), 0);
    assert_eq!(wire.read(&mut bytes, 72_000), 1);
    assert_eq!(wire.read(&mut bytes[1..], 91_999), 1);
    assert_eq!(wire.now_ns(), 91_999);
}
