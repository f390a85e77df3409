//! Every static through which tasks exchange data.
//!
//! | where | written by | read by | rate |
//! |---|---|---|---|
//! | [`Exchange::imu`] | imu task | control | 200 Hz |
//! | [`Exchange::mag`] | mag task | control | 50 Hz |
//! | [`Exchange::remote`] | sbus task | logic, control | each radio frame, 70 to 143 Hz |
//! | [`Exchange::pc`] | link receive task | control, status | each command of the PC |
//! | [`Exchange::link`] | link receive task | control | 100 Hz |
//! | [`Exchange::frames_sent`] | link send task | link receive | 417 Hz |
//! | [`Exchange::telemetry`] | control task | link send | 500 Hz |
//! | `exchange/tunnel.rs`, queues | link receive task, control | control, link send task | tuning over the PC link |
//! | [`Exchange::logic_bus`] | logic task | control | 100 Hz |
//! | [`Exchange::analog`] | status task | control, link send | 100 Hz |
//! | [`Exchange::config`] | control task | imu, mag, logic, params | when tuning changed it |
//! | [`Exchange::params`] | params task | control | when it changes |
//! | [`Exchange::flash_grant`] | control task | params | when it changes |
//! | [`Exchange::diagnostics`] | control task | logic, status, black box | 100 Hz |
//! | [`Exchange::black_box`] | black box task | control | when it changes |
//! | [`RADIO_LINE`] | radio UART interrupt | sbus, control | each radio frame |
//! | [`REPORT_PULSE`] | control task | black box | 100 Hz |
//! | [`TICK_PULSE`] | control task | link receive task | 1 kHz |
//! | [`LINK_LINE`] | link UART interrupt, link receive task | link receive task | each frame of the PC |
//! | `drivers/can/receive.rs`, queues | CAN receive interrupts | control | each CAN frame |
//! | `deadlines.rs`, check-ins | every task below control | control | at least 100 Hz |
//! | `stall.rs`, stalls | params task, while no other task can run | every task with a ticker, `drivers/uart/receiver.rs` | each erase |
//! | `black_box_memory.rs` | black box task | control | 100 Hz |
//! | `debugger_view.rs` | control task | a debugger | 1 kHz |

use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use robot_app::diagnostics::{DiagnosticsSnapshot, Telemetry};
use robot_app::domain::BlackBoxStatus;
use robot_app::domain::{FlashRequest, ParamStatus};
use robot_app::domain::{ImuState, ImuStatus, MagState, RemoteUpdate, RobotConfig, SensorHealth};
use robot_app::domain::{LinkHealth, LogicBus, PcCommand};
use robot_snapshot::{Snapshot, Writer};
use static_cell::StaticCell;

use crate::drivers::analog::AnalogReport;
use crate::drivers::uart::UartLine;

mod tunnel;

pub use tunnel::{ControlTunnel, Tunnel, TunnelReplies, TunnelRequests};

/// The newest IMU sample with the health of the sensor.
#[derive(Clone, Copy, Default)]
pub struct ImuReport {
    pub state: ImuState,
    pub health: SensorHealth,
    pub status: ImuStatus,
}

/// The newest magnetometer sample with the health of the sensor.
#[derive(Clone, Copy, Default)]
pub struct MagReport {
    pub state: MagState,
    pub health: SensorHealth,
}

/// The settings in use.
#[derive(Clone, Copy)]
pub struct ConfigUpdate {
    pub config: RobotConfig,
    /// `TuningStatus::revision` of these settings.
    pub revision: u32,
    /// `TuningStatus::restored` of these settings.
    pub restored: u32,
}

/// State of the parameter store.
#[derive(Clone, Copy, Default)]
pub struct ParamsReport {
    pub status: ParamStatus,
    /// The flash operation for which it asks permission.
    pub request: FlashRequest,
}

/// The flash operation that the control tick permits.
#[derive(Clone, Copy, Default)]
#[repr(align(4))]
pub struct FlashPermission(pub FlashRequest);

/// The newest value of each message between tasks.
pub struct Exchange {
    pub imu: Snapshot<ImuReport>,
    pub mag: Snapshot<MagReport>,
    pub remote: Snapshot<RemoteUpdate>,
    pub logic_bus: Snapshot<LogicBus>,
    pub pc: Snapshot<PcCommand>,
    /// State of the PC link.
    pub link: Snapshot<LinkHealth>,
    /// State frames sent on the PC link since boot.
    pub frames_sent: Snapshot<u32>,
    pub telemetry: Snapshot<Telemetry>,
    pub analog: Snapshot<AnalogReport>,
    pub config: Snapshot<ConfigUpdate>,
    pub params: Snapshot<ParamsReport>,
    pub flash_grant: Snapshot<FlashPermission>,
    pub diagnostics: Snapshot<DiagnosticsSnapshot>,
    pub black_box: Snapshot<BlackBoxStatus>,
}

static EXCHANGE: StaticCell<Exchange> = StaticCell::new();

/// Events on the line of the radio receiver.
pub static RADIO_LINE: UartLine = UartLine::new();

/// Events on the line of the PC link.
pub static LINK_LINE: UartLine = UartLine::new();

/// Given when the control task has published its diagnostics.
pub static REPORT_PULSE: Signal<CriticalSectionRawMutex, ()> = Signal::new();

/// Given at the end of each control tick. A task that runs at 1 kHz and waits for it has no timer of its own, whose
/// handling with interrupts off would delay the release of the tick.
pub static TICK_PULSE: Signal<CriticalSectionRawMutex, ()> = Signal::new();

/// The one writing end of each snapshot.
pub struct Writers {
    pub imu: Writer<'static, ImuReport>,
    pub mag: Writer<'static, MagReport>,
    pub remote: Writer<'static, RemoteUpdate>,
    pub logic_bus: Writer<'static, LogicBus>,
    pub pc: Writer<'static, PcCommand>,
    pub link: Writer<'static, LinkHealth>,
    pub frames_sent: Writer<'static, u32>,
    pub analog: Writer<'static, AnalogReport>,
    pub params: Writer<'static, ParamsReport>,
    pub black_box: Writer<'static, BlackBoxStatus>,
    pub control: ControlWriters,
}

/// What the control task writes.
pub struct ControlWriters {
    pub config: Writer<'static, ConfigUpdate>,
    pub flash_grant: Writer<'static, FlashPermission>,
    pub diagnostics: Writer<'static, DiagnosticsSnapshot>,
    pub telemetry: Writer<'static, Telemetry>,
}

impl Exchange {
    /// Makes the one exchange with the settings at boot. Every other message starts with its default, which stops the robot.
    ///
    /// # Panics
    /// On a second call.
    pub fn init(config: RobotConfig) -> &'static Self {
        EXCHANGE.init_with(|| Self {
            imu: Snapshot::new(ImuReport::default()),
            mag: Snapshot::new(MagReport::default()),
            remote: Snapshot::new(RemoteUpdate::default()),
            logic_bus: Snapshot::new(LogicBus::default()),
            pc: Snapshot::new(PcCommand::default()),
            link: Snapshot::new(LinkHealth::default()),
            frames_sent: Snapshot::new(0),
            telemetry: Snapshot::new(Telemetry::default()),
            analog: Snapshot::new(AnalogReport::default()),
            config: Snapshot::new(ConfigUpdate {
                config,
                revision: 0,
                restored: 0,
            }),
            params: Snapshot::new(ParamsReport::default()),
            flash_grant: Snapshot::new(FlashPermission::default()),
            diagnostics: Snapshot::new(DiagnosticsSnapshot::default()),
            black_box: Snapshot::new(BlackBoxStatus::default()),
        })
    }

    /// `None` after the first call.
    pub fn take_writers(&'static self) -> Option<Writers> {
        Some(Writers {
            imu: self.imu.writer()?,
            mag: self.mag.writer()?,
            remote: self.remote.writer()?,
            logic_bus: self.logic_bus.writer()?,
            pc: self.pc.writer()?,
            link: self.link.writer()?,
            frames_sent: self.frames_sent.writer()?,
            analog: self.analog.writer()?,
            params: self.params.writer()?,
            black_box: self.black_box.writer()?,
            control: ControlWriters {
                config: self.config.writer()?,
                flash_grant: self.flash_grant.writer()?,
                diagnostics: self.diagnostics.writer()?,
                telemetry: self.telemetry.writer()?,
            },
        })
    }
}
