//! The output stage of a channel (RM0090 18.3.9, 18.4.7–18.4.9).

use super::counter::Counter;
use crate::soc::wave::Wave;

/// OCxM of a compare channel.
const FORCE_INACTIVE: u32 = 0b100;
const FORCE_ACTIVE: u32 = 0b101;
const PWM1: u32 = 0b110;
const PWM2: u32 = 0b111;

/// Whether the model can convert this output mode to a wave.
pub fn mode_is_modelled(ocm: u32) -> bool {
    matches!(ocm, 0 | FORCE_INACTIVE | FORCE_ACTIVE | PWM1 | PWM2)
}

/// The wave of a channel in mode `ocm`, before its enable bit.
pub fn wave(counter: &Counter, channel: usize, ocm: u32, inverted: bool, clock_hz: u32) -> Wave {
    let period = f64::from(counter.reload.active) + 1.0;
    let hz = f64::from(clock_hz) / (f64::from(counter.prescaler.active) + 1.0) / period;
    let below = pwm_duty(counter, channel, period);
    let duty = match ocm {
        FORCE_ACTIVE => 1.0,
        PWM1 => below,
        PWM2 => 1.0 - below,
        _ => 0.0,
    };
    Wave {
        hz,
        duty: if inverted { 1.0 - duty } else { duty },
    }
}

/// Fraction of the period with CNT < CCR. With a stopped counter it is 0 or 1.
fn pwm_duty(counter: &Counter, channel: usize, period: f64) -> f64 {
    let compare = counter.compare[channel].active;
    if counter.enabled {
        (f64::from(compare) / period).min(1.0)
    } else {
        f64::from(u8::from(counter.count() < compare))
    }
}
