//! The C board's schematic: which pin of the chip goes to which device (hardware sheet 1.2 and 1.3).

use robot_plant::{time::Ps, world::SpiSelect, world::World};

use crate::soc::{
    peripheral::Ctx,
    pins::{Pin, PinBank, PinMode},
    timer::{Timer, output::Wave},
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

/// Where the schematic wants a signal, and what is missing when it is not there.
struct Route {
    name: &'static str,
    pin: Pin,
    mode: PinMode,
    consequence: &'static str,
}

fn route(signal: Signal) -> Route {
    let (name, pin, mode, consequence) = match signal {
        Signal::Spi1Sck => (
            "SPI1_SCK",
            Pin::new('B', 3),
            af(5),
            "the BMI088 gets no clock",
        ),
        Signal::Spi1Miso => (
            "SPI1_MISO",
            Pin::new('B', 4),
            af(5),
            "nothing of the BMI088 is heard",
        ),
        Signal::Spi1Mosi => (
            "SPI1_MOSI",
            Pin::new('A', 7),
            af(5),
            "the BMI088 gets no data",
        ),
        Signal::I2c3Scl => (
            "I2C3_SCL",
            Pin::new('A', 8),
            af(4),
            "the IST8310 gets no clock",
        ),
        Signal::I2c3Sda => (
            "I2C3_SDA",
            Pin::new('C', 9),
            af(4),
            "the IST8310 is not connected",
        ),
        Signal::Usart1Tx => ("USART1_TX", Pin::new('A', 9), af(7), "the PC hears nothing"),
        Signal::Usart3Rx => (
            "USART3_RX",
            Pin::new('C', 11),
            af(7),
            "the radio is not heard",
        ),
        Signal::Usart6Tx => (
            "USART6_TX",
            Pin::new('G', 14),
            af(8),
            "nothing leaves the 3-pin UART",
        ),
        Signal::Can1Tx => (
            "CAN1_TX",
            Pin::new('D', 1),
            af(9),
            "CAN1 hears nothing of the board",
        ),
        Signal::Can1Rx => (
            "CAN1_RX",
            Pin::new('D', 0),
            af(9),
            "the board hears nothing of CAN1",
        ),
        Signal::Can2Tx => (
            "CAN2_TX",
            Pin::new('B', 6),
            af(9),
            "CAN2 hears nothing of the board",
        ),
        Signal::Can2Rx => (
            "CAN2_RX",
            Pin::new('B', 5),
            af(9),
            "the board hears nothing of CAN2",
        ),
        Signal::Adc3In8 => (
            "ADC3_IN8",
            Pin::new('F', 10),
            PinMode::Analog,
            "the battery voltage is not seen",
        ),
    };
    Route {
        name,
        pin,
        mode,
        consequence,
    }
}

const fn af(number: u8) -> PinMode {
    PinMode::Alternate(number)
}

/// True where the signal's pin is set up so that the signal gets through; otherwise files a board error.
pub fn check(signal: Signal, ctx: &mut Ctx<'_>) -> bool {
    let route = route(signal);
    let found = ctx.pins.mode(route.pin);
    let shared_line = matches!(signal, Signal::I2c3Scl | Signal::I2c3Sda);
    let (is, needed) = if found != route.mode {
        (mode_name(found), mode_name(route.mode))
    } else if shared_line && !ctx.pins.open_drain(route.pin) {
        // A push-pull stage would drive against whoever pulls the line down (RM0090 27.3.2).
        ("push-pull".to_owned(), "open-drain".to_owned())
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

fn mode_name(mode: PinMode) -> String {
    match mode {
        PinMode::Input => "an input".to_owned(),
        PinMode::Output => "an output".to_owned(),
        PinMode::Alternate(number) => format!("AF{number}"),
        PinMode::Analog => "analog".to_owned(),
    }
}

const ACCEL_CS: Pin = Pin::new('A', 4);
const GYRO_CS: Pin = Pin::new('B', 0);
const MAG_RESET: Pin = Pin::new('G', 6);
const MAG_DRDY: Pin = Pin::new('G', 3);
const USER_KEY: Pin = Pin::new('A', 0);
const HEATER: Pin = Pin::new('F', 6);
const BUZZER: Pin = Pin::new('D', 14);
/// Blue, green, red.
const LEDS: [Pin; 3] = [Pin::new('H', 10), Pin::new('H', 11), Pin::new('H', 12)];

/// The timers whose channels reach a device.
pub struct PwmTimers<'a> {
    /// Channel 3 is the buzzer (AF2).
    pub tim4: &'a Timer,
    /// Channels 1–3 are the LEDs (AF2).
    pub tim5: &'a Timer,
    /// Channel 1 is the heater (AF3).
    pub tim10: &'a Timer,
}

/// What the chip last drove onto the devices, so that they hear of changes only.
#[derive(Debug, Default)]
pub struct Outputs {
    last: Option<Levels>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Levels {
    accel_selected: bool,
    gyro_selected: bool,
    mag_reset_high: bool,
    heater_duty: f64,
    leds_bgr: [f64; 3],
    buzzer: Wave,
}

impl Levels {
    fn read(pins: &PinBank, timers: &PwmTimers<'_>) -> Self {
        Self {
            accel_selected: !pins.level(ACCEL_CS),
            gyro_selected: !pins.level(GYRO_CS),
            mag_reset_high: pins.level(MAG_RESET),
            heater_duty: drive(pins, HEATER, 3, timers.tim10, 0).duty,
            leds_bgr: [0, 1, 2].map(|n| drive(pins, LEDS[n], 2, timers.tim5, n).duty),
            buzzer: drive(pins, BUZZER, 2, timers.tim4, 2),
        }
    }
}

impl Outputs {
    /// Passes what changed on the output pins to the devices.
    pub fn update(&mut self, pins: &PinBank, timers: &PwmTimers<'_>, world: &mut World, now: Ps) {
        let levels = Levels::read(pins, timers);
        let before = self.last.replace(levels);
        let changed =
            |field: fn(&Levels) -> bool| before.as_ref().map(field) != Some(field(&levels));
        if changed(|l| l.accel_selected) {
            world.spi_select(SpiSelect::Accel, levels.accel_selected, now);
        }
        if changed(|l| l.gyro_selected) {
            world.spi_select(SpiSelect::Gyro, levels.gyro_selected, now);
        }
        if changed(|l| l.mag_reset_high) {
            world.set_mag_reset_pin(levels.mag_reset_high, now);
        }
        if before.map(|l| l.heater_duty) != Some(levels.heater_duty) {
            world.set_heater_duty(levels.heater_duty, now);
        }
        if before.map(|l| l.leds_bgr) != Some(levels.leds_bgr) {
            world.set_leds(levels.leds_bgr, now);
        }
        if before.map(|l| l.buzzer) != Some(levels.buzzer) {
            world.set_buzzer(levels.buzzer.hz, levels.buzzer.duty, now);
        }
    }
}

/// What a MOSFET's gate sees: its pull-down keeps it off while the pin is no output.
fn drive(pins: &PinBank, pin: Pin, timer_af: u8, timer: &Timer, channel: usize) -> Wave {
    let off = Wave { hz: 0.0, duty: 0.0 };
    match pins.mode(pin) {
        PinMode::Output => Wave {
            hz: 0.0,
            duty: f64::from(u8::from(pins.level(pin))),
        },
        PinMode::Alternate(number) if number == timer_af => timer.wave(channel).unwrap_or(off),
        _ => off,
    }
}

/// True where a device of the model drives the pin. The BMI088's interrupt pins (PC4, PC5) are not modelled.
pub fn drives_input(pin: Pin) -> bool {
    matches!(pin, MAG_DRDY | USER_KEY)
}

/// Levels that devices drive onto the chip's pins.
pub fn drive_inputs(pins: &mut PinBank, world: &World) {
    pins.set_external(MAG_DRDY, world.mag_drdy_pin());
    pins.set_external(USER_KEY, world.user_key_pin());
}
