//! Battery voltage on ADC3.

use embassy_stm32::Peri;
use embassy_stm32::adc::{Adc, AnyAdcChannel, SampleTime};
use embassy_stm32::peripherals::ADC3;

/// 3.3 V full scale at 12 bits behind a 200 kΩ / 22 kΩ divider (`hardware.md` 1.2).
const VOLTS_PER_COUNT: f32 = 3.3 / 4095.0 * (200.0 + 22.0) / 22.0;

pub struct Battery {
    adc: Adc<'static, ADC3>,
    channel: AnyAdcChannel<'static, ADC3>,
}

impl Battery {
    pub fn new(adc: Peri<'static, ADC3>, channel: AnyAdcChannel<'static, ADC3>) -> Self {
        Self {
            adc: Adc::new(adc),
            channel,
        }
    }

    /// Takes about 25 µs: the divider is slow to charge the sampling capacitor.
    pub fn read_v(&mut self) -> f32 {
        let counts = self
            .adc
            .blocking_read(&mut self.channel, SampleTime::CYCLES480);
        f32::from(counts) * VOLTS_PER_COUNT
    }
}
