//! What a tick is given.

use crate::{
    domain::{FlashRequest, ImuState, LogicBus, MagState, ParamStatus, RemoteUpdate, SystemHealth},
    safety::WatchdogPeriod,
};

/// The latest snapshot of each producer.
#[derive(Clone, Copy, Debug)]
pub struct ControlInputs<'a> {
    pub remote: &'a RemoteUpdate,
    pub imu: &'a ImuState,
    pub mag: &'a MagState,
    pub logic: &'a LogicBus,
    pub health: &'a SystemHealth,
    pub params: &'a ParamStatus,
    /// What the parameter store would do to flash.
    pub flash_request: FlashRequest,
    pub watchdog: WatchdogPeriod,
}
