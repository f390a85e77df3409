//! The IMU's heater: a MOSFET driven by a PWM channel.

use embassy_stm32::peripherals::TIM10;
use embassy_stm32::timer::simple_pwm::SimplePwm;

/// The heater. At full duty in a warm room it reaches 58 °C, so a duty that stays on does no harm until the watchdog's reset
/// ends it.
pub struct Heater {
    pwm: SimplePwm<'static, TIM10>,
}

impl Heater {
    /// Takes over the timer. The heater is off.
    pub fn new(pwm: SimplePwm<'static, TIM10>) -> Self {
        let mut heater = Self { pwm };
        heater.set_duty(0.0);
        heater.pwm.ch1().enable();
        heater
    }

    /// Sets the duty, clamped to 0 … 1. NaN turns the heater off.
    pub fn set_duty(&mut self, duty: f32) {
        let mut channel = self.pwm.ch1();
        let steps = channel.max_duty_cycle();
        let on = (duty * steps as f32) as u32;
        channel.set_duty_cycle(on.min(steps));
    }
}
