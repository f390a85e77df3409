//! What balancing needs to know of a robot. It comes from the robot's file (docs/your-robot.md).

/// The shank that carries the wheel's motor. The motor's speed counts from it, and its reaction acts on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// The shank below the front knee.
    Front,
    /// The shank below the rear knee.
    Rear,
}

/// Lengths of a five-bar leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegGeometry {
    /// Distance between front and rear hip in m.
    pub hip_gap_m: f32,
    /// Length of both thighs, hip to knee, in m.
    pub thigh_m: f32,
    /// Length of both shanks, knee to axle, in m.
    pub shank_m: f32,
    /// The shank with the wheel's motor.
    pub carrier: Carrier,
}

impl LegGeometry {
    /// A leg of a small robot, for examples and tests.
    pub const EXAMPLE: Self = Self {
        hip_gap_m: 0.10,
        thigh_m: 0.12,
        shank_m: 0.22,
        carrier: Carrier::Rear,
    };
}

/// Masses of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassModel {
    /// Everything, in kg.
    pub total_kg: f32,
    /// What the legs carry, in kg: the body, the thighs and the upper part of the shanks.
    pub carried_kg: f32,
    /// What moves with one axle, in kg: wheel, its motor and the lower part of both shanks.
    pub axle_kg: f32,
    /// Centre of what the legs carry, above the hip centre, in m.
    pub carried_up_m: f32,
    /// The IMU ahead of this centre, in m.
    pub imu_ahead_m: f32,
    /// The IMU above this centre, in m.
    pub imu_over_m: f32,
    /// Moment of inertia of what the legs carry, about the forward axis through its centre, in kg·m².
    pub roll_kgm2: f32,
    /// The same about the axis to the left.
    pub pitch_kgm2: f32,
    /// Moment of inertia of a wheel and its rotor about the axle in kg·m².
    pub wheel_kgm2: f32,
    /// Moment of inertia of a hip's rotor, seen at the joint, in kg·m².
    pub hip_kgm2: f32,
}

/// State feedback for every pair of leg lengths. `robot gains` computes it from the robot's file.
///
/// Inputs are the torque of the left and the right wheel (forward positive) and the torque of the body on the left and
/// the right leg (leaning the leg forward positive), in N·m. States are distance, its rate, yaw, its rate, lean of the
/// left leg, its rate, lean of the right leg, its rate, pitch, its rate, in m and rad. The torque is −K·(state −
/// reference).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainSchedule {
    /// Leg length in m about which the polynomials are written.
    pub centre_m: f32,
    /// Shortest leg in m for which they hold.
    pub min_m: f32,
    /// Longest leg in m for which they hold.
    pub max_m: f32,
    /// Coefficients of 1, l, r, l², l·r, r² of each gain, by input and state. l and r are the lengths of the left and the
    /// right leg less `centre_m`.
    pub k: [[[f32; 6]; 10]; 4],
}

/// Limits of a balancing robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BalanceLimits {
    /// Speed at full stick in m/s.
    pub max_speed_mps: f32,
    /// Turn rate at full stick in rad/s.
    pub max_yaw_rps: f32,
    /// Roll at full stick in rad.
    pub max_roll_rad: f32,
    /// Shortest leg while balancing in m.
    pub min_length_m: f32,
    /// Longest leg while balancing in m.
    pub max_length_m: f32,
    /// Shortest leg that the mechanics allow, in m.
    pub fold_length_m: f32,
    /// Longest leg that the mechanics allow, in m.
    pub reach_length_m: f32,
    /// Longest leg in m that the ranges of the hips allow, straight down, and how much shorter it is by angle, in m/rad.
    pub hips_reach_m: f32,
    /// See [`Self::hips_reach_m`].
    pub hips_reach_m_per_rad: f32,
    /// Largest torque of a wheel in N·m.
    pub wheel_nm: f32,
    /// Largest torque of a hip joint in N·m, for the moments in which balance needs it.
    pub hip_nm: f32,
}

/// What balancing needs to know of a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BalanceProfile {
    /// Geometry of both legs.
    pub legs: LegGeometry,
    /// Masses.
    pub mass: MassModel,
    /// State feedback.
    pub gains: GainSchedule,
    /// Limits.
    pub limits: BalanceLimits,
}
