//! Decoding of frames as the motors do it: docs/hardware.md#c620-and-m3508, docs/hardware.md#dm4310 and
//! docs/hardware.md#rs00. It is independent of the firmware's own codecs.

use robot_app::domain::{BusId, CanFrame};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Make {
    Dm4310,
    Rs00,
}

impl Make {
    /// Full scale of position, velocity and torque in an MIT frame.
    fn ranges(self) -> [f32; 3] {
        match self {
            Self::Dm4310 => [12.5, 30.0, 10.0],
            Self::Rs00 => [12.57, 33.0, 14.0],
        }
    }

    pub fn position_code(self, rad: f32) -> u16 {
        let [range, ..] = self.ranges();
        ((rad + range) / (2.0 * range) * 65_535.0) as u16
    }

    pub fn motion(self, reply: [u8; 8]) -> Motion {
        let [_, p_h, p_l, v_h, v_l, ..] = reply;
        let [p, v, _] = self.ranges();
        let position = u16::from_be_bytes([p_h, p_l]);
        let velocity = u16::from_be_bytes([v_h, v_l]) >> 4;
        Motion {
            pos_rad: f32::from(position) / 65_535.0 * 2.0 * p - p,
            vel_rps: f32::from(velocity) / 4_095.0 * 2.0 * v - v,
        }
    }

    pub fn torque_code(self, nm: f32) -> u16 {
        let [.., range] = self.ranges();
        ((nm + range) / (2.0 * range) * 4_095.0).round() as u16
    }
}

/// Motor coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    pub pos_rad: f32,
    pub vel_rps: f32,
}

/// Motor coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mit {
    pub pos_rad: f32,
    pub vel_rps: f32,
    pub kp: f32,
    pub kd: f32,
    pub torque_nm: f32,
}

impl Mit {
    fn unpack(data: [u8; 8], make: Make) -> Self {
        let bits = u64::from_be_bytes(data);
        let field = |shift: u32, width: u32, low: f32, high: f32| {
            let max = (1u64 << width) - 1;
            let code = (bits >> shift) & max;
            code as f32 * (high - low) / max as f32 + low
        };
        let [p, v, t] = make.ranges();
        Self {
            pos_rad: field(48, 16, -p, p),
            vel_rps: field(36, 12, -v, v),
            kp: field(24, 12, 0.0, 500.0),
            kd: field(12, 12, 0.0, 5.0),
            torque_nm: field(0, 12, -t, t),
        }
    }

    /// Torque that a motor with this motion computes from the command.
    pub fn asked_nm(&self, motion: Motion) -> f32 {
        let Motion { pos_rad, vel_rps } = motion;
        self.kp * (self.pos_rad - pos_rad) + self.kd * (self.vel_rps - vel_rps) + self.torque_nm
    }

    /// Part of that torque that may come from the resolution of the codes.
    pub fn steps_nm(&self, motion: Motion, make: Make) -> f32 {
        let [p, v, t] = make.ranges();
        let Motion { pos_rad, vel_rps } = motion;
        let gains = 500.0 / 4_095.0 * (self.pos_rad - pos_rad).abs()
            + 5.0 / 4_095.0 * (self.vel_rps - vel_rps).abs();
        let targets = self.kp * 2.0 * p / 65_535.0 + self.kd * 2.0 * v / 4_095.0;
        gains + targets + 2.0 * t / 4_095.0
    }

    /// No gains, and a torque code next to zero.
    pub fn is_off(&self, make: Make) -> bool {
        let [.., range] = make.ranges();
        self.kp == 0.0 && self.kd == 0.0 && self.torque_nm.abs() < range / 4_000.0
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointFrame {
    Disable,
    Enable,
    ClearFault,
    Mit(Mit),
    PositionSpeed {
        pos_rad: f32,
        max_rps: f32,
    },
    /// For an RS00 also a current limit in A.
    Speed {
        vel_rps: f32,
    },
    ReadRegister(u8),
    WriteRegister(u8, u32),
    /// RS00.
    SetMode(u8),
    /// RS00.
    ReadFaults,
}

impl JointFrame {
    /// Whether the frame can neither enable a motor nor move a disabled one.
    pub fn is_harmless(self) -> bool {
        match self {
            Self::Disable | Self::ClearFault | Self::ReadRegister(_) | Self::ReadFaults => true,
            // Time-out 100 ms; control mode MIT, position-speed or speed.
            Self::WriteRegister(9, counts) => counts == 2_000,
            Self::WriteRegister(10, mode) => (1..=3).contains(&mode),
            Self::SetMode(mode) => mode <= 2,
            _ => false,
        }
    }

    /// Stiffness of a MIT command.
    pub fn stiffness(self) -> Option<f32> {
        match self {
            Self::Mit(mit) => Some(mit.kp),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sent {
    /// Counts for speed controllers 1 to 4.
    Wheels([i32; 4]),
    /// Joint 0 to 3.
    Joint(usize, JointFrame),
    TuningReply([u8; 8]),
}

/// Decodes a frame. Panics if it does not belong on this bus.
pub fn understand((bus, frame): &(BusId, CanFrame), make: Make) -> Sent {
    let id = frame.id().raw();
    let data = frame.full_payload().expect("eight bytes");
    let [a, b, c, d, e, f, g, h] = data;
    let floats = [
        f32::from_le_bytes([a, b, c, d]),
        f32::from_le_bytes([e, f, g, h]),
    ];
    match (*bus, id) {
        (_, 0x7A2) => Sent::TuningReply(data),
        (BusId::Can1, 0x200) => Sent::Wheels(std::array::from_fn(|slot| {
            i16::from_be_bytes([data[2 * slot], data[2 * slot + 1]]).into()
        })),
        (BusId::Can2, 0x001..=0x004) => {
            Sent::Joint(usize::from(id) - 1, special_or_mit(data, make))
        }
        (BusId::Can2, 0x101..=0x104) => {
            let [pos_rad, max_rps] = floats;
            let frame = JointFrame::PositionSpeed { pos_rad, max_rps };
            Sent::Joint(usize::from(id) - 0x101, frame)
        }
        (BusId::Can2, 0x201..=0x204) => {
            let [vel_rps, _] = floats;
            Sent::Joint(usize::from(id) - 0x201, JointFrame::Speed { vel_rps })
        }
        (BusId::Can2, 0x7FF) if make == Make::Dm4310 && (1..=4).contains(&a) && b == 0 => {
            let frame = match c {
                0x33 => JointFrame::ReadRegister(d),
                0x55 => JointFrame::WriteRegister(d, u32::from_le_bytes([e, f, g, h])),
                _ => panic!("register order {data:02X?}"),
            };
            Sent::Joint(usize::from(a) - 1, frame)
        }
        _ => panic!("{frame:?} on {bus:?}"),
    }
}

fn special_or_mit(data: [u8; 8], make: Make) -> JointFrame {
    let [first @ .., sixth, last] = data;
    if first != [0xFF; 6] {
        return JointFrame::Mit(Mit::unpack(data, make));
    }
    match (make, sixth, last) {
        (_, 0xFF, 0xFC) => JointFrame::Enable,
        (_, 0xFF, 0xFD) => JointFrame::Disable,
        (_, 0xFF, 0xFB) => JointFrame::ClearFault,
        (Make::Rs00, mode, 0xFC) => JointFrame::SetMode(mode),
        (Make::Rs00, _, 0xFB) => JointFrame::ReadFaults,
        _ => panic!("special frame {data:02X?}"),
    }
}
