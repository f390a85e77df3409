//! A record played through the sensors, read back over their wires.

use std::{io::Write, path::PathBuf};

use robot_plant::{
    time::{MS, Ps, SECOND, US},
    world::{PlantKind, RadioKind, SpiSelect, World, WorldConfig, WorldError},
};

const ROWS: usize = 2_000;
const COLUMNS: [&str; 15] = [
    "t", "gx", "gy", "gz", "ax", "ay", "az", "mx", "my", "mz", "qw", "qx", "qy", "qz", "mov",
];
const GAP: std::ops::Range<usize> = 700..800;
const FAILED: std::ops::Range<usize> = 900..950;

/// A body turning about the vertical at `rate_dps` from row 400 on; the x axis carries the row's number as a rate of
/// one count of ±2000 °/s a row, the field's x axis as 1 µT a row. The y axis turns at 100 °/s. Cameras are blind in
/// `GAP`, and the gyro's y axis fails in `FAILED`.
fn write_trial(name: &str, rate_dps: f64) -> PathBuf {
    let value = |column: &str, row: usize| -> f64 {
        let turned_s = row.saturating_sub(400) as f64 / 200.0;
        let (sin, cos) = (rate_dps * turned_s / 2.0).to_radians().sin_cos();
        let seen = if GAP.contains(&row) { f64::NAN } else { 1.0 };
        match column {
            "t" => row as f64 / 200.0,
            "gx" => (row as f64 / 16.384).to_radians(),
            "gy" if FAILED.contains(&row) => f64::NAN,
            "gy" => 100_f64.to_radians(),
            "mx" => row as f64,
            "gz" => rate_dps.to_radians() * f64::from(row > 400),
            "az" => 9.80665,
            "my" => 30.0,
            "mz" => -60.0,
            "qw" => cos * seen,
            "qz" => sin * seen,
            "mov" => f64::from(row >= 400),
            _ => 0.0,
        }
    };
    let header_path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.json"));
    let columns: Vec<String> = COLUMNS.iter().map(|name| format!("\"{name}\"")).collect();
    let header = format!(
        "{{\"rows\": {ROWS}, \"rate_num\": 200, \"rate_den\": 1, \"columns\": [{}]}}",
        columns.join(",")
    );
    std::fs::write(&header_path, header).expect("temporary folder is writable");
    let data = std::fs::File::create(header_path.with_extension("f32.gz"))
        .expect("temporary folder is writable");
    let mut encoder = flate2::write::GzEncoder::new(data, flate2::Compression::fast());
    for column in COLUMNS {
        for row in 0..ROWS {
            encoder
                .write_all(&(value(column, row) as f32).to_le_bytes())
                .expect("disk has room");
        }
    }
    encoder.finish().expect("disk has room");
    header_path
}

fn play(trial: PathBuf) -> Result<World, WorldError> {
    World::new(WorldConfig {
        plant: PlantKind::Stand,
        radio: RadioKind::Sbus,
        seed: 1,
        imu_trial: Some(trial),
        ..WorldConfig::default()
    })
}

fn write_gyro(world: &mut World, register: u8, value: u8, now: Ps) {
    world.spi_select(SpiSelect::Gyro, true, now);
    world.spi_transfer(register, 5_250_000, 3, now);
    world.spi_transfer(value, 5_250_000, 3, now);
    world.spi_select(SpiSelect::Gyro, false, now);
}

fn read_gyro(world: &mut World, now: Ps) -> [i16; 3] {
    world.spi_select(SpiSelect::Gyro, true, now);
    world.spi_transfer(0x80, 5_250_000, 3, now);
    // One burst from the chip id on.
    let bytes: [u8; 8] = std::array::from_fn(|_| world.spi_transfer(0, 5_250_000, 3, now));
    world.spi_select(SpiSelect::Gyro, false, now);
    assert_eq!(bytes[0], 0x0F);
    std::array::from_fn(|axis| i16::from_le_bytes([bytes[2 * axis + 2], bytes[2 * axis + 3]]))
}

/// Boots a 200 Hz sampler that is `phase` off any grid, and hands over every sample after the lead-in.
fn sample(world: &mut World, phase: Ps, mut each: impl FnMut(&World, Ps, [i16; 3])) {
    write_gyro(world, 0x10, 0x83, 40 * MS + phase);
    for tick in 10..2_150 {
        // A real board is never quite on time.
        let late = (tick * 7_919 % 23) * US;
        let now = tick * 5 * MS + phase + late;
        let counts = read_gyro(world, now);
        if tick >= 202 {
            each(world, now, counts);
        }
    }
}

/// The row in force `delay` before `now`, rows taken as a steady climb: at the middle of its interval the row itself.
fn row_at(now: Ps, delay_s: f64) -> f64 {
    (now as f64 / SECOND as f64 - 1.0 - delay_s) * 200.0 + 0.5
}

/// On a steady climb a low-pass lags by its group delay at 0 Hz: √2 / (2π · 47 Hz) for a Butterworth of second order.
#[test]
fn gyro_shows_the_motion_late_by_its_filter() {
    let trial = write_trial("late_by_its_filter", 0.0);
    let filter_s = std::f64::consts::SQRT_2 / (std::f64::consts::TAU * 47.0);
    for phase in [0, 137 * US, 1_250 * US, 3_333 * US, 4_999 * US] {
        let mut world = play(trial.clone()).expect("trial was just written");
        sample(&mut world, phase, |_, now, [counts, _, _]| {
            let expected = row_at(now, filter_s);
            let steady = (10.0..900.0).contains(&expected) || (960.0..1_990.0).contains(&expected);
            if !steady {
                return;
            }
            let late = expected - f64::from(counts);
            // The last sample is up to 2.5 ms old, half a row; then the count is rounded.
            assert!((-0.6..1.1).contains(&late), "phase {phase} ps: {late} rows");
        });
    }
}

#[test]
fn where_a_sensor_of_the_recorder_failed_its_last_value_stays() {
    let mut world = play(write_trial("failed", 0.0)).expect("trial was just written");
    sample(&mut world, 0, |_, _, [_, counts, _]| {
        assert_eq!(counts, 1_638);
    });
}

#[test]
fn attitude_integrated_from_the_samples_agrees_with_the_reference() {
    let rate_dps = 60.0;
    let mut world = play(write_trial("agrees", rate_dps)).expect("trial was just written");
    let mut turned_deg = 0.0;
    let (mut scored, mut gaps) = (0, 0);
    sample(&mut world, 2_100 * US, |world, _, [_, _, counts]| {
        turned_deg += f64::from(counts) / 16.384 / 200.0;
        let (sin, cos) = f64::to_radians(turned_deg / 2.0).sin_cos();
        match world.attitude_error_deg([cos, 0.0, 0.0, sin]) {
            // A sample is the mean over the 5 ms around an instant 4.8 ms to 7.3 ms ago: at most 0.3° of rotation.
            Some([total, heading, inclination]) => {
                assert!(total < 0.35 && heading < 0.35, "{total} {heading}");
                assert!(inclination < 1e-6);
                scored += 1;
            }
            None => gaps += 1,
        }
    });
    assert!(scored > 1_800, "{scored}");
    assert!(gaps >= GAP.len(), "{gaps}");
}

fn write_mag(world: &mut World, register: u8, value: u8, now: Ps) {
    assert!(world.i2c_address(0x0E, false, 400_000, now));
    assert!(world.i2c_write(register, now) && world.i2c_write(value, now));
    world.i2c_stop(now);
}

fn read_mag_x(world: &mut World, now: Ps) -> i16 {
    assert!(world.i2c_address(0x0E, false, 400_000, now));
    assert!(world.i2c_write(0x03, now));
    assert!(world.i2c_address(0x0E, true, 400_000, now));
    let bytes = [0, 0].map(|_| world.i2c_read(true, now));
    world.i2c_stop(now);
    i16::from_le_bytes(bytes)
}

#[test]
fn magnetometer_averages_the_field_over_its_conversion() {
    let mut world = play(write_trial("field", 0.0)).expect("trial was just written");
    write_mag(&mut world, 0x41, 0x24, 100 * MS);
    for shot in 0..200 {
        let start = SECOND + 200 * MS + shot * 20_370 * US;
        write_mag(&mut world, 0x0A, 0x01, start);
        let field_ut = f64::from(read_mag_x(&mut world, start + 7 * MS)) * 0.3;
        let expected = row_at(start + 3 * MS, 0.0);
        // Half a count, and the steps of the rows under a mean over little more than one of them.
        assert!(
            (field_ut - expected).abs() < 0.3,
            "{field_ut} against {expected}"
        );
    }
}

#[test]
fn lead_in_is_the_records_rest_played_backwards() {
    let mut world = play(write_trial("lead_in", 90.0)).expect("trial was just written");
    let mut values = Vec::new();
    let index = |name: &str, world: &World| {
        world
            .signal_names()
            .iter()
            .position(|signal| signal == name)
            .expect("signal exists while a record plays")
    };
    let (time, rate) = (
        index("truth.trial.t", &world),
        index("truth.imu.gx", &world),
    );
    world.advance(SECOND / 2 + MS);
    world.sample(&mut values);
    assert!((values[time] + 0.499).abs() < 1e-9);
    assert!((values[rate].to_degrees() * 16.384 - 99.0).abs() < 0.01);
    assert!(world.attitude_error_deg([1.0, 0.0, 0.0, 0.0]).is_none());
}

#[test]
fn the_error_of_a_broken_trial_names_the_file_and_the_defect() {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("absent.json");
    let error = play(path).err().expect("file is absent").to_string();
    assert!(error.contains("absent.json"), "{error}");
    let path = write_trial("short", 0.0);
    let header = std::fs::read_to_string(&path).expect("just written");
    std::fs::write(&path, header.replace("2000", "2001")).expect("writable");
    let error = play(path).err().expect("a row is missing").to_string();
    assert!(error.contains("bytes"), "{error}");
}
