//! Tests with synthetic recordings: a sensor with known errors and the noise of the BMI088's datasheet measures gravity
//! in known attitudes.

use nalgebra::Vector3;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use super::*;

const PERIOD_S: f64 = 0.005;
/// The noise is 160 and 190 µg/√Hz through the 80 Hz filter, whose noise bandwidth is 1.57 times that.
const NOISE_MPS2: [f64; 3] = [0.0176, 0.0176, 0.0209];
const SIDES: [[f64; 3]; 6] = [
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
];
/// Attitudes of a robot that leans against something.
const SLANTED: [[f64; 3]; 4] = [
    [0.6, 0.0, 0.8],
    [0.0, -0.7, 0.7],
    [-0.5, 0.5, -0.7],
    [0.6, 0.6, 0.5],
];

/// A sensor that measures `true / gain + offset`, and its recording.
struct SimulatedSensor {
    gain: Vector3<f64>,
    offset_mps2: Vector3<f64>,
    random: Pcg64,
    samples: Vec<Sample>,
}

impl SimulatedSensor {
    fn new() -> Self {
        Self {
            gain: Vector3::new(1.006, 0.995, 1.004),
            offset_mps2: Vector3::new(0.18, -0.12, 0.19),
            random: Pcg64::new(7, 1),
            samples: Vec::new(),
        }
    }

    fn measure(&mut self, force_mps2: Vector3<f64>) {
        let ideal = force_mps2.component_div(&self.gain) + self.offset_mps2;
        let value = Vector3::from_fn(|axis, _| {
            let normal: f64 = StandardNormal.sample(&mut self.random);
            // 12 g over 32,768 counts.
            let count = 12.0 * 9.806_65 / 32_768.0;
            ((ideal[axis] + NOISE_MPS2[axis] * normal) / count).round() * count
        });
        let t_s = self.samples.len() as f64 * PERIOD_S;
        self.samples.push(Sample { t_s, value });
    }

    /// Holds the robot still for `seconds` while `push_mps2` pushes it, and then carries it about.
    fn hold(&mut self, up: [f64; 3], seconds: f64, push_mps2: [f64; 3]) {
        let gravity = Vector3::from(up).normalize() * 9.806_65;
        for _ in 0..(seconds / PERIOD_S) as usize {
            self.measure(gravity + Vector3::from(push_mps2));
        }
        for step in 0..100 {
            let swing = 3.0 * (0.3 * f64::from(step)).sin();
            self.measure(gravity + Vector3::new(swing, -swing, 0.5 * swing));
        }
    }

    fn hold_all(mut self, sides: &[[f64; 3]]) -> Self {
        for side in sides {
            self.hold(*side, 2.5, [0.0; 3]);
        }
        self
    }

    fn fit(self) -> Result<AccelFit, AccelError> {
        calibrate(&[self.samples])
    }
}

/// The noise over two seconds is 0.0015 m/s², and a few such errors may add up.
fn assert_truth(fit: &AccelFit) {
    let correction = &fit.correction;
    let bias_error = correction.bias_mps2 - Vector3::new(0.18, -0.12, 0.19);
    let scale_error = correction.scale - Vector3::new(1.006, 0.995, 1.004);
    assert!(bias_error.amax() < 0.005, "{correction:?}");
    assert!(scale_error.amax() < 0.0008, "{correction:?}");
}

#[test]
fn offsets_and_scales_are_found_through_the_noise() {
    let fit = SimulatedSensor::new()
        .hold_all(&[&SIDES[..], &SLANTED].concat())
        .fit()
        .unwrap();
    assert_truth(&fit);
    assert_eq!((fit.windows.len(), fit.rejected.len()), (10, 0));
    assert!(fit.is_checked());
    assert!(fit.residual_before_mps2 > 0.1 && fit.residual_after_mps2 < 0.004);
}

#[test]
fn six_sides_are_enough_but_leave_no_check() {
    let fit = SimulatedSensor::new().hold_all(&SIDES).fit().unwrap();
    assert_truth(&fit);
    assert!(!fit.is_checked());
}

#[test]
fn sides_may_come_in_several_recordings() {
    let first = SimulatedSensor::new().hold_all(&SIDES[..2]);
    let second = SimulatedSensor::new().hold_all(&SIDES[2..]);
    let fit = calibrate(&[first.samples, second.samples]).unwrap();
    assert_truth(&fit);
}

#[test]
fn the_missing_sides_are_named() {
    let sides = [SIDES[0], SIDES[2], SIDES[3], SIDES[4], SLANTED[2]];
    let error = SimulatedSensor::new().hold_all(&sides).fit().unwrap_err();
    assert_eq!(
        error,
        AccelError::MissingFaces(vec![Face::Bottom, Face::Back])
    );
    let text = error.to_string();
    assert!(text.contains("upside down (-z), back up (-x)"), "{text}");
}

#[test]
fn a_pushed_position_is_left_out() {
    let mut bench = SimulatedSensor::new().hold_all(&[&SIDES[..], &SLANTED].concat());
    bench.hold(SIDES[0], 2.5, [0.0, 0.0, 0.6]);
    let fit = bench.fit().unwrap();
    assert_truth(&fit);
    assert_eq!(fit.rejected.len(), 1);
    assert!((fit.rejected[0].mean_mps2.z - (10.406_65 / 1.004 + 0.19)).abs() < 0.01);
}

#[test]
fn positions_that_contradict_each_other_are_refused() {
    let mut bench = SimulatedSensor::new();
    for (side, offset) in SIDES.iter().chain(&SLANTED).zip([0.4, -0.4].iter().cycle()) {
        bench.hold(*side, 2.5, [*offset, -*offset, *offset]);
    }
    assert!(matches!(bench.fit(), Err(AccelError::BadFit { .. })));
}

#[test]
fn a_robot_in_the_hand_is_not_still() {
    let mut bench = SimulatedSensor::new();
    for side in SIDES {
        bench.hold(side, 0.9, [0.0; 3]);
    }
    assert_eq!(bench.fit().unwrap_err(), AccelError::NeverStill);
}

#[test]
fn values_no_sensor_of_this_kind_has_are_refused() {
    let mut bench = SimulatedSensor::new();
    bench.offset_mps2.y = -2.5;
    let fit = bench.hold_all(&[&SIDES[..], &SLANTED].concat()).fit();
    assert!(matches!(
        fit,
        Err(AccelError::Implausible { axis: 'y', .. })
    ));
}

#[test]
fn a_correction_can_be_undone() {
    let correction = AccelCorrection {
        bias_mps2: Vector3::new(0.1, -0.2, 0.3),
        scale: Vector3::new(1.01, 0.99, 1.02),
    };
    let raw = Vector3::new(3.0, -4.0, 8.0);
    assert!((correction.undo(correction.apply(raw)) - raw).norm() < 1e-12);
}
