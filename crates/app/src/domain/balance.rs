//! State of a robot that stands on two wheels, for safety and diagnostics.

/// What the balance controller does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum BalanceState {
    /// The robot does not balance: wheels follow their speed, and the legs hold their pose.
    #[default]
    Sit = 0,
    /// Standing up.
    StandUp = 1,
    /// Balancing, with or without ground contact.
    Balance = 2,
    /// From the crouch of a jump to its landing. Also the legs being drawn in over an edge that a wheel strikes.
    Jump = 3,
    /// Sitting down.
    SitDown = 4,
    /// Beyond recovery. The controller gives zero torque, and `SafetyPolicy` stops everything.
    Fallen = 5,
    /// The robot lies on a side or its top, from where it cannot stand up. The controller gives zero torque, and
    /// `SafetyPolicy` stops everything.
    CannotRise = 6,
}

/// Part of standing up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum StandUpPhase {
    /// The robot is not standing up.
    #[default]
    None = 0,
    /// The legs come together below the body and lift it from the edge on which it lies.
    Fold = 1,
    /// The legs fold, and the body turns upright.
    Erect = 2,
    /// The legs extend while the robot balances.
    Extend = 3,
}

/// State of the balance controller in one tick. Pairs are left, right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct BalanceStatus {
    /// What the controller does.
    pub state: BalanceState,
    /// The part of standing up.
    pub phase: StandUpPhase,
    /// No wheel touches the ground.
    pub airborne: bool,
    /// A wheel slips: by its speed and the estimate's, for some time.
    pub slipping: bool,
    /// Distance from the hip centre to the axle in m.
    pub leg_m: [f32; 2],
    /// Angle of the leg in the world in rad, positive when the hip is ahead of the axle.
    pub lean_rad: [f32; 2],
    /// Force of the wheel on the ground in N.
    pub contact_n: [f32; 2],
}

impl BalanceStatus {
    /// Whether the robot sits. Then the status says nothing else.
    pub fn sits(&self) -> bool {
        self.state == BalanceState::Sit
    }

    /// No balance controller runs: the default as a constant.
    pub const SIT: Self = Self {
        state: BalanceState::Sit,
        phase: StandUpPhase::None,
        airborne: false,
        slipping: false,
        leg_m: [0.0; 2],
        lean_rad: [0.0; 2],
        contact_n: [0.0; 2],
    };
}

/// How far the pilot's request to stand has come. `SafetyPolicy` decides it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum StandPermit {
    /// The stand switch must be seen down first.
    #[default]
    SwitchMustGoDown = 0,
    /// The stand switch is down. Switching it up makes a request.
    Ready = 1,
    /// The pilot has requested standing, and the robot is not yet armed.
    Requested = 2,
    /// The robot may stand up, within limits of its own.
    StandingUp = 3,
    /// The robot has stood up and may balance.
    Standing = 4,
}

impl StandPermit {
    /// Whether the robot may stand up or stand. If not, a standing robot sits down.
    pub const fn permits(self) -> bool {
        matches!(self, Self::StandingUp | Self::Standing)
    }

    /// Whether a fall stops nothing, as the pilot knows about it.
    pub const fn may_lie(self) -> bool {
        matches!(self, Self::Requested | Self::StandingUp)
    }
}
