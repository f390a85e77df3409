//! Which controller is for a robot.

use robot_app::motor::layout::{CHOSEN_LAYOUT, MotorLayout, ROBOT_LAYOUT, RS00_LAYOUT};
use robot_description::Robot;

static CHOSEN: MotorLayout = CHOSEN_LAYOUT;

/// Motors, geometry and gains for a robot: those that were made of its file when this program was built. They are `None` if it was
/// built with other robots only, or with another file of that name.
pub fn layout_of(robot: &Robot) -> Option<&'static MotorLayout> {
    [&CHOSEN, &ROBOT_LAYOUT, &RS00_LAYOUT]
        .into_iter()
        .find(|layout| is_of(layout, robot))
}

fn is_of(layout: &MotorLayout, robot: &Robot) -> bool {
    let profile = layout.profile();
    let (legs, mass, odom) = (
        &profile.balance.legs,
        &profile.balance.mass,
        &profile.wheel_odom,
    );
    let figures = [
        (legs.hip_gap_m, robot.legs.hip_gap_m),
        (legs.thigh_m, robot.legs.thigh.length_m),
        (legs.shank_m, robot.legs.shank.length_m),
        (odom.wheel_radius_m, robot.wheels.radius_m),
        (odom.wheel_track_m, robot.wheels.track_m),
        (mass.total_kg, robot.total_mass_kg()),
    ];
    // The build writes single precision.
    let same = |(built, filed): &(f32, f64)| (f64::from(*built) / filed - 1.0).abs() < 1e-6;
    profile.name == robot.name && figures.iter().all(same)
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
    fn a_robot_with_another_name_length_or_mass_has_none() {
        let changes: [fn(&mut Robot); 3] = [
            |robot| robot.name = "ours".to_owned(),
            |robot| robot.legs.thigh.length_m += 1e-3,
            |robot| robot.body.mass_kg += 0.01,
        ];
        for change in changes {
            let mut robot = Robot::clone(&with_joints(JointMotor::Dm4310));
            change(&mut robot);
            assert!(layout_of(&robot).is_none());
        }
    }
}
