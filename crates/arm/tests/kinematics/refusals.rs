//! Descriptions that are refused, and what is said about them.

use nalgebra::{IsometryMatrix3, Translation3};
use robot_arm::kinematics::{ElementaryTransform as Et, Gear, Joint, Robot, create_so101_5dof};

use crate::arms::{self, SO101_URDF};

fn said_of(urdf: &str, base: Option<&str>, tip: Option<&str>) -> String {
    let error = Robot::from_urdf(urdf, base, tip).expect_err("refused");
    error.to_string()
}

fn said_with(change: &str, to: &str) -> String {
    assert!(SO101_URDF.contains(change), "{change} is not there");
    let urdf = SO101_URDF.replacen(change, to, 1);
    said_of(&urdf, None, Some("gripper_frame_link"))
}

#[test]
fn a_urdf_that_is_none_is_named_with_its_line() {
    assert!(said_of("<robot><link>", None, None).starts_with("line 1: this is no XML: "));
    assert_eq!(
        said_of("<sdf/>", None, None),
        "line 1: the root is <sdf>, and a URDF's is <robot>: expand xacro first"
    );
    assert_eq!(
        said_with("xyz=\"0.0388353 ", "xyz=\"O.0388353 "),
        "line 55: xyz: \"O.0388353\" is no finite number"
    );
    assert_eq!(
        said_with("-8.97657e-09 0.0624", "0.0624"),
        "line 55: xyz has 2 numbers, and needs 3"
    );
    assert_eq!(
        said_with(
            "<joint name=\"elbow_flex\" type=\"revolute\">",
            "<joint name=\"elbow_flex\" type=\"planar\">"
        ),
        "line 40: joint elbow_flex: its type is planar, and a serial arm has revolute, continuous, prismatic and fixed ones"
    );
    assert_eq!(
        said_with("upper=\"1.69\"", "upper=\"-2\""),
        "line 40: joint elbow_flex: limits -1.69 to -2 hold no value: the lower one comes first, in rad or m"
    );
}

#[test]
fn links_that_are_no_arm_are_named() {
    assert_eq!(
        said_of(SO101_URDF, None, None),
        "line 4: say which link is the tip, since several have no child: gripper_frame_link, moving_jaw_so101_v1_link"
    );
    assert!(
        said_of(SO101_URDF, None, Some("hand"))
            .starts_with("line 4: there is no link hand: there are base_link, shoulder_link, ")
    );
    assert_eq!(
        said_of(SO101_URDF, Some("gripper_link"), Some("wrist_link")),
        "line 4: link gripper_link is not above wrist_link: the chain ends at base_link"
    );
    assert_eq!(
        said_of(SO101_URDF, None, Some("base_link")),
        "0 joints: an arm has 1 to 8. Name a base and a tip that have only the arm between them"
    );
    let circle = "<robot><link name='a'/><link name='b'/>
        <joint name='1' type='fixed'><parent link='a'/><child link='b'/></joint>
        <joint name='2' type='fixed'><parent link='b'/><child link='a'/></joint></robot>";
    assert_eq!(
        said_of(circle, None, Some("a")),
        "line 3: the joints above a form a circle"
    );
}

#[test]
fn a_joint_of_a_urdf_may_turn_without_end() {
    let urdf = SO101_URDF.replace(
        "name=\"wrist_roll\" type=\"revolute\"",
        "name=\"wrist_roll\" type=\"continuous\"",
    );
    let robot = Robot::from_urdf(&urdf, None, Some("gripper_link")).expect("an arm");
    assert_eq!(robot.joints()[4].upper(), f64::INFINITY);
}

#[test]
fn chains_that_are_no_arm_are_refused() {
    let turns = |count| vec![Et::joint_rz(); count];
    let said = |transforms, joints| {
        let robot = Robot::from_elementary("arm", transforms, joints);
        robot.expect_err("refused").to_string()
    };
    assert!(said(turns(9), arms::joints(9)).starts_with("9 joints: an arm has 1 to 8."));
    assert!(said(turns(3), arms::joints(2)).starts_with("2 joints are named, and the transforms"));
    let twice = vec![Joint::new("a", 0.0, 1.0).expect("a joint"); 2];
    assert_eq!(
        said(turns(2), twice),
        "joint a is there twice: give each a name of its own"
    );
    let nan = vec![Et::joint_rz(), Et::tx(f64::NAN)];
    assert_eq!(
        said(nan, arms::joints(1)),
        "a transform holds NaN or infinity"
    );
}

#[test]
fn numbers_that_are_none_are_refused() {
    let mut robot = create_so101_5dof();
    assert!(robot.fkine(&[0.0, 0.0, f64::INFINITY, 0.0, 0.0]).is_err());
    let far = IsometryMatrix3::from_parts(
        Translation3::new(f64::NAN, 0.0, 0.0),
        nalgebra::Rotation3::identity(),
    );
    assert!(robot.set_base(far).is_err() && robot.set_tool(far).is_err());
    assert!(Joint::new("a", f64::NAN, 1.0).is_err());
    for (sign, ratio) in [(0.5, 1.0), (1.0, 0.0), (1.0, -2.0), (1.0, f64::NAN)] {
        let error = Gear::new(sign, ratio).expect_err("refused").to_string();
        assert!(
            error.ends_with("the sign is 1 or -1, and the ratio is greater than 0"),
            "{error}"
        );
    }
}
