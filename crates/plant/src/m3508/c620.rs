//! C620 motor controller: command in, current loop, feedback out.

use robot_description::Wheels;

use super::motor::M3508;
use crate::{
    physics::{PHYSICS_STEP, physics_step_s},
    random::Random,
    time::{Ps, SECOND, US},
    wire::CanFrame,
};

const COMMAND_ID: u32 = 0x200;
/// `motor-N-wrong-id` makes ESC 1 and 2 into 5 and 6.
const WRONG_ID: u32 = 4;
const FULL_SCALE_RAW: f64 = 16_384.0;
const FULL_SCALE_A: f64 = 20.0;
/// Time constant of the current loop. No source gives it.
const CURRENT_LOOP_S: f64 = 1e-3;
const ENCODER_STEPS: f64 = 8_192.0;
const FEEDBACK_PERIOD: Ps = SECOND / 1_000;
/// An assumption: the controllers start one after the other, and each runs on its own crystal, at most 50 ppm off.
const STAGGER: Ps = 370 * US;
const CRYSTAL_PPM: f64 = 50.0;

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EscFaults {
    /// No supply: no torque, no feedback, no acknowledge.
    pub gone: bool,
    /// Feedback repeats its last content; the motor still obeys.
    pub frozen: bool,
    /// Winding at 120 °C.
    pub hot: bool,
    /// The controller has been given another number with its button.
    pub wrong_id: bool,
}

#[derive(Clone)]
pub(crate) struct C620 {
    /// Number of the controller, 1 … 4, as set by its button.
    id: u8,
    pub(crate) motor: M3508,
    faults: EscFaults,
    commanded_raw: i16,
    follow: f64,
    rotor_turns: f64,
    feedback: [u8; 8],
    next_feedback: Ps,
    feedback_period: Ps,
    feedback_pending: bool,
}

impl C620 {
    /// The controller with number `id` of these wheels.
    pub(crate) fn new(id: u8, wheels: &Wheels, mut random: Random) -> Self {
        let ppm = random.symmetric(CRYSTAL_PPM);
        Self {
            id,
            motor: M3508::new(wheels),
            faults: EscFaults::default(),
            commanded_raw: 0,
            follow: 1.0 - (-physics_step_s() / CURRENT_LOOP_S).exp(),
            rotor_turns: random.unit(),
            feedback: [0; 8],
            next_feedback: PHYSICS_STEP + u64::from(id - 1) * STAGGER,
            feedback_period: (FEEDBACK_PERIOD as f64 * (1.0 + ppm * 1e-6)) as Ps,
            feedback_pending: false,
        }
    }

    pub(crate) fn set_faults(&mut self, faults: EscFaults) {
        if faults.gone || faults.wrong_id != self.faults.wrong_id {
            self.commanded_raw = 0;
            self.feedback_pending = false;
            self.motor.cut();
        }
        self.motor.heated = faults.hot;
        self.faults = faults;
    }

    /// Restarts the controller with another number, 1 … 4.
    pub(crate) fn set_number(&mut self, id: u8) {
        if id != self.id {
            self.id = id;
            self.commanded_raw = 0;
            self.feedback_pending = false;
            self.motor.cut();
        }
    }

    /// Identifier of the feedback. With a wrong number the controller listens to 0x1FF.
    fn feedback_id(&self) -> u32 {
        COMMAND_ID + u32::from(self.id) + u32::from(self.faults.wrong_id) * WRONG_ID
    }

    pub(crate) fn powered(&self) -> bool {
        !self.faults.gone
    }

    pub(crate) fn step(&mut self, shaft_rps: f64, supply_v: f64) {
        let dt_s = physics_step_s();
        self.rotor_turns += shaft_rps * self.motor.gear() * dt_s / std::f64::consts::TAU;
        if self.powered() {
            let wanted_a = amperes(self.commanded_raw);
            self.motor
                .step(wanted_a, shaft_rps, supply_v, self.follow, dt_s);
        }
    }

    pub(crate) fn next_feedback(&self) -> Ps {
        self.next_feedback
    }

    /// Prepares the feedback that is due. It replaces one that is still waiting for the bus.
    pub(crate) fn prepare_feedback(&mut self, shaft_rps: f64) {
        self.next_feedback += self.feedback_period;
        if !self.powered() {
            return;
        }
        self.feedback_pending = true;
        if self.faults.frozen {
            return;
        }
        let angle = (self.rotor_turns.rem_euclid(1.0) * ENCODER_STEPS) as u16;
        let rotor_rpm =
            (shaft_rps * self.motor.gear() * 60.0 / std::f64::consts::TAU).round() as i16;
        let current = (self.motor.current_a() * FULL_SCALE_RAW / FULL_SCALE_A).round() as i16;
        self.feedback[0..2].copy_from_slice(&angle.to_be_bytes());
        self.feedback[2..4].copy_from_slice(&rotor_rpm.to_be_bytes());
        self.feedback[4..6].copy_from_slice(&current.to_be_bytes());
        self.feedback[6] = self.motor.temperature_c().round() as u8;
    }

    pub(crate) fn pending(&self) -> Option<CanFrame> {
        self.feedback_pending
            .then_some(CanFrame::with_data(self.feedback_id(), self.feedback))
    }

    pub(crate) fn sent(&mut self) {
        self.feedback_pending = false;
    }

    /// Rotor speed in the last feedback, in rpm.
    pub(crate) fn fed_back_rpm(&self) -> f64 {
        f64::from(i16::from_be_bytes([self.feedback[2], self.feedback[3]]))
    }

    pub(crate) fn commanded_ma(&self) -> f64 {
        amperes(self.commanded_raw) * 1_000.0
    }

    /// Returns true if the frame is a command to this controller. The last command is held indefinitely. Whether a C620
    /// stops by itself is unknown, so the board must send zero.
    pub(crate) fn receive(&mut self, frame: &CanFrame) -> bool {
        if !self.powered()
            || self.faults.wrong_id
            || frame.extended
            || frame.remote
            || frame.id != COMMAND_ID
            || frame.dlc != 8
        {
            return false;
        }
        let slot = 2 * usize::from(self.id - 1);
        self.commanded_raw = i16::from_be_bytes([frame.data[slot], frame.data[slot + 1]]);
        true
    }
}

/// Current of a raw command, A, clipped to full scale as by the controller.
fn amperes(raw: i16) -> f64 {
    f64::from(raw).clamp(-FULL_SCALE_RAW, FULL_SCALE_RAW) * FULL_SCALE_A / FULL_SCALE_RAW
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{random::Stream, robots};
    use robot_description::JointMotor;

    fn esc(id: u8) -> C620 {
        let robot = robots::with_joints(JointMotor::Dm4310);
        C620::new(id, &robot.wheels, Random::new(1, Stream::LeftMotor))
    }

    // docs/hardware.md#test-vectors: +1000, −1000, +16384, −16384.
    #[test]
    fn takes_its_own_slot_of_the_reference_command() {
        let frame = CanFrame::with_data(0x200, [0x03, 0xE8, 0xFC, 0x18, 0x40, 0x00, 0xC0, 0x00]);
        let expected_ma = [1_220.703_125, -1_220.703_125, 20_000.0, -20_000.0];
        for (id, expected) in (1..=4).zip(expected_ma) {
            let mut esc = esc(id);
            assert!(esc.receive(&frame));
            assert_eq!(esc.commanded_ma(), expected);
        }
        let mut esc = esc(1);
        assert!(!esc.receive(&CanFrame { id: 0x1FF, ..frame }));
        assert!(!esc.receive(&CanFrame {
            extended: true,
            ..frame
        }));
        assert!(!esc.receive(&CanFrame {
            remote: true,
            ..frame
        }));
        assert_eq!(esc.commanded_ma(), 0.0);
    }

    #[test]
    fn feedback_is_big_endian_rotor_speed_and_current() {
        let mut esc = esc(2);
        esc.receive(&CanFrame::with_data(0x200, [0, 0, 0x10, 0, 0, 0, 0, 0]));
        // One turn a second at the wheel: 19.203 · 60 = 1152.2 rpm at the rotor; 0x1000 = 5 A after many time constants.
        for _ in 0..100 {
            esc.step(std::f64::consts::TAU, 24.0);
        }
        esc.prepare_feedback(std::f64::consts::TAU);
        let frame = esc.pending().expect("feedback is due");
        assert_eq!((frame.id, frame.dlc), (0x202, 8));
        assert_eq!(frame.data[2..6], [0x04, 0x80, 0x10, 0x00]);
        assert_eq!(frame.data[7], 0);
        assert!((29..=32).contains(&frame.data[6]));
    }

    #[test]
    fn with_another_number_it_obeys_and_answers_under_that() {
        let mut esc = esc(1);
        esc.set_number(2);
        esc.receive(&CanFrame::with_data(0x200, [0x10, 0, 0x20, 0, 0, 0, 0, 0]));
        assert_eq!(esc.commanded_ma(), 10_000.0);
        esc.prepare_feedback(0.0);
        assert_eq!(esc.pending().expect("feedback is due").id, 0x202);
        esc.set_number(1);
        assert_eq!(esc.commanded_ma(), 0.0);
        assert!(esc.pending().is_none());
    }

    #[test]
    fn encoder_counts_8192_a_rotor_turn() {
        let mut esc = esc(1);
        let angle = |esc: &C620| f64::from(u16::from_be_bytes([esc.feedback[0], esc.feedback[1]]));
        esc.prepare_feedback(0.0);
        let before = angle(&esc);
        // A quarter turn of the rotor in 40 steps of 250 µs: 25 turns a second.
        for _ in 0..40 {
            esc.step(25.0 * std::f64::consts::TAU / esc.motor.gear(), 24.0);
        }
        esc.prepare_feedback(0.0);
        let moved = (angle(&esc) - before).rem_euclid(8_192.0);
        assert!((moved - 2_048.0).abs() <= 1.0, "{moved}");
    }

    #[test]
    fn a_current_taken_back_is_zero_and_no_denormal_number_after_50_ms() {
        let mut esc = esc(1);
        for commanded in [0x10, 0] {
            esc.receive(&CanFrame::with_data(
                0x200,
                [commanded, 0, 0, 0, 0, 0, 0, 0],
            ));
            for _ in 0..200 {
                esc.step(0.0, 24.0);
            }
        }
        assert_eq!(esc.motor.current_a(), 0.0);
    }

    #[test]
    fn command_holds_without_further_frames_and_dies_with_the_supply() {
        let mut esc = esc(1);
        esc.receive(&CanFrame::with_data(0x200, [0x10, 0, 0, 0, 0, 0, 0, 0]));
        for _ in 0..4_000 {
            esc.step(0.0, 24.0);
        }
        assert!((esc.motor.current_a() - 5.0).abs() < 1e-6);
        esc.set_faults(EscFaults {
            gone: true,
            ..EscFaults::default()
        });
        esc.step(0.0, 24.0);
        assert_eq!(esc.motor.torque_nm(), 0.0);
        assert!(esc.pending().is_none());
    }
}
