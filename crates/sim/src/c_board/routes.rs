//! Where the schematic routes the chip's signals.

use robot_emulator::soc::{
    pins::Pin,
    signals::{Route, Signal, Stage},
};

#[rustfmt::skip]
pub(super) fn route(signal: Signal) -> Route {
    use Stage::{Fast, None, Shared, Slow};
    let (pin, stage, consequence) = match signal {
        Signal::Spi1Sck => (Pin::new('B', 3), Fast, "the BMI088 gets no clock"),
        Signal::Spi1Miso => (Pin::new('B', 4), None, "nothing of the BMI088 is heard"),
        Signal::Spi1Mosi => (Pin::new('A', 7), Fast, "the BMI088 gets no data"),
        Signal::I2c3Scl => (Pin::new('A', 8), Shared, "the IST8310 gets no clock"),
        Signal::I2c3Sda => (Pin::new('C', 9), Shared, "the IST8310 is not connected"),
        Signal::Usart1Tx => (Pin::new('A', 9), Slow, "the PC hears nothing"),
        Signal::Usart1Rx => (Pin::new('B', 7), None, "the PC is not heard"),
        Signal::Usart3Rx => (Pin::new('C', 11), None, "the radio is not heard"),
        Signal::Usart6Tx => (Pin::new('G', 14), Slow, "nothing leaves the 3-pin UART"),
        Signal::Usart6Rx => (Pin::new('G', 9), None, "nothing comes in by the 3-pin UART"),
        Signal::Can1Tx => (Pin::new('D', 1), Fast, "CAN1 hears nothing of the board"),
        Signal::Can1Rx => (Pin::new('D', 0), None, "the board hears nothing of CAN1"),
        Signal::Can2Tx => (Pin::new('B', 6), Fast, "CAN2 hears nothing of the board"),
        Signal::Can2Rx => (Pin::new('B', 5), None, "the board hears nothing of CAN2"),
        Signal::Adc3In8 => (Pin::new('F', 10), None, "the battery voltage is not seen"),
    };
    Route { pin, stage, consequence }
}
