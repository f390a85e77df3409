//! What plant and firmware both take from the robot's file and no simulation proves. Here the simulated robot is built otherwise than
//! its file says, and the firmware does not know: it must stand up and stand all the same (docs/hardware.md#of-a-balancing-robot).

mod pilot;

use std::sync::Arc;

use robot_app::motor::layout::ROBOT_LAYOUT;
use robot_description::{Carrier, Robot as Description};
use robot_host_loop::Robot;
use robot_plant::{
    robots::{JointMotor, with_joints},
    world::{PlantKind, WorldConfig},
};

const STANDS_BY_S: f64 = 6.5;
const ENDS_S: f64 = 10.0;
/// Largest angle of the body, and largest way, of a robot that stands.
const MOST_RAD: f64 = 0.06;
const MOST_M: f64 = 0.1;

/// Angle and way while it should stand.
fn stands(change: impl Fn(&mut Description)) -> [f64; 2] {
    let mut described = Description::clone(&with_joints(JointMotor::Dm4310));
    change(&mut described);
    let world = WorldConfig {
        plant: PlantKind::Free,
        robot: Arc::new(described),
        seed: 3,
        ..WorldConfig::default()
    };
    let settings = ROBOT_LAYOUT.default_config();
    let mut robot =
        Robot::controlled_by(&ROBOT_LAYOUT, world, settings).expect("no recording to load");
    pilot::stand_up(&mut robot, STANDS_BY_S);
    let began_m = robot.signal("truth.body.x");
    let mut worst = [0.0_f64; 2];
    robot.run_until(ENDS_S, |robot| {
        let tilt_rad = ["truth.body.pitch", "truth.body.roll"].map(|it| robot.signal(it).abs());
        worst[0] = tilt_rad.into_iter().fold(worst[0], f64::max);
        worst[1] = worst[1].max((robot.signal("truth.body.x") - began_m).abs());
    });
    worst
}

type Change = (&'static str, fn(&mut Description));

const CHANGES: [Change; 15] = [
    ("smaller wheels", |it| it.wheels.radius_m *= 0.98),
    ("larger wheels", |it| it.wheels.radius_m *= 1.02),
    ("wider track", |it| it.wheels.track_m += 0.01),
    ("longer thighs", |it| it.legs.thigh.length_m += 0.003),
    ("shorter shanks", |it| it.legs.shank.length_m -= 0.003),
    ("hips apart", |it| it.legs.hip_gap_m += 0.003),
    ("one zero off", |it| it.joints.zeros_rad[0] += 0.03),
    ("both zeros of a leg off", |it| {
        it.joints.zeros_rad[0] += 0.03;
        it.joints.zeros_rad[1] += 0.03;
    }),
    ("heavier rotors of the hips", |it| {
        it.joints.armature_kgm2 *= 2.0
    }),
    ("heavier rotors of the wheels", |it| {
        it.wheels.rotor_inertia_kgm2 *= 1.3
    }),
    ("lighter rotors of the wheels", |it| {
        it.wheels.rotor_inertia_kgm2 *= 0.7
    }),
    ("board elsewhere", |it| {
        it.imu.place_m[0] += 0.03;
        it.imu.place_m[2] += 0.03;
    }),
    ("wheel motors on the other shanks", |it| {
        it.wheels.carrier = Carrier::Front
    }),
    ("body hard to turn", |it| {
        it.body.inertia_kgm2 = it.body.inertia_kgm2.map(|inertia| 1.5 * inertia);
    }),
    ("weaker wheel motors", |it| {
        it.wheels.torque_nm_per_a *= 0.85
    }),
];

#[test]
fn a_robot_stands_that_is_not_quite_as_its_file_says() {
    for (what, change) in CHANGES {
        let [tilt_rad, way_m] = stands(change);
        println!("{what}: {tilt_rad:.3} rad, {way_m:.3} m");
        assert!(
            tilt_rad < MOST_RAD && way_m < MOST_M,
            "{what}: {tilt_rad} rad, {way_m} m"
        );
    }
}
