//! Finds the magnetometer's axes from a full circle of the board.

use std::{
    thread,
    time::{Duration, Instant},
};

use super::verdict::{AXES, Measured, read};
use crate::tuning::{TuningClient, TuningError};

/// Time to turn the board once by hand.
const CIRCLE: Duration = if cfg!(test) {
    Duration::ZERO
} else {
    Duration::from_secs(15)
};
const PAUSE: Duration = Duration::from_millis(20);

/// Follows the field over a full circle to the left that begins with the nose to the north. Iron on the robot moves
/// only the centre of the circle.
pub fn circle(client: &mut TuningClient) -> Result<Measured, TuningError> {
    let mut path = Vec::new();
    let end = Instant::now() + CIRCLE;
    while path.is_empty() || Instant::now() < end {
        let field = read(client, "mag", 0)?;
        let [x, y, z] = AXES.map(|axis| field.number(&format!("{axis}-ut")));
        if let (Some(x), Some(y), Some(z)) = (x, y, z) {
            path.push([x, y, z]);
        }
        thread::sleep(PAUSE);
        if path.is_empty() && Instant::now() >= end {
            break;
        }
    }
    Ok(circle_of(&path))
}

fn circle_of(path: &[[f64; 3]]) -> Measured {
    let mut found = Measured::default();
    let middle = |axis: usize| {
        let of_axis = || path.iter().map(move |field| field[axis]);
        let (low, high) = (
            of_axis().fold(f64::MAX, f64::min),
            of_axis().fold(f64::MIN, f64::max),
        );
        (low + high) / 2.0
    };
    let (x, y) = (middle(0), middle(1));
    let angles: Vec<f64> = path
        .iter()
        .map(|field| (field[1] - y).atan2(field[0] - x).to_degrees())
        .collect();
    let step = |pair: &[f64]| (pair[1] - pair[0] + 180.0).rem_euclid(360.0) - 180.0;
    let turned: f64 = angles.windows(2).map(step).sum();
    let began = angles.first().copied().unwrap_or(f64::NAN);
    let radius = path
        .first()
        .map_or(f64::NAN, |field| (field[0] - x).hypot(field[1] - y));
    found.values.push(("north-at-first-deg".to_owned(), began));
    found.values.push(("north-turned-deg".to_owned(), turned));
    found.values.push(("horizontal-ut".to_owned(), radius));
    found.values.push((
        "z-ut".to_owned(),
        path.first().map_or(f64::NAN, |field| field[2]),
    ));
    found.must(!path.is_empty(), || {
        "the magnetometer shows nothing".to_owned()
    });
    found.must((-450.0..=-270.0).contains(&turned), || {
        format!("north must turn by -360 deg in the robot's axes, to the right: it turned by {turned:.0}")
    });
    found.must(began.abs() < 40.0, || {
        format!("at first north must be ahead (x, 0 deg): it was at {began:.0} deg, left is +90")
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::first_board::Verdict;

    /// The board turns to the left from north in steps of 10°. The horizontal field is 20 µT, and iron adds (35, −50)
    /// µT. After 90° the nose points west and north is to the right, at −y.
    fn path(begin_deg: f64, step_deg: f64, mirrored: bool) -> Vec<[f64; 3]> {
        let place = |step: i32| {
            let angle = (begin_deg + step_deg * f64::from(step)).to_radians();
            let side = if mirrored { -1.0 } else { 1.0 };
            [
                35.0 + 20.0 * angle.cos(),
                -50.0 + side * 20.0 * angle.sin(),
                -40.0,
            ]
        };
        (0..=36).map(place).collect()
    }

    fn complaint(path: &[[f64; 3]]) -> Option<String> {
        match circle_of(path).verdict {
            Verdict::AsItMustBe => None,
            Verdict::Wrong(why) => Some(why),
            Verdict::ForTheUser => panic!("it can be told"),
        }
    }

    #[test]
    fn a_circle_shows_the_magnetometers_axes_despite_iron() {
        assert_eq!(complaint(&path(0.0, -10.0, false)), None);
        let mirrored = complaint(&path(0.0, -10.0, true)).unwrap();
        assert!(mirrored.contains("it turned by 360"), "{mirrored}");
        let turned = complaint(&path(90.0, -10.0, false)).unwrap();
        assert!(turned.contains("it was at 90 deg"), "{turned}");
        let still = complaint(&path(0.0, 0.0, false)).unwrap();
        assert!(still.contains("it turned by 0"), "{still}");
        assert!(complaint(&[]).is_some());
    }
}
