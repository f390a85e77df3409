//! The board's passive buzzer on a PWM channel at its rated pitch.

use embassy_stm32::peripherals::TIM4;
use embassy_stm32::timer::simple_pwm::SimplePwm;

pub struct Buzzer {
    pwm: SimplePwm<'static, TIM4>,
}

impl Buzzer {
    /// Silent until told otherwise. The pitch is that of the timer.
    pub fn new(pwm: SimplePwm<'static, TIM4>) -> Self {
        let mut buzzer = Self { pwm };
        buzzer.sound(false);
        buzzer.pwm.ch3().enable();
        buzzer
    }

    pub fn sound(&mut self, on: bool) {
        let mut channel = self.pwm.ch3();
        if on {
            channel.set_duty_cycle(channel.max_duty_cycle() / 2);
        } else {
            channel.set_duty_cycle_fully_off();
        }
    }
}
