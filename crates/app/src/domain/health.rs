//! What the platform knows about its parts: filled by the firmware, judged by `safety`.

use super::{ImuStatus, LastWords, LateTasks};

/// Fault confinement state of a CAN controller (ISO 11898-1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum BusErrorState {
    #[default]
    Active = 0,
    Passive = 1,
    BusOff = 2,
}

/// Counters of one CAN bus, all since boot unless the name says otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct BusHealth {
    pub tx_frames: u32,
    /// Frames taken back because they had not left within their tick.
    pub tx_aborted: u32,
    /// Of those, how many since the last one that did leave.
    pub tx_failures_in_row: u32,
    pub rx_frames: u32,
    /// Frames lost in the controller's FIFOs.
    pub rx_overruns: u32,
    /// Frames lost because the queue to the control tick was full.
    pub rx_queue_full: u32,
    pub bus_off_count: u32,
    pub state: BusErrorState,
    pub transmit_errors: u8,
    pub receive_errors: u8,
}

/// Health of one sensor, kept by the sensor task.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct SensorHealth {
    /// Brought up and answering.
    pub ready: bool,
    pub samples: u32,
    /// Bus errors and rejected samples since boot.
    pub errors: u32,
    pub reinits: u32,
}

impl SensorHealth {
    pub fn count_sample(&mut self) {
        self.ready = true;
        self.samples = self.samples.wrapping_add(1);
    }

    pub fn count_error(&mut self) {
        self.errors = self.errors.wrapping_add(1);
    }

    /// The sensor does not answer and must be brought up again.
    pub fn count_loss(&mut self) {
        self.ready = false;
        self.reinits = self.reinits.wrapping_add(1);
    }
}

/// What the receiver's UART saw since boot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct RadioLineHealth {
    /// Bursts of bytes.
    pub rx_events: u32,
    pub rx_bytes: u32,
    pub parity: u32,
    pub framing: u32,
    pub noise: u32,
    pub overrun: u32,
}

impl RadioLineHealth {
    /// Errors of any kind; wraps.
    pub fn errors(&self) -> u32 {
        [self.parity, self.framing, self.noise, self.overrun]
            .into_iter()
            .fold(0, u32::wrapping_add)
    }
}

/// What a debug probe does to the core.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct DebugProbe {
    /// One is attached, or was since power-on: C_DEBUGEN of DHCSR (ARMv7-M ARM C1.6.2), which only the probe can clear.
    pub attached: bool,
    /// It halts the core at a fault, a reset or a breakpoint, or the watchdog with it, and clearing that does not help.
    pub catches: bool,
}

/// Why the chip started (RM0090, RCC_CSR).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ResetCause {
    #[default]
    Unknown = 0,
    PowerOn = 1,
    Pin = 2,
    BrownOut = 3,
    Software = 4,
    IndependentWatchdog = 5,
    WindowWatchdog = 6,
    LowPower = 7,
}

/// Everything the safety policy needs to know about the platform.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SystemHealth {
    /// Index = `BusId`.
    pub can: [BusHealth; 2],
    pub imu: SensorHealth,
    pub mag: SensorHealth,
    pub radio_line: RadioLineHealth,
    pub imu_status: ImuStatus,
    /// 0 while not measured.
    pub battery_v: f32,
    /// Of the run before this one.
    pub last_words: LastWords,
    pub reset_cause: ResetCause,
    /// See `TickStats`.
    pub max_jitter_cycles: u32,
    /// Start-up gyro calibration finished.
    pub imu_calibrated: bool,
    pub late_tasks: LateTasks,
    pub debug_probe: DebugProbe,
}
