//! The faults outside of the chip, by name.

/// A fault that a scenario can start and end.
#[derive(Clone, Copy, Debug)]
pub struct FaultInfo {
    /// Name in scenarios, such as `imu-gone`.
    pub name: &'static str,
    /// One sentence: what is broken, and what happens at the end of the fault.
    pub what: &'static str,
}

macro_rules! faults {
    ($($fault:ident $name:literal $what:literal,)*) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum Fault { $($fault),* }

        const ALL: &[Fault] = &[$(Fault::$fault),*];

        pub(crate) const INFO: &[FaultInfo] = &[$(FaultInfo { name: $name, what: $what }),*];
    };
}

faults! {
    SbusSilent "sbus-silent" "radio receiver unplugged: no character more, even within a frame",
    SbusFailsafe "sbus-failsafe" "receiver lost the transmitter: failsafe and frame-lost flags, last sticks held (DBUS: silence)",
    SbusFrameLost "sbus-frame-lost" "receiver misses packets: frame-lost flag, last sticks held (DBUS: silence)",
    SbusLoss10 "sbus-loss-10" "10 % of the radio frames lost: half of them flagged with the last sticks held, half missing (DBUS: all missing)",
    SbusLoss20 "sbus-loss-20" "20 % of the radio frames lost: half of them flagged with the last sticks held, half missing (DBUS: all missing)",
    SbusLoss30 "sbus-loss-30" "30 % of the radio frames lost: half of them flagged with the last sticks held, half missing (DBUS: all missing)",
    SbusLoss40 "sbus-loss-40" "40 % of the radio frames lost: half of them flagged with the last sticks held, half missing (DBUS: all missing)",
    SbusLoss50 "sbus-loss-50" "50 % of the radio frames lost: half of them flagged with the last sticks held, half missing (DBUS: all missing)",
    SbusLoss60 "sbus-loss-60" "60 % of the radio frames lost: half of them flagged with the last sticks held, half missing (DBUS: all missing)",
    SbusLoss70 "sbus-loss-70" "70 % of the radio frames lost: half of them flagged with the last sticks held, half missing (DBUS: all missing)",
    SbusLoss80 "sbus-loss-80" "80 % of the radio frames lost: half of them flagged with the last sticks held, half missing (DBUS: all missing)",
    SbusLoss90 "sbus-loss-90" "90 % of the radio frames lost: half of them flagged with the last sticks held, half missing (DBUS: all missing)",
    SbusNoise "sbus-noise" "bit errors, swallowed and stray characters on the radio line",
    LinkCut "link-cut" "serial cable to the PC cut: no character more either way, even within a frame",
    LinkCutDown "link-cut-down" "wire from the PC to the board cut: the PC hears the robot, but not the other way round",
    LinkCutUp "link-cut-up" "wire from the board to the PC cut: the robot hears the PC, but not the other way round",
    LinkNoise "link-noise" "bit errors, swallowed and stray characters and missing stop bits on the serial link, both ways",
    LinkFlood "link-flood" "random characters at full rate on the line from the PC to the board, in place of the PC's frames",
    LinkBreak "link-break" "line from the PC to the board held low, but for an instant every 50 ms",
    PcFrozen "pc-frozen" "PC repeats its last frame",
    PcExtremes "pc-extremes" "PC sends frames whose fields are all at an end of their range, drawn anew for each frame",
    ImuGone "imu-gone" "BMI088 without supply: MISO reads 0xFF; at the end it powers up anew",
    ImuFrozen "imu-frozen" "BMI088 answers, but its data registers never change",
    ImuExtreme "imu-extreme" "BMI088's data registers jump between the ends of their range",
    GyroFifoShift "gyro-fifo-shift" "the gyro's FIFO slips by one axis, so that X shows Z, Y shows X, Z shows Y, until it is switched off and on; in STREAM mode it slips again about once a second",
    GyroSpike "gyro-spike" "one gyro sample in fifty has -32768 on all axes, in the FIFO and in the data registers",
    MagGone "mag-gone" "IST8310 without supply: no acknowledge; at the end it powers up anew",
    I2cHeld "i2c-held" "a device holds SDA of I2C3 low",
    Can1Broken "can1-broken" "CAN1 shorted: every frame ends in a bit error",
    Can2Broken "can2-broken" "CAN2 shorted: every frame ends in a bit error",
    Can1Empty "can1-empty" "CAN1 plug pulled: nobody there to acknowledge",
    Can2Empty "can2-empty" "CAN2 plug pulled: nobody there to acknowledge",
    Motor0Gone "motor-0-gone" "left C620 without supply: no torque, no feedback; at the end it powers up anew",
    Motor0Frozen "motor-0-frozen" "left C620 repeats its last feedback; the motor still obeys",
    Motor0Hot "motor-0-hot" "left C620 has a winding at 120 °C, and says so",
    Motor0WrongId "motor-0-wrong-id" "left C620 restarts as ESC 5: hears no command, feeds back as 0x205",
    Motor0Doubled "motor-0-doubled" "right C620 restarts with the number of the left one: both obey it and feed back as 0x201",
    Motor1Gone "motor-1-gone" "right C620 without supply: no torque, no feedback; at the end it powers up anew",
    Motor1Frozen "motor-1-frozen" "right C620 repeats its last feedback; the motor still obeys",
    Motor1Hot "motor-1-hot" "right C620 has a winding at 120 °C, and says so",
    Motor1WrongId "motor-1-wrong-id" "right C620 restarts as ESC 6: hears no command, feeds back as 0x206",
    Motor1Doubled "motor-1-doubled" "left C620 restarts with the number of the right one: both obey it and feed back as 0x202",
    Motor2Gone "motor-2-gone" "left front joint without supply: no torque, no feedback; at the end it powers up anew",
    Motor2Frozen "motor-2-frozen" "left front joint repeats its last feedback; the motor still obeys",
    Motor2Hot "motor-2-hot" "left front joint has a winding at 120 °C, and says so",
    Motor2WrongId "motor-2-wrong-id" "left front joint restarts with identifiers 8 too high: hears no command",
    Motor2Tripped "motor-2-fault" "left front joint finds a fault in its driver and goes limp (DM4310: over-current) until it is cleared after the end",
    Motor3Gone "motor-3-gone" "left rear joint without supply: no torque, no feedback; at the end it powers up anew",
    Motor3Frozen "motor-3-frozen" "left rear joint repeats its last feedback; the motor still obeys",
    Motor3Hot "motor-3-hot" "left rear joint has a winding at 120 °C, and says so",
    Motor3WrongId "motor-3-wrong-id" "left rear joint restarts with identifiers 8 too high: hears no command",
    Motor3Tripped "motor-3-fault" "left rear joint finds a fault in its driver and goes limp (DM4310: over-current) until it is cleared after the end",
    Motor4Gone "motor-4-gone" "right front joint without supply: no torque, no feedback; at the end it powers up anew",
    Motor4Frozen "motor-4-frozen" "right front joint repeats its last feedback; the motor still obeys",
    Motor4Hot "motor-4-hot" "right front joint has a winding at 120 °C, and says so",
    Motor4WrongId "motor-4-wrong-id" "right front joint restarts with identifiers 8 too high: hears no command",
    Motor4Tripped "motor-4-fault" "right front joint finds a fault in its driver and goes limp (DM4310: over-current) until it is cleared after the end",
    Motor5Gone "motor-5-gone" "right rear joint without supply: no torque, no feedback; at the end it powers up anew",
    Motor5Frozen "motor-5-frozen" "right rear joint repeats its last feedback; the motor still obeys",
    Motor5Hot "motor-5-hot" "right rear joint has a winding at 120 °C, and says so",
    Motor5WrongId "motor-5-wrong-id" "right rear joint restarts with identifiers 8 too high: hears no command",
    Motor5Tripped "motor-5-fault" "right rear joint finds a fault in its driver and goes limp (DM4310: over-current) until it is cleared after the end",
    JointWritesSlow "joint-writes-slow" "DM4310 joints are deaf and mute for 150 ms after a register write, as one was measured through a USB adapter",
    RogueNodeCan1 "rogue-node-can1" "a node on CAN1 sends id 0x000 whenever the bus is free",
    RogueNodeCan2 "rogue-node-can2" "a node on CAN2 sends id 0x000 whenever the bus is free",
    BatteryLow "battery-low" "battery at 20.5 V instead of 24 V",
    BatteryEmpty "battery-empty" "battery at 18.5 V instead of 24 V",
    VddaHigh "vdda-high" "the board's 3.3 V supply, to which the converters compare, is at 3.4 V",
    VddaLow "vdda-low" "the board's 3.3 V supply, to which the converters compare, is at 3.2 V",
    Tilted "tilted" "body falls forward to 80°, and is put upright at the end (not while a recording plays)",
    Blow "blow" "body is struck: nose down by 35° at 3500 °/s, beyond the gyro's range; it is put upright at the end (not while a recording plays)",
    FloorSlippery "floor-slippery" "floor like wet ice: the wheels spin when they push, and slide when they brake (plant rolling)",
}

/// The faults that are in force.
#[derive(Clone, Debug)]
pub(crate) struct ActiveFaults {
    active: [bool; ALL.len()],
}

impl Default for ActiveFaults {
    fn default() -> Self {
        Self {
            active: [false; ALL.len()],
        }
    }
}

impl ActiveFaults {
    pub(crate) fn set(&mut self, fault: Fault, active: bool) {
        self.active[fault as usize] = active;
    }

    pub(crate) fn has(&self, fault: Fault) -> bool {
        self.active[fault as usize]
    }
}

/// The faults of one motor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotorFaults {
    pub gone: Fault,
    pub frozen: Fault,
    pub hot: Fault,
    pub wrong_id: Fault,
    /// Fault of the driver; joints only.
    pub fault: Option<Fault>,
}

macro_rules! motor_faults {
    ($($gone:ident $frozen:ident $hot:ident $wrong_id:ident $fault:expr,)*) => {
        [$(MotorFaults {
            gone: Fault::$gone,
            frozen: Fault::$frozen,
            hot: Fault::$hot,
            wrong_id: Fault::$wrong_id,
            fault: $fault,
        }),*]
    };
}

/// Wheels left and right, then the joints.
#[rustfmt::skip]
pub(crate) const MOTORS: [MotorFaults; 6] = motor_faults![
    Motor0Gone Motor0Frozen Motor0Hot Motor0WrongId None,
    Motor1Gone Motor1Frozen Motor1Hot Motor1WrongId None,
    Motor2Gone Motor2Frozen Motor2Hot Motor2WrongId Some(Fault::Motor2Tripped),
    Motor3Gone Motor3Frozen Motor3Hot Motor3WrongId Some(Fault::Motor3Tripped),
    Motor4Gone Motor4Frozen Motor4Hot Motor4WrongId Some(Fault::Motor4Tripped),
    Motor5Gone Motor5Frozen Motor5Hot Motor5WrongId Some(Fault::Motor5Tripped),
];

impl MotorFaults {
    pub(crate) fn includes(&self, fault: Fault) -> bool {
        [self.gone, self.frozen, self.hot, self.wrong_id].contains(&fault)
            || self.fault == Some(fault)
    }
}

/// Share of the radio's frames that each fault loses.
pub(crate) const RADIO_LOSSES: [(Fault, f64); 9] = [
    (Fault::SbusLoss10, 0.1),
    (Fault::SbusLoss20, 0.2),
    (Fault::SbusLoss30, 0.3),
    (Fault::SbusLoss40, 0.4),
    (Fault::SbusLoss50, 0.5),
    (Fault::SbusLoss60, 0.6),
    (Fault::SbusLoss70, 0.7),
    (Fault::SbusLoss80, 0.8),
    (Fault::SbusLoss90, 0.9),
];

pub(crate) fn by_name(name: &str) -> Option<Fault> {
    let index = INFO.iter().position(|info| info.name == name)?;
    ALL.get(index).copied()
}
