//! The rules of design.md section 3, written from what goes into the tick alone.

use robot_app::{domain::BusErrorState, tick::ControlInputs};

const REMOTE_TIMEOUT_US: u64 = 100_000;
const IMU_TIMEOUT_US: u64 = 25_000;
const COMMAND_TIMEOUT_US: u64 = 50_000;

/// The rules, as far as they can be told from the inputs without knowing the estimator.
#[derive(Default)]
pub struct Rules {
    /// The enable switch was off in a fresh frame, since boot or since the last stop.
    seen_off: bool,
    /// And then on.
    cycled: bool,
    /// Torque was on since then, so the next stop uses the switch up.
    pub driving: bool,
}

impl Rules {
    /// True if torque may leave now.
    pub fn allow(&mut self, inputs: &ControlInputs<'_>, now_us: u64) -> bool {
        let fresh = |ts_us: u64, limit_us| ts_us != 0 && now_us.saturating_sub(ts_us) <= limit_us;
        let remote_fresh = fresh(inputs.remote.diagnostics.good_ts_us, REMOTE_TIMEOUT_US);
        let operator = &inputs.remote.operator;
        let stopped = !remote_fresh
            || !operator.enabled
            || operator.e_stop
            || inputs.remote.diagnostics.failsafe
            || inputs.remote.diagnostics.quality < 0.5
            || !inputs.health.imu_calibrated
            || !fresh(inputs.imu.ts_us, IMU_TIMEOUT_US);
        if stopped && self.driving {
            *self = Self::default();
        }
        if remote_fresh {
            self.cycled = operator.enabled && self.seen_off;
            self.seen_off |= operator.disabled;
        }
        self.cycled
            && !stopped
            && inputs.health.can[0].state != BusErrorState::BusOff
            && fresh(inputs.logic.ts_us, COMMAND_TIMEOUT_US)
    }
}
