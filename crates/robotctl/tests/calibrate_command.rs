//! Runs `robotctl calibrate` as a user does, from files to values and plots.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

const UP: [[f64; 3]; 8] = [
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.6, 0.0, 0.8],
    [0.0, 0.8, -0.6],
];

fn directory(test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    // Remove the files of an earlier run.
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// Returns two seconds at 100 Hz on each side, from a sensor with an offset of 0.2 m/s² in x and a scale error of 1 %
/// in z.
fn accel_table(sides: &[[f64; 3]]) -> String {
    let mut text = String::from("t,ax,ay,az\n");
    for (row, side) in sides.iter().flat_map(|side| [side; 200]).enumerate() {
        let [x, y, z] = side.map(|part| part * 9.806_65);
        let (t, z) = (row as f64 * 0.01, z * 1.01);
        text.push_str(&format!("{t:.2},{:.5},{y:.5},{z:.5}\n", x + 0.2));
    }
    text
}

fn robotctl(directory: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_robotctl"));
    command.current_dir(directory).args(arguments);
    command.env("RUST_BACKTRACE", "0").output().unwrap()
}

fn value(directory: &Path, table: &str, key: &str) -> f64 {
    let text = fs::read_to_string(directory.join("calibration.toml")).unwrap();
    let file: toml::Table = text.parse().unwrap();
    file[table][key].as_float().unwrap()
}

#[test]
fn a_table_becomes_values_and_a_page() {
    let directory = directory("calibrate-accel");
    fs::write(directory.join("a.csv"), accel_table(&UP[..4])).unwrap();
    fs::write(directory.join("b.csv"), accel_table(&UP[4..])).unwrap();
    fs::write(
        directory.join("calibration.toml"),
        "[heater]\ntarget-c = 45.0\n",
    )
    .unwrap();

    let output = robotctl(&directory, &["calibrate", "accel", "a.csv", "b.csv"]);
    assert!(output.status.success(), "{output:?}");
    let found = |key| value(&directory, "imu-calibration", key);
    assert!((found("accel-bias-x-mps2") - 0.2).abs() < 1e-4);
    assert!((found("accel-scale-z") - 1.0 / 1.01).abs() < 1e-5);
    assert_eq!(value(&directory, "heater", "target-c"), 45.0, "others stay");
    let page = fs::read_to_string(directory.join("calibration-accel.html")).unwrap();
    assert!(page.contains("<svg") && page.contains("upside down"));
}

#[test]
fn the_correction_active_while_recording_is_removed() {
    let directory = directory("calibrate-again");
    fs::write(directory.join("a.csv"), accel_table(&UP)).unwrap();
    // The robot subtracted 0.1 from the sensor's value, so the true offset is 0.3.
    fs::write(
        directory.join("active.toml"),
        "[imu-calibration]\naccel-bias-x-mps2 = 0.1\n",
    )
    .unwrap();
    let arguments = ["calibrate", "accel", "a.csv", "--active", "active.toml"];
    assert!(robotctl(&directory, &arguments).status.success());
    let found = value(&directory, "imu-calibration", "accel-bias-x-mps2");
    assert!((found - 0.3).abs() < 1e-4, "{found}");
}

#[test]
fn a_missing_side_is_named_and_nothing_is_written() {
    let directory = directory("calibrate-missing");
    fs::write(directory.join("a.csv"), accel_table(&UP[1..])).unwrap();
    let output = robotctl(&directory, &["calibrate", "accel", "a.csv"]);
    assert!(!output.status.success());
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("missing: top up (+z)"), "{message}");
    assert!(!directory.join("calibration.toml").exists());
}

#[test]
fn a_magnetometer_table_becomes_values_and_a_page() {
    let directory = directory("calibrate-mag");
    let mut text = String::from("t,mx,my,mz\n");
    for row in 0..600 {
        // The field goes from pole to pole in fifteen turns. A magnet adds 30 µT in y. The stretch of x is twice as
        // large as the shrinkage of y and z.
        let (height, turn) = (1.0 - (f64::from(row) + 0.5) / 300.0, f64::from(row) * 0.157);
        let radius = (1.0 - height * height).sqrt();
        let [x, y, z] = [radius * turn.cos(), radius * turn.sin(), height].map(|v| v * 50.0);
        let t = f64::from(row) * 0.02;
        text.push_str(&format!(
            "{t},{:.4},{:.4},{:.4}\n",
            x * 1.21,
            y / 1.1 + 30.0,
            z / 1.1
        ));
    }
    fs::write(directory.join("m.csv"), text).unwrap();
    let output = robotctl(&directory, &["calibrate", "mag", "m.csv"]);
    assert!(output.status.success(), "{output:?}");
    let found = |key| value(&directory, "mag-calibration", key);
    assert!((found("bias-y-ut") - 30.0).abs() < 0.01);
    assert!((found("soft-iron-xx") - 1.0 / 1.21).abs() < 1e-4);
    assert!((found("soft-iron-zz") - 1.1).abs() < 1e-4);
    assert!(found("soft-iron-xy").abs() < 1e-4);
    let page = fs::read_to_string(directory.join("calibration-mag.html")).unwrap();
    assert!(page.matches("<circle").count() > 1_000);
}

/// Returns the same recording as other programs export it: a header, and the numbers of each field.
fn exported(
    header: &str,
    separator: &str,
    factors: [f64; 2],
    finish: impl Fn(String) -> String,
) -> String {
    let [time_factor, factor] = factors;
    let rows = accel_table(&UP);
    let rows = rows.lines().skip(1).map(|row| {
        let numbers = row.split(',').map(|field| field.parse::<f64>().unwrap());
        let fields = numbers.enumerate().map(|(place, number)| {
            let factor = if place == 0 { time_factor } else { factor };
            finish(format!("{:.6}", number * factor))
        });
        fields.collect::<Vec<_>>().join(separator)
    });
    let header = header.replace(' ', separator);
    std::iter::once(header)
        .chain(rows)
        .collect::<Vec<_>>()
        .join("\r\n")
}

#[test]
fn tables_of_other_programs_give_the_same_values() {
    const G: f64 = 1.0 / 9.806_65;
    let point = |text: String| text;
    let comma = |text: String| text.replace('.', ",");
    let names = "t ax ay az";
    for (case, table) in [
        ("semicolon", exported(names, ";", [1.0, 1.0], point)),
        ("german", exported(names, ";", [1.0, 1.0], comma)),
        ("tab", exported(names, "\t", [1.0, 1.0], point)),
        ("upper", exported("T AX AY AZ", ",", [1.0, 1.0], point)),
        ("g", exported(names, ",", [1.0, G], point)),
        ("ms", exported(names, ",", [1e3, 1.0], point)),
        ("us", exported(names, ",", [1e6, 1.0], point)),
        (
            "all",
            exported("Time Acc_X Acc_Y Acc_Z", ";", [1e3, G], comma),
        ),
    ] {
        let directory = directory(&format!("calibrate-{case}"));
        fs::write(directory.join("a.csv"), table).unwrap();
        let output = robotctl(&directory, &["calibrate", "accel", "a.csv"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{case}: {said}");
        let bias = value(&directory, "imu-calibration", "accel-bias-x-mps2");
        let scale = value(&directory, "imu-calibration", "accel-scale-z");
        assert!((bias - 0.2).abs() < 1e-3, "{case}: {bias}");
        assert!((scale - 1.0 / 1.01).abs() < 1e-3, "{case}: {scale}");
        let converted = ["g", "ms", "us", "all"].contains(&case);
        assert_eq!(said.contains("note: a.csv: "), converted, "{case}: {said}");
    }
}

#[test]
fn a_doubtful_table_is_refused_with_its_cause() {
    let directory = directory("calibrate-doubt");
    for (table, cause) in [
        (
            exported("t ax ay az", ",", [100.0, 1.0], |text| text),
            "`t_ms` or `t_us`",
        ),
        (
            exported("t ax ay az", ",", [1.0, 208.9], |text| text),
            "raw counts",
        ),
        (
            exported("t ax ay az", ",", [1.0, 1.0], |text| text.replace('.', ",")),
            "decimal commas",
        ),
    ] {
        fs::write(directory.join("a.csv"), table).unwrap();
        let output = robotctl(&directory, &["calibrate", "accel", "a.csv"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            !output.status.success() && said.contains(cause),
            "`{cause}` in {said}"
        );
    }
}
