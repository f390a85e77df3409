//! Measures the radio while it is switched on and off.

use super::verdict::{Measured, read};
use crate::tuning::{TuningClient, TuningError};

pub fn radio(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut found = Measured::default();
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
    let mut found = Measured::default();
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
