//! The tables `[[expect]]`, which say what must hold.

use serde::Deserialize;

use super::{Problem, instant};
use crate::expectation::{Bound, Expectation, NamedFlag, Window};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Expect {
    signal: String,
    from: Option<f64>,
    to: Option<f64>,
    at: Option<f64>,
    max_abs: Option<f64>,
    min: Option<f64>,
    max: Option<f64>,
    equals: Option<f64>,
    within: Option<[f64; 2]>,
    has_bit: Option<u8>,
    lacks_bit: Option<u8>,
    has_flag: Option<String>,
    lacks_flag: Option<String>,
    rises_above: Option<f64>,
    falls_below: Option<f64>,
    because: Option<String>,
}

pub(super) fn read_expect(raw: Expect, seconds: f64) -> Result<Expectation, Problem> {
    let window = match (raw.from, raw.to, raw.at) {
        (Some(from), Some(to), None) => {
            let (start, end) = (instant("from", from, seconds)?, instant("to", to, seconds)?);
            if end < start {
                return Err(Problem::Swapped { from, to });
            }
            Window { start, end }
        }
        (None, None, Some(at)) => Window::instant(instant("at", at, seconds)?),
        _ => return Err(Problem::NoWindow),
    };
    let bounds: Vec<Bound> = [
        raw.max_abs.map(Bound::MaxAbs),
        raw.min.map(Bound::Min),
        raw.max.map(Bound::Max),
        raw.equals.map(Bound::Equals),
        raw.within
            .map(|[value, tolerance]| Bound::Within { value, tolerance }),
        raw.has_bit.map(Bound::HasBit),
        raw.lacks_bit.map(Bound::LacksBit),
        raw.rises_above.map(Bound::RisesAbove),
        raw.falls_below.map(Bound::FallsBelow),
    ]
    .into_iter()
    .flatten()
    .collect();
    let named = |name: Option<String>, set| name.map(|name| NamedFlag { name, set });
    let flags: Vec<NamedFlag> = [named(raw.has_flag, true), named(raw.lacks_flag, false)]
        .into_iter()
        .flatten()
        .collect();
    if bounds.is_empty() && flags.is_empty() {
        return Err(Problem::NoBound);
    }
    if bounds.iter().any(|b| !b.is_usable()) {
        return Err(Problem::BadBound);
    }
    Ok(Expectation {
        signal: raw.signal,
        window,
        bounds,
        flags,
        because: raw.because,
    })
}
