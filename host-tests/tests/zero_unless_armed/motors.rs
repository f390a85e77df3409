//! Six simulated motors, each with a given behaviour.

use crate::wire::{JointFrame, Make, Motion};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Behaviour {
    Good,
    Gone,
    /// Repeats its first report.
    Frozen,
    /// °C.
    Hot(u8),
    /// Joints: fault code, 8 to 15.
    Fault(u8),
    /// Joints: answers as if it were disabled, or as if it were enabled.
    Claims(bool),
    /// Joints: angle in motor coordinates.
    At(f32),
    Garbage([u8; 8]),
}

#[derive(Clone, Copy, Debug)]
pub struct JointMotor {
    number: u8,
    make: Make,
    enabled: bool,
    fault: u8,
    control_mode: u32,
    timeout: u32,
    torque_nm: f32,
    pos_rad: f32,
}

impl JointMotor {
    pub fn new(number: u8, make: Make) -> Self {
        Self {
            number,
            make,
            enabled: false,
            fault: 0,
            control_mode: 1,
            timeout: 0,
            torque_nm: 0.0,
            pos_rad: 0.0,
        }
    }

    /// The motor's reply, identifier first.
    pub fn hear(&mut self, frame: JointFrame, behaviour: Behaviour) -> Option<(u16, [u8; 8])> {
        let reply_id = match self.make {
            Make::Dm4310 => 0x10 + u16::from(self.number),
            Make::Rs00 => 0xF0 + u16::from(self.number),
        };
        match behaviour {
            Behaviour::Gone => return None,
            Behaviour::Fault(code) => self.fault = code,
            Behaviour::At(pos_rad) => self.pos_rad = pos_rad,
            _ => {}
        }
        self.obey(frame);
        let data = match (behaviour, frame) {
            (Behaviour::Garbage(data), _) => data,
            (_, JointFrame::ReadRegister(register)) => self.register(register, 0x33),
            (_, JointFrame::WriteRegister(register, _)) => self.register(register, 0x55),
            (_, JointFrame::ReadFaults) => {
                [self.number, u8::from(self.fault != 0), 0, 0, 0, 0, 0, 0]
            }
            _ => self.report(behaviour),
        };
        Some((reply_id, data))
    }

    fn obey(&mut self, frame: JointFrame) {
        match frame {
            JointFrame::Enable => self.enabled = self.fault == 0,
            JointFrame::Disable => self.enabled = false,
            JointFrame::ClearFault => self.fault = 0,
            JointFrame::WriteRegister(9, value) => self.timeout = value,
            JointFrame::WriteRegister(10, value) => self.control_mode = value,
            _ => {}
        }
        self.enabled &= self.fault == 0;
        self.torque_nm = match frame {
            JointFrame::Mit(mit) if self.enabled => mit.asked_nm(Motion {
                pos_rad: self.pos_rad,
                vel_rps: 0.0,
            }),
            _ => 0.0,
        };
    }

    fn register(&self, register: u8, order: u8) -> [u8; 8] {
        let value = match register {
            9 => self.timeout,
            10 => self.control_mode,
            0x15 => 12.5f32.to_bits(),
            0x16 => 30.0f32.to_bits(),
            0x17 => 10.0f32.to_bits(),
            _ => 0,
        };
        let [a, b, c, d] = value.to_le_bytes();
        [self.number, 0, order, register, a, b, c, d]
    }

    fn report(&self, behaviour: Behaviour) -> [u8; 8] {
        let position = self.make.position_code(self.pos_rad).to_be_bytes();
        let torque = self.make.torque_code(self.torque_nm.clamp(-10.0, 10.0));
        let [torque_h, torque_l] = torque.to_be_bytes();
        let celsius = match behaviour {
            Behaviour::Hot(celsius) => celsius,
            _ => 35,
        };
        // A frozen motor reports 1 rad/s at a constant angle.
        let velocity: u16 = if behaviour == Behaviour::Frozen {
            2_116
        } else {
            2_048
        };
        let [velocity_h, velocity_l] = (velocity << 4).to_be_bytes();
        let enabled = match behaviour {
            Behaviour::Claims(enabled) => enabled,
            _ => self.enabled,
        };
        let [first, sixth, last] = match self.make {
            Make::Dm4310 => {
                let status = if self.fault != 0 {
                    self.fault
                } else {
                    u8::from(enabled)
                };
                [status << 4 | self.number, celsius, celsius]
            }
            Make::Rs00 => {
                let fault = if self.fault != 0 { 0x20 } else { 0 };
                let [high, low] = (u16::from(celsius) * 10).to_be_bytes();
                [self.number, fault | high, low]
            }
        };
        [
            first,
            position[0],
            position[1],
            velocity_h,
            velocity_l | torque_h,
            torque_l,
            sixth,
            last,
        ]
    }
}

/// An M3508 whose rotor turns slowly and whose current is the commanded one.
#[derive(Clone, Copy, Debug, Default)]
pub struct WheelMotor {
    angle: u16,
}

impl WheelMotor {
    /// Advances by one millisecond with this commanded current in counts.
    pub fn report(&mut self, counts: i32, behaviour: Behaviour) -> Option<[u8; 8]> {
        let [current_h, current_l] = (counts as i16).to_be_bytes();
        self.angle = (self.angle + 8) % 8_192;
        let [angle_h, angle_l] = self.angle.to_be_bytes();
        let turning = [angle_h, angle_l, 0, 60, current_h, current_l];
        let [a, b, c, d, e, f] = turning;
        match behaviour {
            Behaviour::Gone => None,
            Behaviour::Frozen => Some([0x12, 0x34, 3, 0xE8, 0, 0, 40, 0]),
            Behaviour::Hot(celsius) => Some([a, b, c, d, e, f, celsius, 0]),
            Behaviour::Garbage(data) => Some(data),
            _ => Some([a, b, c, d, e, f, 40, 0]),
        }
    }
}
