//! Levels and PWM waves on plain pins: chip selects, the magnetometer's reset and the loads behind MOSFETs.

use robot_emulator::{
    soc::{
        board::{Outputs, Waves},
        board_errors::BoardErrors,
        pins::{Pin, PinBank, PinMode, Pull},
        wave::Wave,
    },
    time::Ps,
};
use robot_plant::world::{SpiSelect, World};

const ACCEL_CS: Pin = Pin::new('A', 4);
const GYRO_CS: Pin = Pin::new('B', 0);
const MAG_RESET: Pin = Pin::new('G', 6);
const OFF: Wave = Wave { hz: 0.0, duty: 0.0 };

/// A MOSFET and the timer channel that can drive its gate.
struct Gate {
    name: &'static str,
    pin: Pin,
    /// TIM4, TIM5 or TIM10.
    timer: u8,
    /// Counted from 1.
    channel: u8,
    /// Alternate function of the pin that connects it to the channel.
    alternate_function: u8,
}

const fn gate(
    name: &'static str,
    pin: Pin,
    (timer, channel): (u8, u8),
    alternate_function: u8,
) -> Gate {
    Gate {
        name,
        pin,
        timer,
        channel,
        alternate_function,
    }
}

const HEATER: Gate = gate("heater", Pin::new('F', 6), (10, 1), 3);
const BUZZER: Gate = gate("buzzer", Pin::new('D', 14), (4, 3), 2);
/// Blue, green, red.
const LEDS: [Gate; 3] = [
    gate("blue LED", Pin::new('H', 10), (5, 1), 2),
    gate("green LED", Pin::new('H', 11), (5, 2), 2),
    gate("red LED", Pin::new('H', 12), (5, 3), 2),
];

/// A transfer with the IST8310 begins: its reset must not float.
pub(super) fn check_mag_reset(pins: &PinBank, errors: &mut BoardErrors, now: Ps) {
    if pins.mode(MAG_RESET) != PinMode::Output && pins.level(MAG_RESET).is_none() {
        let message = format!("{MAG_RESET} floats: whether the IST8310 leaves its reset is chance");
        errors.suspect(now, message);
    }
}

/// The levels that the chip drives onto the devices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Levels {
    accel_selected: bool,
    gyro_selected: bool,
    mag_reset_high: bool,
    heater_duty: f64,
    leds_bgr: [f64; 3],
    buzzer: Wave,
}

/// Reads the pins, and reports settings that cannot work.
struct Reader<'a> {
    pins: &'a PinBank,
    waves: &'a dyn Waves,
    errors: &'a mut BoardErrors,
    now: Ps,
}

pub(super) fn levels(outputs: &Outputs<'_>, errors: &mut BoardErrors, now: Ps) -> Levels {
    let mut reader = Reader {
        pins: outputs.pins,
        waves: outputs.waves,
        errors,
        now,
    };
    reader.levels()
}

/// Passes changes of the output pins to the devices.
pub(super) fn tell(world: &mut World, before: Option<Levels>, levels: Levels, now: Ps) {
    let changed = |field: fn(&Levels) -> bool| before.as_ref().map(field) != Some(field(&levels));
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

impl Reader<'_> {
    fn levels(&mut self) -> Levels {
        let [blue, green, red] = &LEDS;
        Levels {
            accel_selected: !self.select_high("the accelerometer's chip select", ACCEL_CS),
            gyro_selected: !self.select_high("the gyro's chip select", GYRO_CS),
            mag_reset_high: self.mag_reset_high(),
            heater_duty: self.drive(&HEATER).duty,
            leds_bgr: [
                self.drive(blue).duty,
                self.drive(green).duty,
                self.drive(red).duty,
            ],
            buzzer: self.drive(&BUZZER),
        }
    }

    /// A chip select that nothing drives yet counts as high, because no transfer takes place before it is driven.
    fn select_high(&mut self, name: &str, pin: Pin) -> bool {
        let settings = self.pins.settings(pin);
        let lets_go = settings.mode == PinMode::Output && settings.open_drain && settings.high;
        if !lets_go {
            return self.pins.level(pin).unwrap_or(true);
        }
        if settings.pull == Pull::Up {
            let message = format!("{pin} is open-drain: {name} rises by the chip's 40 kOhm only");
            self.errors.suspect(self.now, message);
            return true;
        }
        let message = format!("{pin} is open-drain, needs push-pull: {name} never rises");
        self.errors.report(self.now, message);
        false
    }

    /// No source says whether the IST8310 pulls its RSTN up itself. An undriven pin counts as high.
    fn mag_reset_high(&mut self) -> bool {
        let settings = self.pins.settings(MAG_RESET);
        if settings.mode == PinMode::Output && settings.open_drain && settings.high {
            let message = format!(
                "{MAG_RESET} is open-drain: the IST8310's reset ends only if a resistor pulls it up"
            );
            self.errors.suspect(self.now, message);
        }
        self.pins.level(MAG_RESET).unwrap_or(true)
    }

    /// The wave at a MOSFET's gate. The pull-down keeps the MOSFET off while the pin drives no high level.
    fn drive(&mut self, gate: &Gate) -> Wave {
        let settings = self.pins.settings(gate.pin);
        let by_timer = self.waves.wave(gate.timer, gate.channel).unwrap_or(OFF);
        let by_port = Wave {
            hz: 0.0,
            duty: f64::from(u8::from(settings.high)),
        };
        let (wave, reaches) = match settings.mode {
            PinMode::Output => (by_port, true),
            PinMode::Alternate(number) => (by_timer, number == gate.alternate_function),
            PinMode::Input | PinMode::Analog if by_timer.duty == 0.0 => (by_port, false),
            PinMode::Input | PinMode::Analog => (by_timer, false),
        };
        if wave.duty == 0.0 {
            return wave;
        }
        if reaches && !settings.open_drain {
            return wave;
        }
        let (name, pin) = (gate.name, gate.pin);
        let message = if reaches {
            format!("{pin} is open-drain, needs push-pull: the {name} stays off")
        } else if by_timer.duty == 0.0 {
            let found = settings.mode;
            format!("{pin} is {found}, needs an output: the {name} stays off")
        } else {
            let (timer, channel, found) = (gate.timer, gate.channel, settings.mode);
            format!(
                "TIM{timer}_CH{channel}: {pin} is {found}, needs AF{}: the {name} stays off",
                gate.alternate_function
            )
        };
        self.errors.report(self.now, message);
        OFF
    }
}
