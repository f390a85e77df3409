//! Compares the codec of the PC link with `vectors/link_*.csv`, which a script computed from the tables of the link's
//! document (see `vectors/README.md`).

use std::str::FromStr;

use robot_app::{
    domain::{CanFrame, JointTarget, PcDrive, StandardId, WheelTarget},
    link::{Downlink, DriveFrame, Keys, MotorState, Sticks, Tunnelled, Uplink},
};

/// The columns of a line, from the left.
struct Columns(std::str::Split<'static, char>);

impl Columns {
    fn of(csv: &'static str) -> impl Iterator<Item = Self> {
        csv.lines().map(|line| Self(line.split(',')))
    }

    fn text(&mut self) -> &'static str {
        self.0.next().expect("another column")
    }

    fn float(&mut self) -> f32 {
        f32::from_bits(u32::from_str_radix(self.text(), 16).unwrap())
    }

    fn floats<const N: usize>(&mut self) -> [f32; N] {
        std::array::from_fn(|_| self.float())
    }

    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        unhex(self.text()).try_into().expect("so many bytes")
    }

    fn number<T: FromStr>(&mut self) -> T {
        self.text().parse().ok().expect("a number")
    }

    /// All that is left: decoded values in decimal.
    fn rest(self) -> Vec<f64> {
        self.0.map(|text| text.parse().unwrap()).collect()
    }
}

fn unhex(text: &str) -> Vec<u8> {
    let digits: Vec<u32> = text.chars().map(|c| c.to_digit(16).unwrap()).collect();
    let pairs = digits.chunks(2);
    pairs.map(|pair| (pair[0] << 4 | pair[1]) as u8).collect()
}

/// Single precision may differ by a third of the smallest step.
fn assert_close(found: &[f32], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let error = (f64::from(*found) - expected).abs();
        let allowed = 3e-5 + expected.abs() * 1e-7;
        assert!(error <= allowed, "{found} {expected}");
    }
}

/// What a field without code brings of the float sent.
fn as_sent(value: f32) -> f32 {
    let number = if value.is_nan() { 0.0 } else { value };
    number.clamp(f32::MIN, f32::MAX)
}

#[test]
fn state_frames_equal_those_of_the_documents_tables() {
    let mut checked = 0;
    for mut columns in Columns::of(include_str!("vectors/link_up.csv")) {
        let state = Uplink {
            time_s: columns.float(),
            battery_v: columns.float(),
            mcu_c: columns.number(),
            accel_mps2: columns.floats(),
            gyro_rps: columns.floats(),
            q_xyzw: columns.floats(),
            keys: Keys::from_bits_retain(u16::from_le_bytes(columns.bytes())),
            sticks: {
                let [lx, rx, ly, l2, ry] = columns.floats();
                Sticks { lx, rx, ly, l2, ry }
            },
            motors: std::array::from_fn(|_| MotorState {
                pos_rad: columns.float(),
                vel_rps: columns.float(),
            }),
        };
        let frame = columns.bytes();
        assert_eq!(state.encode(), frame, "{state:?}");

        let decoded = Uplink::decode(&frame).expect("header and CRC are correct");
        let motors = decoded.motors.iter();
        let motors = motors.flat_map(|motor| [motor.pos_rad, motor.vel_rps]);
        let coded: Vec<f32> = [decoded.battery_v].into_iter().chain(motors).collect();
        assert_close(&coded, &columns.rest());
        let expected = Uplink {
            time_s: as_sent(state.time_s),
            battery_v: decoded.battery_v,
            accel_mps2: state.accel_mps2.map(as_sent),
            gyro_rps: state.gyro_rps.map(as_sent),
            q_xyzw: state.q_xyzw.map(as_sent),
            sticks: Sticks {
                lx: as_sent(state.sticks.lx),
                rx: as_sent(state.sticks.rx),
                ly: as_sent(state.sticks.ly),
                l2: as_sent(state.sticks.l2),
                ry: as_sent(state.sticks.ry),
            },
            motors: decoded.motors,
            ..state
        };
        assert_eq!(decoded, expected);
        checked += 1;
    }
    assert_eq!(checked, 347);
}

#[test]
fn command_frames_equal_those_of_the_documents_tables() {
    let mut checked = 0;
    for mut columns in Columns::of(include_str!("vectors/link_down.csv")) {
        let command = Downlink {
            wheels: std::array::from_fn(|_| WheelTarget {
                speed_rps: columns.float(),
                kp: columns.float(),
                kd: columns.float(),
            }),
            joints: std::array::from_fn(|_| JointTarget {
                pos_rad: columns.float(),
                kp: columns.float(),
                kd: columns.float(),
            }),
        };
        let frame = columns.bytes();
        assert_eq!(command.encode(), frame, "{command:?}");

        let decoded = Downlink::decode(&frame).expect("header and CRC are correct");
        let wheels = decoded
            .wheels
            .map(|wheel| [wheel.speed_rps, wheel.kp, wheel.kd]);
        let joints = decoded
            .joints
            .map(|joint| [joint.pos_rad, joint.kp, joint.kd]);
        assert_close(
            &[wheels.as_flattened(), joints.as_flattened()].concat(),
            &columns.rest(),
        );
        checked += 1;
    }
    assert_eq!(checked, 303);
}

#[test]
fn drive_frames_equal_those_of_the_table() {
    let (mut accepted, mut refused) = (0, 0);
    for mut columns in Columns::of(include_str!("vectors/link_drive.csv")) {
        let [vx, wz, height, roll] = columns.floats();
        let jump = columns.text();
        let count = columns.number();
        let frame = columns.bytes();
        if jump == "-" {
            assert_eq!(DriveFrame::decode(&frame), None, "{frame:02x?}");
            refused += 1;
            continue;
        }
        let command = DriveFrame(PcDrive {
            vx,
            wz,
            height,
            roll,
            jump: jump == "1",
            count,
        });
        assert_eq!(command.encode(), frame, "{command:?}");
        let DriveFrame(read) = DriveFrame::decode(&frame).expect("header and CRC are correct");
        assert_close(&[read.vx, read.wz, read.height, read.roll], &columns.rest());
        assert_eq!((read.jump, read.count), (command.0.jump, count));
        accepted += 1;
    }
    assert_eq!((accepted, refused), (61, 7));
}

#[test]
fn tunnel_frames_equal_those_of_the_table() {
    let (mut accepted, mut refused) = (0, 0);
    for mut columns in Columns::of(include_str!("vectors/link_tunnel.csv")) {
        let id = u16::from_str_radix(columns.text(), 16).unwrap();
        let payload = columns.text().strip_suffix('-');
        let frame = columns.bytes();
        let decoded = Tunnelled::decode(&frame);
        let Some(payload) = payload else {
            assert_eq!(decoded, None, "{id:#x} {frame:02x?}");
            refused += 1;
            continue;
        };
        let id = StandardId::new(id).unwrap();
        let can_frame = CanFrame::from_payload(id, &unhex(payload)).unwrap();
        let tunnelled = Tunnelled::new(can_frame).expect("an identifier of the tuning channel");
        assert_eq!(tunnelled.encode(), frame);
        assert_eq!(decoded, Some(tunnelled));
        accepted += 1;
    }
    assert_eq!((accepted, refused), (144, 28));
}

/// Every single flipped bit, in every byte.
#[test]
fn no_flipped_bit_passes() {
    let up = Uplink::default().encode();
    let down = Downlink::default().encode();
    let drive = DriveFrame::default().encode();
    let id = StandardId::new(0x7A1).unwrap();
    let tunnel = Tunnelled::new(CanFrame::new(id, [7; 8])).unwrap().encode();
    for bit in 0..8 {
        let flipped = |frame: &mut [u8], at: usize| frame[at] ^= 1 << bit;
        for at in 0..up.len() {
            let mut frame = up;
            flipped(&mut frame, at);
            assert_eq!(Uplink::decode(&frame), None);
        }
        for at in 0..down.len() {
            let mut frame = down;
            flipped(&mut frame, at);
            assert_eq!(Downlink::decode(&frame), None);
        }
        for at in 0..drive.len() {
            let mut frame = drive;
            flipped(&mut frame, at);
            assert_eq!(DriveFrame::decode(&frame), None);
        }
        for at in 0..tunnel.len() {
            let mut frame = tunnel;
            flipped(&mut frame, at);
            assert_eq!(Tunnelled::decode(&frame), None);
        }
    }
}
