//! A board that sits in the robot a little otherwise than the firmware has been told.

use crate::attitude::{Quaternion, to_body};

/// The turn of the board, `None` where it sits exactly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Askew(Option<Quaternion>);

impl Askew {
    /// Turned by a rotation vector in body axes, rad.
    pub(super) fn new(vector_rad: [f64; 3]) -> Self {
        let angle_rad = vector_rad
            .iter()
            .map(|part| part * part)
            .sum::<f64>()
            .sqrt();
        Self((angle_rad > 0.0).then(|| {
            let (sin, cos) = (angle_rad / 2.0).sin_cos();
            let [x, y, z] = vector_rad.map(|part| part / angle_rad * sin);
            [cos, x, y, z]
        }))
    }

    /// A vector of the body in the axes that the board has taken.
    pub(super) fn to_board(self, body: [f64; 3]) -> [f64; 3] {
        self.0.map_or(body, |turn| to_body(turn, body))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_with_its_nose_too_low_feels_the_ground_push_it_backward() {
        let askew = Askew::new([0.0, 0.1, 0.0]);
        let [x, y, z] = askew.to_board([0.0, 0.0, 9.80665]);
        assert!(
            (x + 9.80665 * 0.1_f64.sin()).abs() < 1e-9 && y == 0.0,
            "{x}"
        );
        assert!((z - 9.80665 * 0.1_f64.cos()).abs() < 1e-9, "{z}");
        assert_eq!(
            Askew::new([0.0; 3]).to_board([1.0, 2.0, 3.0]),
            [1.0, 2.0, 3.0]
        );
    }
}
