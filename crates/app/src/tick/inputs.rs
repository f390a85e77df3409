//! The inputs of a tick.

use crate::{
    domain::{
        FlashRequest, ImuState, LogicBus, MagState, ParamStatus, PcCommand, RemoteUpdate,
        SystemHealth,
    },
    safety::WatchdogPeriod,
};

/// The newest snapshot of each producer.
#[derive(Clone, Copy, Debug)]
pub struct ControlInputs<'a> {
    /// From the radio task.
    pub remote: &'a RemoteUpdate,
    /// From the IMU task.
    pub imu: &'a ImuState,
    /// From the magnetometer task.
    pub mag: &'a MagState,
    /// From the logic task.
    pub logic: &'a LogicBus,
    /// From the PC link, followed while the logic task selects the PC.
    pub pc: &'a PcCommand,
    /// State of buses, sensors, battery and tasks.
    pub health: &'a SystemHealth,
    /// State of the parameter store.
    pub params: &'a ParamStatus,
    /// What the parameter task requests of flash.
    pub flash_request: FlashRequest,
    /// Present period of the watchdog.
    pub watchdog: WatchdogPeriod,
}
