use super::*;

const FIVEBAR: &str = include_str!("../../../../robots/fivebar.toml");
const RS00: &str = include_str!("../../../../robots/fivebar-rs00.toml");

fn robot(text: &str) -> Robot {
    Robot::parse(text, "r.toml").expect("sound")
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} {expected}");
}

/// A NumPy program that stretches the legs with Jacobians by differences. Its small robot has smaller wheels.
#[test]
fn jumps_are_those_of_another_program() {
    let small = FIVEBAR
        .replace("radius_m = 0.075", "radius_m = 0.06")
        .replace("mass_kg = 0.32", "mass_kg = 0.25")
        .replace("inertia_kgm2 = 1.2e-3", "inertia_kgm2 = 6.0e-4");
    for (text, take_off_mps, push_s, hip_rps, rise_m, clearance_m) in [
        (small.as_str(), 1.97, 0.140, 17.4, 0.118, 0.250),
        (RS00, 2.20, 0.151, 14.2, 0.161, 0.331),
    ] {
        let jump = robot(text).figures().jump;
        assert_near(jump.take_off_mps, take_off_mps, 0.006);
        assert_near(jump.push_s, push_s, 0.001);
        assert_near(jump.hip_rps, hip_rps, 0.06);
        assert_near(jump.rise_m, rise_m, 0.0006);
        assert_near(jump.clearance_m, clearance_m, 0.0006);
    }
}

/// Carried are 4.30 + 4·0.10 + 4·0.12·(1 − 0.10/0.22) = 4.962 kg, on each leg 24.33 N. At 0.22 m each N takes 0.0813 N·m.
#[test]
fn the_hardest_stand_by_hand() {
    let stand = hardest_stand(&robot(FIVEBAR));
    assert_near(stand.length_m, 0.22, 0.01);
    assert_near(stand.hip_nm, 24.33 * 0.0813, 0.002);
    assert_near(stand.share, 24.33 * 0.0813 / 3.0, 0.001);
}

/// In every ms one command and two feedbacks, 0.25 replies of the tuning channel and a recorded sample in each tick: 4.25
/// frames of 135 bits. Each of four joints has a command and a reply in every second ms: 4 + 1.25.
#[test]
fn bus_loads_by_hand() {
    let loads = robot(FIVEBAR).figures().bus_loads;
    assert_near(loads[0], 4.25 * 0.135, 1e-9);
    assert_near(loads[1], 5.25 * 0.135, 1e-9);
}

/// 15 A are 4.5 N·m at each wheel: 120 N. 6.55 kg and 2·(1.2e-3 + 9.5e-3)/0.075² = 3.80 kg of turning parts.
#[test]
fn acceleration_by_hand() {
    assert_near(
        robot(FIVEBAR).figures().acceleration_mps2,
        120.0 / 10.354,
        0.01,
    );
}

/// The centre 0.02 m forward over folded legs of 0.11 m: 4.30/4.962 of it is what the legs carry.
#[test]
fn a_centre_of_mass_forward_leans_the_folded_legs() {
    let mut forward = robot(FIVEBAR);
    forward.body.com_m[0] = 0.02;
    let x_m: f64 = 0.02 * 4.30 / 4.962;
    assert_near(folded_lean_rad(&forward), (x_m / 0.11).asin(), 1e-4);
}
