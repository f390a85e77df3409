//! Rotations of every kind with perfect sensors. Any error here is one of the filter's arithmetic.

mod coning;
mod poses;
mod spinning;
