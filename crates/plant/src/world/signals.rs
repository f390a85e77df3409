//! Named values for reports and expectations.

mod link;

use super::{WireEvent, World};
use crate::{attitude::roll_pitch_yaw_rad, free::FreeBody, recording::Playback};

type Signal = (&'static str, fn(&World) -> f64);

/// A signal whose name need not be looked for again. See [`World::probe`].
#[derive(Clone, Copy, Debug)]
pub struct Probe(fn(&World) -> f64);

impl Probe {
    /// Present value of the signal.
    pub fn read(self, world: &World) -> f64 {
        (self.0)(world)
    }
}

/// Index of the current that the wheel was commanded. Signals decoded from CAN come first, two per wheel, so that wire
/// events can point at them.
pub(super) fn motor_current_ma(wheel: usize) -> usize {
    2 * wheel
}

/// Index of the speed that the wheel's motor fed back.
pub(super) fn motor_rpm(wheel: usize) -> usize {
    2 * wheel + 1
}

/// Indices of the five CAN signals of a joint, in the order of their names.
pub(super) fn joint(joint: usize) -> [usize; 5] {
    std::array::from_fn(|part| 4 + 5 * joint + part)
}

/// Index of the count of tuning replies.
pub(super) const TUNING_REPLIES: usize = 24;

/// Index of one byte of the last tuning reply.
pub(super) fn tuning_reply(byte: usize) -> usize {
    TUNING_REPLIES + 1 + byte
}

/// Index of the count of frames of the serial link that the PC received.
pub(super) const LINK_UP_FRAMES: usize = TUNING_REPLIES + 9;

/// Index of the count of frames of the serial link that reached the board.
pub(super) const LINK_DOWN_FRAMES: usize = LINK_UP_FRAMES + 1;

/// Commanded current and fed-back rotor speed of the wheels, both in the motor's own sense of rotation.
const CAN: &[Signal] = &[
    ("can.m3508.0.current_ma", |w| w.escs[0].commanded_ma()),
    ("can.m3508.0.rpm", |w| w.escs[0].fed_back_rpm()),
    ("can.m3508.1.current_ma", |w| w.escs[1].commanded_ma()),
    ("can.m3508.1.rpm", |w| w.escs[1].fed_back_rpm()),
];

/// Number of tuning replies that a PC's adapter received on either bus, and the bytes of the last one.
const TUNING: &[Signal] = &[
    ("can.tuning.replies", |w| w.tuning_replies.count as f64),
    ("can.tuning.reply.0", |w| w.tuning_replies.last[0]),
    ("can.tuning.reply.1", |w| w.tuning_replies.last[1]),
    ("can.tuning.reply.2", |w| w.tuning_replies.last[2]),
    ("can.tuning.reply.3", |w| w.tuning_replies.last[3]),
    ("can.tuning.reply.4", |w| w.tuning_replies.last[4]),
    ("can.tuning.reply.5", |w| w.tuning_replies.last[5]),
    ("can.tuning.reply.6", |w| w.tuning_replies.last[6]),
    ("can.tuning.reply.7", |w| w.tuning_replies.last[7]),
];

/// One joint's motor, in its own sense of rotation: 1 while it is enabled; the torque that its present command asks for; the
/// last feedback on the wire; the number of disable frames received.
macro_rules! joint_on_the_wire {
    ($name:literal, $joint:literal) => {
        [
            (concat!($name, ".enabled"), |w| {
                f64::from(w.joints[$joint].enabled())
            }),
            (concat!($name, ".torque_nm"), |w| {
                w.joints[$joint]
                    .wire_state(w.joint_shaft($joint))
                    .commanded_nm
            }),
            (concat!($name, ".pos_rad"), |w| {
                w.joints[$joint].fed_back().pos_rad
            }),
            (concat!($name, ".vel_rps"), |w| {
                w.joints[$joint].fed_back().vel_rps
            }),
            (concat!($name, ".stop_frames"), |w| {
                w.joints[$joint]
                    .wire_state(w.joint_shaft($joint))
                    .stop_frames as f64
            }),
        ]
    };
}

const JOINT_WIRES: [[Signal; 5]; 4] = [
    joint_on_the_wire!("can.joint.0", 0),
    joint_on_the_wire!("can.joint.1", 1),
    joint_on_the_wire!("can.joint.2", 2),
    joint_on_the_wire!("can.joint.3", 3),
];

/// Angle from hanging down, speed and motor torque in joint coordinates; winding temperature.
macro_rules! joint_truth {
    ($name:literal, $joint:literal) => {
        [
            (concat!($name, ".pos_rad"), |w| {
                w.body.joint_pos_rad()[$joint]
            }),
            (concat!($name, ".vel_rps"), |w| {
                w.body.joint_vel_rps()[$joint]
            }),
            (concat!($name, ".torque_nm"), |w| {
                w.joints[$joint].torque_nm()
            }),
            (concat!($name, ".temperature_c"), |w| {
                w.joints[$joint].temperature_c()
            }),
        ]
    };
}

const JOINTS: [[Signal; 4]; 4] = [
    joint_truth!("truth.joint.0", 0),
    joint_truth!("truth.joint.1", 1),
    joint_truth!("truth.joint.2", 2),
    joint_truth!("truth.joint.3", 3),
];

/// Sticks −1 … 1 and switches 0, 1, 2, as the pilot holds them.
const RADIO: &[Signal] = &[
    ("radio.vx", |w| w.radio.pilot().vx),
    ("radio.wz", |w| w.radio.pilot().wz),
    ("radio.enable", |w| f64::from(w.radio.pilot().enable)),
    ("radio.e_stop", |w| f64::from(w.radio.pilot().e_stop)),
    ("radio.mode", |w| f64::from(w.radio.pilot().mode)),
];

/// x, y, z and yaw in the ENU earth frame, m and rad (full turns add up); roll right side down and pitch nose down, rad; path
/// along the heading, m; speed along the heading, to its left and up, m/s; yaw rate, rad/s; attitude body → ENU, NaN in a gap of a recording's reference.
const BODY: &[Signal] = &[
    ("truth.body.x", |w| w.body.pose().x_m),
    ("truth.body.y", |w| w.body.pose().y_m),
    ("truth.body.z", |w| w.body.pose().z_m),
    ("truth.body.roll", |w| angle_rad(w, 0)),
    ("truth.body.pitch", |w| angle_rad(w, 1)),
    ("truth.body.yaw", |w| w.body.pose().yaw_rad),
    ("truth.body.path_m", |w| w.body.pose().path_m),
    ("truth.body.vx", |w| w.body.pose().vx_mps),
    ("truth.body.vy", |w| w.body.pose().vy_mps),
    ("truth.body.vz", |w| w.body.pose().vz_mps),
    ("truth.body.wz", |w| w.body.pose().wz_rps),
    ("truth.attitude.w", |w| attitude(w, 0)),
    ("truth.attitude.x", |w| attitude(w, 1)),
    ("truth.attitude.y", |w| attitude(w, 2)),
    ("truth.attitude.z", |w| attitude(w, 3)),
];

/// Speed of the wheel and torque of its motor, forward positive; current in the coil, in the motor's own sense.
const WHEELS: &[Signal] = &[
    ("truth.wheel.0.speed_mps", |w| rim_mps(w, 0)),
    ("truth.wheel.0.speed_rps", |w| w.body.wheel_rps()[0]),
    ("truth.wheel.0.torque_nm", |w| torque_nm(w, 0)),
    ("truth.wheel.0.current_ma", |w| coil_ma(w, 0)),
    ("truth.wheel.1.speed_mps", |w| rim_mps(w, 1)),
    ("truth.wheel.1.speed_rps", |w| w.body.wheel_rps()[1]),
    ("truth.wheel.1.torque_nm", |w| torque_nm(w, 1)),
    ("truth.wheel.1.current_ma", |w| coil_ma(w, 1)),
];

/// Angular rate and specific force at the IMU without its errors, in the body's axes, rad/s and m/s²; temperature and duty
/// cycle of its heater.
const IMU: &[Signal] = &[
    ("truth.imu.gx", |w| w.motion(w.now).gyro_rps[0]),
    ("truth.imu.gy", |w| w.motion(w.now).gyro_rps[1]),
    ("truth.imu.gz", |w| w.motion(w.now).gyro_rps[2]),
    ("truth.imu.ax", |w| w.motion(w.now).accel_mps2[0]),
    ("truth.imu.ay", |w| w.motion(w.now).accel_mps2[1]),
    ("truth.imu.az", |w| w.motion(w.now).accel_mps2[2]),
    ("truth.imu.temperature_c", |w| w.imu.temperature_c()),
    ("truth.imu.heater_duty", |w| w.imu.heater_duty()),
];

/// Battery voltage at the terminals, temperature of the chip, brightness of the LED 0 … 1, frequency of the buzzer, 0 while
/// silent.
const BOARD: &[Signal] = &[
    ("truth.battery_v", |w| w.battery.volts()),
    ("truth.chip.temperature_c", World::chip_temperature_c),
    ("truth.led.r", |w| w.indicators.leds_bgr[2]),
    ("truth.led.g", |w| w.indicators.leds_bgr[1]),
    ("truth.led.b", |w| w.indicators.leds_bgr[0]),
    ("truth.buzzer.hz", |w| w.indicators.buzzer_hz),
];

/// Only while a recording plays: the time in it, s, negative in the lead-in; 1 in its movement phase, which is scored.
const RECORDING: &[Signal] = &[
    ("truth.trial.t", |w| {
        played(w, |playback| playback.time_s(w.now))
    }),
    ("truth.trial.mov", |w| {
        played(w, |playback| f64::from(playback.moving(w.now)))
    }),
];

/// Only of the free robot, left, then right. Leg: distance from the hip centre to the axle, m; its angle in body axes, forward
/// positive, rad; force of the hip motors along it, pushing the ground positive, N. Wheel: angle against its motor, rad; force
/// of the ground, N. Body and links: force of the ground, N.
const FREE: &[Signal] = &[
    ("truth.leg.0.length_m", |w| free(w, |f| f.leg_length_m()[0])),
    ("truth.leg.0.angle_rad", |w| {
        free(w, |f| f.leg_angle_rad()[0])
    }),
    ("truth.leg.0.force_n", |w| free(w, |f| f.leg_force_n()[0])),
    ("truth.leg.1.length_m", |w| free(w, |f| f.leg_length_m()[1])),
    ("truth.leg.1.angle_rad", |w| {
        free(w, |f| f.leg_angle_rad()[1])
    }),
    ("truth.leg.1.force_n", |w| free(w, |f| f.leg_force_n()[1])),
    ("truth.wheel.0.turned_rad", |w| {
        free(w, |f| f.state().wheel_rad[0])
    }),
    ("truth.wheel.0.contact_n", |w| {
        free(w, |f| f.wheel_contact_n()[0])
    }),
    ("truth.wheel.1.turned_rad", |w| {
        free(w, |f| f.state().wheel_rad[1])
    }),
    ("truth.wheel.1.contact_n", |w| {
        free(w, |f| f.wheel_contact_n()[1])
    }),
    ("truth.body.contact_n", |w| {
        free(w, FreeBody::body_contact_n)
    }),
];

/// Which signals there are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extra {
    /// A recording plays.
    pub recording: bool,
    /// The robot is free.
    pub free: bool,
}

fn signals(there: Extra) -> impl Iterator<Item = &'static Signal> {
    let only = |there: bool, signals: &'static [Signal]| if there { signals } else { &[] };
    let recording = only(there.recording, RECORDING);
    let free = only(there.free, FREE);
    [
        CAN,
        JOINT_WIRES.as_flattened(),
        TUNING,
        link::COUNTS,
        link::UP,
        link::UP_MOTORS.as_flattened(),
        link::DOWN,
        link::DOWN_MOTORS.as_flattened(),
        RADIO,
        BODY,
        WHEELS,
        JOINTS.as_flattened(),
        IMU,
        BOARD,
        free,
        recording,
    ]
    .into_iter()
    .flatten()
}

pub(super) fn names(there: Extra) -> Vec<String> {
    signals(there).map(|(name, _)| (*name).to_owned()).collect()
}

impl World {
    fn extra(&self) -> Extra {
        Extra {
            recording: self.playback.is_some(),
            free: self.body.free().is_some(),
        }
    }

    /// Names of every signal: `truth.*` from the plant, `can.*` and `link.*` as decoded from the
    /// wire, `radio.*`.
    pub fn signal_names(&self) -> &[String] {
        &self.signal_names
    }

    /// Present value of one signal, or `None` if there is none of that name.
    pub fn signal(&self, name: &str) -> Option<f64> {
        signals(self.extra())
            .find(|(known, _)| *known == name)
            .map(|(_, read)| read(self))
    }

    /// One signal, to be read often; `None` if there is none of that name.
    pub fn probe(&self, name: &str) -> Option<Probe> {
        signals(self.extra())
            .find(|(known, _)| *known == name)
            .map(|(_, read)| Probe(*read))
    }

    /// Replaces the contents of `out` by the present value of every signal, in the order of [`World::signal_names`].
    pub fn sample(&self, out: &mut Vec<f64>) {
        out.clear();
        out.extend(signals(self.extra()).map(|(_, read)| read(self)));
    }

    /// Appends the wire events since the last call to `out`. Every command that a motor receives is one.
    pub fn drain_wire_events(&mut self, out: &mut Vec<WireEvent>) {
        out.append(&mut self.wire_events);
    }
}

fn attitude(world: &World, part: usize) -> f64 {
    world.true_attitude().map_or(f64::NAN, |q| q[part])
}

fn angle_rad(world: &World, part: usize) -> f64 {
    world
        .true_attitude()
        .map_or(f64::NAN, |q| roll_pitch_yaw_rad(q)[part])
}

fn free(world: &World, read: impl Fn(&FreeBody) -> f64) -> f64 {
    world.body.free().map_or(f64::NAN, read)
}

fn rim_mps(world: &World, wheel: usize) -> f64 {
    world.body.wheel_rps()[wheel] * world.robot.wheels.radius_m
}

fn torque_nm(world: &World, wheel: usize) -> f64 {
    world.shaft_signs()[wheel] * world.escs[wheel].motor.torque_nm()
}

fn coil_ma(world: &World, wheel: usize) -> f64 {
    world.escs[wheel].motor.current_a() * 1_000.0
}

fn played(world: &World, read: impl Fn(&Playback) -> f64) -> f64 {
    world.playback.as_ref().map_or(f64::NAN, read)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wire_events_point_at_their_signals() {
        let names = names(Extra {
            recording: false,
            free: true,
        });
        assert_eq!(names[TUNING_REPLIES], "can.tuning.replies");
        for byte in 0..8 {
            assert_eq!(
                names[tuning_reply(byte)],
                format!("can.tuning.reply.{byte}")
            );
        }
        assert_eq!(names[LINK_UP_FRAMES], "link.up.frames");
        assert_eq!(names[LINK_DOWN_FRAMES], "link.down.frames");
        for index in 0..4 {
            let parts = ["enabled", "torque_nm", "pos_rad", "vel_rps", "stop_frames"];
            for (signal, part) in joint(index).into_iter().zip(parts) {
                assert_eq!(names[signal], format!("can.joint.{index}.{part}"));
            }
        }
        for wheel in 0..2 {
            assert_eq!(
                names[motor_current_ma(wheel)],
                format!("can.m3508.{wheel}.current_ma")
            );
            assert_eq!(names[motor_rpm(wheel)], format!("can.m3508.{wheel}.rpm"));
        }
    }
}
