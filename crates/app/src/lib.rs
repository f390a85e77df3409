//! The pure logic of the robot: everything between bytes received and bytes to send.
//!
//! No clock, no register, no static: time is an argument (`now_us`, microseconds since boot) and every stage is a
//! struct with one `step`, `feed` or `decode` method. Folders follow the data:
//!
//! | folder | in → out |
//! |---|---|
//! | `math` | vectors, quaternions and what `core` lacks of `f32` |
//! | [`domain`] | the types all stages share, plain `repr(C)` data in SI units unless the name says otherwise |
//! | [`input`] | radio bytes → `RemoteUpdate` (stick and switch state, operator state, link diagnostics) |
//! | [`sensing`] | sensor register bytes → calibrated `ImuState`, `MagState`, the heater's duty; the bring-up sequences as data |
//! | [`kinematics`] | joint angles and speeds → where axles and shanks are and how they move |
//! | [`estimation`] | IMU, magnetometer, wheels → `StateEstimate` |
//! | [`logic`] | remote → `LogicBus` (high-level command, or the choice of the PC) |
//! | [`control`] | `LogicBus`, or a PC's command, and estimate → `ChassisCommand`; `control/user_controller.rs` is where a user writes theirs |
//! | [`safety`] | health → flags and verdict; arming; the permit without which no current leaves the board |
//! | [`motor`] | CAN frames ↔ motors; which motor sits where; the frames that stop them all |
//! | [`bring_up`] | radio or tuning request → the command that tries out new hardware |
//! | [`diagnostics`] | one `DiagnosticsSnapshot` of all of the above; a small `Telemetry` of every second tick |
//! | [`black_box`] | diagnostics → the last seconds around each stop that nobody asked for, in RAM that survives a reset |
//! | [`tuning`] | requests over CAN or the PC link → changed `RobotConfig`, replies |
//! | [`params`] | `RobotConfig` ↔ flash; which sector, when, and what to do when it fails |
//! | [`link`] | serial bytes ↔ commands of the PC, the robot's state, tunnelled CAN frames |
//! | [`indication`] | state → what LED and buzzer tell people |
//! | [`tick`] | the 1 kHz tick: all stages from CAN frames in to CAN frames out |
//!
//! A folder uses only folders above it in this table. The test `host-tests/tests/folder_order` reads the table and checks
//! that; inside a folder it allows no circle of modules.
//!
//! # How the firmware uses it
//! - The sbus task calls `input::RemoteReceiver::feed(bytes, ts_us, |update| publish)`, or `reject` if the UART flagged
//!   one of the bytes.
//! - The sensor tasks walk through `sensing::bmi088::INIT` and `sensing::ist8310::INIT`. Every 5 ms they transfer
//!   `bmi088::GYRO_READ`, what `bmi088::gyro_buffer` asks for and `bmi088::ACCEL_READ`, and pass the answers to
//!   `sensing::ImuPipeline::process`, or call `process_silence`. They set the heater to `heater_duty` and send
//!   `bmi088::BUFFER_RESET` if `take_buffer_reset` says so. Every 20 ms they write `ist8310::START_SINGLE_SHOT`, wait
//!   `ist8310::MEASUREMENT_US`, read `ist8310::READ_LEN` bytes from `ist8310::READ_FROM` and pass them to
//!   `sensing::MagPipeline::process`.
//! - The status task calls `sensing::BatteryMonitor::feed` at 200 Hz, and every other time
//!   `sensing::McuThermometer::feed`. At 100 Hz it selects an `indication::Indication` by the diagnostics and plays it
//!   with `indication::IndicationPlayer::step`.
//! - The logic task calls `logic::LogicStage::step` at 100 Hz.
//! - At boot `params::ParamService::boot` returns the settings. The params task calls `ParamService::step` every
//!   millisecond with what the tick grants, and gets the next request.
//! - The control task runs at 1 kHz. It calls `tick::RobotLoop::on_can_frame` for each received frame and then
//!   `tick::RobotLoop::tick`. It sends `outputs.frames` and publishes the rest. A frame that came through the tunnel of
//!   the PC link goes to `on_link_frame`, and `outputs.link_frames` go back there.
//! - The link tasks call `link::RobotReceiver::feed(bytes, ts_us, |received| …)`, publish the commands for
//!   `ControlInputs::pc`, and send a `link::Uplink` made from the telemetry.
//! - The black box task calls `black_box::BlackBox::boot` once and `BlackBox::step` every 10 ms with the diagnostics.
//! - Boot, panic and fault handlers send the layout's `safe_frames`.

#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]
#![deny(missing_docs)]
#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::arithmetic_side_effects
    )
)]

pub mod black_box;
pub mod bring_up;
pub mod control;
pub mod diagnostics;
pub mod domain;
pub mod estimation;
pub mod indication;
pub mod input;
pub mod kinematics;
pub mod link;
pub mod logic;
mod math;
pub mod motor;
pub mod params;
pub mod safety;
pub mod sensing;
pub mod tick;
pub mod tuning;
