//! Named values for reports and expectations.

use super::{WireEvent, World, advance::SHAFT_SIGN};
use crate::body::WHEEL_RADIUS_M;

/// Signals decoded from CAN come first, two a motor, so that wire events can point at them.
pub(super) fn motor_current_ma(wheel: usize) -> usize {
    2 * wheel
}

pub(super) fn motor_rpm(wheel: usize) -> usize {
    2 * wheel + 1
}

const FIXED: &[&str] = &[
    // As commanded on the wire; rotor speed as fed back, in the motor's own sense.
    "can.m3508.0.current_ma",
    "can.m3508.0.rpm",
    "can.m3508.1.current_ma",
    "can.m3508.1.rpm",
    // What the pilot does, −1 … 1 and switches as 0, 1, 2.
    "radio.vx",
    "radio.wz",
    "radio.enable",
    "radio.e_stop",
    "radio.mode",
    // ENU earth, m and rad (full turns add up); way and speed along the body's forward axis, m and m/s; rad/s.
    "truth.body.x",
    "truth.body.y",
    "truth.body.yaw",
    "truth.body.path_m",
    "truth.body.vx",
    "truth.body.wz",
    // Body → ENU, not a number in a gap of a recording's reference.
    "truth.attitude.w",
    "truth.attitude.x",
    "truth.attitude.y",
    "truth.attitude.z",
    // Forward positive; torque of the motor on the wheel, current in the coil.
    "truth.wheel.0.speed_mps",
    "truth.wheel.0.speed_rps",
    "truth.wheel.0.torque_nm",
    "truth.wheel.0.current_ma",
    "truth.wheel.1.speed_mps",
    "truth.wheel.1.speed_rps",
    "truth.wheel.1.torque_nm",
    "truth.wheel.1.current_ma",
    // What the IMU feels before its own errors, rad/s and m/s².
    "truth.imu.gx",
    "truth.imu.gy",
    "truth.imu.gz",
    "truth.imu.ax",
    "truth.imu.ay",
    "truth.imu.az",
    "truth.imu.temperature_c",
    // Register writes that came sooner after another than the BMI088 allows.
    "truth.imu.lost_writes",
    "truth.battery_v",
    "truth.led.r",
    "truth.led.g",
    "truth.led.b",
    "truth.buzzer.hz",
];

/// Only while a recording plays: seconds since its row 0, and 1 in its scored movement phase.
const RECORDING: &[&str] = &["truth.trial.t", "truth.trial.mov"];

pub(super) fn names(recording: bool) -> Vec<String> {
    let extra = if recording { RECORDING } else { &[] };
    FIXED
        .iter()
        .chain(extra)
        .map(|name| (*name).to_owned())
        .collect()
}

impl World {
    /// Names of every signal: `truth.*` from the plant, `can.*` as decoded from the wire, `radio.*`.
    pub fn signal_names(&self) -> &[String] {
        &self.signal_names
    }

    /// Present value of every signal, in the order of `signal_names`; replaces what `out` held.
    pub fn sample(&self, out: &mut Vec<f64>) {
        out.clear();
        for esc in &self.escs {
            out.extend([esc.commanded_ma(), esc.fed_back_rpm()]);
        }
        let pilot = self.radio.pilot();
        out.extend([
            pilot.vx,
            pilot.wz,
            f64::from(pilot.enable),
            f64::from(pilot.e_stop),
            f64::from(pilot.mode),
        ]);
        let pose = self.body.pose();
        out.extend([
            pose.x_m,
            pose.y_m,
            pose.yaw_rad,
            pose.path_m,
            pose.vx_mps,
            pose.wz_rps,
        ]);
        out.extend(self.true_attitude().unwrap_or([f64::NAN; 4]));
        self.sample_wheels(out);
        let motion = self.motion(self.now);
        out.extend(motion.gyro_rps);
        out.extend(motion.accel_mps2);
        out.extend([
            self.imu.temperature_c(),
            self.imu.lost_writes() as f64,
            self.battery.volts(),
        ]);
        let [blue, green, red] = self.indicators.leds_bgr;
        out.extend([red, green, blue, self.indicators.buzzer_hz]);
        if let Some(playback) = &self.playback {
            out.extend([
                playback.time_s(self.now),
                f64::from(playback.moving(self.now)),
            ]);
        }
    }

    fn sample_wheels(&self, out: &mut Vec<f64>) {
        for ((rps, esc), sign) in self.body.wheel_rps().iter().zip(&self.escs).zip(SHAFT_SIGN) {
            out.extend([
                rps * WHEEL_RADIUS_M,
                *rps,
                sign * esc.motor.torque_nm(),
                esc.motor.current_a() * 1_000.0,
            ]);
        }
    }

    /// Moves wire-level changes since the last call (every received actuator command is one) to the end of `out`.
    pub fn drain_wire_events(&mut self, out: &mut Vec<WireEvent>) {
        out.append(&mut self.wire_events);
    }
}
