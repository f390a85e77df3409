//! The controller that the image ships with: it sits while the stand switch is down, and balances while it is up.

use super::{
    ChassisController, ChassisControllerInput, ChassisControllerOutput, DefaultController,
    balance::BalanceController,
};

/// Runs [`DefaultController`] while the robot sits and the balance controller from standing up to sitting down.
#[derive(Clone, Copy, Debug, Default)]
pub struct StandardController {
    sitting: DefaultController,
    balance: Option<BalanceController>,
    /// The pilot's wish to stand has been followed, or the robot has fallen since.
    followed: bool,
}

impl ChassisController for StandardController {
    fn step(&mut self, input: &ChassisControllerInput<'_>) -> ChassisControllerOutput {
        if self.balance.is_none() && input.hl_cmd.stand && input.stand.permits() && !self.followed {
            self.balance = BalanceController::stand_up(input);
            self.followed = self.balance.is_some();
        }
        self.followed &= input.hl_cmd.stand;
        if let Some(balance) = &mut self.balance {
            if let Some(output) = balance.step(input) {
                return output;
            }
            self.balance = None;
            self.sitting.reset();
        }
        self.sitting.step(input)
    }

    fn reset(&mut self) {
        self.sitting.reset();
        self.balance = None;
        self.followed = false;
    }
}

#[cfg(test)]
mod tests;
