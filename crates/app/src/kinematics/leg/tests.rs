use proptest::prelude::*;

use super::*;

const GEOMETRY: LegGeometry = LegGeometry::EXAMPLE;

fn rows() -> Vec<Vec<f32>> {
    let lines = include_str!("vectors.csv").lines().skip(1);
    lines
        .map(|line| line.split(',').map(|v| v.parse().unwrap()).collect())
        .collect()
}

fn close(found: f32, wanted: f32, what: &str, row: &[f32]) {
    let limit = 3e-4 * (1.0 + wanted.abs());
    assert!(
        (found - wanted).abs() < limit,
        "{what}: {found}, {wanted} in {row:?}"
    );
}

/// `vectors.py` computes the rows with SciPy.
#[test]
fn legs_match_those_of_a_solver() {
    let rows = rows();
    assert_eq!(rows.len(), 60);
    for row in rows {
        let [gap, thigh, shank, front, rear, length, angle, ..] = row[..] else {
            panic!("{row:?}");
        };
        for (carrier, of_carrier) in [(Carrier::Front, 11), (Carrier::Rear, 13)] {
            let geometry = LegGeometry {
                hip_gap_m: gap,
                thigh_m: thigh,
                shank_m: shank,
                carrier,
            };
            let speeds = [0.7, -1.3];
            let leg = Leg::new(&geometry, [front, rear], speeds);
            assert!(leg.fits, "{row:?}");
            close(leg.length_m, length, "length", &row);
            close(leg.angle_rad, angle, "angle", &row);
            for joint in [0, 1] {
                close(leg.length_per_rad[joint], row[7 + joint], "length", &row);
                close(leg.angle_per_rad[joint], row[9 + joint], "angle", &row);
                close(
                    leg.carrier_per_rad[joint],
                    row[of_carrier + joint],
                    "carrier",
                    &row,
                );
            }
            let rate = |first: usize| row[first] * speeds[0] + row[first + 1] * speeds[1];
            close(leg.length_mps, rate(7), "rate of length", &row);
            close(leg.angle_rps, rate(9), "rate of angle", &row);
            close(leg.carrier_rps, rate(of_carrier), "carrier", &row);
        }
    }
}

/// Both joints forward by the same angle: the front knee rises, the rear knee sinks, the axle moves ahead.
#[test]
fn joints_that_turn_forward_move_the_axle_forward() {
    let leg = Leg::new(&GEOMETRY, [0.2, 0.2], [1.0, 1.0]);
    assert!(leg.angle_rad > 0.1 && leg.angle_rps > 0.5);
    let longer = Leg::new(&GEOMETRY, [-0.3, 0.3], [-1.0, 1.0]);
    assert!(longer.angle_rad.abs() < 1e-6 && longer.length_mps > 0.05);
}

#[test]
fn a_leg_that_cannot_close_is_told() {
    let apart = LegGeometry {
        hip_gap_m: 0.25,
        ..GEOMETRY
    };
    assert!(!Leg::new(&apart, [0.0, 0.0], [0.0; 2]).fits);
    assert!(Leg::new(&apart, [-1.0, 1.0], [0.0; 2]).fits);
    assert!(!Leg::new(&GEOMETRY, [-1.7, 0.0], [0.0; 2]).fits);
    assert!(!Leg::new(&GEOMETRY, [f32::NAN, 0.0], [0.0; 2]).fits);
}

proptest! {
    #[test]
    fn every_leg_is_finite(angles in any::<[f32; 2]>(), speeds in any::<[f32; 2]>(), near in [-2.0_f32..2.0, -2.0_f32..2.0]) {
        for angles in [angles, near] {
            let leg = Leg::new(&GEOMETRY, angles, [0.0; 2]);
            let Leg { length_m, angle_rad, length_per_rad, angle_per_rad, carrier_per_rad, .. } = leg;
            prop_assert!((0.01..1.0).contains(&length_m) && angle_rad.abs() < 3.2);
            for slope in length_per_rad.into_iter().chain(angle_per_rad).chain(carrier_per_rad) {
                prop_assert!(slope.abs() < 500.0, "{leg:?}");
            }
            let moving = Leg::new(&GEOMETRY, angles, speeds.map(|v| v.clamp(-1e6, 1e6)));
            prop_assert!((moving.length_mps + moving.angle_rps + moving.carrier_rps).is_finite());
        }
    }
}
