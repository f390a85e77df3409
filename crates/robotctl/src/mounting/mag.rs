//! Finds how the magnetometer sits on the board from samples of a robot turned by hand.
//!
//! The earth's field does not move while the robot turns, and the robot's own field turns with it. Each of the 24
//! orientations is tried. For each, the two fields that fit the samples best are computed. The orientation with the
//! smallest residual is the true one.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use robot_app::domain::Orientation;

/// The estimated attitude and the field at the same moment.
#[derive(Clone, Copy, Debug)]
pub struct FieldSample {
    /// Rotation matrix from robot to earth.
    pub attitude: Matrix3<f64>,
    /// The field along the magnetometer's own (right-handed) axes, in µT.
    pub field_ut: Vector3<f64>,
}

/// Fewer samples than this say nothing.
const MIN_SAMPLES: usize = 50;
/// How well each direction of the field must be known. It is the mean square by which turning moved it: a tilt by 60°
/// to one side and back gives 0.2.
const MIN_TURN: f64 = 0.1;
/// The earth's field is 22 to 67 µT, and the magnetometer may not be calibrated.
const EARTH_UT: std::ops::RangeInclusive<f64> = 12.0..=110.0;
/// Largest residual of the best orientation, as a share of the field.
const MAX_LEFT: f64 = 0.3;
/// The residual of the second best orientation must be this many times as large.
const MIN_LEAD: f64 = 2.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MagMounting {
    /// Orientation of the magnetometer on the board.
    pub orientation: Orientation,
    pub earth_ut: f64,
    /// Angle at which the field points into the ground; negative if it points out of it. A mirror image of right-handed
    /// axes fits as well, with the field reversed.
    pub dip_deg: f64,
    /// Residual of the best orientation, in µT rms.
    pub residual_ut: f64,
    /// Residual of the second best orientation, in µT rms.
    pub second_residual_ut: f64,
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MagError {
    #[error(
        "the robot was turned too little, or about one axis only: turn it left, nose up, left side up, upside down"
    )]
    TooLittle,
    #[error(
        "the field that turned against the robot is {0:.0} µT, which is not the earth's; go away from iron and motors"
    )]
    NotTheEarth(f64),
    #[error(
        "no orientation explains what the magnetometer showed: the best leaves {residual_ut:.0} µT of {earth_ut:.0}, the \
         second best {second_residual_ut:.0}; go away from iron and motors, and turn slowly"
    )]
    Unclear {
        residual_ut: f64,
        second_residual_ut: f64,
        earth_ut: f64,
    },
}

/// True if the samples so far are enough.
pub fn enough_turned(samples: &[FieldSample]) -> bool {
    samples.len() >= MIN_SAMPLES && Turn::of(samples).is_some()
}

/// Finds how the magnetometer sits. `board` is how the board sits, and must be right.
pub fn find_mag(board: Orientation, samples: &[FieldSample]) -> Result<MagMounting, MagError> {
    if samples.len() < MIN_SAMPLES {
        return Err(MagError::TooLittle);
    }
    let turn = Turn::of(samples).ok_or(MagError::TooLittle)?;
    let mut ways = Orientation::ALL.map(|mag| {
        let turned = |field: Vector3<f64>| {
            let field = field.map(|part| part as f32);
            Vector3::from(board.rotate(mag.rotate(field.into()))).map(f64::from)
        };
        (mag, turn.fit(samples, turned))
    });
    ways.sort_by(|a, b| a.1.residual_ut.total_cmp(&b.1.residual_ut));
    let [(orientation, best), (_, second), ..] = ways;
    let (residual_ut, second_residual_ut) = (best.residual_ut, second.residual_ut);
    let earth_ut = best.earth_ut.norm();
    if residual_ut > MAX_LEFT * earth_ut || residual_ut * MIN_LEAD > second_residual_ut {
        return Err(MagError::Unclear {
            residual_ut,
            second_residual_ut,
            earth_ut,
        });
    }
    if !EARTH_UT.contains(&earth_ut) {
        return Err(MagError::NotTheEarth(earth_ut));
    }
    Ok(MagMounting {
        orientation,
        earth_ut,
        dip_deg: (-best.earth_ut.z / earth_ut).asin().to_degrees(),
        residual_ut,
        second_residual_ut,
    })
}

/// The mean rotation from earth to robot, and how well the earth's field can be distinguished from the robot's own.
struct Turn {
    mean: Matrix3<f64>,
    inverse: Matrix3<f64>,
}

struct Fit {
    earth_ut: Vector3<f64>,
    residual_ut: f64,
}

impl Turn {
    /// Returns `None` if the robot was turned too little.
    fn of(samples: &[FieldSample]) -> Option<Self> {
        let share = 1.0 / samples.len() as f64;
        let mean = samples.iter().map(|s| s.attitude.transpose() * share);
        let mean: Matrix3<f64> = mean.sum();
        let spread = samples.iter().map(|s| {
            let off = s.attitude.transpose() - mean;
            off.transpose() * off * share
        });
        let spread: Matrix3<f64> = spread.sum();
        let least = SymmetricEigen::new(spread).eigenvalues.min();
        let inverse = spread.try_inverse()?;
        (least > MIN_TURN).then_some(Self { mean, inverse })
    }

    /// Returns the earth's field that fits best, and the residual.
    fn fit(&self, samples: &[FieldSample], turned: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Fit {
        let share = 1.0 / samples.len() as f64;
        let mean: Vector3<f64> = samples.iter().map(|s| turned(s.field_ut) * share).sum();
        let parts = || {
            samples.iter().map(|s| {
                let off = s.attitude.transpose() - self.mean;
                (off, turned(s.field_ut) - mean)
            })
        };
        let sum: Vector3<f64> = parts()
            .map(|(off, field)| off.transpose() * field * share)
            .sum();
        let earth = self.inverse * sum;
        let left: f64 = parts()
            .map(|(off, field)| (field - off * earth).norm_squared() * share)
            .sum();
        Fit {
            earth_ut: earth,
            residual_ut: left.sqrt(),
        }
    }
}
