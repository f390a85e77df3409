//! What the tool finds out by itself from the robot's live pages.

use std::{
    thread,
    time::{Duration, Instant},
};

use robot_app::tuning::{JOINTS, WHEELS};

use crate::tuning::{LiveReading, TuningClient, TuningError, live_page};

#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    AsItMustBe,
    Wrong(String),
    /// Only the user can tell.
    ForTheUser,
}

/// Values with their names, and what they say.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    pub values: Vec<(String, f64)>,
    pub words: Vec<(String, String)>,
    pub verdict: Verdict,
}

impl Measured {
    fn new() -> Self {
        Self {
            values: Vec::new(),
            words: Vec::new(),
            verdict: Verdict::AsItMustBe,
        }
    }

    /// Notes a number; NaN if the robot does not know it.
    fn value(&mut self, reading: &LiveReading, field: &str) -> f64 {
        let value = reading.number(field).unwrap_or(f64::NAN);
        self.values.push((field.to_owned(), value));
        value
    }

    fn word(&mut self, name: &str, word: String) {
        self.words.push((name.to_owned(), word));
    }

    /// The first thing that is wrong counts.
    fn must(&mut self, holds: bool, otherwise: impl FnOnce() -> String) {
        if !holds && self.verdict == Verdict::AsItMustBe {
            self.verdict = Verdict::Wrong(otherwise());
        }
    }
}

pub type Measuring = fn(&mut TuningClient) -> Result<Measured, TuningError>;

fn read(client: &mut TuningClient, page: &str, part: usize) -> Result<LiveReading, TuningError> {
    client
        .live(live_page(page), part)?
        .ok_or(TuningError::TooOld)
}

pub fn boot(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let version = read(client, "version", 0)?;
    for part in ["major", "minor", "patch"] {
        found.value(&version, part);
    }
    found.word("joint-motors", version.choice("joint-motors"));
    let boot = read(client, "boot", 0)?;
    let (cause, words) = (boot.choice("reset-cause"), boot.choice("last-words"));
    let calm = ["power-on", "reset-pin", "software"].contains(&cause.as_str());
    found.must(calm, || format!("the last reset was by {cause}"));
    let silent = words == "nothing was reported";
    found.must(silent, || format!("before the last reset: {words}"));
    found.word("reset-cause", cause);
    found.word("last-words", words);
    let run = read(client, "run", 0)?;
    found.value(&run, "uptime-s");
    let missed = found.value(&run, "missed-ticks");
    found.must(missed == 0.0, || {
        format!("{missed} control ticks were missed")
    });
    let sensors = read(client, "sensors", 0)?;
    for sensor in ["imu", "mag"] {
        found.must(sensors.has("ready", sensor), || {
            format!("{sensor} does not answer")
        });
    }
    Ok(found)
}

pub fn battery(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let volts = found.value(&read(client, "power", 0)?, "battery-v");
    found.must(volts > 0.0, || "no voltage is measured".to_owned());
    if found.verdict == Verdict::AsItMustBe {
        found.verdict = Verdict::ForTheUser;
    }
    Ok(found)
}

pub fn radio(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let radio = read(client, "radio", 0)?;
    let rate = found.value(&radio, "rate-hz");
    let quality = found.value(&radio, "quality-percent");
    let age = found.value(&radio, "age-ms");
    let line = read(client, "radio-line", 0)?;
    let bytes = found.value(&line, "bytes");
    let errors = read(client, "radio-errors", 0)?;
    for kind in ["parity", "framing", "noise", "overrun"] {
        found.value(&errors, kind);
    }
    found.must(bytes > 0.0, || {
        "no byte came on the radio's line".to_owned()
    });
    found.must(age < 100.0, || {
        "bytes, but no frame: other protocol, baud rate or inversion?".to_owned()
    });
    found.must((55.0..=170.0).contains(&rate), || {
        format!("{rate} frames a second")
    });
    found.must(quality >= 95.0, || {
        format!("only {quality} % of the frames are good")
    });
    Ok(found)
}

pub fn radio_off(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let radio = read(client, "radio", 0)?;
    found.value(&radio, "rate-hz");
    found.value(&radio, "age-ms");
    let failsafe = radio.has("marks", "failsafe");
    found.word("failsafe", failsafe.to_string());
    let flags = read(client, "safety", 0)?.set("flags");
    let noticed = flags
        .iter()
        .any(|flag| flag == "remote-lost" || flag == "remote-failsafe");
    found.must(noticed, || {
        "the receiver goes on sending as if nothing had happened: set its failsafe to \"no pulses\" or \"cut\", never \
         \"hold\""
            .to_owned()
    });
    found.word("flags", flags.join(" "));
    Ok(found)
}

/// Two seconds of all joints, disarmed.
pub fn joints_answer(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let mut oldest_ms = [0.0_f64; JOINTS.len()];
    let end = Instant::now() + LOOK;
    loop {
        for (part, name) in JOINTS.iter().enumerate() {
            let joint = read(client, "joint", part)?;
            let state = joint.choice("state");
            found.must(state == "disabled", || format!("{name} is {state}"));
            found.must(!joint.has("marks", "gives-torque"), || {
                format!("{name} reports that it gives torque, though it was told to be off")
            });
            let health = read(client, "joint-health", part)?;
            let age_ms = health.number("age-ms").unwrap_or(f64::INFINITY);
            oldest_ms[part] = oldest_ms[part].max(age_ms);
        }
        if Instant::now() >= end {
            break;
        }
    }
    for (name, oldest_ms) in JOINTS.iter().zip(oldest_ms) {
        found.values.push((format!("{name}-oldest-ms"), oldest_ms));
        found.must(oldest_ms <= 10.0, || {
            format!("{name} was silent for {oldest_ms} ms")
        });
    }
    Ok(found)
}

pub fn wheels_heard(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    for (part, name) in WHEELS.iter().enumerate() {
        let wheel = read(client, "wheel", part)?;
        let age = wheel.number("age-ms").unwrap_or(f64::INFINITY);
        found.values.push((format!("{name}-age-ms"), age));
        found.must(age <= 10.0, || format!("the {name} wheel is not heard"));
        let rpm = wheel.number("rotor-rpm").unwrap_or(f64::NAN);
        found.values.push((format!("{name}-rotor-rpm"), rpm));
    }
    Ok(found)
}

const LOOK: Duration = if cfg!(test) {
    Duration::ZERO
} else {
    Duration::from_secs(2)
};
/// To turn the board by hand.
const TURN: Duration = if cfg!(test) {
    Duration::ZERO
} else {
    Duration::from_secs(5)
};
const CIRCLE: Duration = if cfg!(test) {
    Duration::ZERO
} else {
    Duration::from_secs(15)
};
const PAUSE: Duration = Duration::from_millis(20);
const AXES: [&str; 3] = ["x", "y", "z"];

fn vector(
    found: &mut Measured,
    client: &mut TuningClient,
    page: &str,
    unit: &str,
) -> Result<[f64; 3], TuningError> {
    let reading = read(client, page, 0)?;
    Ok(AXES.map(|axis| found.value(&reading, &format!("{axis}-{unit}"))))
}

/// Gravity must pull along one axis only. The magnetometer's values are noted for whoever reads the report.
fn gravity_on(client: &mut TuningClient, axis: usize, sign: f64) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let accel = vector(&mut found, client, "accel", "mps2")?;
    vector(&mut found, client, "mag", "ut")?;
    let along = sign * accel[axis];
    let others = (0..3).filter(|other| *other != axis);
    let across = others.map(|other| accel[other].abs()).fold(0.0, f64::max);
    found.must((9.0..=10.6).contains(&along) && across < 2.5, || {
        format!(
            "{} must be about {:+} and the other axes about 0",
            AXES[axis],
            sign * 9.8
        )
    });
    Ok(found)
}

pub fn flat(client: &mut TuningClient) -> Result<Measured, TuningError> {
    gravity_on(client, 2, 1.0)
}

pub fn upside_down(client: &mut TuningClient) -> Result<Measured, TuningError> {
    gravity_on(client, 2, -1.0)
}

pub fn nose_up(client: &mut TuningClient) -> Result<Measured, TuningError> {
    gravity_on(client, 0, 1.0)
}

pub fn left_up(client: &mut TuningClient) -> Result<Measured, TuningError> {
    gravity_on(client, 1, 1.0)
}

/// The fastest rate of each axis while the board is turned to the left.
pub fn left_turn(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let mut fastest = [0.0_f64; 3];
    let end = Instant::now() + TURN;
    loop {
        let gyro = read(client, "gyro", 0)?;
        for (fastest, axis) in fastest.iter_mut().zip(AXES) {
            let rate = gyro.number(&format!("{axis}-dps")).unwrap_or(f64::NAN);
            if rate.is_nan() || rate.abs() > fastest.abs() {
                *fastest = rate;
            }
        }
        if Instant::now() >= end {
            break;
        }
        thread::sleep(PAUSE);
    }
    for (axis, fastest) in AXES.iter().zip(fastest) {
        found.values.push((format!("fastest-{axis}-dps"), fastest));
    }
    let [x, y, z] = fastest;
    found.must(z > 20.0 && x.abs() < z / 2.0 && y.abs() < z / 2.0, || {
        "z must be positive and by far the fastest: a turn to the left, seen from above".to_owned()
    });
    Ok(found)
}

/// A full circle to the left that begins with the nose to the north. Iron that turns along only moves the circle's
/// middle.
pub fn circle(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut path = Vec::new();
    let end = Instant::now() + CIRCLE;
    while path.is_empty() || Instant::now() < end {
        let field = read(client, "mag", 0)?;
        let [x, y, z] = AXES.map(|axis| field.number(&format!("{axis}-ut")));
        if let (Some(x), Some(y), Some(z)) = (x, y, z) {
            path.push([x, y, z]);
        }
        thread::sleep(PAUSE);
        if path.is_empty() && Instant::now() >= end {
            break;
        }
    }
    Ok(circle_of(&path))
}

fn circle_of(path: &[[f64; 3]]) -> Measured {
    let mut found = Measured::new();
    let middle = |axis: usize| {
        let of_axis = || path.iter().map(move |field| field[axis]);
        let (low, high) = (
            of_axis().fold(f64::MAX, f64::min),
            of_axis().fold(f64::MIN, f64::max),
        );
        (low + high) / 2.0
    };
    let (x, y) = (middle(0), middle(1));
    let angles: Vec<f64> = path
        .iter()
        .map(|field| (field[1] - y).atan2(field[0] - x).to_degrees())
        .collect();
    let step = |pair: &[f64]| (pair[1] - pair[0] + 180.0).rem_euclid(360.0) - 180.0;
    let turned: f64 = angles.windows(2).map(step).sum();
    let began = angles.first().copied().unwrap_or(f64::NAN);
    let radius = path
        .first()
        .map_or(f64::NAN, |field| (field[0] - x).hypot(field[1] - y));
    found.values.push(("north-at-first-deg".to_owned(), began));
    found.values.push(("north-turned-deg".to_owned(), turned));
    found.values.push(("horizontal-ut".to_owned(), radius));
    found.values.push((
        "z-ut".to_owned(),
        path.first().map_or(f64::NAN, |field| field[2]),
    ));
    found.must(!path.is_empty(), || {
        "the magnetometer shows nothing".to_owned()
    });
    found.must((-450.0..=-270.0).contains(&turned), || {
        format!("north must turn by -360 deg in the robot's axes, to the right: it turned by {turned:.0}")
    });
    found.must(began.abs() < 40.0, || {
        format!("at first north must be ahead (x, 0 deg): it was at {began:.0} deg, left is +90")
    });
    found
}

pub fn jitter(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let tick = read(client, "tick", 0)?;
    let cycles = found.value(&tick, "max-jitter-cycles");
    found.must(cycles > 0.0, || "the cycle counter does not run".to_owned());
    // 5 µs.
    found.must(cycles <= 840.0, || {
        format!("{cycles} cycles are more than 840, 5 us")
    });
    let boot = read(client, "boot", 0)?;
    found.value(&boot, "max-jitter-us");
    let missed = found.value(&read(client, "run", 0)?, "missed-ticks");
    found.must(missed == 0.0, || {
        format!("{missed} control ticks were missed")
    });
    Ok(found)
}

pub fn watchdog(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let cause = read(client, "boot", 0)?.choice("reset-cause");
    found.must(cause == "watchdog", || {
        format!("the last reset was by {cause}")
    });
    found.word("reset-cause", cause);
    Ok(found)
}

pub fn heater(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let imu = read(client, "imu", 0)?;
    found.value(&imu, "temperature-c");
    found.value(&imu, "heater-percent");
    found.value(&read(client, "run", 0)?, "uptime-s");
    found.word("heater", imu.choice("heater"));
    let calibration = imu.choice("calibration");
    found.must(calibration == "done", || {
        format!("gyro calibration: {calibration}")
    });
    found.word("calibration", calibration);
    vector(&mut found, client, "gyro-bias", "dps")?;
    Ok(found)
}

pub fn erase(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let boot = read(client, "boot", 0)?;
    let stalls = found.value(&boot, "stalls");
    let longest = found.value(&boot, "longest-stall-ms");
    found.must(stalls > 0.0, || {
        "no sector was erased since boot".to_owned()
    });
    found.must((100.0..=600.0).contains(&longest), || {
        format!("{longest} ms")
    });
    let saved = client.store()?.is_some_and(|store| store.is_saved());
    found.must(saved, || "not everything is saved".to_owned());
    Ok(found)
}

pub fn after_an_hour(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::new();
    let uptime = found.value(&read(client, "run", 0)?, "uptime-s");
    found.must(uptime >= 3_600.0, || {
        "the robot has not run for an hour yet".to_owned()
    });
    let rejects = read(client, "rejects", 0)?;
    for why in ["absent", "frozen", "implausible", "saturated"] {
        found.value(&rejects, why);
    }
    let sensors = read(client, "sensors", 0)?;
    for count in ["imu-errors", "mag-errors", "imu-restarts", "mag-restarts"] {
        found.value(&sensors, count);
    }
    let buffer = read(client, "gyro-buffer", 0)?;
    for count in ["spikes", "differences", "resets", "overruns"] {
        found.value(&buffer, count);
    }
    let turned = left_turn(client)?;
    found.values.extend(turned.values);
    if found.verdict == Verdict::AsItMustBe {
        found.verdict = turned.verdict;
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of 10° to the left from north, 20 µT horizontal beside iron of (35, −50) µT. After 90° the nose points west and
    /// north is to the right, −y.
    fn path(begin_deg: f64, step_deg: f64, mirrored: bool) -> Vec<[f64; 3]> {
        let place = |step: i32| {
            let angle = (begin_deg + step_deg * f64::from(step)).to_radians();
            let side = if mirrored { -1.0 } else { 1.0 };
            [
                35.0 + 20.0 * angle.cos(),
                -50.0 + side * 20.0 * angle.sin(),
                -40.0,
            ]
        };
        (0..=36).map(place).collect()
    }

    fn complaint(path: &[[f64; 3]]) -> Option<String> {
        match circle_of(path).verdict {
            Verdict::AsItMustBe => None,
            Verdict::Wrong(why) => Some(why),
            Verdict::ForTheUser => panic!("it can be told"),
        }
    }

    #[test]
    fn a_circle_tells_the_magnetometer_s_axes_in_spite_of_iron() {
        assert_eq!(complaint(&path(0.0, -10.0, false)), None);
        let mirrored = complaint(&path(0.0, -10.0, true)).unwrap();
        assert!(mirrored.contains("it turned by 360"), "{mirrored}");
        let turned = complaint(&path(90.0, -10.0, false)).unwrap();
        assert!(turned.contains("it was at 90 deg"), "{turned}");
        let still = complaint(&path(0.0, 0.0, false)).unwrap();
        assert!(still.contains("it turned by 0"), "{still}");
        assert!(complaint(&[]).is_some());
    }
}
