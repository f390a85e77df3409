//! Scalar functions in single precision, with their error and range.

use core::f32::consts::{FRAC_PI_2, PI};

/// 1/√x for normal positive x, else 0. Relative error below 3e-7.
#[inline(never)]
pub fn inverse_sqrt(x: f32) -> f32 {
    const LEAST_NORMAL: u32 = 0x0080_0000;
    const INFINITY: u32 = 0x7F80_0000;
    let bits = x.to_bits();
    // One comparison excludes zero, subnormal, negative, infinite and NaN.
    if bits.wrapping_sub(LEAST_NORMAL) >= INFINITY - LEAST_NORMAL {
        return 0.0;
    }
    // Halving the exponent gives a first guess within 3.5 %. Each Newton step squares the relative error.
    let mut y = f32::from_bits(0x5F37_59DF_u32.wrapping_sub(bits >> 1));
    let half = 0.5 * x;
    y *= 1.5 - half * y * y;
    y *= 1.5 - half * y * y;
    y *= 1.5 - half * y * y;
    y
}

/// The same as `f32::min`, which the compiler turns into a library call, as this core has no such instruction.
pub fn min(a: f32, b: f32) -> f32 {
    if a < b || b.is_nan() { a } else { b }
}

/// The same as `f32::max`.
pub fn max(a: f32, b: f32) -> f32 {
    if a > b || b.is_nan() { a } else { b }
}

/// Limits `value` to `low` … `high`, where `low` ≤ `high`. NaN stays NaN. Unlike `f32::clamp` it cannot panic, which
/// would also add the printing of floats to the image, 20 KiB.
pub fn clamp(value: f32, low: f32, high: f32) -> f32 {
    if value > high {
        high
    } else if value < low {
        low
    } else {
        value
    }
}

/// √x for normal positive x, else 0.
pub fn sqrt(x: f32) -> f32 {
    x * inverse_sqrt(x)
}

/// Sine and cosine by their series. The error is below 1e-7 for |x| ≤ 0.5 and below 3e-6 for |x| ≤ 1.
pub fn sin_cos_small(x: f32) -> (f32, f32) {
    let x2 = x * x;
    let sin = x * (1.0 - x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0)));
    let cos = 1.0 - x2 / 2.0 * (1.0 - x2 / 12.0 * (1.0 - x2 / 30.0 * (1.0 - x2 / 56.0)));
    (sin, cos)
}

/// Sine and cosine by longer series. The error is below 3e-7 for |x| ≤ 1.6.
pub fn sin_cos(x: f32) -> (f32, f32) {
    let x2 = x * x;
    let mut sin = 0.0;
    for coefficient in [
        -2.505_210_8e-8,
        2.755_731_9e-6,
        -1.984_127e-4,
        8.333_333e-3,
        -1.666_666_7e-1,
    ] {
        sin = (sin + coefficient) * x2;
    }
    let mut cos = 0.0;
    for coefficient in [
        2.087_675_7e-9,
        -2.755_732e-7,
        2.480_158_7e-5,
        -1.388_888_9e-3,
        4.166_666_7e-2,
        -0.5,
    ] {
        cos = (cos + coefficient) * x2;
    }
    (x + x * sin, 1.0 + cos)
}

/// Angle of the point (x, y) in −π … π; 0 for the origin, for NaN and for two infinities. The error is below 3e-7.
///
/// The ratio of the smaller part to the larger goes through an odd minimax polynomial over 0 … 1, whose error is 1e-8.
#[inline(never)]
pub fn atan2(y: f32, x: f32) -> f32 {
    let (ax, ay) = (x.abs(), y.abs());
    let (low, high) = if ax < ay { (ax, ay) } else { (ay, ax) };
    let ratio = low / high;
    if ratio.is_nan() {
        return 0.0;
    }
    let r2 = ratio * ratio;
    let mut polynomial = 2.622_238e-3 * r2 - 1.513_251e-2;
    for coefficient in [
        4.112_181_8e-2,
        -7.366_703e-2,
        1.057_393e-1,
        -1.418_597_5e-1,
        1.999_039_7e-1,
        -3.333_298_6e-1,
    ] {
        polynomial = coefficient + polynomial * r2;
    }
    let mut angle = ratio + ratio * r2 * polynomial;
    if ax < ay {
        angle = FRAC_PI_2 - angle;
    }
    if x < 0.0 {
        angle = PI - angle;
    }
    if y < 0.0 { -angle } else { angle }
}

/// Arc sine of `x` limited to −1 … 1; 0 for NaN and infinity. The error is below 1e-6.
///
/// Up to 30° it is the polynomial of the Cephes library. Beyond, asin x = π/2 − 2·asin √((1 − x)/2).
pub fn asin(x: f32) -> f32 {
    let size = x.abs();
    if size <= 0.5 {
        return asin_small(x, x * x);
    }
    if !size.is_finite() {
        return 0.0;
    }
    // Negative for |x| > 1, where `sqrt` gives 0.
    let half = 0.5 - 0.5 * size;
    let angle = FRAC_PI_2 - 2.0 * asin_small(sqrt(half), half);
    if x < 0.0 { -angle } else { angle }
}

/// `x2` is the square of `x`.
fn asin_small(x: f32, x2: f32) -> f32 {
    let polynomial =
        (((4.216_32e-2 * x2 + 2.418_131e-2) * x2 + 4.547_002_6e-2) * x2 + 7.495_300_3e-2) * x2
            + 1.666_675_2e-1;
    x + x * x2 * polynomial
}

#[cfg(test)]
mod beside_micromath;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamp_keeps_values_within_the_limits() {
        let inside = [-2.0, -1.0, 0.5, 1.0, f32::INFINITY].map(|value| clamp(value, -1.0, 1.0));
        assert_eq!(inside, [-1.0, -1.0, 0.5, 1.0, 1.0]);
        assert!(clamp(f32::NAN, -1.0, 1.0).is_nan());
    }

    #[test]
    fn min_and_max_match_the_standard_library() {
        let values = [-1.0, 0.0, 2.5, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        for a in values {
            for b in values {
                assert_eq!(min(a, b).to_bits(), a.min(b).to_bits(), "{a} {b}");
                assert_eq!(max(a, b).to_bits(), a.max(b).to_bits(), "{a} {b}");
            }
        }
    }

    #[test]
    fn inverse_sqrt_matches_double_precision() {
        for exponent in -126..127 {
            for step in 0..64 {
                let x = (1.0 + f64::from(step) / 64.0) * 2f64.powi(exponent);
                let got = f64::from(inverse_sqrt(x as f32));
                let error = got * f64::from(x as f32).sqrt() - 1.0;
                assert!(error.abs() < 3e-7, "1/√{x}: {error}");
            }
        }
        for odd in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert_eq!(inverse_sqrt(odd), 0.0);
        }
    }

    #[test]
    fn small_angles_match_double_precision() {
        for step in -1000..=1000 {
            let x = step as f32 / 1000.0;
            let limit = if x.abs() <= 0.5 { 1e-7 } else { 3e-6 };
            let (sin, cos) = sin_cos_small(x);
            assert!((f64::from(sin) - f64::from(x).sin()).abs() < limit, "{x}");
            assert!((f64::from(cos) - f64::from(x).cos()).abs() < limit, "{x}");
        }
    }

    #[test]
    fn angles_up_to_a_right_angle_match_double_precision() {
        for step in -1600..=1600 {
            let x = step as f32 / 1000.0;
            let (sin, cos) = sin_cos(x);
            assert!((f64::from(sin) - f64::from(x).sin()).abs() < 3e-7, "{x}");
            assert!((f64::from(cos) - f64::from(x).cos()).abs() < 3e-7, "{x}");
        }
    }

    #[test]
    fn atan2_matches_double_precision() {
        for step in -18_000..=18_000 {
            let angle = (f64::from(step) / 100.0).to_radians();
            let (y, x) = (angle.sin() as f32 * 50.0, angle.cos() as f32 * 50.0);
            let expected = f64::from(y).atan2(f64::from(x));
            let error = f64::from(atan2(y, x)) - expected;
            assert!(error.abs() < 3e-7, "{step}: {error}");
        }
        let (nan, infinity) = (f32::NAN, f32::INFINITY);
        for (y, x) in [(0.0, 0.0), (nan, 1.0), (1.0, nan), (infinity, infinity)] {
            assert_eq!(atan2(y, x), 0.0);
        }
        assert_eq!(atan2(infinity, 1.0), FRAC_PI_2);
    }

    #[test]
    fn asin_matches_double_precision_and_clamps() {
        for step in -1000..=1000 {
            let x = step as f32 / 1000.0;
            assert!((f64::from(asin(x)) - f64::from(x).asin()).abs() < 1e-6);
        }
        assert!((asin(2.0) - FRAC_PI_2).abs() < 1e-6);
        assert_eq!(asin(f32::NAN), 0.0);
    }
}
