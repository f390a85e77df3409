//! Rotations known by hand, and the limits of accuracy.

use super::*;
use crate::math::testing::rotation_of;
use robot_test_support::Rotation;

fn rotate(q: Quaternion, v: Vector3) -> Vector3 {
    q.rotation_matrix().map(|row| vector::dot(row, v))
}

#[test]
fn a_quarter_turn_to_the_left_moves_x_to_y() {
    let half = core::f32::consts::FRAC_1_SQRT_2;
    let left = Quaternion {
        w: half,
        z: half,
        x: 0.0,
        y: 0.0,
    };
    let [x, y, z] = rotate(left, [1.0, 0.0, 0.0]);
    assert!(x.abs() < 1e-6 && (y - 1.0).abs() < 1e-6 && z.abs() < 1e-6);
    let [_, _, yaw] = left.roll_pitch_yaw();
    assert!((yaw - core::f32::consts::FRAC_PI_2).abs() < 1e-6);
}

#[test]
fn small_rotations_add_up_to_a_full_turn() {
    let step = Quaternion::from_rotation([0.0, 0.0, core::f32::consts::TAU / 1000.0]);
    let mut q = Quaternion::IDENTITY;
    for _ in 0..1000 {
        q = q.after(step).normalised();
    }
    assert!((q.w.abs() - 1.0).abs() < 1e-6 && q.z.abs() < 1e-4);
}

#[test]
fn nose_up_is_negative_pitch_about_left_axis() {
    // Right-hand rule about y (left): positive pitch turns x (forward) towards −z (down).
    let q = Quaternion::from_rotation([0.0, 0.2, 0.0]);
    let [_, _, z] = rotate(q, [1.0, 0.0, 0.0]);
    assert!((z + 0.2f32.sin()).abs() < 1e-6);
    let [roll, pitch, yaw] = q.roll_pitch_yaw();
    assert!(roll.abs() < 1e-6 && (pitch - 0.2).abs() < 1e-6 && yaw.abs() < 1e-6);
}
/// Error in rad against Rodrigues' formula in double precision.
fn error(angle_rad: Vector3) -> f64 {
    let got = rotation_of(Quaternion::from_rotation(angle_rad));
    got.angle_to_deg(Rotation::by(angle_rad.map(f64::from)))
        .to_radians()
}

fn length(q: Quaternion) -> f64 {
    let [w, x, y, z] = q.to_wxyz().map(f64::from);
    (w * w + x * x + y * y + z * z).sqrt()
}

#[test]
fn rotation_vectors_are_accurate_up_to_two_radians() {
    let axis = [0.6, -0.48, 0.64];
    assert_eq!(Quaternion::from_rotation([0.0; 3]), Quaternion::IDENTITY);
    for (angle, limit) in [
        (1e-20, 1e-7),
        (1e-4, 1e-7),
        (0.1, 5e-7),
        (0.99, 1e-6),
        (1.01, 1e-6),
        (-1.5, 1e-5),
        (2.0, 5e-5),
        // Half a turn, the most that a long gap at full rate asks for.
        (core::f32::consts::PI, 3e-3),
    ] {
        let angle_rad = vector::scale(axis, angle);
        assert!(error(angle_rad) < limit, "{angle}: {}", error(angle_rad));
        let length = length(Quaternion::from_rotation(angle_rad));
        assert!((length - 1.0).abs() < 2e-6, "{angle}: {length}");
    }
}

#[test]
fn levelling_turns_any_vector_upright() {
    let mut vectors = vec![
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.6, 0.0, -0.8],
    ];
    // Upside down, and nearly so.
    for tilt in [0.0, 1e-7, 1e-4, -1e-4, 1e-3, 3e-3, 0.03] {
        vectors.push([tilt, 0.0, -(1.0_f32 - tilt * tilt).sqrt()]);
        vectors.push([0.6 * tilt, -0.8 * tilt, -(1.0_f32 - tilt * tilt).sqrt()]);
    }
    for v in vectors {
        let q = Quaternion::levelling(v);
        assert!((length(q) - 1.0).abs() < 1e-6, "{v:?}: {q:?}");
        let [x, y, z] = rotate(q, v);
        // Within 0.002 rad of upside down any half turn is accepted.
        assert!(
            x.abs() < 2.5e-3 && y.abs() < 2.5e-3 && z > 0.999_99,
            "{v:?}: {x} {y} {z}"
        );
        assert_eq!(q.z, 0.0, "the shortest turn is about a level axis");
    }
}

#[test]
fn nearly_unit_quaternions_become_unit() {
    let unit = Quaternion::from_rotation([0.3, -0.8, 0.5]);
    for factor in [0.5, 0.99, 0.999_5, 1.000_4, 1.01, 3.0] {
        let q = Quaternion {
            w: unit.w * factor,
            x: unit.x * factor,
            y: unit.y * factor,
            z: unit.z * factor,
        };
        for (name, result) in [
            ("renormalised", q.renormalised()),
            ("normalised", q.normalised()),
        ] {
            let off = length(result) - 1.0;
            assert!(off.abs() < 2e-6, "{name} {factor}: {off}");
            let turned = rotation_of(result).angle_to_deg(rotation_of(unit));
            assert!(turned < 1e-4, "{name} {factor}: {turned}");
        }
    }
    let nothing = Quaternion {
        w: 0.0,
        ..Quaternion::IDENTITY
    };
    assert_eq!(nothing.renormalised(), Quaternion::IDENTITY);
}

#[test]
fn a_product_is_one_rotation_after_the_other() {
    let (first, second) = ([0.5, 0.2, -0.7], [-0.3, 0.9, 0.1]);
    let product = Quaternion::from_rotation(second).after(Quaternion::from_rotation(first));
    let expected =
        Rotation::by(second.map(f64::from)).then_in_body(Rotation::by(first.map(f64::from)));
    assert!(rotation_of(product).angle_to_deg(expected) < 1e-4);
    let rows = product.rotation_matrix();
    for (row, expected) in rows.iter().zip(expected.rows()) {
        for (got, expected) in row.iter().zip(expected) {
            assert!((f64::from(*got) - expected).abs() < 1e-6);
        }
    }
}
