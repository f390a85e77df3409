//! The whole run, with the plant in the loop.

use robot_app::domain::RobotConfig;
use robot_host_loop::Robot;
use robot_plant::time::to_seconds;

use crate::{
    course::{self, Moment},
    image,
    ticks::output_names,
};

fn on_the_host() -> Vec<Moment> {
    let mut robot =
        Robot::in_world(course::config(), RobotConfig::default()).expect("no recording to load");
    let mut moments = Vec::new();
    let mut look = |robot: &mut Robot, until| {
        robot.run_until(to_seconds(until), |robot| {
            let due = to_seconds(course::moment_at(moments.len()));
            if robot.seconds() >= due {
                moments.push(Moment::of(robot.world()));
            }
        });
    };
    for (at, event) in course::events() {
        look(&mut robot, at);
        event.happen(robot.world_mut());
    }
    look(&mut robot, course::ENDS_AT);
    moments
}

/// Largest differences, in m, m/s and rad: until the robot stands, and after that. They are some three times those found, which
/// are the work of instants: the image ticks 0.3 ms earlier, and takes samples of its sensors of another phase, whose noise is
/// another one. Dry friction in hips and gears makes the more of it once the robot stands.
const MOST: [(&str, [f64; 2]); 6] = [
    ("truth.body.x", [0.06, 0.12]),
    ("truth.body.vx", [0.25, 0.18]),
    ("truth.body.z", [0.012, 0.003]),
    ("truth.body.roll", [0.015, 0.015]),
    ("truth.body.pitch", [0.07, 0.11]),
    ("truth.body.yaw", [0.036, 0.03]),
];

#[test]
fn a_run_of_the_image_is_that_of_the_host_loop_within_tolerances() {
    let (here, there) = (on_the_host(), &image::run(&output_names()).moments);
    assert_eq!(here.len(), there.len());
    let standing = |number: &usize| course::moment_at(*number) >= course::STANDS_AT;
    let rising = (0..here.len()).take_while(|it| !standing(it)).count();
    for (signal, most) in MOST {
        let apart: Vec<f64> = here
            .iter()
            .zip(there)
            .map(|(here, there)| (here.get(signal) - there.get(signal)).abs())
            .collect();
        let (first, second) = apart.split_at(rising);
        let found = [first, second].map(|it| it.iter().fold(0.0_f64, |most, it| most.max(*it)));
        println!("{signal}: {found:.4?} apart");
        assert!(
            found[0] < most[0] && found[1] < most[1],
            "{signal}: {found:?} apart, at most {most:?}"
        );
    }
    let way_m = there[there.len() - 1].get("truth.body.x");
    assert!(way_m > 1.0, "the robot has driven {way_m} m");
}
