//! Finds how the board sits from three poses of the robot.

use nalgebra::Vector3;
use robot_app::domain::Orientation;

use super::axis::Axis;

const GRAVITY_MPS2: f64 = 9.81;
/// Largest error of gravity that a still accelerometer without calibration shows.
const GRAVITY_ERROR_MPS2: f64 = 1.5;
/// Largest angle from the vertical of a board's axis while the robot is level. Settings have right angles only.
const MAX_SLANT_DEG: f64 = 25.0;
/// Smallest tilt that counts as intended.
const MIN_TILT_DEG: f64 = 15.0;
/// Largest angle between a tilt and the nearest axis of the board.
const MAX_SIDEWAYS_DEG: f64 = 30.0;

/// What the accelerometer shows at rest in each pose, along its own axes, in m/s².
#[derive(Clone, Copy, Debug)]
pub struct Poses {
    pub level: Vector3<f64>,
    pub nose_up: Vector3<f64>,
    pub left_up: Vector3<f64>,
}

/// What the poses showed, and the orientation that follows from it.
#[derive(Clone, Copy, Debug)]
pub struct BoardMounting {
    pub orientation: Orientation,
    /// The axis that pointed up while the robot was level, and by how much it was off.
    pub up: (Axis, f64),
    /// The axis that rose with the nose, and by how much the nose was lifted.
    pub nose: (Axis, f64),
    pub left: (Axis, f64),
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BoardError {
    #[error("{pose}: gravity is {mps2:.1} m/s² instead of 9.8; hold the robot still")]
    NoGravity { pose: &'static str, mps2: f64 },
    #[error(
        "level, the board's {axis} axis is nearest to the vertical, but {degrees:.0}° off; a board must sit at right angles \
         to the robot, and the robot must stand level"
    )]
    Slanted { axis: String, degrees: f64 },
    #[error("{pose}: the robot was tilted by {degrees:.0}° only; make it 30 to 90°")]
    TooLittle { pose: &'static str, degrees: f64 },
    #[error(
        "{pose}: the robot was tilted over an edge, {degrees:.0}° beside the board's {axis} axis; tilt it straight"
    )]
    Sideways {
        pose: &'static str,
        axis: String,
        degrees: f64,
    },
    #[error(
        "with the nose up the board's {nose} axis rose, with the left side up its {left} axis: both cannot be true; do it \
         again from level"
    )]
    SameWay { nose: String, left: String },
    #[error(
        "with the nose up the board's {nose} axis rose, with the left side up its {left} axis: that is a mirror image; was \
         it the tail, or the right side?"
    )]
    Mirrored { nose: String, left: String },
}

pub fn find_board(poses: &Poses) -> Result<BoardMounting, BoardError> {
    let level = unit("level", poses.level)?;
    let axis = Axis::nearest(level);
    let up = (axis, axis.degrees_to(level));
    if up.1 > MAX_SLANT_DEG {
        let (axis, degrees) = (axis.to_string(), up.1);
        return Err(BoardError::Slanted { axis, degrees });
    }
    let nose = risen("nose up", level, poses.nose_up)?;
    let left = risen("left side up", level, poses.left_up)?;
    let names = || (nose.0.to_string(), left.0.to_string());
    if nose.0.is_along(left.0) {
        let (nose, left) = names();
        return Err(BoardError::SameWay { nose, left });
    }
    if nose.0.unit().cross(&left.0.unit()) != up.0.unit() {
        let (nose, left) = names();
        return Err(BoardError::Mirrored { nose, left });
    }
    let points = |axis: Axis, robot: [f32; 3]| {
        let axis = axis.unit().map(|part| part as f32);
        move |orientation: &Orientation| orientation.rotate(axis.into()) == robot
    };
    let (is_up, is_forward) = (
        points(up.0, [0.0, 0.0, 1.0]),
        points(nose.0, [1.0, 0.0, 0.0]),
    );
    let mut all = Orientation::ALL.into_iter();
    let orientation = all.find(|orientation| is_up(orientation) && is_forward(orientation));
    let orientation = orientation.ok_or_else(|| {
        let (nose, left) = names();
        BoardError::SameWay { nose, left }
    })?;
    Ok(BoardMounting {
        orientation,
        up,
        nose,
        left,
    })
}

/// Returns the direction of up.
fn unit(pose: &'static str, force_mps2: Vector3<f64>) -> Result<Vector3<f64>, BoardError> {
    let mps2 = force_mps2.norm();
    if (mps2 - GRAVITY_MPS2).abs() < GRAVITY_ERROR_MPS2 {
        Ok(force_mps2 / mps2)
    } else {
        Err(BoardError::NoGravity { pose, mps2 })
    }
}

/// Returns the axis that was level and now points up the most, and by how much the robot was tilted.
fn risen(
    pose: &'static str,
    level: Vector3<f64>,
    force_mps2: Vector3<f64>,
) -> Result<(Axis, f64), BoardError> {
    let tilted = unit(pose, force_mps2)?;
    let tilt_deg = level.angle(&tilted).to_degrees();
    if !(MIN_TILT_DEG..=180.0 - MIN_TILT_DEG).contains(&tilt_deg) {
        return Err(BoardError::TooLittle {
            pose,
            degrees: tilt_deg.min(180.0 - tilt_deg),
        });
    }
    let along = tilted - level * tilted.dot(&level);
    let axis = Axis::nearest(along);
    let degrees = axis.degrees_to(along);
    if degrees > MAX_SIDEWAYS_DEG {
        let axis = axis.to_string();
        return Err(BoardError::Sideways {
            pose,
            axis,
            degrees,
        });
    }
    Ok((axis, tilt_deg))
}
