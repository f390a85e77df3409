//! Which tasks are late, and what a dying firmware tells the next boot.

/// Tasks below the control tick that missed their deadline. While one is late the robot stops and the watchdog starves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct LateTasks {
    pub imu: bool,
    pub mag: bool,
    pub sbus: bool,
    pub logic: bool,
    pub status: bool,
    pub params: bool,
}

impl LateTasks {
    pub fn any(self) -> bool {
        self.imu | self.mag | self.sbus | self.logic | self.status | self.params
    }

    /// What to tell the next boot. Of several late tasks the one of the highest priority, because it may starve the
    /// others.
    pub const fn last_words(self) -> LastWords {
        if self.imu {
            LastWords::ImuLate
        } else if self.mag {
            LastWords::MagLate
        } else if self.sbus {
            LastWords::SbusLate
        } else if self.logic {
            LastWords::LogicLate
        } else if self.status {
            LastWords::StatusLate
        } else if self.params {
            LastWords::ParamsLate
        } else {
            LastWords::Silent
        }
    }
}

/// Why the run before this one ended, in its own words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum LastWords {
    /// Nothing was said: power-on, reset pin, or a control tick that hangs.
    #[default]
    Silent = 0,
    Panic = 1,
    HardFault = 2,
    /// An exception or interrupt without a handler.
    UnexpectedInterrupt = 3,
    ImuLate = 4,
    MagLate = 5,
    SbusLate = 6,
    LogicLate = 7,
    StatusLate = 8,
    ParamsLate = 9,
}

impl LastWords {
    const ALL: [Self; 10] = [
        Self::Silent,
        Self::Panic,
        Self::HardFault,
        Self::UnexpectedInterrupt,
        Self::ImuLate,
        Self::MagLate,
        Self::SbusLate,
        Self::LogicLate,
        Self::StatusLate,
        Self::ParamsLate,
    ];

    /// For memory that survives the reset.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// `None` unless `code` is one that [`code`](Self::code) gives.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|words| words.code() == code)
    }

    pub const fn text(self) -> &'static str {
        match self {
            Self::Silent => "nothing was reported",
            Self::Panic => "panic",
            Self::HardFault => "hard fault",
            Self::UnexpectedInterrupt => "unexpected interrupt",
            Self::ImuLate => "task imu was late",
            Self::MagLate => "task mag was late",
            Self::SbusLate => "task sbus was late",
            Self::LogicLate => "task logic was late",
            Self::StatusLate => "task status was late",
            Self::ParamsLate => "task params was late",
        }
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for LastWords {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{=str}", self.text());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_survives_its_code_and_nothing_else_is_one() {
        let known: Vec<u8> = (0..=u8::MAX)
            .filter(|&code| LastWords::from_code(code).is_some())
            .collect();
        assert_eq!(known, (0..=9).collect::<Vec<u8>>());
        for code in known {
            assert_eq!(LastWords::from_code(code).map(LastWords::code), Some(code));
        }
    }

    #[test]
    fn a_late_task_names_itself() {
        let named = |late: LateTasks| late.last_words().text();
        let none = LateTasks::default();
        assert!(!none.any());
        assert_eq!(none.last_words(), LastWords::Silent);
        for (late, name) in [
            (LateTasks { imu: true, ..none }, "imu"),
            (LateTasks { mag: true, ..none }, "mag"),
            (LateTasks { sbus: true, ..none }, "sbus"),
            (
                LateTasks {
                    logic: true,
                    ..none
                },
                "logic",
            ),
            (
                LateTasks {
                    status: true,
                    ..none
                },
                "status",
            ),
            (
                LateTasks {
                    params: true,
                    ..none
                },
                "params",
            ),
        ] {
            assert!(late.any());
            assert_eq!(named(late), format!("task {name} was late"));
        }
    }
}
