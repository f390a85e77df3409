//! A serial arm.

use nalgebra::{IsometryMatrix3, Matrix6xX};

use super::{Chain, DhConvention, DhRow, ElementaryTransform, Gear, Joint, KinematicsError};

/// Joints that an arm may have.
pub const MAX_JOINTS: usize = 8;

/// A serial arm: its chain, its joints' limits and gears, and the frames at both ends.
#[derive(Clone, Debug)]
pub struct Robot {
    name: String,
    transforms: Vec<ElementaryTransform>,
    joints: Vec<Joint>,
    base: IsometryMatrix3<f64>,
    tool: IsometryMatrix3<f64>,
    chain: Chain,
}

impl Robot {
    /// An arm of elementary transforms, with a description of each joint among them, in their order.
    ///
    /// # Errors
    /// There are more joints than an arm may have, none, or not as many as are described; two have one name; a transform is
    /// not finite.
    pub fn from_elementary(
        name: &str,
        transforms: Vec<ElementaryTransform>,
        joints: Vec<Joint>,
    ) -> Result<Self, KinematicsError> {
        let is_finite = transforms.iter().all(|it| match it {
            ElementaryTransform::Fixed(pose) => is_finite(pose),
            ElementaryTransform::Joint { axis, .. } => axis.iter().all(|it| it.is_finite()),
        });
        if !is_finite {
            let what = "a transform";
            return Err(KinematicsError::NotFinite { what });
        }
        let robot = Self::from_sound_parts(name, transforms, joints);
        robot.checked()
    }

    /// An arm of Denavit–Hartenberg rows, with a description of each row's joint.
    ///
    /// # Errors
    /// As [`from_elementary`](Self::from_elementary).
    pub fn from_dh(
        name: &str,
        convention: DhConvention,
        rows: &[DhRow],
        joints: Vec<Joint>,
    ) -> Result<Self, KinematicsError> {
        let transforms = rows.iter().flat_map(|row| row.elementary(convention));
        Self::from_elementary(name, transforms.collect(), joints)
    }

    /// As [`from_elementary`](Self::from_elementary), for parts that were looked at.
    pub(super) fn from_sound_parts(
        name: &str,
        transforms: Vec<ElementaryTransform>,
        joints: Vec<Joint>,
    ) -> Self {
        let chain = Chain::new(transforms.iter().copied());
        Self {
            name: name.to_owned(),
            transforms,
            joints,
            base: IsometryMatrix3::identity(),
            tool: IsometryMatrix3::identity(),
            chain,
        }
    }

    fn checked(self) -> Result<Self, KinematicsError> {
        let found = self.chain.joints();
        if !(1..=MAX_JOINTS).contains(&found) {
            let allowed = MAX_JOINTS;
            return Err(KinematicsError::JointCount { found, allowed });
        }
        if found != self.joints.len() {
            return Err(KinematicsError::Names {
                joints: self.joints.len(),
                transforms: found,
            });
        }
        let mut names: Vec<_> = self.joint_names().collect();
        names.sort_unstable();
        if let Some([twice, _]) = names.array_windows().find(|[one, other]| one == other) {
            let joint = (*twice).to_owned();
            return Err(KinematicsError::Twice { joint });
        }
        Ok(self)
    }

    /// The arm's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Joints, from the base to the tool.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Names of the joints, from the base to the tool.
    pub fn joint_names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().map(Joint::name)
    }

    pub(crate) fn chain(&self) -> &Chain {
        &self.chain
    }

    /// Puts the base somewhere else in the world. At first, both frames are one.
    ///
    /// # Errors
    /// The pose is not finite.
    pub fn set_base(&mut self, base: IsometryMatrix3<f64>) -> Result<(), KinematicsError> {
        finite("the base", &base)?;
        self.base = base;
        self.rebuild();
        Ok(())
    }

    /// Where the base is in the world.
    pub fn base(&self) -> &IsometryMatrix3<f64> {
        &self.base
    }

    /// Puts another tool behind the chain's last frame.
    ///
    /// # Errors
    /// The pose is not finite.
    pub fn set_tool(&mut self, tool: IsometryMatrix3<f64>) -> Result<(), KinematicsError> {
        finite("the tool", &tool)?;
        self.tool = tool;
        self.rebuild();
        Ok(())
    }

    /// Where the tool is in the chain's last frame.
    pub fn tool(&self) -> &IsometryMatrix3<f64> {
        &self.tool
    }

    fn rebuild(&mut self) {
        let base = ElementaryTransform::Fixed(self.base);
        let tool = ElementaryTransform::Fixed(self.tool);
        let inner = self.transforms.iter().copied();
        self.chain = Chain::new([base].into_iter().chain(inner).chain([tool]));
    }

    /// Says how a joint's servo is geared to it.
    ///
    /// # Errors
    /// The arm has no such joint.
    pub fn set_gear(&mut self, joint: &str, gear: Gear) -> Result<(), KinematicsError> {
        let index = self.index_of(joint)?;
        if let Some(it) = self.joints.get_mut(index) {
            it.set_gear(gear);
        }
        Ok(())
    }

    pub(super) fn index_of(&self, joint: &str) -> Result<usize, KinematicsError> {
        self.joint_names()
            .position(|it| it == joint)
            .ok_or_else(|| KinematicsError::UnknownJoint {
                joint: joint.to_owned(),
                known: self.joint_names().collect::<Vec<_>>().join(", "),
            })
    }

    /// Pose of the tool in the world.
    ///
    /// # Errors
    /// `q` has not one finite value for each joint, rad or m.
    pub fn fkine(&self, q: &[f64]) -> Result<IsometryMatrix3<f64>, KinematicsError> {
        self.check_values("q", q)?;
        Ok(self.chain.pose(q).into())
    }

    /// Jacobian in the world: it takes joint speeds to the tool's velocity (rows 0–2, m/s) and angular velocity (rows 3–5,
    /// rad/s), both along the world's axes.
    ///
    /// # Errors
    /// As [`fkine`](Self::fkine).
    pub fn jacob0(&self, q: &[f64]) -> Result<Matrix6xX<f64>, KinematicsError> {
        self.check_values("q", q)?;
        Ok(self.chain.jacobian(q).1)
    }

    /// Jacobian in the tool's frame: as [`jacob0`](Self::jacob0), but along the tool's axes.
    ///
    /// # Errors
    /// As [`fkine`](Self::fkine).
    pub fn jacobe(&self, q: &[f64]) -> Result<Matrix6xX<f64>, KinematicsError> {
        self.check_values("q", q)?;
        let (tool, mut jacobian) = self.chain.jacobian(q);
        let to_tool = tool.rotation.transpose();
        for mut column in jacobian.column_iter_mut() {
            let linear = to_tool * column.fixed_rows::<3>(0);
            let angular = to_tool * column.fixed_rows::<3>(3);
            column.fixed_rows_mut::<3>(0).copy_from(&linear);
            column.fixed_rows_mut::<3>(3).copy_from(&angular);
        }
        Ok(jacobian)
    }

    /// Whether there is one finite value for each joint.
    pub(crate) fn check_values(
        &self,
        what: &'static str,
        q: &[f64],
    ) -> Result<(), KinematicsError> {
        let wanted = self.joints.len();
        if q.len() != wanted {
            let found = q.len();
            return Err(KinematicsError::Length {
                what,
                found,
                wanted,
            });
        }
        if q.iter().all(|it| it.is_finite()) {
            return Ok(());
        }
        Err(KinematicsError::NotFinite { what })
    }
}

/// Whether a pose can be computed with.
pub(crate) fn finite(
    what: &'static str,
    pose: &IsometryMatrix3<f64>,
) -> Result<(), KinematicsError> {
    if is_finite(pose) {
        return Ok(());
    }
    Err(KinematicsError::NotFinite { what })
}

fn is_finite(pose: &IsometryMatrix3<f64>) -> bool {
    let place = pose.translation.vector.iter();
    let numbers = place.chain(pose.rotation.matrix().iter());
    numbers.copied().all(f64::is_finite)
}
