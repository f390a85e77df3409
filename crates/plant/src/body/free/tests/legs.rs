//! Legs under a clamped body.

use super::*;

fn clamped(robot: &Robot) -> FreeBody {
    let setup = FreeSetup {
        start: Start::Dropped { height_m: 1.0 },
        hold: Hold::Clamped,
        ..FreeSetup::default()
    };
    FreeBody::new(robot, &setup)
}

const POSES: [[f64; 4]; 3] = [
    [-0.3, 0.3, -0.3, 0.3],
    [0.2, 0.6, -0.8, 0.1],
    [-1.0, -0.4, 0.7, 1.2],
];

fn at_rest(body: &mut FreeBody, joint_rad: [f64; 4]) {
    let mut state = body.state();
    state.joint_rad = joint_rad;
    state.joint_rps = [0.0; 4];
    body.set_state(&state);
}

#[test]
fn holding_torques_are_the_slope_of_the_potential_energy() {
    let mut body = clamped(&robot());
    for pose in POSES {
        at_rest(&mut body, pose);
        let torques_nm = body.holding_torque_nm([[0.0; 2]; 2]);
        for joint in 0..4 {
            let mut energy_j = |by: f64| {
                let mut pose = pose;
                pose[joint] += by;
                at_rest(&mut body, pose);
                body.energy_j()
            };
            let slope_nm = (energy_j(1e-5) - energy_j(-1e-5)) / 2e-5;
            assert!((slope_nm - torques_nm[joint]).abs() < 1e-6, "{joint}");
        }
    }
}

#[test]
fn holding_torques_hold() {
    let mut body = clamped(&robot());
    for pose in POSES {
        at_rest(&mut body, pose);
        let joint_nm = body.holding_torque_nm([[0.0; 2]; 2]);
        // The wheel hangs free, and so takes no torque.
        run(&mut body, 0.01, |_| FreeInputs {
            joint_nm,
            ..FreeInputs::default()
        });
        for rps in body.joint_vel_rps() {
            assert!(rps.abs() < 1e-3, "{rps}");
        }
    }
}

#[test]
fn a_newton_at_180_mm_costs_what_virtual_work_says() {
    let mut body = clamped(&robot());
    let hips = body
        .model
        .bar
        .hips_for(Vec2::new(0.0, -0.18))
        .unwrap_or_default();
    at_rest(&mut body, [hips[0], hips[1], hips[0], hips[1]]);
    let [weight, loaded] = [[0.0, 0.0], [0.0, 1.0]].map(|force| body.holding_torque_nm([force; 2]));
    // Both hips of a leg share the work of one newton over a millimetre of leg length.
    let turned = |by: f64| {
        let at = body
            .model
            .bar
            .hips_for(Vec2::new(0.0, -0.18 - by))
            .unwrap_or_default();
        (at[0] - hips[0]) / by
    };
    let expected_nm = 0.5 / turned(1e-6);
    let front_nm = loaded[0] - weight[0];
    assert!(
        (front_nm / expected_nm - 1.0).abs() < 1e-4,
        "{front_nm} {expected_nm}"
    );
    assert!((front_nm.abs() - 0.077).abs() < 1e-3, "{front_nm}");
}

#[test]
fn a_thigh_alone_swings_as_a_pendulum_does() {
    let mut robot = robot();
    for mass in [
        &mut robot.legs.shank.mass_kg,
        &mut robot.legs.shank.inertia_kgm2,
        &mut robot.wheels.mass_kg,
        &mut robot.wheels.motor_mass_kg,
        &mut robot.wheels.inertia_kgm2,
    ] {
        *mass = 1e-9;
    }
    robot.joints.range_rad.front = [-1.8, 0.5];
    let mut body = clamped(&robot);
    at_rest(&mut body, [-1.47, 0.0, -1.47, 0.0]);
    let hanging_rad = -std::f64::consts::FRAC_PI_2;
    let mut steps = 0;
    while body.joint_pos_rad()[0] > hanging_rad {
        let rear = FreeInputs {
            joint_nm: [0.0, -0.049, 0.0, -0.049],
            ..FreeInputs::default()
        };
        body.step(&rear, DT_S);
        steps += 1;
    }
    let thigh = &robot.legs.thigh;
    let inertia =
        thigh.inertia_kgm2 + thigh.mass_kg * thigh.com_m.powi(2) + robot.joints.armature_kgm2;
    let quarter_s = hanging_rad.abs() / (thigh.mass_kg * G * thigh.com_m / inertia).sqrt();
    assert!(
        (f64::from(steps) * DT_S / quarter_s - 1.0).abs() < 0.01,
        "{steps} {quarter_s}"
    );
}

#[test]
fn a_clamped_accelerometer_reads_gravity() {
    let mut body = clamped(&robot());
    run(&mut body, 0.1, |_| FreeInputs {
        joint_nm: [1.0; 4],
        ..FreeInputs::default()
    });
    let force = body.specific_force_at([0.1, 0.2, 0.3]);
    assert!(
        force[0].abs() < 1e-12 && (force[2] - G).abs() < 1e-12,
        "{force:?}"
    );
}

#[test]
fn a_stop_holds_what_a_motor_can_push() {
    let mut body = clamped(&robot());
    run(&mut body, 1.0, |_| FreeInputs {
        joint_nm: [7.0, -7.0, 7.0, -7.0],
        ..FreeInputs::default()
    });
    let [front, rear, ..] = body.joint_pos_rad();
    let [lower, upper] = body.model.hip_range_rad[0];
    assert!((upper..upper + 0.06).contains(&front), "{front}");
    assert!((lower - 0.06..-upper + 0.06).contains(&rear), "{rear}");
    assert!(body.motion.fastest() < 0.01);
}
