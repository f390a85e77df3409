//! Errors in a scenario file, with the text that names what to write instead.

use crate::parameter_sectors::{MAX_VALUES, SLOTS};

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    #[error("{0}")]
    Toml(String),
    #[error("{0}")]
    Mounting(String),
    #[error("`seconds` is {0}; write a length between 0 and 3600")]
    Length(f64),
    #[error("`imu_temperature_c` is outside what the BMI088 works at; write -40 to 85")]
    ImuTemperature,
    #[error(
        "`{name}` is {t} s, outside the run; write a time from 0 to {seconds} or raise `seconds`"
    )]
    OutsideRun {
        name: &'static str,
        t: f64,
        seconds: f64,
    },
    #[error("flash has either an `image` or records; leave one of them out")]
    ImageAndRecords,
    #[error("the record of group {group} has more than {MAX_VALUES} values")]
    TooManyValues { group: u8 },
    #[error("a sector holds {SLOTS} records")]
    TooManyRecords,
    #[error(
        "this [[at]] does nothing; add `remote`, `pc`, `can`, `push`, `fault` or `end_fault`, or remove it"
    )]
    EmptyAt,
    #[error("`duration` belongs to a `fault`; name the fault")]
    DurationWithoutFault,
    #[error("`duration` is {0}; write seconds above 0")]
    BadDuration(f64),
    #[error("`{0}` is a stick: write −1 to 1")]
    Stick(&'static str),
    #[error("`mode` is a three-position switch: write 0, 1 or 2")]
    Mode,
    #[error("`{name}` is {value}; a frame carries {least} to {most}")]
    PcField {
        name: &'static str,
        value: f64,
        least: f64,
        most: f64,
    },
    #[error("`joints` is \"{0}\"; write \"hold\", \"limp\" or four angles in rad")]
    PcJoints(String),
    #[error("`rate_hz` is {0}; the line carries up to 1,200 frames a second")]
    PcRate(f64),
    #[error("{0}")]
    Robot(String),
    #[error("`robot` names its joints; leave `joints` out")]
    RobotAndJoints,
    #[error("`{name}` of the variation is {value}; write {least} to {most}")]
    Variation {
        name: &'static str,
        value: f64,
        least: f64,
        most: f64,
    },
    #[error(
        "a push has an `impulse_ns` of three numbers up to 100 N·s, an `at_m` up to 1 m, and `ms` from 1 to 1000"
    )]
    Push,
    #[error(
        "`{0}` is out of range: a drop is up to 10 m; a course has lengths from 0 to 1000 m along x, slopes up to 1.05 rad, up to \
         64 plates tilted by 0 to 1 rad, and a grip up to 2"
    )]
    NoPlace(&'static str),
    #[error("`{0}` belongs to `plant = \"free\"`: no other robot can fall or meet terrain")]
    NotFree(&'static str),
    #[error("`bus` is {0}; the board has 1 and 2")]
    Bus(u8),
    #[error("`id` is {0:#x}; a standard identifier ends at 0x7FF")]
    Identifier(u32),
    #[error("`data` is longer than the 8 bytes of a frame")]
    LongData,
    #[error("no fault is named `{name}`;{hint} `cargo xtask sim --list-faults` lists them")]
    UnknownFault { name: String, hint: String },
    #[error("`from` {from} comes after `to` {to}; swap them")]
    Swapped { from: f64, to: f64 },
    #[error("write either `from` and `to`, or `at`")]
    NoWindow,
    #[error(
        "nothing is expected of the signal; add one of `max_abs`, `min`, `max`, `equals`, \
         `within = [value, tolerance]`, `has_flag`, `lacks_flag`, `has_bit`, `lacks_bit`, \
         `rises_above`, `falls_below`"
    )]
    NoBound,
    #[error(
        "a bound is not finite, a tolerance is negative or a bit is above 31; write plain numbers"
    )]
    BadBound,
}
