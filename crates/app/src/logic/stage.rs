//! 100 Hz decision what to do (seed section 2.2.5): manual drive.

use super::LogicBus;
use crate::domain::{HighLevelCommand, RemoteUpdate, SafetyConfig};

/// Sticks closer to the centre than this mean zero: a hand-held stick never returns exactly.
const DEAD_BAND: f32 = 0.02;

/// Maps sticks to a high-level command while the operator is in control.
#[derive(Clone, Debug)]
pub struct LogicStage {
    remote_timeout_us: u32,
}

impl LogicStage {
    pub const fn new(config: &SafetyConfig) -> Self {
        Self {
            remote_timeout_us: config.remote_timeout_us,
        }
    }

    /// `hl_valid` only while the remote is fresh, not in failsafe, enabled and not stopped.
    pub fn step(&mut self, remote: &RemoteUpdate, now_us: u64) -> LogicBus {
        let link = remote.diagnostics.at(now_us);
        let connected = link.age_us <= self.remote_timeout_us && !link.failsafe;
        let in_control = remote.operator.enabled && !remote.operator.e_stop;
        let hl_valid = connected && in_control;
        let hl_cmd = if hl_valid {
            HighLevelCommand {
                vx: outside_dead_band(remote.state.vx),
                wz: outside_dead_band(remote.state.wz),
            }
        } else {
            HighLevelCommand::default()
        };
        LogicBus {
            hl_cmd,
            hl_valid,
            ts_us: now_us,
            ..LogicBus::default()
        }
    }
}

fn outside_dead_band(stick: f32) -> f32 {
    if stick.abs() < DEAD_BAND { 0.0 } else { stick }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::{OperatorState, RemoteDiagnostics, RemoteState};

    fn remote() -> RemoteUpdate {
        RemoteUpdate {
            state: RemoteState {
                vx: 0.5,
                wz: -0.25,
                ..RemoteState::default()
            },
            operator: OperatorState {
                enabled: true,
                e_stop: false,
                ..OperatorState::default()
            },
            diagnostics: RemoteDiagnostics {
                good_ts_us: 1_000_000,
                ..RemoteDiagnostics::default()
            },
        }
    }

    fn decide(change: impl FnOnce(&mut RemoteUpdate), now_us: u64) -> LogicBus {
        let mut remote = remote();
        change(&mut remote);
        LogicStage::new(&SafetyConfig::default()).step(&remote, now_us)
    }

    #[test]
    fn sticks_reach_the_high_level_command() {
        let bus = decide(|_| (), 1_010_000);
        assert!(bus.hl_valid && !bus.cmd_valid);
        assert_eq!((bus.hl_cmd.vx, bus.hl_cmd.wz), (0.5, -0.25));
    }

    #[test]
    fn every_reason_to_stop_invalidates_the_command() {
        let stopped = [
            decide(|_| (), 1_100_001),
            decide(|remote| remote.diagnostics.failsafe = true, 1_010_000),
            decide(|remote| remote.operator.enabled = false, 1_010_000),
            decide(|remote| remote.operator.e_stop = true, 1_010_000),
            decide(|remote| remote.diagnostics.good_ts_us = 0, 1_010_000),
        ];
        for bus in stopped {
            assert!(!bus.hl_valid);
            assert_eq!(bus.hl_cmd, HighLevelCommand::default());
        }
    }

    #[test]
    fn a_nearly_centred_stick_is_centred() {
        let bus = decide(|remote| remote.state.vx = 0.019, 1_010_000);
        assert_eq!(bus.hl_cmd.vx, 0.0);
    }
}
