//! What the states in a sample are called.

use robot_app::{
    black_box::BlackBoxSample,
    domain::{BalanceState, BusErrorState, StandPermit, StandUpPhase},
};

pub(super) fn mode_name(sample: &BlackBoxSample) -> &'static str {
    use robot_app::domain::DriveMode::{Custom, Manual, Pc};
    match sample.mode {
        Manual => "manual",
        Pc => "pc",
        Custom => "custom",
    }
}

pub(super) fn source_name(sample: &BlackBoxSample) -> &'static str {
    use robot_app::black_box::CommandSource::{BringUp, Direct, Drive, Nobody, Pc};
    match sample.source {
        Nobody => "nobody",
        Drive => "drive",
        Direct => "direct",
        Pc => "pc",
        BringUp => "bring-up",
    }
}

/// Returns the name that live pages use.
pub(super) fn state_name(state: BalanceState) -> &'static str {
    match state {
        BalanceState::Sit => "sit",
        BalanceState::StandUp => "stand-up",
        BalanceState::Balance => "balance",
        BalanceState::Jump => "jump",
        BalanceState::SitDown => "sit-down",
        BalanceState::Fallen => "fallen",
        BalanceState::CannotRise => "cannot-rise",
    }
}

pub(super) fn request_name(stand: StandPermit) -> &'static str {
    match stand {
        StandPermit::SwitchMustGoDown => "switch-must-go-down",
        StandPermit::Ready => "ready",
        StandPermit::Requested => "requested",
        StandPermit::StandingUp => "standing-up",
        StandPermit::Standing => "standing",
    }
}

pub(super) fn phase_name(phase: StandUpPhase) -> &'static str {
    match phase {
        StandUpPhase::None => "none",
        StandUpPhase::Fold => "fold",
        StandUpPhase::Erect => "erect",
        StandUpPhase::Extend => "extend",
    }
}

pub(super) fn bus_name(state: BusErrorState) -> &'static str {
    match state {
        BusErrorState::Active => "active",
        BusErrorState::Passive => "passive",
        BusErrorState::BusOff => "bus-off",
    }
}
