//! The arms that are compared.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{IsometryMatrix3, Rotation3, Translation3, Vector3};
use robot_arm::kinematics::{
    DhConvention, DhRow, ElementaryTransform as Et, Joint, JointKind, Robot,
};

pub const SO101_URDF: &str = include_str!("../data/so101.urdf");

pub fn so101() -> Robot {
    Robot::from_urdf(SO101_URDF, Some("base_link"), Some("gripper_frame_link")).expect("an arm")
}

/// The chain of `elementary()` in `roboticstoolbox_values.py`.
pub fn elementary() -> Robot {
    let transforms = vec![
        Et::tz(0.3),
        Et::joint_rz(),
        Et::rx(0.4),
        Et::joint_ry().flipped(),
        Et::tx(0.2),
        Et::joint_tx(),
        Et::ry(-0.7),
        Et::joint_rx(),
        Et::ty(0.1),
        Et::joint_tz().flipped(),
        Et::rz(1.1),
        Et::joint_ty(),
    ];
    let mut robot = Robot::from_elementary("elementary", transforms, joints(6)).expect("an arm");
    let turned = |axis, angle_rad| Rotation3::from_axis_angle(&axis, angle_rad);
    let base = IsometryMatrix3::from_parts(
        Translation3::new(0.5, 0.0, 0.0),
        turned(Vector3::z_axis(), 0.3),
    );
    let tool = IsometryMatrix3::from_parts(
        Translation3::new(0.0, 0.0, 0.15),
        turned(Vector3::y_axis(), 0.2),
    );
    robot.set_base(base).expect("finite");
    robot.set_tool(tool).expect("finite");
    robot
}

pub fn puma560() -> Robot {
    let rows = [
        [0.67183, 0.0, FRAC_PI_2],
        [0.0, 0.4318, 0.0],
        [0.15005, 0.0203, -FRAC_PI_2],
        [0.4318, 0.0, FRAC_PI_2],
        [0.0, 0.0, -FRAC_PI_2],
        [0.0, 0.0, 0.0],
    ];
    dh("puma560", DhConvention::Standard, &rows.map(revolute))
}

/// Its third joint slides.
pub fn stanford() -> Robot {
    let rows = [
        [0.412, 0.0, -FRAC_PI_2],
        [0.154, 0.0, FRAC_PI_2],
        [0.0, 0.0203, 0.0],
        [0.0, 0.0, -FRAC_PI_2],
        [0.0, 0.0, FRAC_PI_2],
        [0.0, 0.0, 0.0],
    ];
    let mut rows = rows.map(revolute);
    rows[2].kind = JointKind::Prismatic;
    rows[2].theta_rad = -FRAC_PI_2;
    dh("stanford", DhConvention::Standard, &rows)
}

/// With the hand as its tool.
pub fn panda() -> Robot {
    let rows = [
        [0.333, 0.0, 0.0],
        [0.0, 0.0, -FRAC_PI_2],
        [0.316, 0.0, FRAC_PI_2],
        [0.0, 0.0825, FRAC_PI_2],
        [0.384, -0.0825, -FRAC_PI_2],
        [0.0, 0.0, FRAC_PI_2],
        [0.107, 0.088, FRAC_PI_2],
    ];
    let mut panda = dh("panda", DhConvention::Modified, &rows.map(revolute));
    let hand = IsometryMatrix3::from_parts(
        Translation3::new(0.0, 0.0, 0.103),
        Rotation3::from_axis_angle(&Vector3::z_axis(), -FRAC_PI_2 / 2.0),
    );
    panda.set_tool(hand).expect("finite");
    panda
}

pub fn joints(count: usize) -> Vec<Joint> {
    let joint = |n| Joint::new(&format!("joint {n}"), -3.0, 3.0).expect("a joint");
    (1..=count).map(joint).collect()
}

fn dh(name: &str, convention: DhConvention, rows: &[DhRow]) -> Robot {
    Robot::from_dh(name, convention, rows, joints(rows.len())).expect("an arm")
}

fn revolute([d_m, a_m, alpha_rad]: [f64; 3]) -> DhRow {
    DhRow {
        kind: JointKind::Revolute,
        d_m,
        a_m,
        alpha_rad,
        theta_rad: 0.0,
        flipped: false,
    }
}
