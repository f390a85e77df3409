//! One GPIO port (RM0090 8.4). Modes and output levels go to the pin bank, levels come from it.

use crate::soc::{
    access::Access,
    peripheral::{Ctx, Peripheral, Unmodelled},
    pins::{Pin, PinMode, PinSettings, Pull},
    registers::registers,
};

registers! {
    MODER = 0x00,
    OTYPER = 0x04,
    OSPEEDR = 0x08,
    PUPDR = 0x0C,
    IDR = 0x10,
    ODR = 0x14,
    BSRR = 0x18,
    LCKR = 0x1C,
    AFRL = 0x20,
    AFRH = 0x24,
}

#[derive(Debug)]
pub struct Gpio {
    port: u8,
    moder: u32,
    otyper: u32,
    ospeedr: u32,
    pupdr: u32,
    odr: u32,
    afr: [u32; 2],
}

impl Gpio {
    /// Port A = 0 … I = 8. Ports A and B start with the debug port's pins (RM0090 8.4.1–8.4.4).
    pub fn new(port: u8) -> Self {
        let (moder, ospeedr, pupdr) = match port {
            0 => (0xA800_0000, 0x0C00_0000, 0x6400_0000),
            1 => (0x0000_0280, 0x0000_00C0, 0x0000_0100),
            _ => (0, 0, 0),
        };
        Self {
            port,
            moder,
            otyper: 0,
            ospeedr,
            pupdr,
            odr: 0,
            afr: [0; 2],
        }
    }

    fn name(&self) -> String {
        format!("GPIO{}", char::from(b'A' + self.port))
    }

    fn pin(&self, number: u8) -> Pin {
        Pin {
            port: self.port,
            number,
        }
    }

    fn mode(&self, number: u8) -> PinMode {
        match self.moder >> (2 * number) & 3 {
            0 => PinMode::Input,
            1 => PinMode::Output,
            2 => PinMode::Alternate(
                (self.afr[usize::from(number / 8)] >> (4 * u32::from(number % 8)) & 0xF) as u8,
            ),
            _ => PinMode::Analog,
        }
    }

    fn publish(&self, ctx: &mut Ctx<'_>) {
        for number in 0..16 {
            let pin = self.pin(number);
            ctx.pins.set(pin, self.settings(number));
            if ctx.pins.contested(pin) {
                let message = format!("{pin} is an output, and so is what the board has there");
                ctx.errors.report(ctx.now, message);
            }
        }
    }

    fn settings(&self, number: u8) -> PinSettings {
        PinSettings {
            mode: self.mode(number),
            open_drain: self.otyper >> number & 1 == 1,
            pull: match self.pupdr >> (2 * number) & 3 {
                1 => Pull::Up,
                2 => Pull::Down,
                _ => Pull::None,
            },
            speed: (self.ospeedr >> (2 * number) & 3) as u8,
            high: self.odr >> number & 1 == 1,
        }
    }

    fn idr(&self, ctx: &Ctx<'_>) -> u32 {
        let noise = noise(ctx.now, self.port);
        (0..16)
            .filter(|n| {
                // An analog pin's Schmitt trigger is off and reads 0.
                self.mode(*n) != PinMode::Analog
                    && ctx.pins.level(self.pin(*n)).unwrap_or(noise >> n & 1 == 1)
            })
            .fold(0, |bits, n| bits | 1 << n)
    }

    fn value(&self, register: u32, ctx: &Ctx<'_>) -> Result<u32, Unmodelled> {
        Ok(match register {
            reg::MODER => self.moder,
            reg::OTYPER => self.otyper,
            reg::OSPEEDR => self.ospeedr,
            reg::PUPDR => self.pupdr,
            reg::IDR => self.idr(ctx),
            reg::ODR => self.odr,
            // BSRR is write-only and reads 0.
            reg::BSRR => 0,
            reg::AFRL => self.afr[0],
            reg::AFRH => self.afr[1],
            _ => return Err(reg::MAP.unmodelled_read(self.name(), register)),
        })
    }
}

impl Peripheral for Gpio {
    fn read(&mut self, offset: u32, size: u8, ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        Ok(access.read_of(self.value(access.register, ctx)?))
    }

    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(offset, size);
        let whole = access.written_over(self.value(access.register, ctx)?, value);
        match access.register {
            reg::MODER => self.moder = whole,
            reg::OTYPER => self.otyper = whole & 0xFFFF,
            reg::OSPEEDR => self.ospeedr = whole,
            reg::PUPDR => self.pupdr = whole,
            reg::IDR => {}
            reg::ODR => self.odr = whole & 0xFFFF,
            // Set has priority over reset.
            reg::BSRR => self.odr = self.odr & !(whole >> 16) | whole & 0xFFFF,
            reg::AFRL => self.afr[0] = whole,
            reg::AFRH => self.afr[1] = whole,
            other => return Err(reg::MAP.unmodelled_write(self.name(), other, value)),
        }
        self.publish(ctx);
        Ok(())
    }

    fn event(&mut self, _tag: u32, _ctx: &mut Ctx<'_>) {}

    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        *self = Self::new(self.port);
        self.publish(ctx);
    }
}

/// Levels of floating inputs at that time. They are a hash (splitmix64), so a run can be repeated.
fn noise(now: u64, port: u8) -> u64 {
    let mut bits = (now ^ u64::from(port)).wrapping_add(0x9E37_79B9_7F4A_7C15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^ bits >> 31
}
