//! Conversion of quaternions to angles that are easier to read.

use robot_plant::attitude::{Quaternion, roll_pitch_yaw_rad};

use super::super::trace::Traces;

/// Roll, pitch and yaw in degrees (z-y-x order) of the quaternion at four signals, w first.
pub fn angles_deg(traces: &Traces, names: [&str; 4]) -> Option<[Vec<Option<f64>>; 3]> {
    let [w, x, y, z] = names.map(|name| traces.signal(name));
    let (w, x, y, z) = (w?, x?, y?, z?);
    let mut angles: [Vec<Option<f64>>; 3] = Default::default();
    for i in 0..w.len() {
        let q = [w[i], x[i], y[i], z[i]];
        let rpy = match q {
            [Some(w), Some(x), Some(y), Some(z)] if w * w + x * x + y * y + z * z > 0.5 => {
                roll_pitch_yaw_deg([w, x, y, z]).map(Some)
            }
            _ => [None; 3],
        };
        for (series, angle) in angles.iter_mut().zip(rpy) {
            series.push(angle);
        }
    }
    Some(angles)
}

fn roll_pitch_yaw_deg(q_wxyz: Quaternion) -> [f64; 3] {
    roll_pitch_yaw_rad(q_wxyz).map(f64::to_degrees)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_about_each_axis() {
        let h = std::f64::consts::FRAC_1_SQRT_2;
        for (q, expected) in [
            ([h, h, 0.0, 0.0], [90.0, 0.0, 0.0]),
            ([h, 0.0, 0.0, h], [0.0, 0.0, 90.0]),
            ([0.75f64.sqrt(), 0.0, -0.5, 0.0], [0.0, -60.0, 0.0]),
        ] {
            let rpy = roll_pitch_yaw_deg(q);
            let pairs = rpy.iter().zip(expected);
            assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-6), "{rpy:?}");
        }
    }
}
