//! The board's passive buzzer on a PWM channel, at its rated pitch.

use embassy_stm32::peripherals::TIM4;
use embassy_stm32::timer::simple_pwm::SimplePwm;

/// The buzzer, either silent or sounding.
pub struct Buzzer {
    pwm: SimplePwm<'static, TIM4>,
}

impl Buzzer {
    /// Takes over the timer, which sets the pitch. The buzzer is silent.
    pub fn new(pwm: SimplePwm<'static, TIM4>) -> Self {
        let mut buzzer = Self { pwm };
        buzzer.sound(false);
        buzzer.pwm.ch3().enable();
        buzzer
    }

    /// Turns the sound on or off.
    pub fn sound(&mut self, on: bool) {
        let mut channel = self.pwm.ch3();
        if on {
            channel.set_duty_cycle(channel.max_duty_cycle() / 2);
        } else {
            channel.set_duty_cycle_fully_off();
        }
    }
}
