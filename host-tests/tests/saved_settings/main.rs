//! Settings between the parameter task and the cells of the flash, through the public interface: what a boot makes of
//! what is there, and when and how changes get there.

mod boot;
mod dump;
mod robot;
mod saving;
mod tuned;
