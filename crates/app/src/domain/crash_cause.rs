//! Late tasks, and the cause of a crash as recorded for the next boot.

/// Tasks that missed their deadline. While one is late, the robot is stopped and the watchdog is not fed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct LateTasks {
    /// The IMU task.
    pub imu: bool,
    /// The magnetometer task.
    pub mag: bool,
    /// The radio task.
    pub sbus: bool,
    /// The logic task.
    pub logic: bool,
    /// The status task.
    pub status: bool,
    /// The parameter task.
    pub params: bool,
    /// The task that receives on the PC link.
    pub link_receive: bool,
    /// The task that sends on the PC link.
    pub link_send: bool,
}

impl LateTasks {
    /// Whether any task is late.
    pub fn any(self) -> bool {
        let above_link = self.imu | self.mag | self.sbus | self.logic | self.status | self.params;
        above_link | self.link_receive | self.link_send
    }

    /// The crash cause to record. If several tasks are late it names the one of the highest priority, which may
    /// starve the others.
    pub const fn crash_cause(self) -> CrashCause {
        if self.imu {
            CrashCause::ImuLate
        } else if self.mag {
            CrashCause::MagLate
        } else if self.sbus {
            CrashCause::SbusLate
        } else if self.logic {
            CrashCause::LogicLate
        } else if self.status {
            CrashCause::StatusLate
        } else if self.params {
            CrashCause::ParamsLate
        } else if self.link_receive {
            CrashCause::LinkReceiveLate
        } else if self.link_send {
            CrashCause::LinkSendLate
        } else {
            CrashCause::Silent
        }
    }
}

/// Why the previous run ended, as recorded by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum CrashCause {
    /// Nothing was recorded: power-on, reset pin, or a control tick that hung.
    #[default]
    Silent = 0,
    /// A panic.
    Panic = 1,
    /// A HardFault exception.
    HardFault = 2,
    /// An exception or interrupt without a handler.
    UnexpectedInterrupt = 3,
    /// The IMU task was late.
    ImuLate = 4,
    /// The magnetometer task was late.
    MagLate = 5,
    /// The radio task was late.
    SbusLate = 6,
    /// The logic task was late.
    LogicLate = 7,
    /// The status task was late.
    StatusLate = 8,
    /// The parameter task was late.
    ParamsLate = 9,
    /// The task that receives on the PC link was late.
    LinkReceiveLate = 10,
    /// The task that sends on the PC link was late.
    LinkSendLate = 11,
}

impl CrashCause {
    const ALL: [Self; 12] = [
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
        Self::LinkReceiveLate,
        Self::LinkSendLate,
    ];

    /// Code for memory that survives a reset.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// Returns `None` unless `code` comes from [`code`](Self::code).
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|words| words.code() == code)
    }

    /// Text for the log.
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
            Self::LinkReceiveLate => "task link-receive was late",
            Self::LinkSendLate => "task link-send was late",
        }
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for CrashCause {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{=str}", self.text());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crash_causes_survive_their_codes() {
        let known: Vec<u8> = (0..=u8::MAX)
            .filter(|&code| CrashCause::from_code(code).is_some())
            .collect();
        assert_eq!(known, (0..=11).collect::<Vec<u8>>());
        for code in known {
            assert_eq!(
                CrashCause::from_code(code).map(CrashCause::code),
                Some(code)
            );
        }
    }

    #[test]
    fn a_late_task_is_named() {
        let named = |late: LateTasks| late.crash_cause().text();
        let none = LateTasks::default();
        assert!(!none.any());
        assert_eq!(none.crash_cause(), CrashCause::Silent);
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
            (
                LateTasks {
                    link_receive: true,
                    ..none
                },
                "link-receive",
            ),
            (
                LateTasks {
                    link_send: true,
                    ..none
                },
                "link-send",
            ),
        ] {
            assert!(late.any());
            assert_eq!(named(late), format!("task {name} was late"));
        }
    }
}
