//! SPI1 as a full-duplex master (RM0090 chapter 28).

use crate::{
    soc::{
        access::Access,
        clocks::cycles_to_ps,
        dma_request::DmaRequest,
        peripheral::{Ctx, Peripheral, Unmodelled},
        registers::registers,
        routing,
        scheduler::Target,
        signals::Signal,
    },
    time::Ps,
};

registers! {
    CR1 = 0x00,
    CR2 = 0x04,
    SR = 0x08,
    DR = 0x0C,
    CRCPR = 0x10,
    RXCRCR = 0x14,
    TXCRCR = 0x18,
    I2SCFGR = 0x1C,
    I2SPR = 0x20,
}

const IRQ: u8 = 35;

mod cr1 {
    pub const MSTR: u32 = 1 << 2;
    pub const SPE: u32 = 1 << 6;
    /// CPHA, CPOL, BR, LSBFIRST, DFF: which must not change during a frame (RM0090 28.5.1).
    pub const FRAME_SHAPE: u32 = 0x8BB;
    pub const LSBFIRST: u32 = 1 << 7;
    pub const SSI: u32 = 1 << 8;
    pub const SSM: u32 = 1 << 9;
    pub const DFF: u32 = 1 << 11;
    /// CPHA, CPOL, MSTR, BR, SPE, LSBFIRST, SSI, SSM, DFF, and BIDIOE, which has no effect without BIDIMODE.
    pub const MODELLED: u32 = 0x4BFF;
}

mod cr2 {
    pub const RXDMAEN: u32 = 1;
    pub const TXDMAEN: u32 = 1 << 1;
    pub const SSOE: u32 = 1 << 2;
    pub const ERRIE: u32 = 1 << 5;
    pub const RXNEIE: u32 = 1 << 6;
    pub const TXEIE: u32 = 1 << 7;
    pub const MODELLED: u32 = RXDMAEN | TXDMAEN | SSOE | ERRIE | RXNEIE | TXEIE;
}

mod sr {
    pub const RXNE: u32 = 1;
    pub const TXE: u32 = 1 << 1;
    pub const MODF: u32 = 1 << 5;
    pub const OVR: u32 = 1 << 6;
    pub const BSY: u32 = 1 << 7;
}

/// A frame in the shift register.
#[derive(Clone, Copy, Debug)]
struct Shifting {
    frame: u16,
    ends_at: Ps,
}

/// SPI1's registers.
#[derive(Debug)]
pub struct Spi {
    cr1: u32,
    cr2: u32,
    crcpr: u32,
    /// RXNE, MODF and OVR; the others follow from the state below.
    flags: u32,
    /// Whether MODF was read in SR, so that the next write of CR1 clears it.
    modf_shown: bool,
    /// Whether DR was read after an overrun, so that the next read of SR clears OVR.
    dr_read_after_overrun: bool,
    received: u16,
    transmit_buffer: Option<u16>,
    shifting: Option<Shifting>,
}

impl Default for Spi {
    fn default() -> Self {
        Self::new()
    }
}

impl Spi {
    pub fn new() -> Self {
        Self {
            cr1: 0,
            cr2: 0,
            crcpr: 7,
            flags: 0,
            modf_shown: false,
            dr_read_after_overrun: false,
            received: 0,
            transmit_buffer: None,
            shifting: None,
        }
    }

    fn status(&self) -> u32 {
        self.flags
            | if self.transmit_buffer.is_none() {
                sr::TXE
            } else {
                0
            }
            | if self.shifting.is_some() { sr::BSY } else { 0 }
    }

    fn sck_hz(&self, ctx: &Ctx<'_>) -> u32 {
        ctx.clocks.pclk2_hz >> ((self.cr1 >> 3 & 7) + 1)
    }

    fn frame_bits(&self) -> u64 {
        if self.cr1 & cr1::DFF != 0 { 16 } else { 8 }
    }

    fn shift_next(&mut self, ctx: &mut Ctx<'_>) {
        let on = cr1::SPE | cr1::MSTR;
        if self.shifting.is_some() || self.cr1 & on != on {
            return;
        }
        let Some(frame) = self.transmit_buffer.take() else {
            return;
        };
        let clocks = self.frame_bits() << ((self.cr1 >> 3 & 7) + 1);
        let ends_at = ctx.now + cycles_to_ps(clocks, ctx.clocks.pclk2_hz);
        self.shifting = Some(Shifting { frame, ends_at });
        ctx.scheduler.at(ends_at, Target::Spi1, 0);
    }

    fn frame_ended(&mut self, frame: u16, ctx: &mut Ctx<'_>) {
        let answer = if self.frame_bits() == 16 {
            let [first, second] = if self.cr1 & cr1::LSBFIRST != 0 {
                frame.to_le_bytes()
            } else {
                frame.to_be_bytes()
            };
            let answers = [self.exchange(first, ctx), self.exchange(second, ctx)];
            if self.cr1 & cr1::LSBFIRST != 0 {
                u16::from_le_bytes(answers)
            } else {
                u16::from_be_bytes(answers)
            }
        } else {
            u16::from(self.exchange(frame as u8, ctx))
        };
        if self.flags & sr::RXNE != 0 {
            self.flags |= sr::OVR;
            self.dr_read_after_overrun = false;
        } else {
            self.received = answer;
            self.flags |= sr::RXNE;
        }
    }

    /// Exchanges one byte, as far as the wires are connected.
    fn exchange(&self, byte: u8, ctx: &mut Ctx<'_>) -> u8 {
        let clocked = routing::check(Signal::Spi1Sck, ctx);
        let sends = routing::check(Signal::Spi1Mosi, ctx);
        let receives = routing::check(Signal::Spi1Miso, ctx);
        let in_order = |b: u8| {
            if self.cr1 & cr1::LSBFIRST != 0 {
                b.reverse_bits()
            } else {
                b
            }
        };
        if !clocked {
            return 0;
        }
        routing::check_speed(Signal::Spi1Sck, self.sck_hz(ctx), ctx);
        let mosi = if sends { in_order(byte) } else { 0 };
        let mode = ((self.cr1 >> 1 & 1) << 1 | self.cr1 & 1) as u8;
        let miso = ctx
            .board
            .spi_transfer(mosi, self.sck_hz(ctx), mode, ctx.now);
        if receives { in_order(miso) } else { 0 }
    }

    fn write_cr1(&mut self, value: u32, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        if value & !cr1::MODELLED != 0 {
            return Err(reg::MAP.unmodelled_write("SPI1", reg::CR1, value));
        }
        if std::mem::take(&mut self.modf_shown) {
            self.flags &= !sr::MODF;
        }
        if self.shifting.is_some() && (self.cr1 ^ value) & cr1::FRAME_SHAPE != 0 {
            ctx.errors.report(
                ctx.now,
                "SPI1: clock or frame settings changed in the middle of a frame",
            );
        }
        if self.shifting.is_some() && value & cr1::SPE == 0 {
            self.shifting = None;
            ctx.errors.report(
                ctx.now,
                "SPI1: switched off in the middle of a frame, the frame is lost",
            );
        }
        self.cr1 = value;
        let enabled = value & cr1::SPE != 0;
        if enabled && value & cr1::MSTR == 0 {
            return Err(reg::MAP.unmodelled("SPI1", reg::CR1, "slave mode"));
        }
        if enabled && value & cr1::SSM == 0 && self.cr2 & cr2::SSOE == 0 {
            return Err(reg::MAP.unmodelled("SPI1", reg::CR1, "master mode with NSS as an input"));
        }
        if enabled && value & (cr1::SSM | cr1::SSI) == cr1::SSM {
            // NSS held low by software: another master has the bus (RM0090 28.3.10).
            self.flags |= sr::MODF;
            self.cr1 &= !(cr1::MSTR | cr1::SPE);
            ctx.errors
                .report(ctx.now, "SPI1: SSM with SSI = 0 in master mode: mode fault");
        }
        Ok(())
    }

    fn write_dr(&mut self, frame: u16, ctx: &mut Ctx<'_>) {
        if self.transmit_buffer.replace(frame).is_some() {
            ctx.errors.report(
                ctx.now,
                "SPI1: DR written while TXE is 0: the frame waiting there is lost",
            );
        }
    }

    fn read_sr(&mut self) -> u32 {
        let status = self.status();
        if std::mem::take(&mut self.dr_read_after_overrun) {
            self.flags &= !sr::OVR;
        }
        self.modf_shown = status & sr::MODF != 0;
        status
    }

    fn read_dr(&mut self) -> u32 {
        self.flags &= !sr::RXNE;
        self.dr_read_after_overrun = self.flags & sr::OVR != 0;
        u32::from(self.received)
    }

    fn update_lines(&self, ctx: &mut Ctx<'_>) {
        let status = self.status();
        let both = |enable, flag| self.cr2 & enable != 0 && status & flag != 0;
        let irq = both(cr2::TXEIE, sr::TXE)
            || both(cr2::RXNEIE, sr::RXNE)
            || both(cr2::ERRIE, sr::OVR | sr::MODF);
        ctx.irq.set(IRQ, irq);
        ctx.dma
            .set(DmaRequest::Spi1Rx, both(cr2::RXDMAEN, sr::RXNE));
        ctx.dma.set(DmaRequest::Spi1Tx, both(cr2::TXDMAEN, sr::TXE));
    }
}

impl Peripheral for Spi {
    fn read(&mut self, offset: u32, size: u8, ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        let value = match access.register {
            reg::CR1 => self.cr1,
            reg::CR2 => self.cr2,
            reg::SR => self.read_sr(),
            reg::DR => self.read_dr(),
            reg::CRCPR => self.crcpr,
            // CRC results and I2S configuration stand at their reset values.
            reg::RXCRCR | reg::TXCRCR | reg::I2SCFGR => 0,
            reg::I2SPR => 2,
            other => return Err(reg::MAP.unmodelled_read("SPI1", other)),
        };
        self.update_lines(ctx);
        Ok(access.read_of(value))
    }

    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(offset, size);
        let over = |old| access.written_over(old, value);
        match access.register {
            reg::CR1 => self.write_cr1(over(self.cr1), ctx)?,
            reg::CR2 => {
                let value = over(self.cr2);
                if value & !cr2::MODELLED != 0 {
                    return Err(reg::MAP.unmodelled_write("SPI1", reg::CR2, value));
                }
                self.cr2 = value;
            }
            // All flags but CRCERR are read-only or cleared by sequences; CRC is not modelled.
            reg::SR => {}
            reg::DR => self.write_dr(over(0) as u16, ctx),
            reg::CRCPR => self.crcpr = over(self.crcpr) & 0xFFFF,
            reg::I2SCFGR if over(0) == 0 => {}
            other => return Err(reg::MAP.unmodelled_write("SPI1", other, value)),
        }
        self.shift_next(ctx);
        self.update_lines(ctx);
        Ok(())
    }

    fn event(&mut self, _tag: u32, ctx: &mut Ctx<'_>) {
        let Some(shifting) = self.shifting.filter(|s| s.ends_at <= ctx.now) else {
            return;
        };
        self.shifting = None;
        self.frame_ended(shifting.frame, ctx);
        self.shift_next(ctx);
        self.update_lines(ctx);
    }

    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        *self = Self::new();
        self.update_lines(ctx);
    }
}

#[cfg(test)]
mod tests;
