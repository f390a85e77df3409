//! The chain in the form in which it is computed quickly: every joint on the z axis of a frame of its own.

use nalgebra::{IsometryMatrix3, Matrix3, Matrix6xX, Rotation3, SMatrix, Unit, Vector3, Vector6};

use super::{ElementaryTransform as Et, JointKind};

/// A joint, and the fixed step to its frame from that of the joint before it.
#[derive(Clone, Copy, Debug)]
struct Link {
    rotation: Matrix3<f64>,
    translation: Vector3<f64>,
    kind: JointKind,
}

/// Joints in their order, and the step from the last one to the tool.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    links: Vec<Link>,
    end: Frame,
}

/// A pose as rotation matrix and place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) rotation: Matrix3<f64>,
    pub(crate) translation: Vector3<f64>,
}

impl Chain {
    /// Gathers what is fixed between joints.
    pub(super) fn new(transforms: impl IntoIterator<Item = Et>) -> Self {
        let mut links = Vec::new();
        let mut fixed = IsometryMatrix3::identity();
        for transform in transforms {
            match transform {
                Et::Fixed(pose) => fixed *= pose,
                Et::Joint { kind, axis } => {
                    let to_axis = z_onto(axis);
                    let Frame {
                        rotation,
                        translation,
                    } = Frame::from(fixed * to_axis);
                    links.push(Link {
                        rotation,
                        translation,
                        kind,
                    });
                    fixed = IsometryMatrix3::identity() * to_axis.inverse();
                }
            }
        }
        Self {
            links,
            end: fixed.into(),
        }
    }

    pub(super) fn joints(&self) -> usize {
        self.links.len()
    }

    /// Pose of the tool. Values beyond the joints are left out.
    pub(crate) fn pose(&self, q: &[f64]) -> Frame {
        let mut frame = Frame::IDENTITY;
        for (link, q) in self.links.iter().zip(q) {
            frame.pass(link, *q);
        }
        frame.then(&self.end)
    }

    /// Pose of the tool, and its Jacobian in the world: rows are velocity and angular velocity, columns joints. It does not
    /// allocate. `N` is the number of joints.
    #[inline]
    pub(crate) fn pose_and_jacobian<const N: usize>(
        &self,
        q: &[f64; N],
    ) -> (Frame, SMatrix<f64, 6, N>) {
        let mut frame = Frame::IDENTITY;
        let mut axes = [Axis::default(); N];
        for ((link, q), axis) in self.links.iter().zip(q).zip(&mut axes) {
            *axis = frame.pass(link, *q);
        }
        let tool = frame.then(&self.end);
        let mut jacobian = SMatrix::<f64, 6, N>::zeros();
        for (axis, mut column) in axes.iter().zip(jacobian.column_iter_mut()) {
            column.copy_from(&axis.moves(&tool));
        }
        (tool, jacobian)
    }

    /// The same for any number of joints.
    pub(super) fn jacobian(&self, q: &[f64]) -> (Frame, Matrix6xX<f64>) {
        let mut frame = Frame::IDENTITY;
        let pairs = self.links.iter().zip(q);
        let axes: Vec<_> = pairs.map(|(link, q)| frame.pass(link, *q)).collect();
        let tool = frame.then(&self.end);
        let columns: Vec<_> = axes.iter().map(|axis| axis.moves(&tool)).collect();
        (tool, Matrix6xX::from_columns(&columns))
    }
}

/// A joint's axis in the world.
#[derive(Clone, Copy, Debug)]
struct Axis {
    kind: JointKind,
    direction: Vector3<f64>,
    place: Vector3<f64>,
}

impl Axis {
    /// Velocity and angular velocity of the tool for a joint speed of 1.
    #[inline]
    fn moves(&self, tool: &Frame) -> Vector6<f64> {
        let (linear, angular) = match self.kind {
            JointKind::Revolute => (
                self.direction.cross(&(tool.translation - self.place)),
                self.direction,
            ),
            JointKind::Prismatic => (self.direction, Vector3::zeros()),
        };
        Vector6::new(
            linear.x, linear.y, linear.z, angular.x, angular.y, angular.z,
        )
    }
}

impl Default for Axis {
    fn default() -> Self {
        Self {
            kind: JointKind::Revolute,
            direction: Vector3::zeros(),
            place: Vector3::zeros(),
        }
    }
}

impl Frame {
    const IDENTITY: Self = Self {
        rotation: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        translation: Vector3::new(0.0, 0.0, 0.0),
    };

    #[inline]
    fn then(&self, next: &Self) -> Self {
        Self {
            rotation: self.rotation * next.rotation,
            translation: self.translation + self.rotation * next.translation,
        }
    }

    /// Goes on to the frame behind a joint, and returns the joint's axis.
    #[inline]
    fn pass(&mut self, link: &Link, q: f64) -> Axis {
        self.translation += self.rotation * link.translation;
        self.rotation *= link.rotation;
        match link.kind {
            JointKind::Revolute => {
                let (sin, cos) = q.sin_cos();
                let x = self.rotation.column(0).into_owned();
                let y = self.rotation.column(1).into_owned();
                self.rotation.set_column(0, &(x * cos + y * sin));
                self.rotation.set_column(1, &(y * cos - x * sin));
            }
            JointKind::Prismatic => self.translation += self.rotation.column(2) * q,
        }
        Axis {
            kind: link.kind,
            direction: self.rotation.column(2).into_owned(),
            place: self.translation,
        }
    }
}

impl From<IsometryMatrix3<f64>> for Frame {
    fn from(pose: IsometryMatrix3<f64>) -> Self {
        Self {
            rotation: pose.rotation.into_inner(),
            translation: pose.translation.vector,
        }
    }
}

impl From<Frame> for IsometryMatrix3<f64> {
    fn from(frame: Frame) -> Self {
        Self::from_parts(
            frame.translation.into(),
            Rotation3::from_matrix_unchecked(frame.rotation),
        )
    }
}

/// A rotation that brings z onto `axis`.
fn z_onto(axis: Unit<Vector3<f64>>) -> Rotation3<f64> {
    // There is none for the opposite direction, since each half turn would do.
    Rotation3::rotation_between(&Vector3::z_axis(), &axis)
        .unwrap_or_else(|| Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI))
}
