//! What the computer on the PC link sends, and the state of that link.

use super::age_us;
use crate::math::scalar;

/// A PC that was silent for longer than this has left, and its next command begins new statistics.
const GONE_US: u32 = 1_000_000;

/// Target of one wheel. The wheel gets the torque kd · (`speed_rps` − speed), at the wheel and not at the rotor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct WheelTarget {
    /// Speed of the wheel in rad/s, ±200, positive rolls the robot forward.
    pub speed_rps: f32,
    /// 0…1000. It has no effect, as there is no target angle.
    pub kp: f32,
    /// Damping in N·m·s/rad, 0…1000.
    pub kd: f32,
}

/// Target of one joint motor: MIT law with target speed and feed-forward zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct JointTarget {
    /// Joint angle in rad, ±3.2.
    pub pos_rad: f32,
    /// Stiffness in N·m/rad, 0…1000.
    pub kp: f32,
    /// Damping in N·m·s/rad, 0…1000.
    pub kd: f32,
}

/// What a PC's command is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum PcKind {
    /// Every motor, bypassing the controller.
    #[default]
    Motors = 0,
    /// The controller, in place of the sticks.
    Drive = 1,
}

/// A PC in place of the sticks. Standing up is not among its commands, as only the pilot asks for that.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct PcDrive {
    /// Forward, −1…1.
    pub vx: f32,
    /// Turn, −1…1, counter-clockwise from above positive.
    pub wz: f32,
    /// Leg length while standing, −1…1, long positive.
    pub height: f32,
    /// Roll while standing, −1…1, right side down positive.
    pub roll: f32,
    /// Jump; it counts when it is set after it was not.
    pub jump: bool,
    /// Changes from frame to frame, to show that the program is alive.
    pub count: u8,
}

/// A command of the PC. A PC steers and never arms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct PcCommand {
    /// Which of the targets count.
    pub kind: PcKind,
    /// Target of the controller.
    pub drive: PcDrive,
    /// Left, right.
    pub wheels: [WheelTarget; 2],
    /// Left front, left rear, right front, right rear, as in `ChassisCommand`.
    pub joints: [JointTarget; 4],
    /// Arrival of the frame's last byte in µs since boot, 0 = never.
    pub ts_us: u64,
    /// Arrival of the first of the equal frames up to this one, in µs since boot, 0 = never.
    pub changed_us: u64,
}

/// State of the PC link. Counters run since boot and wrap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct LinkHealth {
    /// Frames with a correct CRC, of both kinds.
    pub good: u32,
    /// Frames that began where one was due, but had a wrong CRC.
    pub crc_errors: u32,
    /// Times that bytes were discarded to find the next frame.
    pub resyncs: u32,
    /// Bytes that belonged to no frame.
    pub discarded_bytes: u32,
    /// Commands not used because damaged bytes preceded them.
    pub unconfirmed: u32,
    /// Frames received for the tuning channel.
    pub tunnelled: u32,
    /// Frames of the tuning channel lost in either direction because a queue was full.
    pub tunnel_dropped: u32,
    /// Framing, noise and overrun errors of the UART.
    pub line_errors: u32,
    /// State frames sent.
    pub sent: u32,
    /// Smoothed number of commands per second, 0 when silent.
    pub rate_hz: f32,
    /// Longest time between two commands since the link came up. A silence of more than a second starts it anew.
    pub longest_gap_us: u32,
    /// Arrival of the last command, 0 = never.
    pub last_us: u64,
}

impl LinkHealth {
    /// Weight of the newest interval in the smoothed rate.
    const RATE_GAIN: f32 = 0.1;

    /// Counts a command that arrived at `ts_us`.
    pub fn count_command(&mut self, ts_us: u64) {
        let gap_us = age_us(self.last_us, ts_us).max(1);
        self.last_us = ts_us;
        if gap_us > GONE_US {
            self.rate_hz = 0.0;
            self.longest_gap_us = 0;
            return;
        }
        self.longest_gap_us = self.longest_gap_us.max(gap_us);
        let rate_hz = 1_000_000.0 / gap_us as f32;
        if self.rate_hz == 0.0 {
            self.rate_hz = rate_hz;
        } else {
            self.rate_hz += Self::RATE_GAIN * (rate_hz - self.rate_hz);
        }
    }

    /// The link's state at `now_us`: without commands the rate falls, and after a second it is 0.
    #[must_use]
    pub fn at(mut self, now_us: u64) -> Self {
        let silence_us = age_us(self.last_us, now_us);
        if silence_us > GONE_US {
            self.rate_hz = 0.0;
        } else if silence_us > 0 {
            self.rate_hz = scalar::min(self.rate_hz, 2_000_000.0 / silence_us as f32);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(commands_us: impl IntoIterator<Item = u64>) -> LinkHealth {
        let mut health = LinkHealth::default();
        for ts_us in commands_us {
            health.count_command(ts_us);
        }
        health
    }

    #[test]
    fn rate_and_gap_follow_the_commands() {
        let health = after((1..=50).map(|n| n * 10_000).chain([530_000]));
        assert_eq!(health.longest_gap_us, 30_000);
        assert_eq!(health.last_us, 530_000);
        assert!((90.0..100.0).contains(&health.rate_hz), "{health:?}");
    }

    #[test]
    fn the_rate_falls_in_silence() {
        let health = after((1..=50).map(|n| n * 10_000));
        for (now_us, most_hz) in [(500_000, 101.0), (600_000, 20.0), (1_500_001, 0.0)] {
            assert!(health.at(now_us).rate_hz <= most_hz, "{now_us}");
        }
    }

    #[test]
    fn a_second_of_silence_starts_the_gap_anew() {
        let health = after([1_000, 900_000, 2_000_000, 2_010_000]);
        assert_eq!(health.longest_gap_us, 10_000);
        assert!((health.rate_hz - 100.0).abs() < 0.01, "{health:?}");
    }
}
