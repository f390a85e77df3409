//! What can go wrong with a bus, by name.

use std::{fmt, str::FromStr};

use thiserror::Error;

/// A fault. Probabilities are from 0 to 1, and servos are named by their place in the bus's list, from 0 on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// Bytes vanish, of the host and of servos.
    Drop {
        /// For each byte.
        probability: f64,
    },
    /// Bytes are changed.
    Corrupt {
        /// For each byte.
        probability: f64,
    },
    /// Bytes reach the host late, and those after them as well.
    Delay {
        /// For each byte.
        probability: f64,
        /// Delay, ns.
        by_ns: u64,
    },
    /// Whole requests or answers vanish.
    DropPacket {
        /// For each of them.
        probability: f64,
    },
    /// One byte of a request or an answer is changed.
    CorruptPacket {
        /// For each of them.
        probability: f64,
    },
    /// The host hears its own bytes, as behind an adapter that only ties both lines together.
    Echo,
    /// A servo has no power and is off the bus; at the fault's end it is plugged in again.
    Gone {
        /// Its place.
        servo: usize,
    },
    /// A servo writes another id into its answers.
    WrongId {
        /// Its place.
        servo: usize,
        /// The id that it writes.
        id: u8,
    },
    /// A servo has the id of another.
    DuplicateId {
        /// Its place.
        servo: usize,
        /// The id that it has until the fault ends.
        id: u8,
    },
    /// The supply breaks down for all servos; at the fault's end they start anew.
    BrownOut,
    /// The supply has another voltage.
    Supply {
        /// Supply of all servos, V.
        volts: f64,
    },
    /// A servo's shaft cannot turn.
    Blocked {
        /// Its place.
        servo: usize,
    },
    /// A servo is hot, and so is all around it.
    Hot {
        /// Its place.
        servo: usize,
        /// Temperature, °C.
        celsius: f64,
    },
}

/// A text that names no fault.
#[derive(Debug, Error)]
#[error("{text} is no fault: write {}", NAMES.join(", "))]
pub struct UnknownFault {
    text: String,
}

/// How faults are written. N counts servos from 1.
pub const NAMES: [&str; 13] = [
    "drop=0.5%",
    "corrupt=1%",
    "delay=1%:5ms",
    "drop-packet=0.5%",
    "corrupt-packet=1%",
    "echo",
    "gone=N",
    "wrong-id=N:ID",
    "duplicate-id=N:ID",
    "brown-out",
    "supply=7.4V",
    "blocked=N",
    "hot=N:80C",
];

impl FromStr for Fault {
    type Err = UnknownFault;

    fn from_str(text: &str) -> Result<Self, UnknownFault> {
        parse(text).ok_or_else(|| UnknownFault {
            text: text.to_owned(),
        })
    }
}

fn parse(text: &str) -> Option<Fault> {
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    let (first, second) = value.split_once(':').unwrap_or((value, ""));
    Some(match name {
        "drop" => Fault::Drop {
            probability: percent(value)?,
        },
        "corrupt" => Fault::Corrupt {
            probability: percent(value)?,
        },
        "delay" => Fault::Delay {
            probability: percent(first)?,
            by_ns: (number(second.strip_suffix("ms")?, 0.0, 60_000.0)? * 1e6) as u64,
        },
        "drop-packet" => Fault::DropPacket {
            probability: percent(value)?,
        },
        "corrupt-packet" => Fault::CorruptPacket {
            probability: percent(value)?,
        },
        "echo" if value.is_empty() => Fault::Echo,
        "gone" => Fault::Gone {
            servo: place(value)?,
        },
        "wrong-id" => Fault::WrongId {
            servo: place(first)?,
            id: second.parse().ok().filter(|id| *id <= 253)?,
        },
        "duplicate-id" => Fault::DuplicateId {
            servo: place(first)?,
            id: second.parse().ok().filter(|id| *id <= 253)?,
        },
        "brown-out" if value.is_empty() => Fault::BrownOut,
        "supply" => Fault::Supply {
            volts: number(value.strip_suffix('V')?, 0.0, 30.0)?,
        },
        "blocked" => Fault::Blocked {
            servo: place(value)?,
        },
        "hot" => Fault::Hot {
            servo: place(first)?,
            celsius: number(second.strip_suffix('C')?, -40.0, 150.0)?,
        },
        _ => return None,
    })
}

fn percent(text: &str) -> Option<f64> {
    Some(number(text.strip_suffix('%')?, 0.0, 100.0)? / 100.0)
}

fn number(text: &str, least: f64, most: f64) -> Option<f64> {
    let number: f64 = text.parse().ok()?;
    (least..=most).contains(&number).then_some(number)
}

fn place(text: &str) -> Option<usize> {
    text.parse::<usize>().ok()?.checked_sub(1)
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |probability: &f64| probability * 100.0;
        match self {
            Self::Drop { probability } => write!(f, "drop={}%", percent(probability)),
            Self::Corrupt { probability } => write!(f, "corrupt={}%", percent(probability)),
            Self::Delay { probability, by_ns } => {
                let milliseconds = *by_ns as f64 / 1e6;
                write!(f, "delay={}%:{milliseconds}ms", percent(probability))
            }
            Self::DropPacket { probability } => write!(f, "drop-packet={}%", percent(probability)),
            Self::CorruptPacket { probability } => {
                write!(f, "corrupt-packet={}%", percent(probability))
            }
            Self::Echo => f.write_str("echo"),
            Self::Gone { servo } => write!(f, "gone={}", servo + 1),
            Self::WrongId { servo, id } => write!(f, "wrong-id={}:{id}", servo + 1),
            Self::DuplicateId { servo, id } => write!(f, "duplicate-id={}:{id}", servo + 1),
            Self::BrownOut => f.write_str("brown-out"),
            Self::Supply { volts } => write!(f, "supply={volts}V"),
            Self::Blocked { servo } => write!(f, "blocked={}", servo + 1),
            Self::Hot { servo, celsius } => write!(f, "hot={}:{celsius}C", servo + 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_read_as_it_is_written() {
        for text in [
            "drop=0.5%",
            "corrupt=1%",
            "delay=1%:5ms",
            "drop-packet=0.5%",
            "corrupt-packet=1%",
            "echo",
            "gone=3",
            "wrong-id=2:9",
            "duplicate-id=6:1",
            "brown-out",
            "supply=7.4V",
            "blocked=2",
            "hot=1:80C",
        ] {
            let fault: Fault = text.parse().expect("a fault");
            assert_eq!(fault.to_string(), text);
        }
    }

    #[test]
    fn what_is_no_fault_is_answered_with_the_list() {
        for text in [
            "",
            "drop",
            "drop=2",
            "drop=101%",
            "drop=NaN%",
            "gone=0",
            "gone=-1",
            "echo=1",
            "hot=1:9000C",
            "wrong-id=1:254",
            "delay=1%:5",
        ] {
            let error = text.parse::<Fault>().expect_err(text);
            assert!(error.to_string().contains("brown-out"), "{error}");
        }
    }
}
