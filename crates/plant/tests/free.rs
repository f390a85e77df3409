//! The free robot in the world: its motors, its sensors' place, pushes and what can differ from its file.

use robot_plant::{
    time::{MS, Ps, SECOND},
    wire::CanFrame,
    world::{CanBusId, PlantKind, Push, Start, Variation, World, WorldConfig},
};

fn world(start: Start, variation: Variation) -> World {
    World::new(WorldConfig {
        plant: PlantKind::Free,
        start,
        variation,
        ..WorldConfig::default()
    })
    .expect("no recording to load")
}

fn signal(world: &World, name: &str) -> f64 {
    world.signal(name).expect(name)
}

/// Commands the left wheel's C620 with a raw current.
fn drive(world: &mut World, raw: i16, now: Ps) {
    let [high, low] = raw.to_be_bytes();
    let frame = CanFrame::with_data(0x200, [high, low, 0, 0, 0, 0, 0, 0]);
    world.can_received(CanBusId::Can1, 0, &frame, now);
}

#[test]
fn a_sitting_robot_stays_where_it_is_and_its_wheels_carry_weight() {
    let mut world = world(Start::Sitting, Variation::default());
    world.advance(MS);
    let place = signal(&world, "truth.body.x");
    world.advance(2 * SECOND);
    assert!((signal(&world, "truth.body.x") - place).abs() < 2e-3);
    // 6.4 kg on the file, whoever carries it: wheels and body together.
    let carried_n: f64 = [
        "truth.wheel.0.contact_n",
        "truth.wheel.1.contact_n",
        "truth.body.contact_n",
    ]
    .map(|name| signal(&world, name))
    .iter()
    .sum();
    let mass_kg = WorldConfig::default().robot.total_mass_kg();
    assert!(
        (carried_n / (mass_kg * 9.80665) - 1.0).abs() < 0.05,
        "{carried_n} N"
    );
    let [x, y, z] = ["ax", "ay", "az"].map(|axis| signal(&world, &format!("truth.imu.{axis}")));
    let force = (x * x + y * y + z * z).sqrt();
    assert!((force - 9.80665).abs() < 0.02, "{force}");
}

#[test]
fn in_flight_the_imu_feels_nothing_and_the_motors_speed_is_against_the_shank() {
    let mut world = world(Start::Dropped { height_m: 2.0 }, Variation::default());
    drive(&mut world, 4_000, MS);
    world.advance(150 * MS);
    // The wheel is driven one way, shank and body go the other: the motor counts both.
    let motor_rps =
        signal(&world, "can.m3508.0.rpm") * std::f64::consts::TAU / 60.0 / (3591.0 / 187.0);
    let wheel_rps = signal(&world, "truth.wheel.0.speed_rps");
    assert!(
        wheel_rps > 5.0 && (0.0..2.0).contains(&(motor_rps - wheel_rps)),
        "{motor_rps} {wheel_rps}"
    );
    // The right leg's wheel is not driven, and the whole robot turns nose up as the wheel rolls forward.
    assert!(signal(&world, "truth.body.pitch") < 0.0);
    let force = signal(&world, "truth.imu.az").abs();
    assert!(force < 2.0, "{force} m/s²: it falls freely");
}

#[test]
fn a_push_gives_the_robot_its_impulse() {
    let mut world = world(Start::Dropped { height_m: 2.0 }, Variation::default());
    world.advance(MS);
    let mass_kg = WorldConfig::default().robot.total_mass_kg();
    world.push(Push::instant([1.5 * mass_kg, 0.0, 0.0]));
    world.advance(31 * MS);
    // At the body's centre of mass, which the legs follow only in part: the body is faster than the whole.
    let vx = signal(&world, "truth.body.vx");
    assert!((1.5..3.5).contains(&vx), "{vx} m/s");
    world.advance(60 * MS);
    assert!(
        (signal(&world, "truth.body.vx") - vx).abs() < 1.0,
        "the push has ended"
    );
}

#[test]
fn a_delayed_command_acts_later_and_a_weak_motor_makes_less_torque() {
    let torque_after = |variation: Variation, at: Ps| {
        let mut world = world(Start::Sitting, variation);
        drive(&mut world, 4_000, 10 * MS);
        world.advance(at);
        signal(&world, "can.m3508.0.current_ma")
    };
    let late = Variation {
        delay: 5 * MS,
        ..Variation::default()
    };
    assert_eq!(torque_after(late, 14 * MS), 0.0);
    assert!((torque_after(late, 16 * MS) - 4_882.8).abs() < 0.1);
    assert!((torque_after(Variation::default(), 10 * MS) - 4_882.8).abs() < 0.1);
    let speed = |torque| {
        let weak = Variation {
            torque,
            ..Variation::default()
        };
        let mut world = world(Start::Dropped { height_m: 2.0 }, weak);
        drive(&mut world, 4_000, MS);
        world.advance(51 * MS);
        signal(&world, "truth.wheel.0.speed_rps")
    };
    let (weak, strong) = (speed(0.9), speed(1.1));
    assert!(strong > 1.15 * weak, "{weak} {strong}");
}
