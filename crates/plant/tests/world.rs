//! The world through its wires alone.

use robot_plant::{
    time::{MS, Ps, SECOND, US},
    wire::{CanFrame, Parity},
    world::{
        CanBusId, PlantKind, RadioKind, RemoteInput, SpiSelect, WireEvent, World, WorldConfig,
    },
};

fn world(plant: PlantKind, radio: RadioKind) -> World {
    World::new(WorldConfig {
        plant,
        radio,
        seed: 1,
        imu_trial: None,
        ..WorldConfig::default()
    })
    .expect("no file is read")
}

fn signal(world: &World, name: &str) -> f64 {
    world.signal(name).expect(name)
}

fn command(world: &mut World, left: i16, right: i16, now: Ps) {
    let mut data = [0; 8];
    data[..2].copy_from_slice(&left.to_be_bytes());
    data[2..4].copy_from_slice(&right.to_be_bytes());
    let frame = CanFrame::with_data(0x200, data);
    for node in 0..world.can_nodes(CanBusId::Can1) {
        if world.can_present(CanBusId::Can1, node) {
            world.can_received(CanBusId::Can1, node, &frame, now);
        }
    }
}

/// Delivers every frame pending at `now`, as an idle bus would: (id, rotor rpm).
fn take_feedback(world: &mut World, now: Ps) -> Vec<(u32, i16)> {
    let mut frames = Vec::new();
    for node in 0..world.can_nodes(CanBusId::Can1) {
        if let Some(frame) = world.can_pending(CanBusId::Can1, node, now) {
            world.can_sent(CanBusId::Can1, node, now);
            frames.push((frame.id, i16::from_be_bytes([frame.data[2], frame.data[3]])));
        }
    }
    frames
}

#[test]
fn sbus_frames_follow_every_7_ms_in_characters_of_120_us() {
    let mut world = world(PlantKind::Stand, RadioKind::Sbus);
    let mut characters = Vec::new();
    let mut now = 0;
    while now < 70 * MS {
        world.advance(now);
        while let Some(character) = world.radio_char(now) {
            assert!(character.start <= now);
            characters.push(character);
        }
        let next = world.next_event();
        assert!(next > now);
        now = next;
    }
    assert_eq!(characters.len(), 10 * 25);
    for (index, character) in characters.iter().enumerate() {
        let (frame, position) = (index as Ps / 25, index as Ps % 25);
        assert_eq!(character.start, frame * 7 * MS + position * 120 * US);
    }
    assert_eq!((characters[0].byte, characters[24].byte), (0x0F, 0x00));
    let format = characters[0].format;
    assert_eq!(
        (
            format.baud,
            format.data_bits,
            format.parity,
            format.stop_bits
        ),
        (100_000, 8, Parity::Even, 2)
    );
}

#[test]
fn unplugged_receiver_falls_silent_within_a_frame_and_failsafe_sets_both_flags() {
    let mut world = world(PlantKind::Stand, RadioKind::Sbus);
    world.advance(MS);
    world.set_fault("sbus-silent", true).expect("listed");
    let mut count = 0;
    while world.radio_char(20 * MS).is_some() {
        count += 1;
    }
    assert_eq!(count, 9);
    world.set_fault("sbus-silent", false).expect("listed");
    world.set_fault("sbus-failsafe", true).expect("listed");
    let bytes: Vec<u8> = std::iter::from_fn(|| world.radio_char(27 * MS))
        .map(|character| character.byte)
        .collect();
    assert_eq!(bytes.len(), 25);
    assert_eq!(bytes[23], 0x0C);
}

#[test]
fn dbus_sends_18_characters_of_110_us_every_14_ms() {
    let mut world = world(PlantKind::Stand, RadioKind::Dbus);
    let starts: Vec<Ps> = std::iter::from_fn(|| world.radio_char(20 * MS))
        .map(|character| character.start)
        .collect();
    assert_eq!(starts.len(), 36);
    assert_eq!(
        (starts[1], starts[17], starts[18]),
        (110 * US, 1_870 * US, 14 * MS)
    );
}

#[test]
fn each_motor_feeds_back_1000_times_a_second() {
    let mut world = world(PlantKind::Stand, RadioKind::Sbus);
    let mut counts = [0; 2];
    for tick in 1..=10_000 {
        let now = tick * 100 * US;
        world.advance(now);
        for (id, _) in take_feedback(&mut world, now) {
            counts[(id - 0x201) as usize] += 1;
        }
    }
    for count in counts {
        assert!((999..=1_001).contains(&count), "{count}");
    }
}

#[test]
fn opposite_currents_drive_forward_and_every_command_is_an_event() {
    let mut world = world(PlantKind::Rolling, RadioKind::Sbus);
    let mut rpm = [0; 2];
    for tick in 1..=2_000 {
        let now = tick * MS;
        // 2 A: 0.6 N·m at each wheel.
        command(&mut world, 1_638, -1_638, now);
        for (id, value) in take_feedback(&mut world, now) {
            rpm[(id - 0x201) as usize] = value;
        }
    }
    let mut events: Vec<WireEvent> = Vec::new();
    world.drain_wire_events(&mut events);
    let left = events
        .iter()
        .filter(|event| world.signal_names()[event.signal] == "can.m3508.0.current_ma");
    assert_eq!(left.clone().count(), 2_000);
    assert!(
        left.clone()
            .all(|event| (event.value - 1_999.5).abs() < 0.1)
    );
    let speed_mps = signal(&world, "truth.body.vx");
    assert!(speed_mps > 1.0, "{speed_mps}");
    assert!(signal(&world, "truth.body.y").abs() < 1e-6);
    // Rotor rpm of the left motor: v / 0.075 · 60/2π · 19.2032, with a little slip.
    let expected_rpm = speed_mps / 0.075 * 60.0 / std::f64::consts::TAU * 3_591.0 / 187.0;
    assert!(
        (f64::from(rpm[0]) / expected_rpm - 1.0).abs() < 0.03,
        "{}",
        rpm[0]
    );
    // The right motor turns the other way, and reports at another instant.
    assert!((rpm[0] + rpm[1]).abs() <= 5, "{rpm:?}");
}

#[test]
fn faults_take_nodes_off_the_bus_and_put_a_rogue_on_it() {
    let mut world = world(PlantKind::Stand, RadioKind::Sbus);
    world.advance(5 * MS);
    assert!(!world.can_present(CanBusId::Can1, 2));
    world.set_fault("rogue-node-can1", true).expect("listed");
    assert_eq!(
        world.can_pending(CanBusId::Can1, 2, 5 * MS).map(|f| f.id),
        Some(0)
    );
    world.set_fault("motor-0-gone", true).expect("listed");
    assert!(!world.can_present(CanBusId::Can1, 0));
    assert!(world.can_pending(CanBusId::Can1, 1, 5 * MS).is_some());
    world.set_fault("can1-broken", true).expect("listed");
    assert!(world.can_broken(CanBusId::Can1) && !world.can_broken(CanBusId::Can2));
    for fault in World::faults() {
        world.set_fault(fault.name, true).expect("listed");
        world.set_fault(fault.name, false).expect("listed");
    }
    let error = world.set_fault("sbus-silnet", true);
    assert!(error.is_err_and(|error| error.to_string().contains("--list-faults")));
}

#[test]
fn remote_moves_the_sticks_and_unset_fields_stay() {
    let mut world = world(PlantKind::Stand, RadioKind::Sbus);
    world.set_remote(RemoteInput {
        enable: Some(true),
        vx: Some(0.4),
        ..RemoteInput::default()
    });
    world.set_remote(RemoteInput {
        wz: Some(-0.5),
        ..RemoteInput::default()
    });
    assert_eq!(signal(&world, "radio.vx"), 0.4);
    assert_eq!(signal(&world, "radio.wz"), -0.5);
    assert_eq!(signal(&world, "radio.enable"), 1.0);
}

#[test]
fn battery_reaches_the_converter_through_its_divider() {
    let mut world = world(PlantKind::Stand, RadioKind::Sbus);
    world.advance(MS);
    // docs/hardware.md#board-devices: volts at the pin · 10.0909.
    assert!((world.battery_adc_volts() * 10.0909 - 24.0).abs() < 0.01);
    world.set_fault("battery-low", true).expect("listed");
    world.advance(2 * MS);
    assert!((world.battery_adc_volts() * 10.0909 - 20.5).abs() < 0.01);
    world.set_fault("battery-empty", true).expect("listed");
    world.advance(3 * MS);
    assert!((world.battery_adc_volts() * 10.0909 - 18.5).abs() < 0.01);
}

/// The same calls give the same bytes; another seed gives others.
#[test]
fn a_seed_fixes_every_random_number() {
    let trace = |seed: u64| {
        let mut world = World::new(WorldConfig {
            plant: PlantKind::Stand,
            radio: RadioKind::Sbus,
            seed,
            imu_trial: None,
            ..WorldConfig::default()
        })
        .expect("no file is read");
        world.set_fault("sbus-noise", true).expect("listed");
        let mut bytes = Vec::new();
        for tick in 6..200 {
            let now = tick * 5 * MS;
            world.spi_select(SpiSelect::Gyro, true, now);
            world.spi_transfer(0x82, 5_250_000, 3, now);
            bytes.extend((0..6).map(|_| world.spi_transfer(0, 5_250_000, 3, now)));
            world.spi_select(SpiSelect::Gyro, false, now);
            bytes.extend(std::iter::from_fn(|| world.radio_char(now)).map(|c| c.byte));
        }
        world.advance(SECOND);
        bytes
    };
    assert_eq!(trace(1), trace(1));
    assert_ne!(trace(1), trace(2));
}

/// The robot must be drivable: a plain proportional loop, 30 A per m/s and at most 8 A, on the speeds that come back
/// over the bus.
#[test]
fn a_proportional_loop_over_the_bus_settles_on_both_plants() {
    for plant in [PlantKind::Stand, PlantKind::Rolling] {
        let mut world = world(plant, RadioKind::Sbus);
        let mut rim_mps = [0.0; 2];
        let mut settled: Vec<[f64; 2]> = Vec::new();
        for tick in 1..=3_000 {
            let now = tick * MS;
            world.advance(now);
            for (id, rpm) in take_feedback(&mut world, now) {
                let wheel_rps = f64::from(rpm) / (3_591.0 / 187.0) * std::f64::consts::TAU / 60.0;
                rim_mps[(id - 0x201) as usize] = wheel_rps * 0.075;
            }
            // Left 0.5 m/s forward; the right motor forward is negative, 0.7 m/s.
            let raw = |wanted_mps: f64, is_mps: f64| {
                let amperes = (30.0 * (wanted_mps - is_mps)).clamp(-8.0, 8.0);
                (amperes * 16_384.0 / 20.0) as i16
            };
            let (left, right) = (raw(0.5, rim_mps[0]), raw(-0.7, rim_mps[1]));
            command(&mut world, left, right, now);
            if tick > 2_000 {
                settled.push(rim_mps);
            }
        }
        for speeds in settled {
            assert!((speeds[0] / 0.5 - 1.0).abs() < 0.05, "{plant:?} {speeds:?}");
            assert!(
                (speeds[1] / -0.7 - 1.0).abs() < 0.05,
                "{plant:?} {speeds:?}"
            );
        }
    }
}
