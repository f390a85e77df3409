//! Checks that signals get through their pins: muxed as the board needs, with an output stage that can drive them.

use crate::soc::{
    peripheral::Ctx,
    pins::{ExternalConnection, PinSettings, Pull},
    signals::{Signal, Stage},
};

/// Whether the signal's pin is set up so that the signal gets through. If not, a board error is reported. A signal that
/// the board does not route does not get through either.
pub fn check(signal: Signal, ctx: &mut Ctx<'_>) -> bool {
    let Some(route) = ctx.board.route(signal) else {
        return false;
    };
    let found = ctx.pins.settings(route.pin);
    let (is, needed) = if found.mode != signal.mode() {
        (found.mode.to_string(), signal.mode().to_string())
    } else if let Some(misfit) = stage_misfit(route.stage, found, ctx.pins.outside(route.pin)) {
        (misfit.0.to_owned(), misfit.1.to_owned())
    } else {
        return true;
    };
    let message = format!(
        "{}: {} is {is}, needs {needed}: {}",
        signal.name(),
        route.pin,
        route.consequence
    );
    ctx.errors.report(ctx.now, message);
    false
}

/// The current and the required output stage, if the current one cannot drive the signal. 40 kΩ and the 30 pF of a pin, its
/// track and an input lead to edges of more than 1 µs.
fn stage_misfit(
    stage: Stage,
    pin: PinSettings,
    outside: ExternalConnection,
) -> Option<(&'static str, &'static str)> {
    let pulled_up = outside == ExternalConnection::PullUp || pin.pull == Pull::Up;
    match stage {
        // A push-pull stage would drive against a device that pulls the line down (RM0090 27.3.2).
        Stage::Shared if !pin.open_drain => Some(("push-pull", "open-drain")),
        Stage::Fast if pin.open_drain && pulled_up => {
            Some(("open-drain and rises too slowly by a resistor", "push-pull"))
        }
        Stage::Shared | Stage::Fast | Stage::Slow if pin.open_drain && !pulled_up => {
            Some(("open-drain without a pull-up and never rises", "push-pull"))
        }
        _ => None,
    }
}

/// Slowest setting of OSPEEDR: 4 MHz into 50 pF, 8 MHz into 10 pF (STM32F407 datasheet, table of I/O AC
/// characteristics).
const SLOW_STAGE_HZ: u32 = 4_000_000;
const SLOW_STAGE_LIGHT_LOAD_HZ: u32 = 8_000_000;

/// Reports an output stage that is too slow for a square wave of `hz`.
pub fn check_speed(signal: Signal, hz: u32, ctx: &mut Ctx<'_>) {
    let Some(route) = ctx.board.route(signal) else {
        return;
    };
    if ctx.pins.settings(route.pin).speed > 0 || hz <= SLOW_STAGE_HZ {
        return;
    }
    let message = format!(
        "{}: {} switches {hz} Hz at OSPEEDR = 0, made for {SLOW_STAGE_HZ} Hz",
        signal.name(),
        route.pin
    );
    if hz > SLOW_STAGE_LIGHT_LOAD_HZ {
        ctx.errors.report(ctx.now, message);
    } else {
        ctx.errors.suspect(ctx.now, message);
    }
}
