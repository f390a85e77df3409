//! The true motion of the body, and the field around it.

use robot_test_support::{Rotation, Vector};

pub const GRAVITY_MPS2: f64 = 9.806_65;

pub type OverTime = Box<dyn Fn(f64) -> Vector>;

/// Functions of time in seconds. The world frame is ENU with y to magnetic north.
pub struct Motion {
    pub start: Rotation,
    /// Body frame.
    pub rate_rps: OverTime,
    /// World frame, without gravity.
    pub accel_mps2: OverTime,
    /// World frame.
    pub earth_field_ut: Vector,
    /// World frame, added to the earth's field.
    pub magnet_ut: OverTime,
    /// Ground speed of the left and the right wheel in m/s. `None`: the wheels are silent.
    pub wheels_mps: Option<Box<dyn Fn(f64) -> [f64; 2]>>,
}

/// A field that points north and down by `dip_deg`.
fn field_ut(strength_ut: f64, dip_deg: f64) -> Vector {
    let dip = dip_deg.to_radians();
    [0.0, strength_ut * dip.cos(), -strength_ut * dip.sin()]
}

/// The field of Central Europe: 19.1 µT to the north.
pub fn home_field_ut() -> Vector {
    field_ut(49.0, 67.0)
}

impl Motion {
    pub fn at_rest() -> Self {
        Self {
            start: Rotation::default(),
            rate_rps: Box::new(|_| [0.0; 3]),
            accel_mps2: Box::new(|_| [0.0; 3]),
            earth_field_ut: home_field_ut(),
            magnet_ut: Box::new(|_| [0.0; 3]),
            wheels_mps: None,
        }
    }

    pub fn where_field_is(mut self, strength_ut: f64, dip_deg: f64) -> Self {
        self.earth_field_ut = field_ut(strength_ut, dip_deg);
        self
    }

    pub fn rolling(mut self, wheels_mps: impl Fn(f64) -> [f64; 2] + 'static) -> Self {
        self.wheels_mps = Some(Box::new(wheels_mps));
        self
    }

    pub fn starting(mut self, start: Rotation) -> Self {
        self.start = start;
        self
    }

    /// Sets the rate in °/s, body frame.
    pub fn turning(mut self, rate_dps: impl Fn(f64) -> Vector + 'static) -> Self {
        self.rate_rps = Box::new(move |t| rate_dps(t).map(f64::to_radians));
        self
    }

    pub fn accelerated(mut self, accel_mps2: impl Fn(f64) -> Vector + 'static) -> Self {
        self.accel_mps2 = Box::new(accel_mps2);
        self
    }

    pub fn with_magnet(mut self, magnet_ut: impl Fn(f64) -> Vector + 'static) -> Self {
        self.magnet_ut = Box::new(magnet_ut);
        self
    }

    /// The motion of a robot carried by hand: rotation about all axes at up to some 100 °/s, accelerations of up to
    /// 3 m/s², no rest.
    pub fn carried_about() -> Self {
        Self::at_rest().turning(carried_rate_dps).accelerated(|t| {
            let wave = |hz: f64, phase: f64| (std::f64::consts::TAU * hz * t + phase).sin();
            [
                2.0 * wave(0.9, 0.3) + wave(2.3, 1.0),
                1.5 * wave(1.1, 2.0) + wave(1.9, 0.0),
                1.0 * wave(1.3, 0.7) + 0.5 * wave(2.9, 0.1),
            ]
        })
    }
}

pub fn carried_rate_dps(t: f64) -> Vector {
    let wave = |hz: f64, phase: f64| (std::f64::consts::TAU * hz * t + phase).sin();
    [
        60.0 * wave(0.31, 0.4) + 40.0 * wave(0.83, 1.1),
        55.0 * wave(0.27, 1.9) + 35.0 * wave(0.71, 0.2),
        70.0 * wave(0.19, 0.8) + 40.0 * wave(0.57, 2.6),
    ]
}

/// 1 between `from` and `to`, else 0, with ramps of `ramp_s` inside.
pub fn window(t: f64, from: f64, to: f64, ramp_s: f64) -> f64 {
    ((t - from) / ramp_s).min((to - t) / ramp_s).clamp(0.0, 1.0)
}
