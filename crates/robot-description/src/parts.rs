//! Names and places of a robot's parts, as MJCF and URDF share them.

use crate::{Carrier, HipRange, Joints, Legs, Link, Wheels};

/// Moment of inertia in kg·m² of what has none in the robot's file: a rod about its length, the still part of a motor.
/// Simulators refuse 0.
pub(crate) const NONE_KGM2: f64 = 1e-12;
/// Radius in m of a link, to look at and to touch the floor. An assumption.
pub const LINK_RADIUS_M: f64 = 0.008;
/// Radii in m of the motors, to look at: those of a DM4310 and an M3508.
pub(crate) const HIP_MOTOR_RADIUS_M: f64 = 0.028;
pub(crate) const WHEEL_MOTOR_RADIUS_M: f64 = 0.021;

/// How far a tyre gives under half of the robot's weight: hard rubber, an assumption.
const TYRE_GIVES_M: f64 = 0.8e-3;

pub(crate) const BODY_COLOUR: [f64; 4] = [0.25, 0.32, 0.42, 1.0];
const FRONT_COLOUR: [f64; 4] = [0.85, 0.45, 0.15, 1.0];
const REAR_COLOUR: [f64; 4] = [0.2, 0.55, 0.6, 1.0];
pub(crate) const MOTOR_COLOUR: [f64; 4] = [0.3, 0.3, 0.3, 1.0];
pub(crate) const TYRE_COLOUR: [f64; 4] = [0.1, 0.1, 0.1, 1.0];
pub(crate) const MARK_COLOUR: [f64; 4] = [0.9, 0.9, 0.9, 1.0];
pub(crate) const ARROW_COLOUR: [f64; 4] = [0.8, 0.1, 0.1, 1.0];

/// A left or right leg.
#[derive(Clone, Copy)]
pub(crate) struct Side {
    pub(crate) name: &'static str,
    /// Sign of its y.
    pub(crate) sign: f64,
}

pub(crate) const SIDES: [Side; 2] = [
    Side {
        name: "left",
        sign: 1.0,
    },
    Side {
        name: "right",
        sign: -1.0,
    },
];

pub(crate) const ENDS: [Carrier; 2] = [Carrier::Front, Carrier::Rear];

/// All four pairs of thigh and shank.
pub(crate) fn limbs() -> impl Iterator<Item = (Side, Carrier)> {
    SIDES
        .into_iter()
        .flat_map(|side| ENDS.map(|end| (side, end)))
}

/// The name of a part of one limb, such as `left_front_hip`.
pub(crate) fn part(side: Side, end: Carrier, what: &str) -> String {
    let end = match end {
        Carrier::Front => "front",
        Carrier::Rear => "rear",
    };
    format!("{}_{end}_{what}", side.name)
}

pub(crate) fn wheel_name(side: Side) -> String {
    format!("{}_wheel", side.name)
}

/// Sign of x of the outward direction, along which a link lies at angle 0.
pub(crate) fn out(end: Carrier) -> f64 {
    match end {
        Carrier::Front => 1.0,
        Carrier::Rear => -1.0,
    }
}

/// Front and rear links have a colour each.
pub(crate) fn link_colour(end: Carrier) -> [f64; 4] {
    match end {
        Carrier::Front => FRONT_COLOUR,
        Carrier::Rear => REAR_COLOUR,
    }
}

impl Joints {
    pub(crate) fn hip_range_rad(&self, end: Carrier) -> HipRange {
        match end {
            Carrier::Front => self.range_rad.front,
            Carrier::Rear => self.range_rad.rear,
        }
    }
}

impl Link {
    /// Moments of inertia about x, y, z of a link along x.
    pub(crate) fn rod_kgm2(&self) -> [f64; 3] {
        [NONE_KGM2, self.inertia_kgm2, self.inertia_kgm2]
    }
}

impl Legs {
    /// Place of a hip in body axes.
    pub(crate) fn hip_m(&self, side: Side, end: Carrier) -> [f64; 3] {
        let x = out(end) * self.hip_gap_m / 2.0;
        [x, side.sign * self.plane_y_m, 0.0]
    }

    /// The y of a wheel's middle relative to the plane of its leg.
    pub(crate) fn wheel_outward_m(&self, wheels: &Wheels, side: Side) -> f64 {
        side.sign * (wheels.track_m / 2.0 - self.plane_y_m)
    }
}

impl Wheels {
    /// Moments of inertia of what turns with a wheel about x, y, z: across the axle those of a disc.
    pub(crate) fn turning_kgm2(&self) -> [f64; 3] {
        let across = self.inertia_kgm2 / 2.0 + self.mass_kg * self.width_m.powi(2) / 12.0;
        [across, self.inertia_kgm2, across]
    }

    /// Torque against turning on the spot, in N·m for each newton of friction that the load allows: the lever of a patch that slides
    /// all over while it turns.
    ///
    /// Hertz's pressure makes it 3π/16 of the patch's radius (Johnson, Contact Mechanics, 1985, section 7.2). The patch of a
    /// tyre that gives by δ is an ellipse of half axes √(R δ) along and √(r δ) across the wheel, with the radius R of the wheel and
    /// r of the tyre's cross-section; a circle of its area stands for it. That δ is that of the robot's weight is assumed. A tyre
    /// that rolls resists less: its patch is a new one all the time.
    pub fn twist_lever_m(&self) -> f64 {
        let half_axes_m = [self.radius_m, self.cross_section_m()]
            .map(|radius_m| (radius_m * TYRE_GIVES_M).sqrt());
        let patch_m = half_axes_m.into_iter().product::<f64>().sqrt();
        3.0 * std::f64::consts::PI / 16.0 * patch_m
    }

    /// Radius in m of a tyre's round cross-section.
    pub(crate) fn cross_section_m(&self) -> f64 {
        (self.width_m / 2.0).min(self.radius_m / 2.0)
    }

    /// Largest torque in N·m of a motor at its wheel.
    pub(crate) fn peak_nm(&self) -> f64 {
        self.max_current_a * self.torque_nm_per_a
    }
}
