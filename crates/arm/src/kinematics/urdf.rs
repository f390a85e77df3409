//! An arm from a URDF: the joints between two of its links.
//!
//! `roxmltree` reads the XML: a tree with the line of everything, and no crate below it but memchr. `urdf-rs` brings three XML
//! parsers and tells no lines.

use nalgebra::{Unit, Vector3};
use roxmltree::{Document, Node};

use super::{ElementaryTransform as Et, Joint, JointKind, KinematicsError, Robot};

impl Robot {
    /// The arm between two links of a URDF. The base frame is that of the link `base`, and the chain's last frame that of `tip`,
    /// which is the tool until [`set_tool`](Self::set_tool) says otherwise.
    ///
    /// Without `base` it is the root, and without `tip` the only link that has no child. Joints of type `fixed` join the
    /// transforms, `continuous` ones have no limits. Meshes and masses are not looked at.
    ///
    /// # Errors
    /// The text is no URDF, the links are not there or not connected, a number is missing or none, a joint between them is of
    /// type `floating` or `planar` or mimics another one, or the arm has too many joints. The message names the line.
    pub fn from_urdf(
        urdf: &str,
        base: Option<&str>,
        tip: Option<&str>,
    ) -> Result<Self, KinematicsError> {
        let document = Document::parse(urdf).map_err(|error| KinematicsError::Urdf {
            line: error.pos().row,
            message: format!("this is no XML: {error}"),
        })?;
        let source = Source::new(&document)?;
        let tip = match tip {
            Some(tip) => source.known(tip)?,
            None => source.only_leaf()?,
        };
        let base = base.map(|base| source.known(base)).transpose()?;
        let mut transforms = Vec::new();
        let mut joints = Vec::new();
        for element in source.between(base, tip)? {
            transforms.push(source.origin(element)?);
            if let Some((transform, joint)) = source.moving(element)? {
                transforms.push(transform);
                joints.push(joint);
            }
        }
        let name = source.robot.attribute("name").unwrap_or("arm");
        Self::from_elementary(name, transforms, joints)
    }
}

/// A URDF with its joints.
struct Source<'a> {
    document: &'a Document<'a>,
    robot: Node<'a, 'a>,
    joints: Vec<Node<'a, 'a>>,
}

impl<'a> Source<'a> {
    fn new(document: &'a Document<'a>) -> Result<Self, KinematicsError> {
        let robot = document.root_element();
        let source = Self {
            document,
            robot,
            joints: robot.children().filter(|it| is_joint(*it)).collect(),
        };
        if robot.has_tag_name("robot") {
            return Ok(source);
        }
        let found = robot.tag_name().name();
        let message = format!("the root is <{found}>, and a URDF's is <robot>: expand xacro first");
        Err(source.complaint(robot, message))
    }

    fn complaint(&self, at: Node<'_, '_>, message: String) -> KinematicsError {
        let line = self.document.text_pos_at(at.range().start).row;
        KinematicsError::Urdf { line, message }
    }

    fn links(&self) -> impl Iterator<Item = &'a str> {
        let links = self.robot.children().filter(|it| it.has_tag_name("link"));
        links.filter_map(|it| it.attribute("name"))
    }

    /// A link that is there.
    fn known(&self, link: &str) -> Result<&'a str, KinematicsError> {
        self.links().find(|it| *it == link).ok_or_else(|| {
            let known = self.links().collect::<Vec<_>>().join(", ");
            let message = format!("there is no link {link}: there are {known}");
            self.complaint(self.robot, message)
        })
    }

    fn only_leaf(&self) -> Result<&'a str, KinematicsError> {
        let has_child = |link: &str| {
            self.joints
                .iter()
                .any(|it| end(*it, "parent") == Some(link))
        };
        let leaves: Vec<_> = self.links().filter(|link| !has_child(link)).collect();
        if let [leaf] = leaves.as_slice() {
            return Ok(leaf);
        }
        let leaves = leaves.join(", ");
        let message = format!("say which link is the tip, since several have no child: {leaves}");
        Err(self.complaint(self.robot, message))
    }

    /// Joints from one link to another, in this order.
    fn between(
        &self,
        base: Option<&str>,
        tip: &'a str,
    ) -> Result<Vec<Node<'a, 'a>>, KinematicsError> {
        let mut path = Vec::new();
        let mut link = tip;
        while Some(link) != base {
            let Some(joint) = self
                .joints
                .iter()
                .find(|it| end(**it, "child") == Some(link))
            else {
                break;
            };
            path.push(*joint);
            link = end(*joint, "parent").ok_or_else(|| {
                let message = format!("joint {} has no <parent link=…>", name_of(*joint));
                self.complaint(*joint, message)
            })?;
            if path.len() > self.joints.len() {
                let message = format!("the joints above {tip} form a circle");
                return Err(self.complaint(*joint, message));
            }
        }
        if let Some(base) = base.filter(|base| *base != link) {
            let message = format!("link {base} is not above {tip}: the chain ends at {link}");
            return Err(self.complaint(self.robot, message));
        }
        path.reverse();
        Ok(path)
    }

    fn origin(&self, joint: Node<'a, 'a>) -> Result<Et, KinematicsError> {
        let zero = [0.0; 3];
        let Some(origin) = child(joint, "origin") else {
            return Ok(Et::origin(zero, zero));
        };
        let xyz_m = self.triple(origin, "xyz")?.unwrap_or(zero);
        let rpy_rad = self.triple(origin, "rpy")?.unwrap_or(zero);
        Ok(Et::origin(xyz_m, rpy_rad))
    }

    /// The joint's own movement, unless it is fixed.
    fn moving(&self, joint: Node<'a, 'a>) -> Result<Option<(Et, Joint)>, KinematicsError> {
        let name = name_of(joint);
        let kind = match joint.attribute("type") {
            Some("fixed") => return Ok(None),
            Some("revolute" | "continuous") => JointKind::Revolute,
            Some("prismatic") => JointKind::Prismatic,
            other => {
                let found = other.unwrap_or("not given");
                let message = format!(
                    "joint {name}: its type is {found}, and a serial arm has revolute, continuous, prismatic and fixed ones"
                );
                return Err(self.complaint(joint, message));
            }
        };
        if child(joint, "mimic").is_some() {
            let message = format!(
                "joint {name} mimics another one: end the chain above it, as the tip of an arm ends above its gripper"
            );
            return Err(self.complaint(joint, message));
        }
        let axis = match child(joint, "axis") {
            Some(axis) => self.triple(axis, "xyz")?,
            None => None,
        };
        let axis = Vector3::from(axis.unwrap_or([1.0, 0.0, 0.0]));
        let axis = Unit::try_new(axis, 1e-9).ok_or_else(|| {
            let message = format!("joint {name}: its axis has no direction");
            self.complaint(joint, message)
        })?;
        let [lower, upper] = self.limits(joint)?;
        let described = Joint::new(&name, lower, upper)
            .map_err(|error| self.complaint(joint, error.to_string()))?;
        Ok(Some((Et::joint(kind, axis), described)))
    }

    fn limits(&self, joint: Node<'a, 'a>) -> Result<[f64; 2], KinematicsError> {
        if joint.attribute("type") == Some("continuous") {
            return Ok([f64::NEG_INFINITY, f64::INFINITY]);
        }
        let limit = child(joint, "limit").ok_or_else(|| {
            let name = name_of(joint);
            let message = format!("joint {name} has no <limit lower=… upper=…>");
            self.complaint(joint, message)
        })?;
        // URDF takes a limit that is not there for 0.
        let number = |key| match limit.attribute(key) {
            None => Ok(0.0),
            Some(text) => self.number(limit, key, text),
        };
        Ok([number("lower")?, number("upper")?])
    }

    fn triple(&self, node: Node<'a, 'a>, key: &str) -> Result<Option<[f64; 3]>, KinematicsError> {
        let Some(text) = node.attribute(key) else {
            return Ok(None);
        };
        let words = text.split_whitespace();
        let numbers = words.map(|word| self.number(node, key, word));
        let numbers = numbers.collect::<Result<Vec<_>, _>>()?;
        let triple = numbers.try_into().map_err(|numbers: Vec<f64>| {
            let found = numbers.len();
            self.complaint(node, format!("{key} has {found} numbers, and needs 3"))
        })?;
        Ok(Some(triple))
    }

    fn number(&self, node: Node<'_, '_>, key: &str, text: &str) -> Result<f64, KinematicsError> {
        let number = text.trim().parse::<f64>().ok();
        number.filter(|it| it.is_finite()).ok_or_else(|| {
            let message = format!("{key}: \"{text}\" is no finite number");
            self.complaint(node, message)
        })
    }
}

/// A `<transmission>` has elements `<joint>` as well; only those with links are joints.
fn is_joint(node: Node<'_, '_>) -> bool {
    node.has_tag_name("joint") && child(node, "child").is_some()
}

fn child<'a>(node: Node<'a, 'a>, tag: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|it| it.has_tag_name(tag))
}

fn end<'a>(joint: Node<'a, 'a>, tag: &str) -> Option<&'a str> {
    child(joint, tag).and_then(|it| it.attribute("link"))
}

fn name_of(joint: Node<'_, '_>) -> String {
    joint
        .attribute("name")
        .unwrap_or("without a name")
        .to_owned()
}
