//! The line that is logged a few times a second.

use robot_app::diagnostics::DiagnosticsSnapshot;

pub fn log(d: &DiagnosticsSnapshot) {
    let [roll_rad, pitch_rad, yaw_rad] = d.estimate.rpy_rad;
    let [left, right] = &d.motor.wheels;
    let [left_command, right_command] = &d.command.wheels;
    defmt::info!(
        "{} | stick vx {=f32} wz {=f32} | rpm {=i16} {=i16} | mA {=f32} {=f32} | rpy {=f32} {=f32} {=f32} rad | vx {=f32} m/s | {=f32} V | tick {=u32}, jitter {=u32} us",
        d.arming.state,
        d.remote.vx,
        d.remote.wz,
        left.rpm,
        right.rpm,
        left_command.current_ma,
        right_command.current_ma,
        roll_rad,
        pitch_rad,
        yaw_rad,
        d.estimate.vel_mps[0],
        d.battery_v,
        d.tick.count,
        d.tick.max_jitter_us,
    );
}
