//! Measures the board itself: start, battery, clock, watchdog, heater and flash.

use super::verdict::{Measured, Verdict, read, vector};
use crate::tuning::{TuningClient, TuningError};

pub fn boot(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::default();
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
    let mut found = Measured::default();
    let volts = found.value(&read(client, "power", 0)?, "battery-v");
    found.must(volts > 0.0, || "no voltage is measured".to_owned());
    if found.verdict == Verdict::AsItMustBe {
        found.verdict = Verdict::ForTheUser;
    }
    Ok(found)
}

pub fn jitter(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::default();
    let tick = read(client, "tick", 0)?;
    let cycles = found.value(&tick, "max-jitter-cycles");
    found.must(cycles > 0.0, || "the cycle counter does not run".to_owned());
    // 840 cycles are 5 µs.
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
    let mut found = Measured::default();
    let cause = read(client, "boot", 0)?.choice("reset-cause");
    found.must(cause == "watchdog", || {
        format!("the last reset was by {cause}")
    });
    found.word("reset-cause", cause);
    Ok(found)
}

pub fn heater(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::default();
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
    let mut found = Measured::default();
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
