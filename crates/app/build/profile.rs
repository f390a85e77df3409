//! `RobotProfile` of a robot.

use robot_description::{Carrier, Mounting, Robot};

use crate::{
    Constants, gains,
    literal::{f32, sign},
};

/// `pub const …: RobotProfile`.
pub fn constant(Constants { profile, .. }: &Constants, robot: &Robot) -> Result<String, String> {
    let Robot { name, wheels, .. } = robot;
    Ok(format!(
        "/// The robot `{name}`.\n\
         pub const {profile}: RobotProfile = RobotProfile {{ \
             name: {name:?}, \
             fingerprint: {fingerprint:#018x}, \
             wheel_odom: {odom}, \
             wheel_current_ma: {current_ma}, \
             mounting: {mounting}, \
             imu_up_m: {imu_up_m}, \
             balance: BalanceProfile {{ legs: {legs}, mass: {mass}, gains: {gains}, limits: {limits} }} \
         }};\n",
        fingerprint = robot.fingerprint(),
        odom = wheel_odom(robot),
        current_ma = f32(wheels.current_limit_a * 1e3),
        mounting = mounting(robot),
        imu_up_m = f32(robot.imu.place_m[2]),
        legs = legs(robot),
        mass = mass(robot),
        gains = gains::schedule(robot)?,
        limits = limits(robot),
    ))
}

fn wheel_odom(robot: &Robot) -> String {
    let wheels = &robot.wheels;
    let [left, right] = wheels.signs.map(sign);
    format!(
        "WheelOdomConfig {{ \
             wheel_radius_m: {radius_m}, \
             wheel_track_m: {track_m}, \
             gear_ratio: {gear_ratio}, \
             rpm_sign_left: {left}, \
             rpm_sign_right: {right} \
         }}",
        radius_m = f32(wheels.radius_m),
        track_m = f32(wheels.track_m),
        gear_ratio = f32(wheels.gear_ratio),
    )
}

fn mounting(robot: &Robot) -> String {
    let mag = match &robot.imu.mag_mounting {
        Some(mounting) => format!("Some({})", orientation(mounting)),
        None => "None".to_owned(),
    };
    format!(
        "MountingConfig {{ board: {board}, mag: {mag} }}",
        board = orientation(&robot.imu.mounting),
    )
}

/// `x-forward-z-up` is `Orientation::XForwardZUp`.
fn orientation(mounting: &Mounting) -> String {
    let words = mounting.name().split('-').map(|word| {
        let (first, rest) = word.split_at(1);
        first.to_uppercase() + rest
    });
    format!("Orientation::{}", words.collect::<String>())
}

fn legs(robot: &Robot) -> String {
    let legs = &robot.legs;
    let carrier = match robot.wheels.carrier {
        Carrier::Front => "Front",
        Carrier::Rear => "Rear",
    };
    format!(
        "LegGeometry {{ \
             hip_gap_m: {gap_m}, \
             thigh_m: {thigh_m}, \
             shank_m: {shank_m}, \
             carrier: Carrier::{carrier} \
         }}",
        gap_m = f32(legs.hip_gap_m),
        thigh_m = f32(legs.thigh.length_m),
        shank_m = f32(legs.shank.length_m),
    )
}

fn mass(robot: &Robot) -> String {
    let split = robot.split_mass();
    format!(
        "MassModel {{ \
             total_kg: {total_kg}, \
             carried_kg: {carried_kg}, \
             axle_kg: {axle_kg}, \
             carried_up_m: {carried_up_m}, \
             imu_ahead_m: {imu_ahead_m}, \
             imu_over_m: {imu_over_m}, \
             roll_kgm2: {roll_kgm2}, \
             pitch_kgm2: {pitch_kgm2}, \
             wheel_kgm2: {wheel_kgm2}, \
             hip_kgm2: {hip_kgm2} \
         }}",
        total_kg = f32(robot.total_mass_kg()),
        carried_kg = f32(split.carried_kg),
        axle_kg = f32(split.axle_kg),
        carried_up_m = f32(split.carried_up_m),
        imu_ahead_m = f32(robot.imu.place_m[0] - split.carried_ahead_m),
        imu_over_m = f32(robot.imu.place_m[2] - split.carried_up_m),
        roll_kgm2 = f32(split.roll_kgm2),
        pitch_kgm2 = f32(split.pitch_kgm2),
        wheel_kgm2 = f32(robot.wheels.inertia_kgm2 + robot.wheels.rotor_inertia_kgm2),
        hip_kgm2 = f32(robot.joints.armature_kgm2),
    )
}

fn limits(robot: &Robot) -> String {
    let limits = &robot.control.limits;
    let [min_length_m, max_length_m] = limits.height_m;
    let reach = robot.reach();
    format!(
        "BalanceLimits {{ \
             max_speed_mps: {speed_mps}, \
             max_yaw_rps: {yaw_rps}, \
             max_roll_rad: {roll_rad}, \
             min_length_m: {min_length_m}, \
             max_length_m: {max_length_m}, \
             fold_length_m: {fold_length_m}, \
             reach_length_m: {reach_length_m}, \
             hips_reach_m: {hips_reach_m}, \
             hips_reach_m_per_rad: {hips_reach_m_per_rad}, \
             wheel_nm: {wheel_nm}, \
             hip_nm: {hip_nm} \
         }}",
        speed_mps = f32(limits.max_speed_mps),
        yaw_rps = f32(limits.max_yaw_rps),
        roll_rad = f32(limits.max_roll_rad),
        min_length_m = f32(min_length_m),
        max_length_m = f32(max_length_m),
        fold_length_m = f32(robot.legs.min_m),
        reach_length_m = f32(robot.legs.max_m),
        hips_reach_m = f32(reach.down_m),
        hips_reach_m_per_rad = f32(reach.less_m_per_rad),
        wheel_nm = f32(robot.wheels.max_current_a * robot.wheels.torque_nm_per_a),
        hip_nm = f32(robot.joints.torque_limit_nm),
    )
}
