//! State of the platform, filled in by the firmware and judged by `safety`.

use super::{BlackBoxStatus, CrashCause, ImuStatus, LateTasks, LinkHealth};

/// Fault confinement state of a CAN controller (ISO 11898-1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum BusErrorState {
    /// Error active.
    #[default]
    Active = 0,
    /// Error passive.
    Passive = 1,
    /// Bus-off.
    BusOff = 2,
}

/// Counters and state of one CAN bus. Counters run since boot unless the name says otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct BusHealth {
    /// Frames sent.
    pub tx_frames: u32,
    /// Frames aborted because they had not been sent within their tick.
    pub tx_aborted: u32,
    /// Frames aborted since the last one that was sent.
    pub tx_failures_in_row: u32,
    /// Frames received.
    pub rx_frames: u32,
    /// Frames lost in the controller's FIFOs.
    pub rx_overruns: u32,
    /// Frames lost because the queue to the control tick was full.
    pub rx_queue_full: u32,
    /// Transitions to bus-off.
    pub bus_off_count: u32,
    /// Fault confinement state.
    pub state: BusErrorState,
    /// The controller's transmit error counter.
    pub transmit_errors: u8,
    /// The controller's receive error counter.
    pub receive_errors: u8,
}

/// Health of one sensor, maintained by its task.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct SensorHealth {
    /// The sensor has been brought up and responds.
    pub ready: bool,
    /// Samples since boot.
    pub samples: u32,
    /// Bus errors and rejected samples since boot.
    pub errors: u32,
    /// Bring-ups after a loss since boot.
    pub reinits: u32,
}

impl SensorHealth {
    /// Counts a good sample.
    pub fn count_sample(&mut self) {
        self.ready = true;
        self.samples = self.samples.wrapping_add(1);
    }

    /// Counts an error.
    pub fn count_error(&mut self) {
        self.errors = self.errors.wrapping_add(1);
    }

    /// Counts a loss: the sensor does not respond and must be brought up again.
    pub fn count_loss(&mut self) {
        self.ready = false;
        self.reinits = self.reinits.wrapping_add(1);
    }
}

/// What the receiver's UART has seen since boot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct RadioLineHealth {
    /// Bursts of bytes.
    pub rx_events: u32,
    /// Bytes received.
    pub rx_bytes: u32,
    /// Parity errors.
    pub parity: u32,
    /// Framing errors.
    pub framing: u32,
    /// Noise errors.
    pub noise: u32,
    /// Overrun errors.
    pub overrun: u32,
}

impl RadioLineHealth {
    /// Errors of all kinds; it wraps.
    pub fn errors(&self) -> u32 {
        [self.parity, self.framing, self.noise, self.overrun]
            .into_iter()
            .fold(0, u32::wrapping_add)
    }
}

/// How a debug probe affects the core.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct DebugProbe {
    /// A probe is attached, or has been since power-on: C_DEBUGEN of DHCSR (ARMv7-M ARM C1.6.2), which only a probe
    /// can clear.
    pub attached: bool,
    /// The probe would halt the core at a fault, a reset or a breakpoint, or halt the watchdog with it, and this
    /// could not be cleared.
    pub catches: bool,
}

/// Why the chip started (RM0090, RCC_CSR).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ResetCause {
    /// No known flag was set.
    #[default]
    Unknown = 0,
    /// Power-on.
    PowerOn = 1,
    /// Reset pin.
    Pin = 2,
    /// Supply voltage too low.
    BrownOut = 3,
    /// Reset by software.
    Software = 4,
    /// Independent watchdog.
    IndependentWatchdog = 5,
    /// Window watchdog.
    WindowWatchdog = 6,
    /// Low-power reset.
    LowPower = 7,
}

impl ResetCause {
    const ALL: [Self; 8] = [
        Self::Unknown,
        Self::PowerOn,
        Self::Pin,
        Self::BrownOut,
        Self::Software,
        Self::IndependentWatchdog,
        Self::WindowWatchdog,
        Self::LowPower,
    ];

    /// Decodes a cause. Returns `None` for an unknown number.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|cause| *cause as u8 == code)
    }
}

/// State of the platform for the safety policy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SystemHealth {
    /// Index = `BusId`.
    pub can: [BusHealth; 2],
    /// The IMU.
    pub imu: SensorHealth,
    /// The magnetometer.
    pub mag: SensorHealth,
    /// The radio's UART.
    pub radio_line: RadioLineHealth,
    /// Details of the IMU.
    pub imu_status: ImuStatus,
    /// Battery voltage, 0 while not measured.
    pub battery_v: f32,
    /// How the previous run ended.
    pub last_words: CrashCause,
    /// Why the chip started.
    pub reset_cause: ResetCause,
    /// See `TickStats`.
    pub max_jitter_cycles: u32,
    /// The start-up gyro calibration has finished.
    pub imu_calibrated: bool,
    /// Tasks that missed their deadline.
    pub late_tasks: LateTasks,
    /// State of the debug interface.
    pub debug_probe: DebugProbe,
    /// The PC link.
    pub link: LinkHealth,
    /// State of the black box.
    pub black_box: BlackBoxStatus,
}
