//! Battery voltage on ADC3 against the internal reference on ADC1, without waiting for either.

use embassy_stm32::adc::{Adc, AdcChannel, AnyAdcChannel, Instance, SampleTime};
use embassy_stm32::peripherals::{ADC1, ADC3};
use embassy_stm32::{Peri, pac};
use robot_app::sensing::BatteryMonitor;

/// 23 µs at 21 MHz. The divider charges the sampling capacitor slowly, and the reference needs 10 µs.
const SAMPLE_TIME: SampleTime = SampleTime::CYCLES480;

/// Both converters, each set to one input.
pub struct Battery {
    battery: Converter<ADC3>,
    reference: Converter<ADC1>,
    monitor: BatteryMonitor,
}

impl Battery {
    /// Sets up both converters and waits some 60 µs for their first conversions. `reference_counts` is the maker's
    /// calibration word.
    pub fn new(
        battery: (Peri<'static, ADC3>, pac::adc::Adc),
        mut channel: AnyAdcChannel<'static, ADC3>,
        reference: (Peri<'static, ADC1>, pac::adc::Adc),
        reference_counts: u16,
    ) -> Self {
        // One reset bit serves all converters: both are reset before either is set up.
        let (adc3, adc1) = (Adc::new(battery.0), Adc::new(reference.0));
        let mut vrefint = adc1.enable_vrefint();
        Self {
            battery: Converter::new(adc3, battery.1, &mut channel),
            reference: Converter::new(adc1, reference.1, &mut vrefint),
            monitor: BatteryMonitor::new(reference_counts),
        }
    }

    /// Takes the conversions that the last call began, and begins the next. Call this every 5 ms.
    pub fn sample(&mut self) {
        self.monitor
            .feed(self.battery.take(), self.reference.take());
    }

    /// Battery voltage, V, as [`BatteryMonitor::volts`].
    pub fn volts(&self) -> f32 {
        self.monitor.volts()
    }
}

/// One converter, which always converts the same input.
struct Converter<T: Instance> {
    registers: pac::adc::Adc,
    /// Kept, because it switches the converter off when it is dropped.
    _adc: Adc<'static, T>,
}

impl<T: Instance<Regs = pac::adc::Adc>> Converter<T> {
    /// One reading through the HAL sets up pin, sequence and sampling time. Later conversions reuse them.
    fn new(
        mut adc: Adc<'static, T>,
        registers: pac::adc::Adc,
        channel: &mut impl AdcChannel<T>,
    ) -> Self {
        adc.blocking_read(channel, SAMPLE_TIME);
        let converter = Self {
            registers,
            _adc: adc,
        };
        converter.start();
        converter
    }

    fn start(&self) {
        self.registers.cr2().modify(|w| w.set_swstart(true));
    }

    fn take(&mut self) -> Option<u16> {
        let done = self.registers.sr().read().eoc();
        // Reading the data clears the flag.
        let counts = self.registers.dr().read().data();
        self.start();
        done.then_some(counts)
    }
}
