//! What only the simulator knows.

use robot_plant::world::{Probe, World};

/// The robot as it is. Pairs are left, right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Truth {
    /// Forward speed of the hip centre in m/s.
    pub forward_mps: f64,
    /// Turn rate in rad/s.
    pub yaw_rps: f64,
    /// Roll and pitch in rad.
    pub roll_pitch_rad: [f64; 2],
    /// Height of the hip centre above the ground in m.
    pub height_m: f64,
    /// Place of the hip centre in m, east and north.
    pub place_m: [f64; 2],
    /// Leg lengths in m.
    pub leg_m: [f64; 2],
    /// Torques of the wheels in N·m.
    pub wheel_nm: [f64; 2],
    /// Force of the ground on body and links in N.
    pub body_n: f64,
    /// Whether the firmware lets the motors move.
    pub armed: bool,
}

impl Truth {
    /// Angle between the body's z axis and the vertical in rad.
    pub fn tilt_rad(&self) -> f64 {
        let [roll, pitch] = self.roll_pitch_rad;
        (roll.cos() * pitch.cos()).clamp(-1.0, 1.0).acos()
    }
}

/// The signals of a [`Truth`], found once.
#[derive(Clone, Copy)]
pub(crate) struct Probes {
    forward: Probe,
    yaw: Probe,
    tilt: [Probe; 2],
    place: [Probe; 3],
    leg: [Probe; 2],
    torque: [Probe; 2],
    body: Probe,
}

impl Probes {
    pub fn new(world: &World) -> Self {
        let find = |name: &str| world.probe(name).expect(name);
        Self {
            forward: find("truth.body.vx"),
            yaw: find("truth.body.wz"),
            tilt: ["truth.body.roll", "truth.body.pitch"].map(find),
            place: ["truth.body.x", "truth.body.y", "truth.body.z"].map(find),
            leg: ["truth.leg.0.length_m", "truth.leg.1.length_m"].map(find),
            torque: ["truth.wheel.0.torque_nm", "truth.wheel.1.torque_nm"].map(find),
            body: find("truth.body.contact_n"),
        }
    }

    /// All but what the firmware does.
    pub fn read(&self, world: &World) -> Truth {
        let [x_m, y_m, height_m] = self.place.map(|probe| probe.read(world));
        Truth {
            forward_mps: self.forward.read(world),
            yaw_rps: self.yaw.read(world),
            roll_pitch_rad: self.tilt.map(|probe| probe.read(world)),
            height_m,
            place_m: [x_m, y_m],
            leg_m: self.leg.map(|probe| probe.read(world)),
            wheel_nm: self.torque.map(|probe| probe.read(world)),
            body_n: self.body.read(world),
            armed: false,
        }
    }
}
