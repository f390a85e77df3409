//! Torque and heat of a geared motor with its driver, seen at the output shaft.

const AMBIENT_C: f64 = 30.0;
/// Temperature of the winding under the fault `motor-N-hot`.
const HOT_C: f64 = 120.0;
/// Assumed share of the winding's rise that reaches the driver's transistors.
const DRIVER_SHARE: f64 = 0.5;

#[derive(Debug)]
pub(super) struct Rating {
    pub peak_nm: f64,
    /// Speed without load at `supply_v`.
    pub no_load_rps: f64,
    pub supply_v: f64,
    /// Fall of the speed under load. It stands for the resistance of the winding and so gives the heat too: a torque of τ
    /// loses `slope · τ²` watts.
    pub slope_rps_per_nm: f64,
    /// Dry friction of the gear.
    pub friction_nm: f64,
    pub kelvin_per_watt: f64,
    pub heat_capacity_j_per_k: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Actuator {
    rating: &'static Rating,
    torque_nm: f64,
    winding_c: f64,
    pub(super) heated: bool,
}

impl Actuator {
    pub(super) fn new(rating: &'static Rating) -> Self {
        Self {
            rating,
            torque_nm: 0.0,
            winding_c: AMBIENT_C,
            heated: false,
        }
    }

    pub(super) fn rating(&self) -> &'static Rating {
        self.rating
    }

    pub(super) fn torque_nm(&self) -> f64 {
        self.torque_nm
    }

    pub(super) fn winding_c(&self) -> f64 {
        if self.heated { HOT_C } else { self.winding_c }
    }

    pub(super) fn driver_c(&self) -> f64 {
        AMBIENT_C + DRIVER_SHARE * (self.winding_c() - AMBIENT_C)
    }

    /// The torque follows at once, as far as the supply can drive the current against the back-EMF. `None` is a driver that
    /// is switched off.
    pub(super) fn step(&mut self, wanted_nm: Option<f64>, vel_rps: f64, supply_v: f64, dt_s: f64) {
        let rating = self.rating;
        let loss_w = rating.slope_rps_per_nm * self.torque_nm * self.torque_nm;
        let cooling_w = (self.winding_c - AMBIENT_C) / rating.kelvin_per_watt;
        self.winding_c += (loss_w - cooling_w) * dt_s / rating.heat_capacity_j_per_k;
        self.torque_nm = wanted_nm.map_or(0.0, |nm| self.reachable_nm(nm, vel_rps, supply_v));
    }

    fn reachable_nm(&self, wanted_nm: f64, vel_rps: f64, supply_v: f64) -> f64 {
        let rating = self.rating;
        // The no-load speed is reached against the friction of the gear; without it the motor would run a little faster.
        let free_rps = rating.no_load_rps * supply_v / rating.supply_v
            + rating.slope_rps_per_nm * rating.friction_nm;
        let max_nm = (free_rps - vel_rps) / rating.slope_rps_per_nm;
        let min_nm = (-free_rps - vel_rps) / rating.slope_rps_per_nm;
        wanted_nm
            .clamp(min_nm, max_nm)
            .clamp(-rating.peak_nm, rating.peak_nm)
    }

    pub(super) fn cut(&mut self) {
        self.torque_nm = 0.0;
    }
}
