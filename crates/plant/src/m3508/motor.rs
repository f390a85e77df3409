//! Torque, friction and heat of the M3508 at its output shaft.

use robot_description::Wheels;

/// Datasheet: 0.78 A without load at 24 V.
const NO_LOAD_A: f64 = 0.78;
const RATED_V: f64 = 24.0;
/// An assumption: no public source gives the phase resistance. It limits the current at high speed and heats the winding.
const RESISTANCE_OHM: f64 = 0.194;
/// Assumed share of the no-load torque that is dry friction of gear and seals; the rest grows with speed.
const DRY_SHARE: f64 = 0.6;
const AMBIENT_C: f64 = 30.0;
/// Temperature of the winding under the fault `motor-N-hot`.
const HOT_C: f64 = 120.0;
/// A smaller current counts as zero, which avoids denormal numbers. One step of the feedback is 10⁶ times as large.
const NO_CURRENT_A: f64 = 1e-9;
/// From winding to air. No source gives these two: with them 10 A end near 90 °C.
const KELVIN_PER_WATT: f64 = 3.0;
const HEAT_CAPACITY_J_PER_K: f64 = 120.0;

/// Torque that always opposes the motion of a shaft.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Friction {
    pub dry_nm: f64,
    pub viscous_nm_per_rps: f64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct M3508 {
    /// Rotor turns per turn of the output shaft.
    gear: f64,
    /// At the output shaft per ampere of torque current.
    torque_nm_per_a: f64,
    /// Speed of the output shaft without load at 24 V.
    no_load_rps: f64,
    current_a: f64,
    winding_c: f64,
    pub(super) heated: bool,
}

impl M3508 {
    /// A motor of these wheels.
    pub(crate) fn new(wheels: &Wheels) -> Self {
        Self {
            gear: wheels.gear_ratio,
            torque_nm_per_a: wheels.torque_nm_per_a,
            no_load_rps: wheels.no_load_rps,
            current_a: 0.0,
            winding_c: AMBIENT_C,
            heated: false,
        }
    }

    pub(crate) fn gear(&self) -> f64 {
        self.gear
    }

    pub(crate) fn friction(&self) -> Friction {
        let no_load_nm = self.torque_nm_per_a * NO_LOAD_A;
        Friction {
            dry_nm: DRY_SHARE * no_load_nm,
            viscous_nm_per_rps: (1.0 - DRY_SHARE) * no_load_nm / self.no_load_rps,
        }
    }

    /// Torque current in A.
    pub(crate) fn current_a(&self) -> f64 {
        self.current_a
    }

    /// Electromagnetic torque at the output shaft, before friction.
    pub(crate) fn torque_nm(&self) -> f64 {
        self.current_a * self.torque_nm_per_a
    }

    pub(crate) fn temperature_c(&self) -> f64 {
        if self.heated { HOT_C } else { self.winding_c }
    }

    /// The current follows `wanted_a` with a first-order lag, as far as the supply can drive it against the back-EMF.
    pub(crate) fn step(
        &mut self,
        wanted_a: f64,
        shaft_rps: f64,
        supply_v: f64,
        follow: f64,
        dt_s: f64,
    ) {
        // 24 V give the no-load speed.
        let back_emf_v = (RATED_V - RESISTANCE_OHM * NO_LOAD_A) * shaft_rps / self.no_load_rps;
        let max_a = (supply_v - back_emf_v) / RESISTANCE_OHM;
        let min_a = (-supply_v - back_emf_v) / RESISTANCE_OHM;
        let goal_a = wanted_a.clamp(min_a, max_a.max(min_a));
        self.current_a += (goal_a - self.current_a) * follow;
        if self.current_a.abs() < NO_CURRENT_A {
            self.current_a = 0.0;
        }
        let loss_w = self.current_a * self.current_a * RESISTANCE_OHM;
        let cooling_w = (self.winding_c - AMBIENT_C) / KELVIN_PER_WATT;
        self.winding_c += (loss_w - cooling_w) * dt_s / HEAT_CAPACITY_J_PER_K;
    }

    /// Opens the winding, as when the supply is cut.
    pub(crate) fn cut(&mut self) {
        self.current_a = 0.0;
    }
}
