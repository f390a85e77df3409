//! Peripherals' signals on their pins: muxed as the schematic wants them, with an output stage that can drive them.

use crate::soc::{
    peripheral::Ctx,
    pins::{Outside, Pin, PinMode, PinSettings, Pull},
};

/// A peripheral's signal that the board routes to a device or connector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Signal {
    Spi1Sck,
    Spi1Miso,
    Spi1Mosi,
    I2c3Scl,
    I2c3Sda,
    Usart1Tx,
    Usart3Rx,
    Usart6Tx,
    Can1Tx,
    Can1Rx,
    Can2Tx,
    Can2Rx,
    Adc3In8,
}

/// What the signal asks of the pin's output stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// The board drives it.
    None,
    /// Edges of a few ns to 100 ns: push-pull.
    Fast,
    /// Bits of µs: push-pull, or open-drain with a pull-up.
    Slow,
    /// Others pull it down too: open-drain.
    Shared,
}

/// Where the schematic wants a signal, and what is missing when it is not there.
struct Route {
    name: &'static str,
    pin: Pin,
    mode: PinMode,
    stage: Stage,
    consequence: &'static str,
}

#[rustfmt::skip]
fn route(signal: Signal) -> Route {
    use Stage::{Fast, None, Shared, Slow};
    let (name, pin, mode, stage, consequence) = match signal {
        Signal::Spi1Sck => ("SPI1_SCK", Pin::new('B', 3), af(5), Fast, "the BMI088 gets no clock"),
        Signal::Spi1Miso => ("SPI1_MISO", Pin::new('B', 4), af(5), None, "nothing of the BMI088 is heard"),
        Signal::Spi1Mosi => ("SPI1_MOSI", Pin::new('A', 7), af(5), Fast, "the BMI088 gets no data"),
        Signal::I2c3Scl => ("I2C3_SCL", Pin::new('A', 8), af(4), Shared, "the IST8310 gets no clock"),
        Signal::I2c3Sda => ("I2C3_SDA", Pin::new('C', 9), af(4), Shared, "the IST8310 is not connected"),
        Signal::Usart1Tx => ("USART1_TX", Pin::new('A', 9), af(7), Slow, "the PC hears nothing"),
        Signal::Usart3Rx => ("USART3_RX", Pin::new('C', 11), af(7), None, "the radio is not heard"),
        Signal::Usart6Tx => ("USART6_TX", Pin::new('G', 14), af(8), Slow, "nothing leaves the 3-pin UART"),
        Signal::Can1Tx => ("CAN1_TX", Pin::new('D', 1), af(9), Fast, "CAN1 hears nothing of the board"),
        Signal::Can1Rx => ("CAN1_RX", Pin::new('D', 0), af(9), None, "the board hears nothing of CAN1"),
        Signal::Can2Tx => ("CAN2_TX", Pin::new('B', 6), af(9), Fast, "CAN2 hears nothing of the board"),
        Signal::Can2Rx => ("CAN2_RX", Pin::new('B', 5), af(9), None, "the board hears nothing of CAN2"),
        Signal::Adc3In8 => (
            "ADC3_IN8", Pin::new('F', 10), PinMode::Analog, None, "the battery voltage is not seen",
        ),
    };
    Route { name, pin, mode, stage, consequence }
}

const fn af(number: u8) -> PinMode {
    PinMode::Alternate(number)
}

/// True where the signal's pin is set up so that the signal gets through; otherwise files a board error.
pub fn check(signal: Signal, ctx: &mut Ctx<'_>) -> bool {
    let route = route(signal);
    let found = ctx.pins.settings(route.pin);
    let (is, needed) = if found.mode != route.mode {
        (mode_name(found.mode), mode_name(route.mode))
    } else if let Some(misfit) = stage_misfit(route.stage, found, ctx.pins.outside(route.pin)) {
        (misfit.0.to_owned(), misfit.1.to_owned())
    } else {
        return true;
    };
    let message = format!(
        "{}: {} is {is}, needs {needed}: {}",
        route.name, route.pin, route.consequence
    );
    ctx.errors.report(ctx.now, message);
    false
}

/// What the output stage is and should be, where it cannot drive the signal. 40 kΩ and the 30 pF of a pin, its track and
/// an input make edges of more than a µs.
fn stage_misfit(
    stage: Stage,
    pin: PinSettings,
    outside: Outside,
) -> Option<(&'static str, &'static str)> {
    let pulled_up = outside == Outside::PullUp || pin.pull == Pull::Up;
    match stage {
        // A push-pull stage would drive against whoever pulls the line down (RM0090 27.3.2).
        Stage::Shared if !pin.open_drain => Some(("push-pull", "open-drain")),
        Stage::Fast if pin.open_drain && pulled_up => {
            Some(("open-drain and rises too slowly by a resistor", "push-pull"))
        }
        Stage::Shared | Stage::Fast | Stage::Slow if pin.open_drain && !pulled_up => {
            Some(("open-drain without a pull-up and never rises", "push-pull"))
        }
        _ => None,
    }
}

/// Slowest setting of OSPEEDR: 4 MHz into 50 pF, 8 MHz into 10 pF (STM32F407 datasheet, table of I/O AC
/// characteristics).
const SLOW_STAGE_HZ: u32 = 4_000_000;
const SLOW_STAGE_LIGHT_LOAD_HZ: u32 = 8_000_000;

/// Complains of an output stage too slow for a square wave of `hz`.
pub fn check_speed(signal: Signal, hz: u32, ctx: &mut Ctx<'_>) {
    let route = route(signal);
    if ctx.pins.settings(route.pin).speed > 0 || hz <= SLOW_STAGE_HZ {
        return;
    }
    let message = format!(
        "{}: {} switches {hz} Hz at OSPEEDR = 0, made for {SLOW_STAGE_HZ} Hz",
        route.name, route.pin
    );
    if hz > SLOW_STAGE_LIGHT_LOAD_HZ {
        ctx.errors.report(ctx.now, message);
    } else {
        ctx.errors.suspect(ctx.now, message);
    }
}

pub(super) fn mode_name(mode: PinMode) -> String {
    match mode {
        PinMode::Input => "an input".to_owned(),
        PinMode::Output => "an output".to_owned(),
        PinMode::Alternate(number) => format!("AF{number}"),
        PinMode::Analog => "analog".to_owned(),
    }
}
