//! What a scenario changes in the world, and what it asks about it.

use super::{Push as Shove, World, WorldError};
use crate::{
    attitude::{self, Quaternion},
    bmi088::ImuFaults,
    faults::{self, Fault, FaultInfo, MOTORS},
    free::{FreeState, Hold, Push},
    ist8310::MagFaults,
    joints::DriveFaults,
    m3508::EscFaults,
    pc::PcInput,
    radio::RemoteInput,
    time::Ps,
};

impl World {
    /// Moves sticks and switches; the next radio frame carries them.
    pub fn set_remote(&mut self, input: RemoteInput) {
        self.radio.set_remote(input);
    }

    /// Changes what the program on the PC sends over the serial link.
    pub fn set_pc(&mut self, input: PcInput) {
        self.pc.set(input, self.now);
    }

    /// Pushes the free robot from now on; a push before it ends. No other robot minds.
    pub fn push(&mut self, push: Shove) {
        let (com_m, shift_m) = (self.robot.body.com_m, self.variation.body.com_offset_m);
        let force = Push {
            force_n: push.force_n(self.body.pose().yaw_rad),
            at_m: push
                .at_m
                .unwrap_or_else(|| std::array::from_fn(|axis| com_m[axis] + shift_m[axis])),
        };
        self.push = Some((force, self.now + push.lasts));
    }

    /// Puts the free robot into a state, and holds its body there or lets go of it. Sensors notice from the next step on. No
    /// other robot minds.
    pub fn place(&mut self, state: &FreeState, hold: Hold) {
        self.body.place(state, hold);
    }

    /// State of the free robot; `None` of any other.
    pub fn free_state(&self) -> Option<FreeState> {
        Some(self.body.free()?.state())
    }

    /// Starts or ends a fault at the present time.
    ///
    /// # Errors
    /// No fault has this name.
    pub fn set_fault(&mut self, name: &str, active: bool) -> Result<(), WorldError> {
        let fault =
            faults::by_name(name).ok_or_else(|| WorldError::UnknownFault(name.to_owned()))?;
        self.faults.set(fault, active);
        match fault {
            Fault::SbusSilent if active => self.radio.unplug(self.now),
            Fault::LinkCut | Fault::LinkCutDown | Fault::LinkFlood | Fault::LinkBreak => {
                self.pc.set_faults(self.link_faults(), self.now);
            }
            Fault::ImuGone
            | Fault::ImuFrozen
            | Fault::ImuExtreme
            | Fault::GyroFifoShift
            | Fault::GyroSpike
            | Fault::MagGone
            | Fault::I2cHeld => self.set_sensor_faults(),
            Fault::Motor0Doubled | Fault::Motor1Doubled => self.number_escs(),
            _ => {}
        }
        for (motor, faults) in MOTORS.iter().enumerate() {
            if faults.includes(fault) || fault == Fault::JointWritesSlow {
                self.set_motor_faults(motor);
            }
        }
        Ok(())
    }

    /// Gives each controller the number of the robot's file, unless a fault gives both the same.
    fn number_escs(&mut self) {
        let [left, right] = &mut self.escs;
        let [left_id, right_id] = self.robot.wheels.escs;
        let has = |fault| self.faults.has(fault);
        left.set_number(if has(Fault::Motor1Doubled) {
            right_id
        } else {
            left_id
        });
        right.set_number(if has(Fault::Motor0Doubled) {
            left_id
        } else {
            right_id
        });
    }

    /// Switches the power of the board and its sensors. Motors, radio and PC have their own.
    pub fn set_board_supply(&mut self, on: bool) {
        self.board_supply = on;
        self.set_sensor_faults();
    }

    fn set_sensor_faults(&mut self) {
        let has = |fault| self.faults.has(fault);
        let imu = ImuFaults {
            gone: has(Fault::ImuGone) || !self.board_supply,
            frozen: has(Fault::ImuFrozen),
            extreme: has(Fault::ImuExtreme),
            fifo_shift: has(Fault::GyroFifoShift),
            gyro_spikes: has(Fault::GyroSpike),
        };
        let mag = MagFaults {
            gone: has(Fault::MagGone) || !self.board_supply,
            bus_held: has(Fault::I2cHeld),
        };
        self.imu.set_faults(imu, self.now);
        self.mag.set_faults(mag, self.now);
    }

    /// Motors 0 and 1 are the wheels; the joints follow.
    fn set_motor_faults(&mut self, motor: usize) {
        let faults = &MOTORS[motor];
        let has = |fault| self.faults.has(fault);
        let (gone, frozen) = (has(faults.gone), has(faults.frozen));
        let (hot, wrong_id) = (has(faults.hot), has(faults.wrong_id));
        match motor.checked_sub(self.escs.len()) {
            None => self.escs[motor].set_faults(EscFaults {
                gone,
                frozen,
                hot,
                wrong_id,
            }),
            Some(joint) => {
                let drive_faults = DriveFaults {
                    gone,
                    frozen,
                    hot,
                    wrong_id,
                    tripped: faults.fault.is_some_and(has),
                    slow_writes: self.faults.has(Fault::JointWritesSlow),
                };
                self.joints[joint].set_faults(drive_faults, self.now);
                self.report_joint(joint, self.now);
            }
        }
    }

    /// Every fault of the world, for [`World::set_fault`].
    pub fn faults() -> &'static [FaultInfo] {
        faults::INFO
    }

    /// Error of the attitude `q_wxyz` (body → ENU earth, scalar first) against the truth or the recording's reference, in
    /// degrees: `[total, heading, inclination]`. `None` in a gap of the reference, and for a quaternion without direction.
    pub fn attitude_error_deg(&self, q_wxyz: [f64; 4]) -> Option<[f64; 3]> {
        attitude::error_deg(q_wxyz, self.true_attitude()?)
    }

    /// Error of an estimate that was made at `at`, a moment ago. Without a recording the present truth is used, since the
    /// past one is not stored.
    pub fn past_attitude_error_deg(&self, q_wxyz: [f64; 4], at: Ps) -> Option<[f64; 3]> {
        match &self.playback {
            Some(playback) => attitude::error_deg(q_wxyz, playback.reference(at)?),
            None => self.attitude_error_deg(q_wxyz),
        }
    }

    pub(super) fn true_attitude(&self) -> Option<Quaternion> {
        match &self.playback {
            Some(playback) => playback.reference(self.now),
            None => Some(self.body.attitude()),
        }
    }
}
