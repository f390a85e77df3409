//! The whole app and the simulated world without a chip: every wire of the world leads to the app's own decoders.
//!
//! It runs what the image runs, with the timing of the image where that matters to a control loop:
//!
//! | what | here | in the image |
//! |---|---|---|
//! | control tick | at each whole millisecond | the same, 2 µs of jitter |
//! | its frames | reach the bus 50 µs after the tick began, and each takes its time there; the lowest identifier goes first | the same |
//! | frames of motors | contend for the same bus, and are decoded by the next tick | the same, through interrupts and a queue |
//! | frames that still wait at the next tick | are dropped | the same |
//! | IMU | read every 5 ms, 200 µs before a tick, in no time | the phase is that at which bring-up ended; reading takes 0.1 ms |
//! | magnetometer | every 20 ms, its result as soon as it is complete | the same |
//! | radio | bytes up to the tick | in pieces, at pauses of the line |
//! | logic stage | every 10 ms, before the tick | between two ticks |
//! | battery | every 240 ms | the median of 100 ms |
//!
//! The periods are written down once more, in `robot.rs`: those of the image stand in `src/tasks`, which compiles for the
//! chip only. The image's own are measured by `scenarios/rates.toml`. `crates/sim/tests/host_loop` compares whole runs.
//!
//! Memory for parameters, link, indication and the recorder of the last seconds are not here. The same calls with the
//! same seed give the same run, bit for bit.

#![deny(missing_docs)]

mod buses;
mod layout;
mod robot;
mod robots;
mod sensors;

pub use layout::layout_of;
pub use robot::Robot;
pub use robots::Robots;
pub use sensors::Sensors;
