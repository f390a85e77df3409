//! The balance controller: what the robot does from sitting to jumping, and what it tells.

use super::{
    edge::Edge,
    jump::{FLIGHT_MPS, Jump, Legs},
    law::{Goal, Ground, Law, Torques},
    measured::Measured,
    ramp::Ramp,
    reference::Wish,
    sit_down::SitDown,
    stand_up::{Rising, StandUp},
    torques::joint_command,
};
use crate::{
    control::{ChassisControllerInput, ChassisControllerOutput},
    domain::{
        BalanceProfile, BalanceState, BalanceStatus, ChassisCommand, HighLevelCommand,
        StandUpPhase, WheelCommand, WheelOdomConfig,
    },
    math::scalar,
};

/// Longest time step in s that counts, and the one of a tick whose time is not later than the last.
const MAX_DT_S: f32 = 0.005;
const TICK_S: f32 = 0.001;
/// Rate in m/s at which the pilot changes the legs' length, and in rad/s the roll.
const LENGTH_MPS: f32 = 0.25;
const ROLL_RPS: f32 = 0.5;
/// Shortest time in s from one jump to the next: in between the robot catches itself.
const JUMP_REST_S: f32 = 1.5;
/// Beyond this pitch, roll or lean in rad the robot cannot catch itself.
const MAX_PITCH_RAD: f32 = 1.0;
const MAX_ROLL_RAD: f32 = 0.7;
const MAX_LEAN_RAD: f32 = 1.2;
/// Time in s over which the present rate of lean counts towards a fall.
const FALL_AHEAD_S: f32 = 0.05;
/// Time in s after a flight in which only the present angles count.
const LANDING_S: f32 = 0.1;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    StandUp(StandUp),
    Balance,
    Jump(Jump),
    SitDown(SitDown),
    Fallen,
    /// It lies so that it cannot stand up.
    CannotRise,
}

/// What comes of a tick.
enum Outcome {
    Torques(Torques),
    /// The robot has fallen or given up.
    Fallen,
    Sits,
}

/// A robot that stands up, balances, jumps and sits down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BalanceController {
    phase: Phase,
    law: Law,
    length: Ramp,
    roll: Ramp,
    jump_wished: bool,
    /// Time in s since the last jump began.
    since_jump_s: f32,
    edge: Edge,
    /// Time in s since the last flight.
    grounded_s: f32,
    ts_us: u64,
}

impl BalanceController {
    /// Begins to stand up. Returns `None` while anything that it takes is unknown or not ready.
    pub fn stand_up(input: &ChassisControllerInput<'_>) -> Option<Self> {
        let measured = Measured::new(&input.profile.balance.legs, input);
        let phase = if StandUp::is_possible(&measured) {
            Phase::StandUp(StandUp::new(&measured))
        } else {
            Phase::CannotRise
        };
        measured.known.then(|| Self {
            phase,
            law: Law::new(&input.profile.balance, &measured),
            length: Ramp::at(measured.length_m()),
            roll: Ramp::default(),
            jump_wished: input.hl_cmd.jump,
            since_jump_s: JUMP_REST_S,
            edge: Edge::default(),
            grounded_s: 0.0,
            ts_us: input.sensors.ts_us,
        })
    }

    /// The commands of this tick, or `None` once the robot sits.
    pub fn step(&mut self, input: &ChassisControllerInput<'_>) -> Option<ChassisControllerOutput> {
        let dt_s = self.time_step_s(input.sensors.ts_us);
        let profile = &input.profile.balance;
        let measured = Measured::new(&profile.legs, input);
        self.grounded_s = if self.law.airborne() {
            0.0
        } else {
            self.grounded_s + dt_s
        };
        let wishes_to_stand = input.hl_cmd.stand && input.stand.permits();
        let outcome = if measured.known && !self.has_fallen(&measured) {
            self.go_on(input, &measured, wishes_to_stand, dt_s)
        } else {
            Outcome::Fallen
        };
        let cmd = match outcome {
            Outcome::Torques(torques) => command(&torques, input.wheel_odom_cfg),
            Outcome::Fallen if wishes_to_stand => {
                if self.phase != Phase::CannotRise {
                    self.phase = Phase::Fallen;
                }
                ChassisCommand::STOP
            }
            Outcome::Fallen | Outcome::Sits => return None,
        };
        Some(ChassisControllerOutput {
            cmd,
            cmd_valid: true,
            balance: self.status(&measured),
        })
    }

    fn time_step_s(&mut self, now_us: u64) -> f32 {
        let elapsed_us = now_us.saturating_sub(self.ts_us);
        self.ts_us = now_us;
        match u32::try_from(elapsed_us) {
            Ok(0) | Err(_) => TICK_S,
            Ok(us) => scalar::min(us as f32 * 1e-6, MAX_DT_S),
        }
    }

    /// Goes on with the present phase, or begins the next one.
    fn go_on(
        &mut self,
        input: &ChassisControllerInput<'_>,
        measured: &Measured,
        wishes_to_stand: bool,
        dt_s: f32,
    ) -> Outcome {
        let profile = &input.profile.balance;
        let odometry = input.wheel_odom_cfg;
        if !wishes_to_stand && matches!(self.phase, Phase::Balance | Phase::Jump(_)) {
            self.phase = Phase::SitDown(SitDown::new(self.length));
        }
        let jump_edge = input.hl_cmd.jump && !self.jump_wished;
        self.jump_wished = input.hl_cmd.jump;
        self.since_jump_s += dt_s;
        let torques = match &mut self.phase {
            Phase::StandUp(_) if !wishes_to_stand => return Outcome::Sits,
            Phase::StandUp(stand_up) => {
                let length_m = standing_length_m(profile, &input.hl_cmd);
                match stand_up.step(&mut self.law, profile, odometry, measured, length_m, dt_s) {
                    Rising::Torques(torques) => torques,
                    Rising::Stands(length_m) => {
                        self.length = Ramp::at(length_m);
                        self.roll = Ramp::default();
                        self.phase = Phase::Balance;
                        self.balance(input, measured, None, dt_s)
                    }
                    Rising::GaveUp => return Outcome::Fallen,
                }
            }
            Phase::Balance => {
                let radius_m = input.wheel_odom_cfg.wheel_radius_m;
                let struck = self.edge.step(measured, radius_m, self.grounded_s, dt_s);
                if struck && !self.law.airborne() {
                    self.phase = Phase::Jump(Jump::OVER_EDGE);
                } else if jump_edge && !self.law.airborne() && self.since_jump_s >= JUMP_REST_S {
                    self.since_jump_s = 0.0;
                    self.phase = Phase::Jump(Jump::START);
                }
                self.balance(input, measured, None, dt_s)
            }
            Phase::Jump(jump) => {
                let airborne = self.law.airborne();
                let legs = jump.step(profile, measured, airborne, &self.length, dt_s);
                if legs.is_none() {
                    self.phase = Phase::Balance;
                }
                self.balance(input, measured, legs, dt_s)
            }
            Phase::SitDown(sit_down) => {
                match sit_down.step(&mut self.law, profile, odometry, measured, dt_s) {
                    Some(torques) => torques,
                    None => return Outcome::Sits,
                }
            }
            Phase::Fallen | Phase::CannotRise => return Outcome::Fallen,
        };
        Outcome::Torques(torques)
    }

    /// Balances and follows the pilot. In a jump the legs do what it needs.
    fn balance(
        &mut self,
        input: &ChassisControllerInput<'_>,
        measured: &Measured,
        legs: Option<Legs>,
        dt_s: f32,
    ) -> Torques {
        let profile = &input.profile.balance;
        let limits = &profile.limits;
        let command = &input.hl_cmd;
        let (push_n, ground) = if let Some(legs) = legs {
            self.length = legs.length;
            (legs.push_n, legs.ground)
        } else if self.law.airborne() {
            self.length.step(limits.max_length_m, FLIGHT_MPS, dt_s);
            (None, Ground::Felt)
        } else {
            let wished_m = standing_length_m(profile, command);
            self.length.step(wished_m, LENGTH_MPS, dt_s);
            (None, Ground::Felt)
        };
        let roll_rad = within_stick(command.roll) * limits.max_roll_rad;
        self.roll.step(roll_rad, ROLL_RPS, dt_s);
        let goal = Goal {
            wish: Wish {
                speed_mps: within_stick(command.vx) * limits.max_speed_mps,
                yaw_rps: within_stick(command.wz) * limits.max_yaw_rps,
            },
            length: self.length,
            roll_rad: self.roll.value,
            pitch_rad: 0.0,
            push_n,
            learn: legs.is_none(),
            stop: legs.is_none(),
            ground,
        };
        self.law
            .step(profile, input.wheel_odom_cfg, measured, &goal, dt_s)
    }

    /// Whether the robot is beyond recovery, or will be in a moment.
    fn has_fallen(&self, measured: &Measured) -> bool {
        if !matches!(self.phase, Phase::Balance | Phase::Jump(_)) {
            return matches!(self.phase, Phase::Fallen);
        }
        let tilt = &measured.tilt;
        // Legs catch a robot that has just landed, however it turns.
        let ahead_s = if self.grounded_s > LANDING_S {
            FALL_AHEAD_S
        } else {
            0.0
        };
        let soon = |angle_rad: f32, rate_rps: f32| (angle_rad + rate_rps * ahead_s).abs();
        soon(tilt.pitch_rad, tilt.pitch_rps) > MAX_PITCH_RAD
            || soon(tilt.roll_rad, tilt.roll_rps) > MAX_ROLL_RAD
            || soon(measured.mean_lean_rad(), measured.mean_lean_rps()) > MAX_LEAN_RAD
    }

    fn status(&self, measured: &Measured) -> BalanceStatus {
        let mut phase = StandUpPhase::None;
        let state = match &self.phase {
            Phase::StandUp(stand_up) => {
                phase = stand_up.phase;
                BalanceState::StandUp
            }
            Phase::Balance => BalanceState::Balance,
            Phase::Jump(_) => BalanceState::Jump,
            Phase::SitDown(_) => BalanceState::SitDown,
            Phase::Fallen => BalanceState::Fallen,
            Phase::CannotRise => BalanceState::CannotRise,
        };
        BalanceStatus {
            state,
            phase,
            airborne: self.law.airborne(),
            slipping: self.law.slip.is_slipping(),
            leg_m: measured.legs.map(|leg| leg.length_m),
            lean_rad: measured.lean_rad,
            contact_n: self.law.contact.wheels.map(|wheel| wheel.force_n),
        }
    }
}

/// A stick's deflection, −1…1; NaN counts as centred.
fn within_stick(stick: f32) -> f32 {
    if stick.is_nan() {
        return 0.0;
    }
    scalar::clamp(stick, -1.0, 1.0)
}

/// Leg length in m that the pilot wishes.
fn standing_length_m(profile: &BalanceProfile, command: &HighLevelCommand) -> f32 {
    let limits = &profile.limits;
    let middle_m = 0.5 * (limits.min_length_m + limits.max_length_m);
    let half_m = 0.5 * (limits.max_length_m - limits.min_length_m);
    middle_m + half_m * within_stick(command.height)
}

fn command(torques: &Torques, odometry: &WheelOdomConfig) -> ChassisCommand {
    let [left_nm, right_nm] = torques.wheels_nm;
    let [left_sign, right_sign] = odometry.rpm_signs();
    let current_ma = |sign: f32, nm: f32| WheelCommand {
        current_ma: sign * nm * odometry.ma_per_nm(),
    };
    let [[left_front, left_rear], [right_front, right_rear]] = torques.hips_nm;
    ChassisCommand {
        wheels: [
            current_ma(left_sign, left_nm),
            current_ma(right_sign, right_nm),
        ],
        joints: [left_front, left_rear, right_front, right_rear].map(joint_command),
    }
}
