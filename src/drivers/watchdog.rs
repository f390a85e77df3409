//! The independent watchdog: resets the chip when the control tick stops feeding it.

use embassy_stm32::Peri;
use embassy_stm32::pac;
use embassy_stm32::pac::iwdg::vals::{Key, Pr};
use embassy_stm32::peripherals::IWDG;
use robot_app::safety::WatchdogPeriod;

/// Prescaler and reload value of a period. Its clock, the LSI, runs at 17 to 47 kHz (STM32F407 datasheet table 35;
/// nominal 32 kHz).
struct Period {
    prescaler: Pr,
    reload: u16,
}

/// 12 to 34 ms. With the deadlines of `deadlines.rs` (25 ms) a hang ends in a reset within 60 ms.
const SHORT: Period = Period {
    prescaler: Pr::DIVIDE_BY4,
    reload: 143,
};
/// 0.68 to 1.88 s, because a sector of 16 KiB takes up to 0.5 s to erase. It is in force at boot and around an erase, when the
/// robot is always disarmed; a hang then ends within 1.9 s.
const LONG: Period = Period {
    prescaler: Pr::DIVIDE_BY32,
    reload: 998,
};

/// The running watchdog.
pub struct Watchdog {
    _token: Peri<'static, IWDG>,
    period: WatchdogPeriod,
    /// The period to which it is changing.
    becomes: WatchdogPeriod,
}

impl Watchdog {
    /// Starts the watchdog with its long period, for what is slow at boot; nothing but a reset can stop it. It counts
    /// down from its largest value, 0.35 to 0.96 s, until a feed finds the long period in force.
    pub fn start_long(token: Peri<'static, IWDG>) -> Self {
        set(&LONG);
        pac::IWDG.kr().write(|w| w.set_key(Key::START));
        Self {
            _token: token,
            period: WatchdogPeriod::Changing,
            becomes: WatchdogPeriod::Long,
        }
    }

    /// The period in force.
    pub fn period(&self) -> WatchdogPeriod {
        self.period
    }

    /// Begins a change of the period if another one is wanted. A later [`feed`](Self::feed) completes it.
    pub fn set_long(&mut self, long: bool) {
        let (wanted, period) = if long {
            (WatchdogPeriod::Long, &LONG)
        } else {
            (WatchdogPeriod::Short, &SHORT)
        };
        if self.period == wanted || self.period == WatchdogPeriod::Changing {
            return;
        }
        set(period);
        self.becomes = wanted;
        self.period = WatchdogPeriod::Changing;
    }

    /// Restarts the count, and completes a change of the period that has arrived.
    pub fn feed(&mut self) {
        // The registers arrive in the watchdog's clock domain within six cycles of the slower of both divided clocks
        // (ST's stm32f4xx_hal_iwdg.c): 4 to 12 ms. They count from the next feed on.
        let arrived = self.period == WatchdogPeriod::Changing && !is_updating();
        pac::IWDG.kr().write(|w| w.set_key(Key::RESET));
        if arrived {
            self.period = self.becomes;
        }
    }
}

fn set(period: &Period) {
    pac::IWDG.kr().write(|w| w.set_key(Key::ENABLE));
    pac::IWDG.pr().write(|w| w.set_pr(period.prescaler));
    pac::IWDG.rlr().write(|w| w.set_rl(period.reload));
}

fn is_updating() -> bool {
    let status = pac::IWDG.sr().read();
    status.pvu() || status.rvu()
}
