//! Sums worked out by hand.

use super::*;

fn close(got: f32, expected: f32) -> bool {
    (got - expected).abs() < 1e-5
}

#[test]
fn forty_samples_fill_a_window() {
    let mut window = Window::new();
    // The body's x axis points north, y west, z up.
    let mid_sample = MidSample {
        rotation: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        gap_error_rad2: 1e-4,
    };
    for sample in 0_u8..40 {
        assert!(!window.is_full());
        window.add_rotation(&mid_sample, [1.0, 2.0, 3.0], [0.5, 2.0, 3.0], 0.005);
        window.add_accel([f32::from(sample), 0.0, 9.0]);
    }
    assert!(window.is_full());
    assert!(close(window.duration_s, 0.2));
    assert!(close(window.gap_error_rad2, 0.004));
    // (0.25 + 4 + 9) · 0.2
    assert!(close(window.squared_rate_integral, 2.65));
    let [east, north, up] = window.accel_mps2();
    assert!(close(east, 19.5) && close(north, 0.0) && close(up, 9.0));
    // A bias about y (west) rotates about east positively, one about x about north negatively, one about z about up
    // negatively.
    let t = 0.2;
    let expected = [
        [
            0.0,
            t,
            0.0,
            0.0,
            0.0,
            0.0,
            t,
            2.0 * t,
            3.0 * t,
            0.0,
            0.0,
            0.0,
        ],
        [
            -t,
            0.0,
            0.0,
            -t,
            -2.0 * t,
            -3.0 * t,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        ],
        [
            0.0,
            0.0,
            -t,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            -t,
            -2.0 * t,
            -3.0 * t,
        ],
    ];
    for (row, expected) in window.angle_jacobian.iter().zip(expected) {
        for (got, expected) in row.iter().zip(expected) {
            assert!(close(*got, expected), "{got}, not {expected}");
        }
    }
}

#[test]
fn an_empty_window_has_no_force() {
    assert_eq!(Window::new().accel_mps2(), [0.0; 3]);
}
