//! Faults of radio, IMU and body, seen from the wires.

use robot_plant::{
    time::{MS, Ps, SECOND},
    world::{RadioKind, RemoteInput, SpiSelect, World, WorldConfig},
};

fn world(config: WorldConfig) -> World {
    World::new(config).expect("no file is read")
}

fn signal(world: &World, name: &str) -> f64 {
    world.signal(name).expect(name)
}

/// Whole frames on the radio line up to `end`, told apart by the gap after them.
fn frames(world: &mut World, end: Ps) -> Vec<Vec<u8>> {
    let mut frames: Vec<Vec<u8>> = Vec::new();
    let mut last = None;
    for at in (0..=end / MS).map(|ms| ms * MS) {
        while let Some(character) = world.radio_char(at) {
            let follows = last.is_some_and(|last| character.start < last + MS);
            if !follows {
                frames.push(Vec::new());
            }
            let frame = frames.last_mut().expect("one was begun");
            frame.push(character.byte);
            last = Some(character.start);
        }
    }
    frames
}

/// 1000 frames of 7 ms. A tenth of the lost ones' count is more than three standard deviations of it, for every share.
#[test]
fn a_share_of_the_sbus_frames_is_lost_half_flagged_half_missing() {
    for percent in (10..=90).step_by(10) {
        let mut world = world(WorldConfig {
            seed: 3,
            ..WorldConfig::default()
        });
        let name = format!("sbus-loss-{percent}");
        world.set_fault(&name, true).expect("listed");
        let frames = frames(&mut world, 7 * SECOND - MS);
        let flagged = frames.iter().filter(|frame| frame[23] == 0x04).count();
        let good = frames.iter().filter(|frame| frame[23] == 0x00).count();
        let missing = 1_000 - frames.len();
        assert_eq!(flagged + good, frames.len());
        assert!(frames.iter().all(|frame| frame.len() == 25));
        let half = 5.0 * f64::from(percent);
        let spread = 4.0 * half.sqrt();
        assert!(
            (flagged as f64 - half).abs() < spread,
            "{percent}: {flagged}"
        );
        assert!(
            (missing as f64 - half).abs() < spread,
            "{percent}: {missing}"
        );
    }
}

#[test]
fn lost_dbus_frames_are_not_sent() {
    let mut world = world(WorldConfig {
        radio: RadioKind::Dbus,
        ..WorldConfig::default()
    });
    world.set_fault("sbus-loss-50", true).expect("listed");
    let sent = frames(&mut world, 14 * SECOND - MS).len();
    assert!((435..=565).contains(&sent), "{sent}");
}

#[test]
fn a_receiver_without_packets_holds_the_last_sticks() {
    let mut world = world(WorldConfig::default());
    world.advance(MS);
    world.set_fault("sbus-failsafe", true).expect("listed");
    world.set_remote(RemoteInput {
        vx: Some(1.0),
        wz: Some(-1.0),
        enable: Some(true),
        ..RemoteInput::default()
    });
    let held = frames(&mut world, 20 * MS);
    assert_eq!(held[2][1..23], held[0][1..23]);
    world.set_fault("sbus-failsafe", false).expect("listed");
    let after = frames(&mut world, 27 * MS);
    assert_ne!(after[0][1..23], held[0][1..23]);
}

fn gyro_x(world: &mut World, now: Ps) -> i16 {
    world.spi_select(SpiSelect::Gyro, true, now);
    world.spi_transfer(0x82, 5_250_000, 3, now);
    let [low, high] = [0, 0].map(|byte| world.spi_transfer(byte, 5_250_000, 3, now));
    world.spi_select(SpiSelect::Gyro, false, now);
    i16::from_le_bytes([low, high])
}

#[test]
fn an_extreme_imu_reads_nothing_but_the_ends_of_its_range() {
    let mut world = world(WorldConfig::default());
    world.advance(100 * MS);
    world.set_fault("imu-extreme", true).expect("listed");
    world.advance(110 * MS);
    let mut seen = std::collections::BTreeSet::new();
    for tick in 0..100 {
        seen.insert(gyro_x(&mut world, (115 + 5 * tick) * MS));
    }
    assert_eq!(
        seen.into_iter().collect::<Vec<_>>(),
        [i16::MIN, -i16::MAX, i16::MAX]
    );
    world.set_fault("imu-extreme", false).expect("listed");
    let calm = gyro_x(&mut world, 700 * MS);
    assert!(calm.abs() < 100, "{calm}");
}

#[test]
fn a_body_tips_over_and_is_put_upright() {
    let mut world = world(WorldConfig::default());
    world.advance(100 * MS);
    world.set_fault("tilted", true).expect("listed");
    world.advance(400 * MS);
    assert!((signal(&world, "truth.imu.gy") - 2.0).abs() < 1e-9);
    world.advance(2 * SECOND);
    // sin and cos of 80° of 9.80665 m/s².
    assert!((signal(&world, "truth.imu.ax") + 9.6577).abs() < 1e-3);
    assert!((signal(&world, "truth.imu.az") - 1.7029).abs() < 1e-3);
    let upright = [1.0, 0.0, 0.0, 0.0];
    let error_deg = world.attitude_error_deg(upright).expect("truth is known");
    assert!((error_deg[2] - 80.0).abs() < 1e-6, "{error_deg:?}");
    world.set_fault("tilted", false).expect("listed");
    world.advance(4 * SECOND);
    assert_eq!(signal(&world, "truth.imu.ax"), 0.0);
}

#[test]
fn the_imu_starts_warm_unless_told_and_full_heat_adds_25_kelvin_to_the_board() {
    let mut warm = world(WorldConfig::default());
    assert_eq!(signal(&warm, "truth.imu.temperature_c"), 40.0);
    // Four time constants of the package.
    warm.set_heater_duty(1.0, 0);
    warm.advance(60 * SECOND);
    let warm_c = signal(&warm, "truth.imu.temperature_c");
    assert!((warm_c - 55.0).abs() < 0.6, "{warm_c}");
    let mut cold = world(WorldConfig {
        imu_temperature_c: Some(15.0),
        ..WorldConfig::default()
    });
    assert_eq!(signal(&cold, "truth.imu.temperature_c"), 15.0);
    cold.set_heater_duty(1.0, 0);
    cold.advance(60 * SECOND);
    let cold_c = signal(&cold, "truth.imu.temperature_c");
    assert!((cold_c - 40.0).abs() < 0.6, "{cold_c}");
}
