//! The bus and the arm against emulated servos, in simulated time.

mod calibrating;
mod complaints;
mod controller;
mod firmware;
mod loops;
mod wire;
