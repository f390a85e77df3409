//! Tests with synthetic recordings: the earth's field in known attitudes with known iron and the noise of the IST8310.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3, Vector4};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use super::*;

/// The field of Central Europe: 20 µT north, 44 µT down (x east, y north, z up).
const EARTH_UT: Vector3<f64> = Vector3::new(0.0, 20.0, -44.0);
const STRENGTH_UT: f64 = 48.332_183_894_378_29;
const NOISE_UT: f64 = 0.8;
const COUNT_UT: f64 = 0.3;

/// A sensor that measures `iron · field + magnet`.
struct SimulatedSensor {
    iron: Matrix3<f64>,
    magnet_ut: Vector3<f64>,
    random: Pcg64,
    samples: Vec<Sample>,
}

impl SimulatedSensor {
    fn new() -> Self {
        Self {
            iron: Matrix3::new(1.12, 0.05, -0.03, 0.05, 0.94, 0.02, -0.03, 0.02, 1.03),
            magnet_ut: Vector3::new(24.0, -13.0, 37.0),
            random: Pcg64::new(11, 2),
            samples: Vec::new(),
        }
    }

    fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.random)
    }

    fn measure(&mut self, attitude: UnitQuaternion<f64>, disturbance_ut: Vector3<f64>) {
        let field = attitude.inverse() * (EARTH_UT + disturbance_ut);
        let ideal = self.iron * field + self.magnet_ut;
        let value = ideal.map(|v| ((v + NOISE_UT * self.normal()) / COUNT_UT).round() * COUNT_UT);
        let t_s = self.samples.len() as f64 * 0.02;
        self.samples.push(Sample { t_s, value });
    }

    fn any_attitude(&mut self) -> UnitQuaternion<f64> {
        let parts = Vector4::from_fn(|_, _| self.normal());
        UnitQuaternion::new_normalize(Quaternion::from_vector(parts))
    }

    fn tumble(mut self, count: usize) -> Self {
        for _ in 0..count {
            let attitude = self.any_attitude();
            self.measure(attitude, Vector3::zeros());
        }
        self
    }

    fn fit(self) -> Result<MagFit, MagError> {
        calibrate(&[self.samples], None)
    }
}

/// Expects the soft iron of determinant 1 that undoes the bench's iron, and the bench's magnet. 1,500 samples of 0.8 µT
/// noise determine an offset to about 0.8 / √(1500 / 3) = 0.04 µT. Four times that is allowed, and the same share of 48
/// µT.
fn assert_truth(fit: &MagFit) {
    let bench = SimulatedSensor::new();
    let undo = bench.iron.try_inverse().unwrap() * bench.iron.determinant().cbrt();
    let bias_error = fit.correction.bias_ut - bench.magnet_ut;
    let iron_error = fit.correction.soft_iron - undo;
    assert!(bias_error.amax() < 0.2, "{:?}", fit.correction);
    assert!(iron_error.amax() < 0.006, "{:?}", fit.correction);
}

#[test]
fn hard_and_soft_iron_are_found_through_the_noise() {
    let fit = SimulatedSensor::new().tumble(1_500).fit().unwrap();
    assert_truth(&fit);
    assert_eq!(fit.rejected, 0);
    assert_eq!(fit.coverage.share, 1.0);
    assert!(fit.residual_before_ut > 10.0, "{}", fit.residual_before_ut);
    assert!((0.7..0.95).contains(&fit.residual_after_ut));
    let stretched = STRENGTH_UT * SimulatedSensor::new().iron.determinant().cbrt();
    assert!((fit.field_ut - stretched).abs() < 0.1, "{}", fit.field_ut);
}

#[test]
fn the_matrix_is_symmetric_and_the_wanted_strength_is_kept() {
    let bench = SimulatedSensor::new().tumble(1_500);
    let fit = calibrate(&[bench.samples], Some(STRENGTH_UT)).unwrap();
    let matrix = fit.correction.soft_iron;
    assert_eq!(matrix, matrix.transpose());
    let truth = SimulatedSensor::new().iron.try_inverse().unwrap();
    assert!((matrix - truth).amax() < 0.006);
    assert_eq!(fit.field_ut, STRENGTH_UT);
}

#[test]
fn glitches_and_a_passing_magnet_are_left_out() {
    let mut bench = SimulatedSensor::new().tumble(1_400);
    for _ in 0..60 {
        let attitude = bench.any_attitude();
        bench.measure(attitude, Vector3::new(15.0, -10.0, 10.0));
    }
    for n in 0..20 {
        let value = Vector3::new(-900.0, 600.0, 300.0 + f64::from(n));
        bench.samples.push(Sample { t_s: 60.0, value });
    }
    let fit = bench.fit().unwrap();
    assert!(fit.rejected >= 60, "{}", fit.rejected);
    let bench = SimulatedSensor::new();
    let bias_error = fit.correction.bias_ut - bench.magnet_ut;
    assert!(bias_error.amax() < 0.6, "{:?}", fit.correction);
}

#[test]
fn a_place_full_of_iron_is_refused() {
    let mut bench = SimulatedSensor::new();
    for n in 0..1_500 {
        let attitude = bench.any_attitude();
        let drift = Vector3::new(12.0, -9.0, 14.0) * (f64::from(n) * 0.01).sin();
        bench.measure(attitude, drift);
    }
    let refused = bench.fit().unwrap_err();
    assert!(
        matches!(
            refused,
            MagError::Disturbed { .. } | MagError::BadFit { .. }
        ),
        "{refused:?}"
    );
}

#[test]
fn turning_about_one_axis_is_not_enough() {
    let mut bench = SimulatedSensor::new();
    for n in 0..1_500 {
        let yaw = f64::from(n) * 0.01;
        bench.measure(
            UnitQuaternion::from_euler_angles(0.0, 0.0, yaw),
            Vector3::zeros(),
        );
    }
    let refused = bench.fit().unwrap_err();
    assert!(
        matches!(
            refused,
            MagError::TooLittleRotation | MagError::Uncovered { .. }
        ),
        "{refused:?}"
    );
    assert!(refused.to_string().contains("too little rotation"));
}

#[test]
fn the_side_that_was_not_seen_is_named() {
    let mut bench = SimulatedSensor::new();
    while bench.samples.len() < 1_500 {
        let attitude = bench.any_attitude();
        // The field points down, so an upright robot never measures a field out of its top.
        if (attitude.inverse() * EARTH_UT).z < 5.0 {
            bench.measure(attitude, Vector3::zeros());
        }
    }
    let MagError::Uncovered { covered, missing } = bench.fit().unwrap_err() else {
        panic!("not refused for its coverage");
    };
    assert!((0.5..0.75).contains(&covered), "{covered}");
    assert!(missing.contains("top"), "{missing}");
}

#[test]
fn too_few_samples_and_wrong_units_are_refused() {
    let few = SimulatedSensor::new().tumble(150).fit().unwrap_err();
    assert!(matches!(few, MagError::TooFewSamples(_)));
    let mut bench = SimulatedSensor::new().tumble(1_000);
    for sample in &mut bench.samples {
        sample.value /= 100.0;
    }
    assert!(matches!(bench.fit(), Err(MagError::Implausible { .. })));
}

#[test]
fn a_correction_can_be_undone() {
    let fit = SimulatedSensor::new().tumble(1_000).fit().unwrap();
    let raw = Vector3::new(30.0, -4.0, 8.0);
    let again = fit.correction.undo(fit.correction.apply(raw)).unwrap();
    assert!((again - raw).norm() < 1e-9);
}
