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

/// Returns the name that the live page uses.
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

#[cfg(test)]
mod tests {
    use robot_app::tuning::LiveKind;

    use super::*;
    use crate::tuning::live_page;

    fn choices(field: &str) -> &'static [&'static str] {
        let mut fields = live_page("balance").fields.iter();
        match fields.find(|known| known.name == field).map(|f| &f.kind) {
            Some(LiveKind::Choice { names, .. }) => names,
            other => panic!("`{field}` is no choice: {other:?}"),
        }
    }

    #[test]
    fn states_and_requests_have_the_names_of_the_live_page() {
        use BalanceState::{Balance, CannotRise, Fallen, Jump, Sit, SitDown, StandUp};
        use StandPermit::{Ready, Requested, Standing, StandingUp, SwitchMustGoDown};
        let states = [Sit, StandUp, Balance, Jump, SitDown, Fallen, CannotRise];
        assert_eq!(choices("state").len(), states.len());
        for state in states {
            assert_eq!(state_name(state), choices("state")[state as usize]);
        }
        let requests = [SwitchMustGoDown, Ready, Requested, StandingUp, Standing];
        assert_eq!(choices("request").len(), requests.len());
        for stand in requests {
            assert_eq!(request_name(stand), choices("request")[stand as usize]);
        }
    }
}
