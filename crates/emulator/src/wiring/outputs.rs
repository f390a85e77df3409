//! Chip selects, the magnetometer's reset and what hangs on MOSFETs: levels and PWM waves on plain pins.

use robot_plant::{time::Ps, world::SpiSelect, world::World};

use super::signals::mode_name;
use crate::{
    board_errors::BoardErrors,
    soc::{
        peripheral::Ctx,
        pins::{Pin, PinBank, PinMode, Pull},
        timer::{Timer, output::Wave},
    },
};

const ACCEL_CS: Pin = Pin::new('A', 4);
const GYRO_CS: Pin = Pin::new('B', 0);
const MAG_RESET: Pin = Pin::new('G', 6);
const OFF: Wave = Wave { hz: 0.0, duty: 0.0 };

/// A MOSFET and the timer channel that can drive its gate.
struct Gate {
    name: &'static str,
    pin: Pin,
    timer_name: &'static str,
    timer_af: u8,
}

const fn gate(name: &'static str, pin: Pin, timer_name: &'static str, timer_af: u8) -> Gate {
    Gate {
        name,
        pin,
        timer_name,
        timer_af,
    }
}

const HEATER: Gate = gate("heater", Pin::new('F', 6), "TIM10_CH1", 3);
const BUZZER: Gate = gate("buzzer", Pin::new('D', 14), "TIM4_CH3", 2);
/// Blue, green, red.
const LEDS: [Gate; 3] = [
    gate("blue LED", Pin::new('H', 10), "TIM5_CH1", 2),
    gate("green LED", Pin::new('H', 11), "TIM5_CH2", 2),
    gate("red LED", Pin::new('H', 12), "TIM5_CH3", 2),
];

/// The timers whose channels reach a device.
pub struct PwmTimers<'a> {
    /// Channel 3 is the buzzer.
    pub tim4: &'a Timer,
    /// Channels 1–3 are the LEDs.
    pub tim5: &'a Timer,
    /// Channel 1 is the heater.
    pub tim10: &'a Timer,
}

/// The IST8310 is talked to.
pub fn check_mag_reset(ctx: &mut Ctx<'_>) {
    if ctx.pins.mode(MAG_RESET) != PinMode::Output && ctx.pins.level(MAG_RESET).is_none() {
        let message = format!("{MAG_RESET} floats: whether the IST8310 leaves its reset is chance");
        ctx.errors.suspect(ctx.now, message);
    }
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

/// Where the pins are read, and where is complained of what cannot work.
struct Reader<'a> {
    pins: &'a PinBank,
    errors: &'a mut BoardErrors,
    now: Ps,
}

impl Outputs {
    /// Passes what changed on the output pins to the devices.
    pub fn update(
        &mut self,
        pins: &PinBank,
        timers: &PwmTimers<'_>,
        world: &mut World,
        errors: &mut BoardErrors,
        now: Ps,
    ) {
        let levels = Reader { pins, errors, now }.levels(timers);
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

impl Reader<'_> {
    fn levels(&mut self, timers: &PwmTimers<'_>) -> Levels {
        let [blue, green, red] = &LEDS;
        Levels {
            accel_selected: !self.select_high("the accelerometer's chip select", ACCEL_CS),
            gyro_selected: !self.select_high("the gyro's chip select", GYRO_CS),
            mag_reset_high: self.mag_reset_high(),
            heater_duty: self.drive(&HEATER, timers.tim10, 0).duty,
            leds_bgr: [
                self.drive(blue, timers.tim5, 0).duty,
                self.drive(green, timers.tim5, 1).duty,
                self.drive(red, timers.tim5, 2).duty,
            ],
            buzzer: self.drive(&BUZZER, timers.tim4, 2),
        }
    }

    /// A chip select that nothing drives yet counts as high: the sensor is not talked to before it is.
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

    /// Whether the IST8310 pulls its RSTN up itself no source says; a pin that lets go counts as high.
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

    /// What a MOSFET's gate sees: its pull-down keeps it off while the pin drives no high level.
    fn drive(&mut self, gate: &Gate, timer: &Timer, channel: usize) -> Wave {
        let settings = self.pins.settings(gate.pin);
        let by_timer = timer.wave(channel).unwrap_or(OFF);
        let by_port = Wave {
            hz: 0.0,
            duty: f64::from(u8::from(settings.high)),
        };
        let (wave, reaches) = match settings.mode {
            PinMode::Output => (by_port, true),
            PinMode::Alternate(number) => (by_timer, number == gate.timer_af),
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
            let found = mode_name(settings.mode);
            format!("{pin} is {found}, needs an output: the {name} stays off")
        } else {
            let (timer, found) = (gate.timer_name, mode_name(settings.mode));
            format!(
                "{timer}: {pin} is {found}, needs AF{}: the {name} stays off",
                gate.timer_af
            )
        };
        self.errors.report(self.now, message);
        OFF
    }
}
