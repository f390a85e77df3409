use robot_envelope::*;
use robot_plant::world::*;
use std::sync::Arc;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let seed: u64 = args[1].parse().unwrap();
    let vary = args[2] == "vary";
    let what = args[3].as_str();
    let amount: f64 = args.get(4).map_or(0.0, |a| a.parse().unwrap());
    let from: f64 = args.get(5).map_or(6.9, |a| a.parse().unwrap());
    let to: f64 = args.get(6).map_or(9.0, |a| a.parse().unwrap());
    let step: u32 = args.get(7).map_or(20, |a| a.parse().unwrap());
    let robots = Robots {
        robot: Arc::new(
            robot_description::Robot::read(std::path::Path::new("robots/fivebar.toml")).unwrap(),
        ),
        vary,
    };
    println!("{:?} {}", robots.variation(seed), robots.mass_kg(seed));
    let start = match what {
        "front" => Start::Front,
        "back" => Start::Back,
        "left" => Start::Left,
        "right" => Start::Right,
        "top" => Start::UpsideDown,
        "folded" => Start::Folded,
        _ => Start::Sitting,
    };
    let terrain = match what {
        "step" => Terrain::Step {
            at_m: 1.5,
            height_m: amount,
        },
        "slope" => Terrain::Slope {
            start_m: 1.5,
            angle_rad: amount,
            length_m: 6.0,
        },
        _ => Terrain::Flat,
    };
    let mut trial = Trial::new(&robots, seed, terrain, start);
    let mut n = 0u32;
    let run = |trial: &mut Trial, until: f64, n: &mut u32| {
        while trial.now().t_s < until {
            let t = trial.now().t_s + 0.001;
            trial.run_until(t);
            *n += 1;
            if t >= from && t < to && *n % step == 0 {
                let d = trial.robot().diagnostics();
                let s = *trial.now();
                let e = &d.estimate;
                let lt = [
                    trial.robot().signal("truth.leg.0.angle_rad"),
                    trial.robot().signal("truth.leg.1.angle_rad"),
                ];
                let deg = |r: f64| r.to_degrees();
                println!(
                    "{:.2} {:6.2} {:6.1} {:6.1} est {:6.1} {:6.1} lean {:6.1} {:6.1} v {:6.2} est {:6.2} L {:.3} {:.3} F {:5.0} {:5.0} body {:5.0} Tw {:5.2} {:5.2} z {:.3} x {:.2} {:?} air {} est {:5.0} {:5.0} leanE {:5.1}",
                    s.t_s,
                    deg(s.rpy_rad[0]),
                    deg(s.rpy_rad[1]),
                    deg(s.rpy_rad[2]),
                    deg(e.rpy_rad[0].into()),
                    deg(e.rpy_rad[1].into()),
                    deg(s.rpy_rad[1] - lt[0]),
                    deg(s.rpy_rad[1] - lt[1]),
                    s.forward_mps,
                    e.vel_mps[0].hypot(e.vel_mps[1]),
                    s.leg_m[0],
                    s.leg_m[1],
                    s.wheel_n[0],
                    s.wheel_n[1],
                    s.body_n,
                    s.wheel_nm[0],
                    s.wheel_nm[1],
                    s.place_m[2],
                    s.place_m[0],
                    format!(
                        "{:?} valid {} frozen {:?} gyro {:?} acc {:?} flags {:?}",
                        d.balance.state,
                        e.valid,
                        d.sensors
                            .motor
                            .joints
                            .map(|j| (j.frozen, (j.vel_rps * 10.0).round() / 10.0)),
                        d.sensors.imu.gyro_dps[1].round(),
                        d.sensors.imu.accel_mps2.map(|a| a.round()),
                        d.safety.flags.names().collect::<Vec<_>>()
                    ),
                    d.balance.airborne,
                    d.balance.contact_n[0],
                    d.balance.contact_n[1],
                    deg(d.balance.lean_rad[0].into())
                );
            }
        }
    };
    run(&mut trial, 3.0, &mut n);
    trial.pilot(RemoteInput {
        enable: Some(true),
        ..Default::default()
    });
    run(&mut trial, 3.3, &mut n);
    trial.pilot(RemoteInput {
        stand: Some(true),
        ..Default::default()
    });
    run(&mut trial, 7.0, &mut n);
    match what {
        "push" => trial.push([amount, 0.0, 0.0]),
        "diag" => trial.push([amount * 0.7, amount * 0.7, 0.0]),
        "drop" => trial.push([0.0, 0.0, amount]),
        "jump" => trial.pilot(RemoteInput {
            jump: Some(true),
            ..Default::default()
        }),
        "spin" => trial.sticks(0.0, 1.0),
        "step" | "slope" => trial.sticks(0.4, 0.0),
        _ => {}
    }
    run(&mut trial, to, &mut n);
    println!("{:?}", trial.require_upright());
}
