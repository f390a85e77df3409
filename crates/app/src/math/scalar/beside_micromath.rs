//! Errors of the functions of [`scalar`](super) beside those of `micromath` (docs/decisions/micromath.md).

use micromath::F32Ext;

use super::{asin, atan2, inverse_sqrt, sin_cos_small, sqrt};

/// Points at which each function is compared with double precision.
const STEPS: i32 = 200_000;

/// Largest distance from `exact` over `range`.
fn error(f: &dyn Fn(f32) -> f32, exact: &dyn Fn(f64) -> f64, [from, to]: [f32; 2]) -> f64 {
    let errors = (0..=STEPS).map(|step| {
        let x = from + (to - from) * step as f32 / STEPS as f32;
        (f64::from(f(x)) - exact(f64::from(x))).abs()
    });
    errors.fold(0.0, f64::max)
}

/// `cargo test -p robot-app --profile host --target host-tuple --lib micromath -- --nocapture` prints the table.
#[test]
fn every_function_is_a_thousand_times_closer_than_that_of_micromath() {
    type F<'a> = &'a dyn Fn(f32) -> f32;
    type Exact<'a> = &'a dyn Fn(f64) -> f64;
    // Between two powers of four the error of both roots repeats.
    let rows: [(&str, F, F, Exact, [f32; 2]); 6] = [
        ("sqrt", &sqrt, &F32Ext::sqrt, &f64::sqrt, [1.0, 4.0]),
        (
            "inverse_sqrt",
            &inverse_sqrt,
            &F32Ext::invsqrt,
            &|x| x.sqrt().recip(),
            [1.0, 4.0],
        ),
        ("asin", &asin, &F32Ext::asin, &f64::asin, [-1.0, 1.0]),
        (
            "atan2, right half",
            &|y| atan2(y, 1.0),
            &|y| F32Ext::atan2(y, 1.0),
            &|y| y.atan2(1.0),
            [-10.0, 10.0],
        ),
        (
            "sin, small angles",
            &|x| sin_cos_small(x).0,
            &F32Ext::sin,
            &f64::sin,
            [-0.5, 0.5],
        ),
        (
            "cos, small angles",
            &|x| sin_cos_small(x).1,
            &F32Ext::cos,
            &f64::cos,
            [-0.5, 0.5],
        ),
    ];
    println!("largest error        here     micromath");
    for (name, here, there, exact, range) in rows {
        let [here, there] = [here, there].map(|f| error(f, exact, range));
        println!("{name:<18} {here:>8.1e}  {there:>8.1e}");
        assert!(1_000.0 * here < there, "{name}: {here} and {there}");
    }
}
