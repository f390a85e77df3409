//! Why the chip started, from RCC_CSR (RM0090 7.3.21).

use embassy_stm32::pac::RCC;
use robot_app::domain::ResetCause;

/// Reads the flags and clears them for the next time.
pub fn take() -> ResetCause {
    let flags = RCC.csr().read();
    RCC.csr().modify(|w| w.set_rmvf(true));
    // Most specific first: every reset also pulls the reset pin, and a power-on is also a brown-out.
    if flags.wdgrstf() {
        ResetCause::IndependentWatchdog
    } else if flags.wwdgrstf() {
        ResetCause::WindowWatchdog
    } else if flags.sftrstf() {
        ResetCause::Software
    } else if flags.lpwrrstf() {
        ResetCause::LowPower
    } else if flags.porrstf() {
        ResetCause::PowerOn
    } else if flags.borrstf() {
        ResetCause::BrownOut
    } else if flags.padrstf() {
        ResetCause::Pin
    } else {
        ResetCause::Unknown
    }
}
