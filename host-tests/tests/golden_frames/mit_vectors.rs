//! Compares the codecs with `vectors/*.csv`, which come from the maker's C code (see `vectors/README.md`), and over
//! all raw codes.

use robot_app::motor::{
    mit::{MitCommand, MitRanges, MitReport, MitTargets},
    rs00,
};

const DM4310: MitRanges = MitRanges {
    p_max_rad: 12.5,
    v_max_rps: 30.0,
    t_max_nm: 10.0,
};

fn ranges(motor: &str) -> MitRanges {
    match motor {
        "dm4310" => DM4310,
        "rs00" => rs00::RANGES,
        other => panic!("unknown motor {other}"),
    }
}

fn float(hex: &str) -> f32 {
    f32::from_bits(u32::from_str_radix(hex, 16).unwrap())
}

fn bytes(hex: &str) -> [u8; 8] {
    u64::from_str_radix(hex, 16).unwrap().to_be_bytes()
}

fn rows(csv: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    csv.lines().skip(1).map(|line| line.split(',').collect())
}

#[test]
fn commands_equal_those_of_the_makers_code() {
    let mut checked = 0;
    for row in rows(include_str!("vectors/mit_commands.csv")) {
        let [motor, pos, vel, kp, kd, torque, payload] = row[..] else {
            panic!("{row:?}");
        };
        let targets = MitTargets {
            pos_rad: float(pos),
            vel_rps: float(vel),
            kp: float(kp),
            kd: float(kd),
            torque_nm: float(torque),
        };
        let command = MitCommand::clamped(&targets, &ranges(motor));
        assert_eq!(command.payload(), bytes(payload), "{motor} {targets:?}");
        checked += 1;
    }
    assert_eq!(checked, 944);
}

#[test]
fn reports_equal_those_of_the_makers_code() {
    let mut checked = 0;
    for row in rows(include_str!("vectors/mit_replies.csv")) {
        let [motor, payload, pos, vel, torque] = row[..] else {
            panic!("{row:?}");
        };
        let [_, body @ .., _, _] = bytes(payload);
        let report = MitReport::decode(body, &ranges(motor));
        assert_eq!(report.pos_rad, float(pos), "{payload}");
        assert_eq!(report.vel_rps, float(vel), "{payload}");
        assert_eq!(report.torque_nm, float(torque), "{payload}");
        checked += 1;
    }
    assert_eq!(checked, 808);
}

/// The middle of step `code`, in double precision.
fn middle(code: u32, last_code: u32, max: f64) -> f32 {
    ((f64::from(code) + 0.5) / f64::from(last_code) * 2.0 * max - max) as f32
}

#[test]
fn every_position_code_is_reached_and_read_back() {
    for ranges in [DM4310, rs00::RANGES] {
        let max = f64::from(ranges.p_max_rad);
        for code in 0..=u16::MAX {
            let [high, low] = code.to_be_bytes();
            let report = MitReport::decode([high, low, 0, 0, 0], &ranges);
            let exact = f64::from(code) / 65_535.0 * 2.0 * max - max;
            assert!((f64::from(report.pos_rad) - exact).abs() < 2e-6, "{code}");
            assert_eq!(report.position_code, code);
            let targets = MitTargets {
                pos_rad: middle(code.into(), 65_535, max),
                ..MitTargets::default()
            };
            let payload = MitCommand::clamped(&targets, &ranges).payload();
            assert_eq!(payload[..2], [high, low], "{targets:?}");
        }
    }
}

#[test]
fn every_twelve_bit_code_is_reached_and_read_back() {
    for ranges in [DM4310, rs00::RANGES] {
        let (v_max, t_max) = (f64::from(ranges.v_max_rps), f64::from(ranges.t_max_nm));
        for code in 0..=4_095_u32 {
            let other = 4_095 - code;
            let packed = (code << 12 | other).to_be_bytes();
            let report = MitReport::decode([0, 0, packed[1], packed[2], packed[3]], &ranges);
            let vel_rps = f64::from(code) / 4_095.0 * 2.0 * v_max - v_max;
            let torque_nm = f64::from(other) / 4_095.0 * 2.0 * t_max - t_max;
            assert!((f64::from(report.vel_rps) - vel_rps).abs() < 5e-6);
            assert!((f64::from(report.torque_nm) - torque_nm).abs() < 5e-6);
            let targets = MitTargets {
                pos_rad: 0.0,
                vel_rps: middle(code, 4_095, v_max),
                kp: middle(code, 4_095, 250.0) + 250.0,
                kd: middle(other, 4_095, 2.5) + 2.5,
                torque_nm: middle(other, 4_095, t_max),
            };
            let payload = MitCommand::clamped(&targets, &ranges).payload();
            let [_, _, vk @ .., a, b, c] = payload;
            let first = u32::from_be_bytes([0, vk[0], vk[1], vk[2]]);
            let second = u32::from_be_bytes([0, a, b, c]);
            assert_eq!((first >> 12, first & 0xFFF), (code, code));
            assert_eq!((second >> 12, second & 0xFFF), (other, other));
        }
    }
}
