use super::*;
use crate::motor::{
    dm4310::{Dm4310, Register},
    layout::{ROBOT_LAYOUT, RS00_LAYOUT},
};

/// A motor with these registers. It answers each request after 200 µs and each other frame with a report.
struct Bench {
    set_up: SetUp,
    now_us: u64,
    registers: Vec<(Register, u32)>,
    requests: Vec<[u8; 8]>,
}

const FACTORY: [(Register, u32); 5] = [
    (Register::PositionRange, 12.5_f32.to_bits()),
    (Register::VelocityRange, 30.0_f32.to_bits()),
    (Register::TorqueRange, 10.0_f32.to_bits()),
    (Register::Timeout, 0),
    (Register::ControlMode, 1),
];

impl Bench {
    fn new(mode: JointMode, change: &[(Register, u32)]) -> Self {
        let mut registers = FACTORY.to_vec();
        for (register, value) in change {
            registers.retain(|(known, _)| known != register);
            registers.push((*register, *value));
        }
        Self {
            set_up: SetUp::new(&ROBOT_LAYOUT.joints()[0].motor, mode),
            now_us: 1_000_000,
            registers,
            requests: Vec::new(),
        }
    }

    /// Runs one slot. If `answers` is false, the answer is lost.
    fn slot(&mut self, answers: bool) {
        self.now_us += 2_000;
        match self.set_up.request(self.now_us) {
            None => self.set_up.on_report(Status::Disabled),
            Some(frame) => {
                let payload = frame.full_payload().unwrap();
                self.requests.push(payload);
                let [_, _, order, index, value @ ..] = payload;
                let entry = self
                    .registers
                    .iter_mut()
                    .find(|(register, _)| *register as u8 == index)
                    .unwrap();
                if order == 0x55 {
                    entry.1 = u32::from_le_bytes(value);
                }
                let value = entry.1;
                if answers {
                    self.set_up.on_register(value, self.now_us + 200);
                }
            }
        }
    }

    fn slots(&mut self, count: u32) {
        for _ in 0..count {
            self.slot(true);
        }
    }

    fn value(&self, register: Register) -> u32 {
        let mut known = self.registers.iter();
        known.find(|(name, _)| *name == register).unwrap().1
    }

    fn orders(&self) -> Vec<(u8, u8)> {
        self.requests
            .iter()
            .map(|[_, _, order, index, ..]| (*order, *index))
            .collect()
    }
}

#[test]
fn all_registers_are_read_and_the_timeout_is_written_and_verified() {
    let mut bench = Bench::new(JointMode::Mit, &[]);
    bench.slots(9);
    assert!(bench.set_up.is_done());
    let (read, write) = (0x33, 0x55);
    assert_eq!(
        bench.orders(),
        [
            (read, 0x15),
            (read, 0x16),
            (read, 0x17),
            (read, 9),
            (write, 9),
            (read, 9),
            (read, 10),
        ]
    );
    // 100 ms in steps of 50 µs.
    assert_eq!(bench.value(Register::Timeout), 2_000);
}

#[test]
fn a_correctly_set_motor_is_not_written() {
    let mut bench = Bench::new(JointMode::Mit, &[(Register::Timeout, 2_000)]);
    bench.slots(7);
    assert!(bench.set_up.is_done());
    assert!(bench.orders().iter().all(|(order, _)| *order == 0x33));
}

#[test]
fn a_different_mode_is_written() {
    for (mode, number) in [(JointMode::PositionSpeed, 2), (JointMode::Speed, 3)] {
        let mut bench = Bench::new(mode, &[]);
        bench.slots(12);
        assert!(bench.set_up.is_done());
        assert_eq!(bench.value(Register::ControlMode), number);
    }
}

/// Its codes would mean other angles, speeds or torques than the layout says.
#[test]
fn a_motor_with_other_ranges_never_becomes_ready() {
    for (register, value) in [
        (Register::PositionRange, 12.57_f32),
        (Register::VelocityRange, 45.0),
        (Register::TorqueRange, 18.0),
        (Register::TorqueRange, f32::NAN),
    ] {
        let mut bench = Bench::new(JointMode::Mit, &[(register, value.to_bits())]);
        bench.slots(3_000);
        assert!(!bench.set_up.is_done(), "{register:?}");
        assert!(bench.orders().iter().all(|(order, _)| *order == 0x33));
        // It is checked again about once a second.
        assert!(bench.requests.len() < 25, "{}", bench.requests.len());
    }
}

#[test]
fn lost_answers_only_delay_the_set_up() {
    let mut bench = Bench::new(JointMode::Mit, &[]);
    for slot in 0..2_000 {
        bench.slot(slot % 3 == 0);
    }
    assert!(bench.set_up.is_done());
    assert_eq!(bench.value(Register::Timeout), 2_000);
}

#[test]
fn an_enabled_motor_gets_no_requests() {
    let JointMotor::Dm4310(motor) = &ROBOT_LAYOUT.joints()[0].motor else {
        panic!("the robot's joints are DM4310");
    };
    let motor: &'static Dm4310 = motor;
    let mut set_up = dm4310::SetUp::new(motor, JointMode::Mit);
    for slot in 0..100 {
        assert_eq!(set_up.request(slot * 2_000), None);
        set_up.on_report(Status::Enabled);
    }
}

#[test]
fn silence_restarts_the_set_up_except_after_a_write() {
    let mut bench = Bench::new(JointMode::Mit, &[]);
    bench.slots(5);
    bench.slot(false);
    assert_eq!(bench.orders().last(), Some(&(0x55, 9)));
    let written_us = bench.now_us;
    bench.set_up.on_silence(written_us + 299_999);
    assert_eq!(
        bench.set_up.expected(),
        Expected::Register(Register::Timeout)
    );
    bench.set_up.on_silence(written_us + 300_000);
    assert_eq!(bench.set_up.expected(), Expected::Report);
}

#[test]
fn an_rs00_is_stopped_checked_for_faults_and_set_to_its_mode() {
    let mut set_up = SetUp::new(&RS00_LAYOUT.joints()[0].motor, JointMode::Speed);
    let last_bytes = |set_up: &mut SetUp, now_us| {
        set_up.request(now_us).map(|frame| {
            let [.., detail, order] = frame.full_payload().unwrap();
            (detail, order)
        })
    };
    // A report from before the request is not its answer.
    set_up.on_report(Status::Working);
    assert_eq!(last_bytes(&mut set_up, 1_000), Some((0xFF, 0xFD)));
    set_up.on_report(Status::Working);
    assert_eq!(last_bytes(&mut set_up, 3_000), Some((0x00, 0xFB)));
    assert_eq!(set_up.expected(), Expected::FaultWord);
    // The answer was lost, so the request is repeated after 10 ms.
    assert_eq!(last_bytes(&mut set_up, 5_000), None);
    assert_eq!(last_bytes(&mut set_up, 13_000), Some((0x00, 0xFB)));
    set_up.on_no_fault();
    assert_eq!(last_bytes(&mut set_up, 15_000), Some((2, 0xFC)));
    assert!(!set_up.is_done());
    // The motor fell silent, so the dialogue restarts. Silence while it is being stopped changes nothing.
    set_up.on_silence(17_000);
    assert_eq!(last_bytes(&mut set_up, 17_000), Some((0xFF, 0xFD)));
    set_up.on_silence(19_000);
    assert_eq!(last_bytes(&mut set_up, 19_000), None);
    set_up.on_report(Status::Working);
    last_bytes(&mut set_up, 21_000);
    set_up.on_no_fault();
    last_bytes(&mut set_up, 23_000);
    set_up.on_report(Status::Working);
    assert!(set_up.is_done());
}
