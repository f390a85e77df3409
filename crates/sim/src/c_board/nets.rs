//! Resistors and devices that give the chip's pins a level.

use robot_emulator::soc::pins::{ExternalConnection, Pin, PinBank};
use robot_plant::world::World;

const MAG_DRDY: Pin = Pin::new('G', 3);
const USER_KEY: Pin = Pin::new('A', 0);
/// RXD of the 4-pin UART2, which has no pull-up.
const LINK_RX: Pin = Pin::new('B', 7);

/// I2C3 (4.7 kΩ), the key (10 kΩ), and both lines of the 3-pin UART (4.7 kΩ).
const PULLED_UP: [Pin; 5] = [
    Pin::new('A', 8),
    Pin::new('C', 9),
    USER_KEY,
    Pin::new('G', 14),
    Pin::new('G', 9),
];

/// Outputs of the radio's inverter (4.7 kΩ to 3.3 V) and of both CAN transceivers, which are high while their lines idle.
const RESTING_HIGH: [Pin; 3] = [Pin::new('C', 11), Pin::new('D', 0), Pin::new('B', 5)];

/// Connects everything that gives a pin its level from power-on.
pub fn connect(pins: &mut PinBank) {
    for pin in PULLED_UP {
        pins.connect(pin, ExternalConnection::PullUp);
    }
    for pin in RESTING_HIGH {
        pins.connect(pin, ExternalConnection::Drives(true));
    }
}

/// Whether a device of the model drives the pin. The BMI088's interrupt pins (PC4, PC5) are not modelled.
pub fn drives_input(pin: Pin) -> bool {
    matches!(pin, MAG_DRDY | USER_KEY | LINK_RX)
}

/// Sets the levels that devices now drive onto the chip's pins.
pub fn drive_inputs(pins: &mut PinBank, world: &World) {
    pins.connect(MAG_DRDY, ExternalConnection::Drives(world.mag_drdy_pin()));
    let key = if world.user_key_pin() {
        ExternalConnection::PullUp
    } else {
        ExternalConnection::Drives(false)
    };
    pins.connect(USER_KEY, key);
    let link = world
        .link_rx_pin()
        .map_or(ExternalConnection::Nothing, ExternalConnection::Drives);
    pins.connect(LINK_RX, link);
}
