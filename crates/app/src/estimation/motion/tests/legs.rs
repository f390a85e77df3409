//! Bodies that move over their axle. The motion is worked out in double precision.

use super::*;
use crate::kinematics::Leg;

const UP_M: f64 = 0.05;
const LENGTH_M: f64 = 0.2;
const RADIUS_M: f64 = 0.06;

fn leg(angle_rad: f64, angle_rps: f64, carrier_rps: f64) -> Leg {
    Leg {
        length_m: LENGTH_M as f32,
        angle_rad: angle_rad as f32,
        length_mps: 0.0,
        angle_rps: angle_rps as f32,
        carrier_rps: carrier_rps as f32,
        length_per_rad: [0.0; 2],
        angle_per_rad: [0.0; 2],
        carrier_per_rad: [0.0; 2],
        fits: true,
    }
}

/// One instant of a robot whose level body swings on its legs, 2 Hz.
struct Swing {
    /// Of the legs in the world, hip ahead of the axle.
    lean_rad: f64,
    lean_rps: f64,
    lean_rps2: f64,
    axle_mps: f64,
    axle_mps2: f64,
}

impl Swing {
    /// The body stays where it is on the whole, or gets faster by `mps2`.
    fn at(t: f64, mps2: f64) -> Self {
        let rate = 4.0 * std::f64::consts::PI;
        let (sin, cos) = (rate * t).sin_cos();
        let (lean_rad, lean_rps, lean_rps2) =
            (0.2 - 0.2 * cos, 0.2 * rate * sin, 0.2 * rate * rate * cos);
        Self {
            lean_rad,
            lean_rps,
            lean_rps2,
            axle_mps: mps2 * t - 0.5 * LENGTH_M * lean_rps,
            axle_mps2: mps2 - 0.5 * LENGTH_M * lean_rps2,
        }
    }

    fn show(&self, bench: &mut Bench) {
        // The body is level: a leg that leans forward points backward in it.
        let carrier_rps = 0.7 * self.lean_rps;
        bench.legs = Some(
            [AxlePath::new(
                &leg(-self.lean_rad, -self.lean_rps, carrier_rps),
                UP_M as f32,
            ); 2],
        );
        let relative_mps = self.axle_mps - RADIUS_M * carrier_rps;
        bench.wheels_run([relative_mps as f32; 2]);
        let (sin, cos) = self.lean_rad.sin_cos();
        let forward_mps2 = self.axle_mps2
            + LENGTH_M * (self.lean_rps2 * cos - self.lean_rps * self.lean_rps * sin);
        let up_mps2 = -LENGTH_M * (self.lean_rps2 * sin + self.lean_rps * self.lean_rps * cos);
        bench.accel_mps2 = [
            forward_mps2 as f32,
            0.0,
            (f64::from(GRAVITY_MPS2) + up_mps2) as f32,
        ];
    }
}

/// The body moves by up to 0.4 m/s over the wheels, and these against it.
#[test]
fn a_body_that_swings_on_its_legs_does_not_slip() {
    let mut bench = Bench::on_wheels();
    let mut worst_mps = 0.0_f64;
    for sample in 0..1_000 {
        // The force of a sample is the mean over it; the rest is that of its end.
        let end = f64::from(sample + 1) * f64::from(DT_S);
        Swing::at(end - 0.5 * f64::from(DT_S), 0.2).show(&mut bench);
        let force = bench.accel_mps2;
        let now = Swing::at(end, 0.2);
        now.show(&mut bench);
        bench.accel_mps2 = force;
        bench.sample();
        worst_mps = worst_mps.max((f64::from(bench.forward_mps()) - now.axle_mps).abs());
    }
    assert!(worst_mps < 0.05, "{worst_mps} m/s");
    let [x, _, z] = bench.position_m();
    // ½ · 0.2 · 5².
    assert!((x - 2.5).abs() < 0.05 && z.abs() < 0.02, "{x} {z}");
}

/// The wheels of a robot that has left the ground turn as if it swung, but nothing accelerates it.
#[test]
fn wheels_that_spin_below_still_legs_slip() {
    let mut bench = Bench::on_wheels();
    bench.legs = Some([AxlePath::new(&leg(0.0, 0.0, 0.0), UP_M as f32); 2]);
    bench.run(1.0);
    bench.wheels_run([1.0, 1.0]);
    bench.run(1.0);
    assert!(bench.forward_mps().abs() < 0.1, "{}", bench.forward_mps());
}

/// A body that is turned on its stiff legs about the axle, with standing wheels: the motor goes with it.
#[test]
fn a_body_that_pitches_about_its_axle_does_not_move_it() {
    let mut bench = Bench::on_wheels();
    bench.legs = Some([AxlePath::new(&leg(0.0, 0.0, 0.0), UP_M as f32); 2]);
    let mut way_m = 0.0_f32;
    for sample in 0..200 {
        let t = f64::from(sample) * f64::from(DT_S);
        let rate = 4.0 * std::f64::consts::PI;
        let (sin, cos) = (rate * t).sin_cos();
        let (pitch, pitch_rps, pitch_rps2) =
            (0.1 - 0.1 * cos, 0.1 * rate * sin, 0.1 * rate * rate * cos);
        let (half_sin, half_cos) = (0.5 * pitch).sin_cos();
        bench.pose = BodyPose {
            orientation: Quaternion {
                w: half_cos as f32,
                x: 0.0,
                y: half_sin as f32,
                z: 0.0,
            },
            rate_rps: [0.0, pitch_rps as f32, 0.0],
        };
        // The wheel stands in the world, so the motor sees it turn backward.
        let relative_mps = -(RADIUS_M * pitch_rps) as f32;
        bench.wheels_run([relative_mps; 2]);
        let height = LENGTH_M + UP_M;
        let gravity = f64::from(GRAVITY_MPS2);
        bench.accel_mps2 = [
            (height * pitch_rps2 - gravity * pitch.sin()) as f32,
            0.0,
            (gravity * pitch.cos() - height * pitch_rps * pitch_rps) as f32,
        ];
        bench.sample();
        way_m = way_m.max(bench.position_m()[0].abs());
        assert!(bench.forward_mps().abs() < 0.05, "{}", bench.forward_mps());
    }
    assert!(way_m < 0.005, "{way_m} m");
}
