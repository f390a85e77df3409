//! Velocity and position of the estimate, compared with the simulated truth.
//!
//! The world's IMU sits 5 cm ahead of the axle and 2 cm to the left; its accelerometer has the datasheet's offset.

use super::*;

/// Largest errors seen: speed along and across the body's nose in m/s, inclination in degrees.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    forward_mps: f64,
    left_mps: f64,
    inclination_deg: f64,
}

fn truth_m(robot: &Robot) -> [f64; 2] {
    ["truth.body.x", "truth.body.y"].map(|name| robot.signal(name))
}

/// [east, north] turned into [forward, left] of a body with this yaw.
fn along_body([east, north]: [f64; 2], yaw_rad: f64) -> [f64; 2] {
    let (sin, cos) = yaw_rad.sin_cos();
    [cos * east + sin * north, cos * north - sin * east]
}

fn run_and_compare(robot: &mut Robot, until_s: f64) -> Worst {
    let mut before_m = truth_m(robot);
    let mut worst = Worst::default();
    robot.run_until(until_s, |robot| {
        let now_m = truth_m(robot);
        // One tick is 1 ms.
        let true_mps = [0, 1].map(|axis| (now_m[axis] - before_m[axis]) * 1e3);
        before_m = now_m;
        let estimate = robot.diagnostics().estimate;
        let [east, north, _] = estimate.vel_mps.map(f64::from);
        let [_, _, yaw_rad] = estimate.rpy_rad.map(f64::from);
        let [forward, left] = along_body([east, north], yaw_rad);
        let [true_forward, true_left] = along_body(true_mps, robot.signal("truth.body.yaw"));
        let [_, _, inclination_deg] = robot.attitude_error_deg();
        worst.forward_mps = worst.forward_mps.max((forward - true_forward).abs());
        worst.left_mps = worst.left_mps.max((left - true_left).abs());
        worst.inclination_deg = worst.inclination_deg.max(inclination_deg);
    });
    worst
}

fn armed(plant: PlantKind) -> Robot {
    let mut robot = Robot::new(plant, RadioKind::Sbus);
    robot.run_until(2.5, assert_still);
    robot.remote(ENABLE);
    robot.run_until(3.0, |_| ());
    assert!(robot.armed(), "{:?}", blockers(&robot));
    robot
}

fn position_error_m(robot: &Robot) -> f64 {
    let [x, y, _] = robot.diagnostics().estimate.pos_m.map(f64::from);
    let [true_x, true_y] = truth_m(robot);
    (x - true_x).hypot(y - true_y)
}

/// 0.6 m/s for 2 s, a turn on the spot, full speed, full circles at full speed, and a full reversal: 10 m of way. In the
/// circles the tyres creep sideways by 0.12 m/s, which no sensor shows for long.
#[test]
fn velocity_and_position_follow_a_wild_drive() {
    let mut robot = armed(PlantKind::Rolling);
    let parts = [
        (0.4, 0.0, 5.0, 0.03, 0.02),
        (0.0, 0.0, 6.0, 0.03, 0.02),
        (0.0, 0.3, 8.0, 0.05, 0.08),
        (0.0, 0.0, 9.0, 0.05, 0.10),
        (1.0, 0.0, 10.0, 0.08, 0.02),
        (1.0, 1.0, 13.0, 0.08, 0.20),
        (-1.0, 0.0, 14.0, 0.20, 0.20),
        (0.0, 0.0, 16.0, 0.08, 0.10),
    ];
    for (vx, wz, until_s, forward_mps, left_mps) in parts {
        robot.remote(sticks(vx, wz));
        let worst = run_and_compare(&mut robot, until_s);
        assert!(
            worst.forward_mps < forward_mps && worst.left_mps < left_mps,
            "until {until_s} s: {worst:?}"
        );
        // 0.9° of it is the accelerometer's offset.
        assert!(worst.inclination_deg < 1.3, "until {until_s} s: {worst:?}");
    }
    let off_m = position_error_m(&robot);
    assert!(off_m < 0.15, "{off_m} m off after 10 m");
    let [_, _, z_m] = robot.diagnostics().estimate.pos_m;
    assert!(z_m.abs() < 0.1, "{z_m} m high");
}

/// Two minutes of weaving at 1 m/s and ±2.4 rad/s. The position error comes from the heading: 2° of 120 m.
#[test]
fn two_minutes_of_weaving_drift_by_the_heading_alone() {
    let mut robot = armed(PlantKind::Rolling);
    for second in 0..120 {
        let wz = if second % 2 == 0 { 0.6 } else { -0.6 };
        robot.remote(sticks(0.7, wz));
        let worst = run_and_compare(&mut robot, f64::from(4 + second));
        assert!(
            worst.forward_mps < 0.12 && worst.left_mps < 0.25 && worst.inclination_deg < 1.3,
            "at {second} s: {worst:?}"
        );
    }
    let off_m = position_error_m(&robot);
    let way_m = robot.signal("truth.body.path_m");
    assert!(
        way_m > 100.0 && off_m < 0.04 * way_m,
        "{off_m} m of {way_m} m"
    );
}

#[test]
fn a_robot_at_rest_keeps_its_position() {
    let mut robot = driving(PlantKind::Rolling, RadioKind::Sbus);
    robot.remote(sticks(0.0, 0.0));
    robot.run_until(7.0, |_| ());
    let before_m = robot.diagnostics().estimate.pos_m;
    robot.run_until(60.0, |robot| {
        let speeds = robot.diagnostics().estimate.vel_mps;
        assert!(
            speeds.iter().all(|mps| mps.abs() < 1e-3),
            "{speeds:?} m/s at {} s",
            robot.seconds()
        );
    });
    let after_m = robot.diagnostics().estimate.pos_m;
    for (before_m, after_m) in before_m.iter().zip(after_m) {
        assert!((before_m - after_m).abs() < 1e-3, "{before_m} → {after_m}");
    }
    // The body's z axis shows all of its offset, which the tilt cannot hide.
    let [_, _, z] = robot.diagnostics().estimate.accel_bias_mps2;
    assert!((0.05..0.25).contains(&z.abs()), "{z} m/s²");
}

/// The wheels reach 0.58 m/s at once, while the robot gains 0.49 m/s each second.
#[test]
fn spinning_wheels_do_not_change_the_velocity() {
    let mut robot = armed(PlantKind::Rolling);
    robot.fault("floor-slippery", true);
    robot.remote(FORWARD);
    let worst = run_and_compare(&mut robot, 4.0);
    let rim_mps = robot.signal("truth.wheel.0.speed_mps");
    let body_mps = robot.signal("truth.body.vx");
    assert!(rim_mps > 0.55 && body_mps < 0.5, "{rim_mps} {body_mps}");
    assert!(worst.forward_mps < 0.1, "{worst:?}");
    let worst = run_and_compare(&mut robot, 5.0);
    assert!(worst.forward_mps < 0.15, "{worst:?}");
    assert!(worst.inclination_deg < 1.3, "{worst:?}");
}

/// Full speed back and forth for 20 s on ice. The wheels never roll, so the speed cannot be known, but the horizon
/// stays.
#[test]
fn wheels_that_never_roll_do_not_tilt_the_horizon() {
    let mut robot = armed(PlantKind::Rolling);
    robot.fault("floor-slippery", true);
    for second in 0..20 {
        let vx = if second % 2 == 0 { 1.0 } else { -1.0 };
        robot.remote(sticks(vx, 0.0));
        let worst = run_and_compare(&mut robot, f64::from(4 + second));
        assert!(worst.inclination_deg < 1.3, "at {second} s: {worst:?}");
    }
}

/// From a circle at full speed into reverse on ice, the robot slides sideways at up to 1.3 m/s with its wheels
/// running backwards.
#[test]
fn sliding_sideways_is_detected() {
    let mut robot = armed(PlantKind::Rolling);
    robot.remote(sticks(1.0, 1.0));
    robot.run_until(5.0, |_| ());
    robot.fault("floor-slippery", true);
    robot.remote(sticks(-1.0, 0.0));
    let mut fastest_mps = 0.0_f64;
    robot.run_until(5.5, |robot| {
        let [east, north, _] = robot.diagnostics().estimate.vel_mps.map(f64::from);
        let [_, _, yaw_rad] = robot.diagnostics().estimate.rpy_rad.map(f64::from);
        let [_, left] = along_body([east, north], yaw_rad);
        fastest_mps = fastest_mps.max(left.abs());
    });
    assert!(fastest_mps > 0.8, "{fastest_mps} m/s");
    let worst = run_and_compare(&mut robot, 6.0);
    assert!(worst.forward_mps < 0.3 && worst.left_mps < 0.6, "{worst:?}");
    robot.fault("floor-slippery", false);
    robot.remote(sticks(0.0, 0.0));
    robot.run_until(8.0, |_| ());
    let worst = run_and_compare(&mut robot, 9.0);
    assert!(
        worst.forward_mps < 1e-3 && worst.left_mps < 1e-3,
        "{worst:?}"
    );
    let off_m = position_error_m(&robot);
    assert!(off_m < 0.6, "{off_m} m off");
}

#[test]
fn one_wheel_and_the_gyro_are_enough() {
    for fault in ["motor-0-gone", "motor-1-frozen"] {
        let mut robot = driving(PlantKind::Rolling, RadioKind::Sbus);
        robot.fault(fault, true);
        let worst = run_and_compare(&mut robot, 6.0);
        assert!(
            worst.forward_mps < 0.1 && worst.left_mps < 0.1,
            "{fault}: {worst:?}"
        );
    }
}

/// The wheels are in the air. Without an acceleration there is no motion, however long they turn.
#[test]
fn wheels_turning_in_the_air_are_not_motion() {
    let mut robot = driving(PlantKind::Stand, RadioKind::Sbus);
    for (vx, wz) in [(0.4, 0.0), (0.4, 0.3), (0.0, 0.8), (-1.0, 0.0), (0.1, 0.0)] {
        robot.remote(sticks(vx, wz));
        let until_s = robot.seconds() + 5.0;
        robot.run_until(until_s, |robot| {
            let speeds = robot.diagnostics().estimate.vel_mps;
            assert!(
                speeds.iter().all(|mps| mps.abs() < 0.2),
                "{speeds:?} at {} s",
                robot.seconds()
            );
        });
    }
    robot.remote(sticks(0.0, 0.0));
    let until_s = robot.seconds() + 1.0;
    robot.run_until(until_s, |_| ());
    let speeds = robot.diagnostics().estimate.vel_mps;
    assert!(speeds.iter().all(|mps| mps.abs() < 1e-3), "{speeds:?}");
}
