//! Battery voltage on ADC3; the internal reference and the chip's temperature in turn on ADC1. Nothing waits for a
//! conversion.

use embassy_stm32::adc::{Adc, AdcChannel, AnyAdcChannel, Instance, SampleTime};
use embassy_stm32::peripherals::{ADC1, ADC3};
use embassy_stm32::{Peri, pac};
use robot_app::sensing::{BatteryMonitor, McuThermometer};

/// 23 µs at 21 MHz. The divider charges the sampling capacitor slowly; reference and temperature sensor need 10 µs.
const SAMPLE_TIME: SampleTime = SampleTime::CYCLES480;
/// Inputs of ADC1 (RM0090 13.10, 13.11).
const TEMPERATURE_INPUT: u8 = 16;
const REFERENCE_INPUT: u8 = 17;

/// What the converters measure.
#[derive(Clone, Copy, Default)]
pub struct AnalogReport {
    /// Battery voltage, V; 0 while it is not measured.
    pub battery_v: f32,
    /// Temperature of the chip, °C; 0 until it was measured.
    pub mcu_c: f32,
}

/// Both converters.
pub struct AnalogInputs {
    battery: Converter<ADC3>,
    internal: Converter<ADC1>,
    /// Whether the conversion under way is that of the temperature sensor, and not of the reference.
    measures_temperature: bool,
    monitor: BatteryMonitor,
    thermometer: McuThermometer,
}

/// What the maker measured of this chip.
pub struct FactoryWords {
    /// VREFIN_CAL.
    pub reference: u16,
    /// TS_CAL1 and TS_CAL2.
    pub temperature: [u16; 2],
}

impl AnalogInputs {
    /// Sets up both converters and waits some 90 µs for their first conversions.
    pub fn new(
        adc3: (Peri<'static, ADC3>, pac::adc::Adc),
        mut battery: AnyAdcChannel<'static, ADC3>,
        adc1: (Peri<'static, ADC1>, pac::adc::Adc),
        words: &FactoryWords,
    ) -> Self {
        // One reset bit serves all converters: both are reset before either is set up.
        let mut battery_converter = Converter::new(adc3.0, adc3.1);
        let mut internal = Converter::new(adc1.0, adc1.1);
        battery_converter.set_up(&mut battery);
        let mut temperature = internal.adc.enable_temperature();
        internal.set_up(&mut temperature);
        let mut reference = internal.adc.enable_vrefint();
        internal.set_up(&mut reference);
        battery_converter.start();
        internal.start();
        let [cold, hot] = words.temperature;
        Self {
            battery: battery_converter,
            internal,
            measures_temperature: false,
            monitor: BatteryMonitor::new(words.reference),
            thermometer: McuThermometer::new(cold, hot),
        }
    }

    /// Takes the conversions that the last call began, and begins the next. Call this every 5 ms.
    pub fn sample(&mut self) {
        let battery = self.battery.take();
        self.battery.start();
        let internal = self.internal.take();
        if self.measures_temperature {
            self.monitor.feed(battery, None);
            self.thermometer.feed(internal);
            self.internal.select(REFERENCE_INPUT);
        } else {
            self.monitor.feed(battery, internal);
            self.internal.select(TEMPERATURE_INPUT);
        }
        self.measures_temperature = !self.measures_temperature;
        self.internal.start();
    }

    /// What was measured.
    pub fn report(&self) -> AnalogReport {
        AnalogReport {
            battery_v: self.monitor.volts(),
            mcu_c: self.thermometer.celsius(self.monitor.supply_v()),
        }
    }
}

/// One converter, for one input at a time.
struct Converter<T: Instance> {
    registers: pac::adc::Adc,
    /// Kept, because it switches the converter off when it is dropped.
    adc: Adc<'static, T>,
}

impl<T: Instance<Regs = pac::adc::Adc>> Converter<T> {
    fn new(adc: Peri<'static, T>, registers: pac::adc::Adc) -> Self {
        Self {
            registers,
            adc: Adc::new(adc),
        }
    }

    /// One reading through the HAL sets up pin, sequence and sampling time. Later conversions reuse them.
    fn set_up(&mut self, channel: &mut impl AdcChannel<T>) {
        self.adc.blocking_read(channel, SAMPLE_TIME);
    }

    /// Selects an input that was set up before. No conversion may be under way.
    fn select(&self, input: u8) {
        self.registers.sqr3().write(|w| w.set_sq(0, input));
    }

    fn start(&self) {
        self.registers.cr2().modify(|w| w.set_swstart(true));
    }

    /// The result of a conversion that has ended.
    fn take(&mut self) -> Option<u16> {
        let done = self.registers.sr().read().eoc();
        // Reading the data clears the flag.
        let counts = self.registers.dr().read().data();
        done.then_some(counts)
    }
}
