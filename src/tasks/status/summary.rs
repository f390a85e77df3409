//! The summary that is logged a few times a second.

use robot_app::diagnostics::DiagnosticsSnapshot;

/// Logs whole thousandths and degrees, because a fraction of a float would print nine digits.
pub fn log(d: &DiagnosticsSnapshot) {
    let [roll_rad, pitch_rad, yaw_rad] = d.estimate.rpy_rad;
    let [left, right] = &d.sensors.motor.wheels;
    let [left_command, right_command] = &d.command.wheels;
    let [vx_mps, ..] = d.estimate.vel_mps;
    defmt::info!(
        "{} | stick vx {=i32} wz {=i32} % | wheels {=i16} {=i16} rpm, {=i32} {=i32} mA | roll {=i32} pitch {=i32} yaw {=i32} deg | {=i32} mm/s | {=i32} mV",
        d.arming.state,
        (d.remote.vx * 100.0) as i32,
        (d.remote.wz * 100.0) as i32,
        left.rpm,
        right.rpm,
        left_command.current_ma as i32,
        right_command.current_ma as i32,
        roll_rad.to_degrees() as i32,
        pitch_rad.to_degrees() as i32,
        yaw_rad.to_degrees() as i32,
        (vx_mps * 1_000.0) as i32,
        (d.battery_v * 1_000.0) as i32,
    );
}
