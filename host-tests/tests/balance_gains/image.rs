//! The image has the gains that are designed here.

use robot_app::domain::robots;
use robot_balance_design::Schedule;
use robot_description::Robot;

use crate::scipy::file;

#[test]
fn the_image_has_the_gains_of_its_robot() {
    for profile in [robots::FIVEBAR, robots::FIVEBAR_RS00] {
        let robot = Robot::read(&file(profile.name)).expect("a robot of this repository");
        let schedule = Schedule::new(&robot).expect("a loop that holds");
        let gains = &profile.balance.gains;
        assert_eq!(gains.centre_m, schedule.centre_m as f32);
        assert_eq!(gains.min_m, schedule.min_m as f32);
        assert_eq!(gains.max_m, schedule.max_m as f32);
        let designed = schedule.coefficients.as_flattened().as_flattened();
        let built_in = gains.k.as_flattened().as_flattened();
        for (built_in, designed) in built_in.iter().zip(designed) {
            // The build script may round sums differently.
            let difference = f64::from(*built_in) - designed;
            assert!(
                difference.abs() < 1e-6 * designed.abs().max(1.0),
                "{}",
                profile.name
            );
        }
    }
}
