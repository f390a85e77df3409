//! Bytes written by hand from docs/tuning.md#frames.

use super::*;
use crate::{
    bring_up::BringUpStep,
    domain::{BusId, ParamError, ParamState, ParamStatus, StandardId, WheelOdomConfig},
    motor::layout::ROBOT_LAYOUT,
    tuning::READ_ID,
};

mod black_box;
mod defaults;
mod joint_zero;
mod reading;
mod recording;
mod wheel_geometry;

/// docs/tuning.md#frames: radius 80 mm, track 450 mm, ratio 36.00, left wheel reversed.
const GEOMETRY: [u8; 8] = [0x10, 80, 0, 0xC2, 0x01, 0x10, 0x0E, 0x01];

struct Bench {
    channel: TuningChannel,
    config: RobotConfig,
    bring_up: BringUp,
    diagnostics: DiagnosticsSnapshot,
    /// Stationary angles of the joint motors.
    stationary: [Result<f32, NotStationary>; 4],
}

impl Default for Bench {
    fn default() -> Self {
        Self {
            channel: TuningChannel::new(&ROBOT_LAYOUT),
            config: RobotConfig::default(),
            bring_up: BringUp::default(),
            diagnostics: DiagnosticsSnapshot::default(),
            stationary: [Err(NotStationary::Unknown); 4],
        }
    }
}

impl Bench {
    fn ask(&mut self, gate: TuningGate, id: u16, payload: &[u8]) -> Option<CanFrame> {
        let id = StandardId::new(id).unwrap();
        let frame = CanFrame::from_payload(id, payload).unwrap();
        self.ask_on(TuningPort::Bus(BusId::Can1), gate, &frame)
    }

    fn ask_on(&mut self, port: TuningPort, gate: TuningGate, frame: &CanFrame) -> Option<CanFrame> {
        let access = TuningAccess {
            config: &mut self.config,
            bring_up: &mut self.bring_up,
            sensors: &self.diagnostics.sensors,
            diagnostics: &self.diagnostics,
            stationary_angle_rad: &|joint| self.stationary.get(joint).copied(),
        };
        self.channel.on_frame(port, frame, gate, access)
    }

    /// Returns the reply to the first request of a slot.
    fn reply(&mut self, gate: TuningGate, id: u16, payload: &[u8]) -> [u8; 8] {
        self.channel.begin_slot();
        let reply = self.ask(gate, id, payload).unwrap();
        assert_eq!(reply.id().raw(), 0x7A2);
        reply.full_payload().unwrap()
    }

    fn write(&mut self, payload: &[u8]) -> [u8; 8] {
        self.reply(TuningGate::Open, 0x7A0, payload)
    }

    fn read(&mut self, payload: &[u8]) -> [u8; 8] {
        self.reply(TuningGate::Open, 0x7A1, payload)
    }

    fn unchanged(&self) -> bool {
        self.config == RobotConfig::default()
            && self.channel.status().revision == 0
            && self.bring_up.status().step == BringUpStep::Off
    }
}

/// In IEEE 754, 30,000 is 0x46EA6000 and 8,000 is 0x45FA0000.
#[test]
fn every_setting_can_be_written_and_read() {
    let mut bench = Bench::default();
    let write = [0x20, 2, 2, 0, 0x00, 0x60, 0xEA, 0x46];
    assert_eq!(bench.write(&write), write);
    assert_eq!(bench.config.wheel_ctrl.kp_ma_per_mps, 30_000.0);
    assert_eq!(
        bench.read(&[0x21, 2, 2]),
        [0x21, 2, 2, 0, 0x00, 0x60, 0xEA, 0x46]
    );
    assert_eq!(
        bench.read(&[0x21, 2, 3]),
        [0x21, 2, 3, 0, 0x00, 0x00, 0xFA, 0x45]
    );
}

/// A refusal never begins with the command of a reply that an old client knows.
#[test]
fn every_refusal_names_its_reason_and_changes_nothing() {
    const NAN: [u8; 4] = [0x00, 0x00, 0xC0, 0x7F];
    let [n0, n1, n2, n3] = NAN;
    let writes: [(&[u8], [u8; 5]); 18] = [
        // An empty, a short and an unknown command, and a read with the identifier of writes.
        (&[], [0xEE, 0x00, 1, 0, 0]),
        (
            &[0x10, 75, 0, 0xC2, 0x01, 0x10, 0x0E],
            [0xEE, 0x10, 1, 0, 0],
        ),
        (&[0x20, 2, 2], [0xEE, 0x20, 1, 2, 2]),
        (&[0x40, 1], [0xEE, 0x40, 1, 0, 0]),
        (&[0x30, 2], [0xEE, 0x30, 1, 0, 0]),
        (&[0x31, 0, 0, 0, 0, 0, 0, 0], [0xEE, 0x31, 2, 0, 0]),
        (&[0x12, 0, 0, 0, 0, 0, 0, 0], [0xEE, 0x12, 2, 0, 0]),
        (&[0x11], [0xEE, 0x11, 2, 0, 0]),
        // No such setting.
        (&[0x20, 99, 1, 0, 0, 0, 0, 0], [0xEE, 0x20, 3, 99, 1]),
        (&[0x30, 99, 0, 0, 0, 0, 0, 0], [0xEE, 0x30, 3, 0, 0]),
        (&[0x30, 2, 0, 0, 0, 0, 0, 1], [0xEE, 0x30, 4, 0, 0]),
        // Ratio 0, radius 0, an undefined bit, a byte that must be 0, −1.0 mA as current limit.
        (&[0x10, 75, 0, 0xC2, 0x01, 0, 0, 0], [0xEE, 0x10, 4, 0, 0]),
        (
            &[0x10, 0, 0, 0xC2, 0x01, 0x10, 0x0E, 0],
            [0xEE, 0x10, 4, 0, 0],
        ),
        (
            &[0x10, 75, 0, 0xC2, 0x01, 0x10, 0x0E, 4],
            [0xEE, 0x10, 4, 0, 0],
        ),
        (&[0x20, 2, 2, 1, 0, 0x60, 0xEA, 0x46], [0xEE, 0x20, 4, 2, 2]),
        (&[0x20, 2, 3, 0, 0, 0, 0x80, 0xBF], [0xEE, 0x20, 4, 2, 3]),
        (&[0x20, 2, 2, 0, n0, n1, n2, n3], [0xEE, 0x20, 6, 2, 2]),
        // The lower limit of joint 0 at 2.0 rad would be above its upper one at 0.75.
        (&[0x20, 16, 2, 0, 0, 0, 0, 0x40], [0xEE, 0x20, 7, 16, 2]),
    ];
    for (payload, expected) in writes {
        let mut bench = Bench::default();
        assert_eq!(bench.write(payload)[..5], expected, "{payload:x?}");
        assert_eq!(bench.write(payload)[5..], [0; 3]);
        assert!(bench.unchanged(), "{payload:x?}");
        let status = bench.channel.status();
        assert_eq!((status.accepted, status.refused), (0, 2));
        assert_eq!(status.last_refusal, expected[2]);
    }
    let reads: [(&[u8], [u8; 5]); 6] = [
        (&[], [0xEE, 0x00, 1, 0, 0]),
        (&[0x30], [0xEE, 0x30, 2, 0, 0]),
        (&[0x21, 2], [0xEE, 0x21, 1, 2, 0]),
        (&[0x21, 2, 200], [0xEE, 0x21, 3, 2, 200]),
        (
            &[0x10, 75, 0, 0xC2, 0x01, 0x10, 0x0E, 0],
            [0xEE, 0x10, 2, 0, 0],
        ),
        (&[0xEE, 1, 2], [0xEE, 0xEE, 2, 0, 0]),
    ];
    for (payload, expected) in reads {
        assert_eq!(
            Bench::default().read(payload)[..5],
            expected,
            "{payload:x?}"
        );
    }
}

#[test]
fn nothing_is_written_while_armed() {
    let mut bench = Bench::default();
    for (payload, expected) in [
        (GEOMETRY, [0xEE, 0x10, 5, 0, 0, 0, 0, 0]),
        (
            [0x20, 2, 2, 0, 0, 0x60, 0xEA, 0x46],
            [0xEE, 0x20, 5, 2, 2, 0, 0, 0],
        ),
        ([0x30, 0, 0, 0, 0, 0, 0, 0], [0xEE, 0x30, 5, 0, 0, 0, 0, 0]),
        ([0x40, 2, 0, 0, 0, 0, 0, 0], [0xEE, 0x40, 5, 0, 0, 0, 0, 0]),
    ] {
        assert_eq!(bench.reply(TuningGate::Shut, 0x7A0, &payload), expected);
        assert!(bench.unchanged());
    }
}

/// The geometry is one change: an impossible ratio keeps the radius that came with it out, too.
#[test]
fn a_write_is_applied_entirely_or_not_at_all() {
    let mut bench = Bench::default();
    bench.write(&[0x10, 75, 0, 0xC2, 0x01, 0, 0, 0]);
    assert!(bench.unchanged());
}

#[test]
fn one_request_is_executed_per_slot_and_bus() {
    let mut bench = Bench::default();
    bench.channel.begin_slot();
    assert!(bench.ask(TuningGate::Open, 0x7A1, &[0x11]).is_some());
    assert_eq!(bench.ask(TuningGate::Open, 0x7A0, &GEOMETRY), None);
    assert!(bench.unchanged());
    assert_eq!(bench.channel.status().dropped, 1);
    let read = CanFrame::from_payload(READ_ID, &[0x11]).unwrap();
    let other_bus = bench.ask_on(TuningPort::Bus(BusId::Can2), TuningGate::Open, &read);
    assert!(other_bus.is_some());
    bench.channel.begin_slot();
    assert!(bench.ask(TuningGate::Open, 0x7A0, &GEOMETRY).is_some());
}

#[test]
fn other_frames_are_ignored() {
    let mut bench = Bench::default();
    for id in [0x7A2, 0x79F, 0x201, 0x000] {
        assert_eq!(bench.ask(TuningGate::Open, id, &GEOMETRY), None);
    }
    assert_eq!(*bench.channel.status(), TuningStatus::default());
}

#[test]
fn the_revision_counts_changes_only() {
    let mut bench = Bench::default();
    bench.write(&GEOMETRY);
    bench.write(&GEOMETRY);
    bench.read(&[0x11]);
    let status = bench.channel.status();
    assert_eq!((status.accepted, status.revision), (3, 1));
}

/// Third step, motor 2 (joint 0), torque 300 mN·m = 0x012C; then 501 mN·m = 0x01F5.
#[test]
fn bring_up_requests_are_executed_and_echoed() {
    let mut bench = Bench::default();
    let start = [0x40, 3, 2, 0, 0x2C, 0x01, 0, 0];
    assert_eq!(bench.write(&start), start);
    assert!(!bench.bring_up.blocks_arming());
    let read_only = [0x40, 1, 0, 0, 0, 0, 0, 0];
    assert_eq!(bench.write(&read_only), read_only);
    assert!(bench.bring_up.blocks_arming());
    let too_much = bench.write(&[0x40, 3, 2, 0, 0xF5, 0x01, 0, 0]);
    assert_eq!(too_much, [0xEE, 0x40, 4, 0, 0, 0, 0, 0]);
    let reserved = bench.write(&[0x40, 3, 2, 0, 0x2C, 0x01, 0, 1]);
    assert_eq!(reserved, [0xEE, 0x40, 4, 0, 0, 0, 0, 0]);
    assert!(bench.bring_up.blocks_arming());
    bench.write(&[0x40, 0, 0, 0, 0, 0, 0, 0]);
    assert!(!bench.bring_up.blocks_arming());
}

/// Speed 3.5 m/s = 0x40600000 and target 30 °C = 0x41F00000. Neither is in group 16.
fn tuned() -> Bench {
    let mut bench = Bench::default();
    bench.write(&[0x20, 2, 0, 0, 0x00, 0x00, 0x60, 0x40]);
    bench.write(&[0x20, 7, 0, 0, 0x00, 0x00, 0xF0, 0x41]);
    assert_eq!(bench.config.wheel_ctrl.max_vx_mps, 3.5);
    assert_eq!(bench.config.heater.target_c, 30.0);
    bench
}

/// The bit of a group in a mask by table index.
fn place(number: u8) -> u32 {
    let mut groups = crate::tuning::PARAMETERS.iter();
    1 << groups.position(|group| group.number == number).unwrap()
}

proptest::proptest! {
    /// Most requests are valid, with any value. Whatever the channel accepts must be in range and consistent.
    #[test]
    fn no_sequence_of_requests_makes_an_invalid_configuration(
        requests in proptest::collection::vec(
            (
                proptest::prelude::prop_oneof![8 => 1u8..20, 1 => proptest::prelude::any::<u8>()],
                0u8..16,
                proptest::prelude::prop_oneof![
                    -2.0f32..2.0,
                    -600.0f32..600.0,
                    proptest::num::f32::ANY,
                ],
                proptest::prelude::any::<[u8; 7]>(),
            ),
            1..60,
        ),
    ) {
        let mut bench = Bench::default();
        for (group, index, value, geometry) in requests {
            let [a, b, c, d] = value.to_le_bytes();
            bench.write(&[0x20, group, index, 0, a, b, c, d]);
            let [radius, track, e, ratio, f, signs, _] = geometry;
            bench.write(&[0x10, radius, 0, track, e & 7, ratio, f & 63, signs & 7]);
        }
        proptest::prop_assert_eq!(consistency::check(&bench.config), Ok(()));
        for parameter in crate::tuning::PARAMETERS.iter().flat_map(|group| group.parameters) {
            let value = parameter.read(&bench.config);
            proptest::prop_assert!((parameter.min..=parameter.max).contains(&value));
        }
    }
}
