//! Settings between the parameter task and the cells of the flash, through the public interface: how a boot
//! uses the contents, and when and how changes are written.

mod boot;
mod dump;
mod robot;
mod saving;
mod tuned;
