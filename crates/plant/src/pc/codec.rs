//! The two frames of the serial link as the PC sees them (docs/pc-link.md), little endian.

use std::f64::consts::PI;

/// First byte of both frames.
pub(super) const HEADER: u8 = 0xFE;
/// Length of a frame to the PC.
pub const UP_LEN: usize = 94;
/// Length of a frame from the PC.
pub const DOWN_LEN: usize = 38;
/// First byte and length of a frame that takes the place of the sticks.
pub(super) const DRIVE_HEADER: u8 = 0xFC;
pub(super) const DRIVE_LEN: usize = 12;

const BATTERY_V: [f64; 2] = [20.0, 60.0];
const MOTOR_POS_RAD: [f64; 2] = [-PI, PI];
const MOTOR_VEL_RPS: [f64; 2] = [-33.0, 33.0];
const WHEEL_RPS: [f64; 2] = [-200.0, 200.0];
const JOINT_RAD: [f64; 2] = [-3.2, 3.2];
const GAIN: [f64; 2] = [0.0, 1_000.0];
const SHARE: [f64; 2] = [-1.0, 1.0];

/// Position and speed of one motor, in rad and rad/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct MotorState {
    pub pos_rad: f64,
    pub vel_rps: f64,
}

/// The state of the robot in a frame to the PC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Uplink {
    pub time_s: f64,
    pub battery_v: f64,
    pub mcu_c: f64,
    /// x, y, z.
    pub accel_mps2: [f64; 3],
    /// x, y, z.
    pub gyro_rps: [f64; 3],
    pub q_xyzw: [f64; 4],
    pub keys: [u8; 2],
    /// lx, rx, ly, L2, ry.
    pub sticks: [f64; 5],
    /// Wheels left and right, then the joints.
    pub motors: [MotorState; 6],
}

/// What the PC asks of one motor: speed of a wheel in rad/s or angle of a joint in rad, and the gains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct MotorCommand {
    pub target: f64,
    pub kp: f64,
    pub kd: f64,
}

/// The command in a frame from the PC: wheels left and right, then the joints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Downlink {
    pub motors: [MotorCommand; 6],
}

impl Uplink {
    /// Decodes a frame whose header and checksum are right.
    pub(super) fn decode(frame: &[u8; UP_LEN]) -> Self {
        let float = |at: usize| f64::from(f32::from_le_bytes([0, 1, 2, 3].map(|n| frame[at + n])));
        let motor = |n: usize| MotorState {
            pos_rad: value(word(frame, 69 + 4 * n), MOTOR_POS_RAD),
            vel_rps: value(word(frame, 71 + 4 * n), MOTOR_VEL_RPS),
        };
        let [low_v, high_v] = BATTERY_V;
        Self {
            time_s: float(1),
            battery_v: low_v + f64::from(frame[5]) / 255.0 * (high_v - low_v),
            mcu_c: f64::from(frame[6].cast_signed()),
            accel_mps2: [7, 11, 15].map(float),
            gyro_rps: [19, 23, 27].map(float),
            q_xyzw: [31, 35, 39, 43].map(float),
            keys: [frame[47], frame[48]],
            sticks: [49, 53, 57, 61, 65].map(float),
            motors: [0, 1, 2, 3, 4, 5].map(motor),
        }
    }
}

impl Downlink {
    pub(super) fn encode(&self) -> [u8; DOWN_LEN] {
        let codes = std::array::from_fn(|motor| {
            let MotorCommand { target, kp, kd } = self.motors[motor];
            [
                code(target, target_range(motor)),
                code(kp, GAIN),
                code(kd, GAIN),
            ]
        });
        down_frame(codes)
    }

    /// Decodes a frame whose header and checksum are right.
    pub(super) fn decode(frame: &[u8; DOWN_LEN]) -> Self {
        Self {
            motors: std::array::from_fn(|motor| MotorCommand {
                target: value(word(frame, 1 + 6 * motor), target_range(motor)),
                kp: value(word(frame, 3 + 6 * motor), GAIN),
                kd: value(word(frame, 5 + 6 * motor), GAIN),
            }),
        }
    }
}

/// The frame with these codes: target, Kp, Kd of each motor.
pub(super) fn down_frame(codes: [[u16; 3]; 6]) -> [u8; DOWN_LEN] {
    let mut frame = [0; DOWN_LEN];
    frame[0] = HEADER;
    for (bytes, code) in frame[1..37].chunks_exact_mut(2).zip(codes.as_flattened()) {
        bytes.copy_from_slice(&code.to_le_bytes());
    }
    frame[37] = crc8(&frame[..37]);
    frame
}

/// The frame that asks for these shares of the highest speed, turn, height and roll.
pub(super) fn drive_frame(shares: [f64; 4], jump: bool, count: u8) -> [u8; DRIVE_LEN] {
    let mut frame = [0; DRIVE_LEN];
    frame[0] = DRIVE_HEADER;
    for (bytes, share) in frame[1..9].chunks_exact_mut(2).zip(shares) {
        bytes.copy_from_slice(&code(share, SHARE).to_le_bytes());
    }
    frame[9] = u8::from(jump);
    frame[10] = count;
    frame[11] = crc8(&frame[..11]);
    frame
}

fn target_range(motor: usize) -> [f64; 2] {
    if motor < 2 { WHEEL_RPS } else { JOINT_RAD }
}

fn word(frame: &[u8], at: usize) -> u16 {
    u16::from_le_bytes([frame[at], frame[at + 1]])
}

fn value(code: u16, [least, most]: [f64; 2]) -> f64 {
    f64::from(code) / 65_535.0 * (most - least) + least
}

fn code(value: f64, [least, most]: [f64; 2]) -> u16 {
    ((value.clamp(least, most) - least) / (most - least) * 65_535.0).round() as u16
}

/// CRC-8/MAXIM-DOW.
pub(super) fn crc8(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |crc, byte| {
        (0..8).fold(crc ^ byte, |crc, _| {
            if crc & 1 == 1 {
                crc >> 1 ^ 0x8C
            } else {
                crc >> 1
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    // The check value of the catalogue of parametrised CRC algorithms.
    #[test]
    fn the_checksum_has_the_published_check_value() {
        assert_eq!(crc8(b"123456789"), 0xA1);
    }

    #[test]
    fn a_command_comes_back_within_half_a_step() {
        let sent = Downlink {
            motors: std::array::from_fn(|n| MotorCommand {
                target: -3.0 + n as f64,
                kp: 100.0 * n as f64,
                kd: 1.0,
            }),
        };
        let heard = Downlink::decode(&sent.encode());
        for (sent, heard) in sent.motors.iter().zip(&heard.motors) {
            assert!((sent.target - heard.target).abs() <= 200.0 / 65_535.0);
            assert!((sent.kp - heard.kp).abs() <= 500.0 / 65_535.0);
            assert!((sent.kd - heard.kd).abs() <= 500.0 / 65_535.0);
        }
    }

    // Ends of the ranges by the document's table 4.1 and formula 5.1; header, codes and checksum by hand.
    #[test]
    fn the_ends_of_the_ranges_have_the_codes_of_the_document() {
        let least = Downlink {
            motors: std::array::from_fn(|motor| MotorCommand {
                target: if motor < 2 { -250.0 } else { -3.2 },
                kp: -1.0,
                kd: 0.0,
            }),
        };
        let frame = least.encode();
        assert_eq!((frame[0], &frame[1..37]), (0xFE, &[0; 36][..]));
        let most = down_frame([[0xFFFF; 3]; 6]);
        let read = Downlink::decode(&most);
        assert_eq!(read.motors[1].target, 200.0);
        assert_eq!(read.motors[5].target, 3.2);
        assert_eq!((read.motors[0].kp, read.motors[5].kd), (1_000.0, 1_000.0));
    }

    // Places, ends and middle of the ranges by the page's table; the middle of 0 … 65,535 is rounded up.
    #[test]
    fn the_fields_of_a_drive_stand_where_the_page_says() {
        let frame = drive_frame([1.0, -1.0, 0.0, 2.0], true, 7);
        assert_eq!(frame[..3], [0xFC, 0xFF, 0xFF]);
        assert_eq!(frame[3..9], [0, 0, 0x00, 0x80, 0xFF, 0xFF]);
        assert_eq!((frame[9], frame[10]), (1, 7));
        assert_eq!(frame[11], crc8(&frame[..11]));
    }

    #[test]
    fn the_fields_of_an_uplink_stand_where_the_document_says() {
        let mut frame = [0; UP_LEN];
        frame[0] = HEADER;
        frame[1..5].copy_from_slice(&12.5_f32.to_le_bytes());
        frame[5] = 255;
        frame[6] = 0xF6;
        frame[15..19].copy_from_slice(&9.5_f32.to_le_bytes());
        frame[43..47].copy_from_slice(&1.0_f32.to_le_bytes());
        frame[47] = 0x20;
        frame[65..69].copy_from_slice(&0.5_f32.to_le_bytes());
        frame[69..71].copy_from_slice(&[0xFF, 0xFF]);
        frame[91..93].copy_from_slice(&[0xFF, 0xFF]);
        let read = Uplink::decode(&frame);
        assert_eq!(
            (read.time_s, read.battery_v, read.mcu_c),
            (12.5, 60.0, -10.0)
        );
        assert_eq!((read.accel_mps2[2], read.q_xyzw[3]), (9.5, 1.0));
        assert_eq!((read.keys, read.sticks[4]), ([0x20, 0], 0.5));
        assert_eq!((read.motors[0].pos_rad, read.motors[5].vel_rps), (PI, 33.0));
        assert_eq!(read.motors[0].vel_rps, -33.0);
    }
}
