//! A chain as a sequence of simple movements.

use nalgebra::{IsometryMatrix3, Rotation3, Translation3, Unit, Vector3};

use super::JointKind;

/// One step from a frame to the next: a fixed one, or a joint.
///
/// The notation is Corke's (P. Corke, "A simple and systematic approach to assigning Denavit–Hartenberg parameters", IEEE
/// Transactions on Robotics 23(3), 2007): `Rx Ry Rz tx ty tz`, each by a constant or by a joint's angle or length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ElementaryTransform {
    /// It always moves by the same.
    Fixed(IsometryMatrix3<f64>),
    /// A joint moves along or around this axis of its frame.
    Joint {
        /// Whether it turns or slides.
        kind: JointKind,
        /// The axis. It is turned round for a joint that counts the other way.
        axis: Unit<Vector3<f64>>,
    },
}

impl ElementaryTransform {
    /// Turns around x by a fixed angle.
    pub fn rx(angle_rad: f64) -> Self {
        Self::turned(Vector3::x_axis(), angle_rad)
    }

    /// Turns around y by a fixed angle.
    pub fn ry(angle_rad: f64) -> Self {
        Self::turned(Vector3::y_axis(), angle_rad)
    }

    /// Turns around z by a fixed angle.
    pub fn rz(angle_rad: f64) -> Self {
        Self::turned(Vector3::z_axis(), angle_rad)
    }

    /// Moves along x by a fixed length.
    pub fn tx(length_m: f64) -> Self {
        Self::moved(Vector3::new(length_m, 0.0, 0.0))
    }

    /// Moves along y by a fixed length.
    pub fn ty(length_m: f64) -> Self {
        Self::moved(Vector3::new(0.0, length_m, 0.0))
    }

    /// Moves along z by a fixed length.
    pub fn tz(length_m: f64) -> Self {
        Self::moved(Vector3::new(0.0, 0.0, length_m))
    }

    /// A joint that turns around x.
    pub fn joint_rx() -> Self {
        Self::joint(JointKind::Revolute, Vector3::x_axis())
    }

    /// A joint that turns around y.
    pub fn joint_ry() -> Self {
        Self::joint(JointKind::Revolute, Vector3::y_axis())
    }

    /// A joint that turns around z.
    pub fn joint_rz() -> Self {
        Self::joint(JointKind::Revolute, Vector3::z_axis())
    }

    /// A joint that slides along x.
    pub fn joint_tx() -> Self {
        Self::joint(JointKind::Prismatic, Vector3::x_axis())
    }

    /// A joint that slides along y.
    pub fn joint_ty() -> Self {
        Self::joint(JointKind::Prismatic, Vector3::y_axis())
    }

    /// A joint that slides along z.
    pub fn joint_tz() -> Self {
        Self::joint(JointKind::Prismatic, Vector3::z_axis())
    }

    /// A joint on any axis of its frame.
    pub fn joint(kind: JointKind, axis: Unit<Vector3<f64>>) -> Self {
        Self::Joint { kind, axis }
    }

    /// The same joint, counted the other way, or a fixed transform's inverse.
    #[must_use]
    pub fn flipped(self) -> Self {
        match self {
            Self::Fixed(pose) => Self::Fixed(pose.inverse()),
            Self::Joint { kind, axis } => Self::Joint { kind, axis: -axis },
        }
    }

    /// A place and fixed-axis roll, pitch and yaw: the `origin` of a URDF.
    pub fn origin(xyz_m: [f64; 3], rpy_rad: [f64; 3]) -> Self {
        let [roll, pitch, yaw] = rpy_rad;
        let rotation = Rotation3::from_euler_angles(roll, pitch, yaw);
        Self::Fixed(IsometryMatrix3::from_parts(
            Translation3::from(Vector3::from(xyz_m)),
            rotation,
        ))
    }

    fn turned(axis: Unit<Vector3<f64>>, angle_rad: f64) -> Self {
        let rotation = Rotation3::from_axis_angle(&axis, angle_rad);
        Self::Fixed(IsometryMatrix3::from_parts(
            Translation3::identity(),
            rotation,
        ))
    }

    fn moved(by_m: Vector3<f64>) -> Self {
        Self::Fixed(IsometryMatrix3::from_parts(
            Translation3::from(by_m),
            Rotation3::identity(),
        ))
    }
}
