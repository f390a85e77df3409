//! Which controller is for a robot.

use robot_app::motor::layout::{CHOSEN_LAYOUT, MotorLayout, ROBOT_LAYOUT, RS00_LAYOUT};
use robot_description::Robot;

static CHOSEN: MotorLayout = CHOSEN_LAYOUT;

/// Motors, geometry and gains for a robot: those that were made of its file when this program was built. They are `None` if it was
/// built with other robots only, or with another file of that name.
pub fn layout_of(robot: &Robot) -> Option<&'static MotorLayout> {
    [&CHOSEN, &ROBOT_LAYOUT, &RS00_LAYOUT]
        .into_iter()
        .find(|layout| layout.profile().fingerprint == robot.fingerprint())
}

#[cfg(test)]
mod tests {
    use robot_plant::robots::{JointMotor, with_joints};

    use super::*;

    #[test]
    fn both_robots_of_the_folder_have_their_controllers() {
        for motor in [JointMotor::Dm4310, JointMotor::Rs00] {
            let robot = with_joints(motor);
            let layout = layout_of(&robot).expect("it is built in");
            assert_eq!(layout.profile().name, robot.name);
        }
    }

    #[test]
    fn a_robot_with_another_name_or_figure_has_none() {
        let changes: [fn(&mut Robot); 5] = [
            |robot| robot.name = "ours".to_owned(),
            |robot| robot.legs.thigh.length_m += 1e-3,
            |robot| robot.body.mass_kg += 0.01,
            |robot| robot.body.com_m[0] += 1e-3,
            |robot| robot.control.weights.q[0] *= 2.0,
        ];
        for change in changes {
            let mut robot = Robot::clone(&with_joints(JointMotor::Dm4310));
            change(&mut robot);
            assert!(layout_of(&robot).is_none());
        }
    }
}
