//! Everything that can go wrong outside the chip, by name.

use crate::world::FaultInfo;

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
    SbusNoise "sbus-noise" "bit errors, swallowed and stray characters on the radio line",
    ImuGone "imu-gone" "BMI088 without supply: MISO reads 0xFF; at the end it powers up anew",
    ImuFrozen "imu-frozen" "BMI088 answers, but its data registers never change",
    MagGone "mag-gone" "IST8310 without supply: no acknowledge; at the end it powers up anew",
    I2cHeld "i2c-held" "a device holds SDA of I2C3 low",
    Can1Broken "can1-broken" "CAN1 shorted: every frame ends in a bit error",
    Can2Broken "can2-broken" "CAN2 shorted: every frame ends in a bit error",
    Can1Empty "can1-empty" "CAN1 plug pulled: nobody there to acknowledge",
    Can2Empty "can2-empty" "CAN2 plug pulled: nobody there to acknowledge",
    Motor0Gone "motor-0-gone" "left C620 without supply: no torque, no feedback",
    Motor1Gone "motor-1-gone" "right C620 without supply: no torque, no feedback",
    Motor0Frozen "motor-0-frozen" "left C620 repeats its last feedback; the motor still obeys",
    Motor1Frozen "motor-1-frozen" "right C620 repeats its last feedback; the motor still obeys",
    RogueNodeCan1 "rogue-node-can1" "a node on CAN1 sends id 0x000 whenever the bus is free",
    RogueNodeCan2 "rogue-node-can2" "a node on CAN2 sends id 0x000 whenever the bus is free",
    BatteryLow "battery-low" "battery at 19.2 V instead of 24 V",
}

/// Which faults are there now.
#[derive(Clone, Debug, Default)]
pub(crate) struct ActiveFaults {
    active: [bool; ALL.len()],
}

impl ActiveFaults {
    pub(crate) fn set(&mut self, fault: Fault, active: bool) {
        self.active[fault as usize] = active;
    }

    pub(crate) fn has(&self, fault: Fault) -> bool {
        self.active[fault as usize]
    }
}

pub(crate) fn by_name(name: &str) -> Option<Fault> {
    let index = INFO.iter().position(|info| info.name == name)?;
    ALL.get(index).copied()
}
