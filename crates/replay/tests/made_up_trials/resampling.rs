//! Rows of any rate become samples of 5 ms.

use robot_replay::Trial;

use crate::recorder::{self, HZ200, NATIVE, Rate};

/// Returns a trial in which every sensor axis of row i reads i.
fn counting(
    rate: Rate,
    rows: u16,
    change: impl Fn(&mut Vec<Vec<f32>>),
) -> (&'static str, Rate, Vec<Vec<f32>>) {
    let row: Vec<f32> = (0..rows).map(f32::from).collect();
    let mut columns = vec![row; 10];
    change(&mut columns);
    ("counting", rate, columns)
}

fn read(test: &str, (name, rate, columns): (&str, Rate, Vec<Vec<f32>>)) -> Trial {
    let folder = recorder::folder(test);
    Trial::read(&recorder::write(&folder, name, rate, &columns)).unwrap()
}

#[test]
fn rows_at_the_firmwares_rate_do_not_change() {
    let trial = read("same-rate", counting(HZ200, 9, |_| {}));
    assert_eq!(trial.samples.len(), 9);
    for (index, sample) in trial.samples.iter().enumerate() {
        assert_eq!(sample.end_us, index as u64 * 5_000);
        assert_eq!(sample.motion.unwrap().gyro_rps, [index as f32; 3]);
        let field = (index % 4 == 0).then_some([index as f32; 3]);
        assert_eq!(sample.field_ut, field);
    }
}

/// Row i lasts from 3.5 (i − 1) ms to 3.5 i ms. So the window from 0 to 5 ms is all of row 1 and 1.5 ms of row 2. The
/// one from 30 to 35 ms is 1.5 ms of row 9 and all of row 10. A window that begins before row 0 is left out.
#[test]
fn rows_of_3_5_ms_are_weighted_into_windows_of_5_ms() {
    let trial = read("shared-out", counting(NATIVE, 11, |_| {}));
    let gyro = |end_us: u64| {
        let sample = trial.samples.iter().find(|sample| sample.end_us == end_us);
        sample.map(|sample| sample.motion.unwrap().gyro_rps[0])
    };
    assert_eq!(gyro(0), None);
    assert_eq!(gyro(5_000), Some(1.3));
    assert_eq!(gyro(35_000), Some(9.7));
    assert_eq!(gyro(40_000), None);
}

#[test]
fn a_row_without_a_number_is_no_sample() {
    let damaged = counting(HZ200, 12, |columns| {
        columns[5][2] = f32::NAN;
        columns[2][3] = f32::INFINITY;
        columns[8][4] = f32::NAN;
    });
    let trial = read("no-number", damaged);
    let without: Vec<usize> = (0..12)
        .filter(|i| trial.samples[*i].motion.is_none())
        .collect();
    assert_eq!(without, [2, 3]);
    assert_eq!(trial.samples[4].field_ut, None);
    assert!(trial.samples[8].field_ut.is_some());
    assert_eq!(
        (trial.rows_without_motion, trial.rows_without_field),
        (2, 1)
    );
}

/// The BMI088 measures ±2000 °/s (34.907 rad/s) and ±12 g (117.680 m/s²); the recorder may have measured more.
#[test]
fn values_beyond_the_imus_range_are_clipped_and_marked() {
    let beyond = counting(HZ200, 8, |columns| {
        columns[1][3] = -36.0;
        columns[4][5] = 130.0;
        columns[7][6] = 4_000.0;
    });
    let trial = read("beyond", beyond);
    let motion = |index: usize| trial.samples[index].motion.unwrap();
    let marked: Vec<usize> = (0..8).filter(|i| motion(*i).saturated).collect();
    assert_eq!(marked, [3, 5]);
    assert!((motion(3).gyro_rps[0] + 34.907).abs() < 1e-3);
    assert_eq!(motion(3).gyro_clipped_ms, [5, 0, 0]);
    assert_eq!(motion(5).gyro_clipped_ms, [0; 3]);
    assert!((motion(5).accel_mps2[0] - 117.680).abs() < 1e-3);
}
