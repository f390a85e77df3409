//! What a scenario does to the world and asks of it.

use super::{FaultInfo, RemoteInput, World, WorldError};
use crate::{
    attitude::{self, Quaternion},
    bmi088::ImuFaults,
    faults::{self, Fault},
    ist8310::MagFaults,
    m3508::EscFaults,
};

impl World {
    /// Takes effect with the next radio frame.
    pub fn set_remote(&mut self, input: RemoteInput) {
        self.radio.set_remote(input);
    }

    /// Starts or ends a fault at the present time.
    pub fn set_fault(&mut self, name: &str, active: bool) -> Result<(), WorldError> {
        let fault =
            faults::by_name(name).ok_or_else(|| WorldError::UnknownFault(name.to_owned()))?;
        self.faults.set(fault, active);
        match fault {
            Fault::SbusSilent if active => self.radio.unplug(self.now),
            Fault::ImuGone | Fault::ImuFrozen => self.imu.set_faults(
                ImuFaults {
                    gone: self.faults.has(Fault::ImuGone),
                    frozen: self.faults.has(Fault::ImuFrozen),
                },
                self.now,
            ),
            Fault::MagGone | Fault::I2cHeld => self.mag.set_faults(
                MagFaults {
                    gone: self.faults.has(Fault::MagGone),
                    bus_held: self.faults.has(Fault::I2cHeld),
                },
                self.now,
            ),
            Fault::Motor0Gone | Fault::Motor0Frozen => {
                self.set_esc_faults(0, Fault::Motor0Gone, Fault::Motor0Frozen);
            }
            Fault::Motor1Gone | Fault::Motor1Frozen => {
                self.set_esc_faults(1, Fault::Motor1Gone, Fault::Motor1Frozen);
            }
            _ => {}
        }
        Ok(())
    }

    fn set_esc_faults(&mut self, wheel: usize, gone: Fault, frozen: Fault) {
        self.escs[wheel].set_faults(EscFaults {
            gone: self.faults.has(gone),
            frozen: self.faults.has(frozen),
        });
    }

    pub fn faults() -> &'static [FaultInfo] {
        faults::INFO
    }

    /// Attitude error of `q_wxyz` (body → ENU earth) against truth or the recording's reference, in degrees:
    /// `[total, heading, inclination]`; `None` in a gap of the reference and for a quaternion that is none.
    pub fn attitude_error_deg(&self, q_wxyz: [f64; 4]) -> Option<[f64; 3]> {
        attitude::error_deg(q_wxyz, self.true_attitude()?)
    }

    pub(super) fn true_attitude(&self) -> Option<Quaternion> {
        match &self.playback {
            Some(playback) => playback.reference(self.now),
            None => Some(attitude::from_yaw(self.body.pose().yaw_rad)),
        }
    }
}
