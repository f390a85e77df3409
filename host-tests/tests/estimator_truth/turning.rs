//! Rotations of every kind, with perfect sensors: what is wrong here is the filter's arithmetic.

mod coning;
mod poses;
mod spinning;
