//! The SO-101 arm of TheRobotStudio.

use super::{ElementaryTransform as Et, Joint, Robot};

/// A joint: its name, the origin of its frame in the one before (xyz in m, fixed-axis rpy in rad), and its limits in rad.
type Row = (&'static str, [f64; 3], [f64; 3], [f64; 2]);

/// `Simulation/SO101/so101_new_calib.urdf` of TheRobotStudio/SO-ARM100 (commit fda892c, Apache-2.0). Every joint turns around
/// z of its frame, and is 0 in the middle of its travel.
#[expect(clippy::approx_constant, reason = "the URDF rounds so")]
const ROWS: [Row; 5] = [
    (
        "shoulder_pan",
        [0.0388353, -8.97657e-09, 0.0624],
        [3.14159, 4.18253e-17, -3.14159],
        [-1.91986, 1.91986],
    ),
    (
        "shoulder_lift",
        [-0.0303992, -0.0182778, -0.0542],
        [-1.5708, -1.5708, 0.0],
        [-1.74533, 1.74533],
    ),
    (
        "elbow_flex",
        [-0.11257, -0.028, 1.73763e-16],
        [-3.63608e-16, 8.74301e-16, 1.5708],
        [-1.69, 1.69],
    ),
    (
        "wrist_flex",
        [-0.1349, 0.0052, 3.62355e-17],
        [4.02456e-15, 8.67362e-16, -1.5708],
        [-1.65806, 1.65806],
    ),
    (
        "wrist_roll",
        [5.55112e-17, -0.0611, 0.0181],
        [1.5708, 0.0486795, 3.14159],
        [-2.74385, 2.84121],
    ),
];

/// From the wrist's last frame to the point between the jaws (`gripper_frame_link`).
#[expect(clippy::approx_constant, reason = "the URDF rounds so")]
const TOOL: ([f64; 3], [f64; 3]) = ([-0.0079, -0.000218121, -0.0981274], [0.0, 3.14159, 0.0]);

/// The SO-101 without its gripper, as the five joints that place the tool: `shoulder_pan`, `shoulder_lift`, `elbow_flex`,
/// `wrist_flex`, `wrist_roll`.
///
/// The base frame is the URDF's: x forward, y to the left, z up. The tool is the point between the jaws. Gears are direct
/// (sign 1, ratio 1): steps grow with the angle, as LeRobot takes them to.
pub fn create_so101_5dof() -> Robot {
    let mut transforms = Vec::new();
    let mut joints = Vec::new();
    for (name, xyz_m, rpy_rad, limits) in ROWS {
        transforms.extend([Et::origin(xyz_m, rpy_rad), Et::joint_rz()]);
        joints.push(Joint::within(name, limits));
    }
    let (xyz_m, rpy_rad) = TOOL;
    transforms.push(Et::origin(xyz_m, rpy_rad));
    Robot::from_sound_parts("so101", transforms, joints)
}
