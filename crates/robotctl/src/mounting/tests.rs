use nalgebra::{Rotation3, Vector3};
use robot_app::domain::Orientation;

use super::*;

fn poses(level: [f64; 3], nose_up: [f64; 3], left_up: [f64; 3]) -> Poses {
    Poses {
        level: level.into(),
        nose_up: nose_up.into(),
        left_up: left_up.into(),
    }
}

fn found(poses: &Poses) -> &'static str {
    find_board(poses).unwrap().orientation.name()
}

/// These were worked out by hand for a board held before a robot: 9.8 m/s² upwards, nose up by 45°, left side up by 60°
/// and 30°.
#[test]
fn three_poses_show_how_the_board_is_mounted() {
    // The board is flat with its default mounting and a small error.
    let flat = poses([0.3, -0.2, 9.8], [6.9, 0.1, 6.9], [0.1, 8.5, 4.9]);
    assert_eq!(found(&flat), "x-forward-z-up");
    // A quarter turn to the left: x points left, y backward.
    let turned = poses([0.0, 0.0, 9.8], [0.0, -6.9, 6.9], [8.5, 0.0, 4.9]);
    assert_eq!(found(&turned), "x-left-z-up");
    // Upside down, x forward: y points right.
    let over = poses([0.0, 0.0, -9.8], [6.9, 0.0, -6.9], [0.0, -4.9, -8.5]);
    assert_eq!(found(&over), "x-forward-z-down");
    // Upright, x down, face forward: y points left.
    let upright = poses([-9.8, 0.0, 0.0], [-6.9, 0.0, 6.9], [-4.9, 8.5, 0.0]);
    let seen = find_board(&upright).unwrap();
    assert_eq!(seen.orientation.name(), "x-down-z-forward");
    assert_eq!(
        describe(seen.orientation),
        "x points down, y left, z forward"
    );
    assert_eq!(seen.up.0.to_string(), "-x");
    assert_eq!(
        (seen.nose.0.to_string(), seen.nose.1.round()),
        ("z".to_owned(), 45.0)
    );
    assert_eq!(
        (seen.left.0.to_string(), seen.left.1.round()),
        ("y".to_owned(), 60.0)
    );
}

#[test]
fn every_orientation_of_the_board_is_found() {
    for orientation in Orientation::ALL {
        let felt = |up: [f32; 3]| {
            Vector3::from(orientation.rotate_back(up.map(|part| 9.8 * part))).map(f64::from)
        };
        let poses = Poses {
            level: felt([0.05, -0.05, 0.99]),
            nose_up: felt([0.6, 0.1, 0.79]),
            left_up: felt([-0.1, 0.95, 0.3]),
        };
        assert_eq!(find_board(&poses).unwrap().orientation, orientation);
    }
}

#[test]
fn poses_that_contradict_each_other_are_named() {
    let complaint = |poses: &Poses| find_board(poses).unwrap_err().to_string();
    let (level, nose, left) = ([0.0, 0.0, 9.8], [6.9, 0.0, 6.9], [0.0, 6.9, 6.9]);
    let slanted = complaint(&poses([4.9, 0.0, 8.5], nose, left));
    assert!(
        slanted.contains("the board's z axis is nearest to the vertical, but 30° off"),
        "{slanted}"
    );
    let little = complaint(&poses(level, [1.7, 0.0, 9.65], left));
    assert!(
        little.contains("nose up: the robot was tilted by 10° only"),
        "{little}"
    );
    let flipped = complaint(&poses(level, nose, [0.0, 0.5, -9.8]));
    assert!(
        flipped.contains("left side up: the robot was tilted by 3° only"),
        "{flipped}"
    );
    let sideways = complaint(&poses(level, [4.9, 4.9, 6.9], left));
    assert!(
        sideways.contains("nose up: the robot was tilted over an edge, 45° beside"),
        "{sideways}"
    );
    let same = complaint(&poses(level, nose, [-6.9, 0.0, 6.9]));
    assert!(
        same.contains("x axis rose, with the left side up its -x axis: both cannot"),
        "{same}"
    );
    let mirrored = complaint(&poses(level, nose, [0.0, -6.9, 6.9]));
    assert!(
        mirrored.contains("x axis rose, with the left side up its -y axis: that is a mirror"),
        "{mirrored}"
    );
    let falling = complaint(&poses(level, [0.0, 0.0, 0.5], left));
    assert!(
        falling.contains("nose up: gravity is 0.5 m/s²"),
        "{falling}"
    );
}

/// The field of Europe in east, north, up, in µT.
const EARTH_UT: [f64; 3] = [0.0, 22.0, -42.0];

/// The robot's own field, which turns with it.
const OWN_UT: [f64; 3] = [60.0, -25.0, 110.0];

/// Returns the samples of a robot turned by hand to the left, nose up and left side up. `felt` turns a field in the
/// robot's axes into what the magnetometer shows.
fn turned(
    count: usize,
    tilt_rad: f64,
    mut felt: impl FnMut([f64; 3]) -> [f64; 3],
) -> Vec<FieldSample> {
    let at = |index: usize| {
        let phase = index as f64 / count as f64 * std::f64::consts::TAU;
        let (roll, pitch) = (
            tilt_rad * (2.0 * phase).sin(),
            tilt_rad * (3.0 * phase).cos(),
        );
        let attitude = Rotation3::from_euler_angles(roll, pitch, 1.5 * phase.sin()).into_inner();
        let field = attitude.transpose() * Vector3::from(EARTH_UT) + Vector3::from(OWN_UT);
        FieldSample {
            attitude,
            field_ut: felt(field.into()).into(),
        }
    };
    (0..count).map(at).collect()
}

/// The code of DJI and of PX4 implies these two orientations for a board that lies flat with x forward.
#[test]
fn turning_the_robot_shows_how_its_magnetometer_is_mounted() {
    let board = Orientation::XForwardZUp;
    let as_the_imu = turned(300, 1.0, |field| field);
    assert!(enough_turned(&as_the_imu));
    let seen = find_mag(board, &as_the_imu).unwrap();
    assert_eq!(seen.orientation, Orientation::XForwardZUp);
    assert!(
        (seen.earth_ut - 47.4).abs() < 0.1 && seen.residual_ut < 0.1,
        "{seen:?}"
    );
    // Its x points left, its y backward.
    let quarter = turned(300, 1.0, |[forward, left, up]| [left, -forward, up]);
    assert_eq!(
        find_mag(board, &quarter).unwrap().orientation,
        Orientation::XLeftZUp
    );
}

#[test]
fn every_orientation_of_the_magnetometer_is_found() {
    for (index, mag) in Orientation::ALL.into_iter().enumerate() {
        let board = Orientation::ALL[(5 * index + 3) % 24];
        let mut wobble = 0.0_f64;
        let samples = turned(200, 0.9, |field| {
            wobble += 1.3;
            let noisy = field.map(|part| (part + 2.0 * wobble.sin()) as f32);
            mag.rotate_back(board.rotate_back(noisy)).map(f64::from)
        });
        assert_eq!(find_mag(board, &samples).unwrap().orientation, mag);
    }
}

/// A field of 47.4 µT with −42 µT upwards points 62° into the ground. Its mirror image points as far out of it.
#[test]
fn a_mirror_image_reverses_the_field() {
    let board = Orientation::XForwardZUp;
    let dip = |samples: &[FieldSample]| find_mag(board, samples).unwrap().dip_deg;
    assert!((dip(&turned(300, 1.0, |field| field)) - 62.4).abs() < 0.1);
    let mirrored = turned(300, 1.0, |[x, y, z]| [x, -y, z]);
    assert!((dip(&mirrored) + 62.4).abs() < 0.1);
}

#[test]
fn a_field_that_fits_no_orientation_is_reported() {
    let board = Orientation::XForwardZUp;
    let complaint = |samples: &[FieldSample]| find_mag(board, samples).unwrap_err();
    let level_only = turned(300, 0.0, |field| field);
    assert!(!enough_turned(&level_only));
    assert_eq!(complaint(&level_only), MagError::TooLittle);
    assert_eq!(
        complaint(&turned(20, 1.0, |field| field)),
        MagError::TooLittle
    );
    let mut index = 0_u32;
    let stirred = turned(300, 1.0, |[x, y, z]| {
        index += 1;
        let iron = 60.0 * f64::from(index % 7) / 7.0;
        [x + iron, y - 2.0 * iron, z + 1.5 * iron]
    });
    assert!(matches!(complaint(&stirred), MagError::Unclear { .. }));
    let weak = turned(300, 1.0, |field| field.map(|part| part / 8.0));
    assert!(matches!(complaint(&weak), MagError::NotTheEarth(_)));
}
