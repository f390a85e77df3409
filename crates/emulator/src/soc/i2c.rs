//! I2C3 as the only master of its bus (RM0090 chapter 27).

use crate::soc::{
    access::Access,
    dma_request::DmaRequest,
    peripheral::{Ctx, Peripheral, Unmodelled},
};

mod master;
mod registers;

use master::{Master, Phase};
use registers::{cr1, cr2, reg, sr1, sr2};

const IRQ_EVENT: u8 = 72;
const IRQ_ERROR: u8 = 73;

/// The registers of I2C3 and its bus master.
#[derive(Debug, Default)]
pub struct I2c {
    master: Master,
    oar: [u32; 2],
    /// Flags that were set when SR1 was read. The second half of their clear sequence may follow.
    shown: u32,
}

impl I2c {
    pub fn new() -> Self {
        Self {
            master: Master::new(),
            ..Self::default()
        }
    }

    fn read_sr1(&mut self) -> u32 {
        self.shown = self.master.sr1;
        self.master.sr1
    }

    fn read_sr2(&mut self, ctx: &mut Ctx<'_>) -> u32 {
        let master = self.master.owns_bus();
        let value = if master { sr2::MSL } else { 0 }
            | if master || ctx.board.i2c_bus_held() {
                sr2::BUSY
            } else {
                0
            }
            | if master && self.master.transmitter {
                sr2::TRA
            } else {
                0
            };
        if self.shown & sr1::ADDR != 0 {
            self.shown &= !sr1::ADDR;
            self.master.address_acknowledged_seen(ctx);
        }
        value
    }

    fn write_dr(&mut self, byte: u8, ctx: &mut Ctx<'_>) {
        match self.master.phase {
            Phase::Started if self.shown & sr1::SB != 0 => {
                self.shown &= !sr1::SB;
                self.master.send_address(byte, ctx);
            }
            Phase::Started => ctx.errors.report(
                ctx.now,
                "I2C3: DR written after START without reading SR1: the address is not sent",
            ),
            _ => self.master.write(byte, ctx),
        }
    }

    fn write_cr1(&mut self, value: u32, ctx: &mut Ctx<'_>) {
        let was = self.master.cr1;
        if value & cr1::SWRST != 0 {
            self.master.release_bus(ctx);
            *self = Self::new();
            self.master.cr1 = value & cr1::SWRST;
            return;
        }
        if was & cr1::PE != 0 && value & cr1::PE == 0 {
            self.master.release_bus(ctx);
        } else {
            self.check_requests_done(was, value, ctx);
        }
        self.master.cr1 = value;
        self.master.requests_changed(ctx);
    }

    /// CR1 must not be written before the hardware has cleared START and STOP: "there is a risk of setting a second
    /// request" (RM0090 27.6.1). The effect on a START was observed on a bus in stm32f4xx-hal, pull request 737.
    fn check_requests_done(&mut self, was: u32, value: u32, ctx: &mut Ctx<'_>) {
        let why = match (was & cr1::STOP != 0, value & cr1::START != 0) {
            (true, true) => {
                self.master.start_cut_off = true;
                "STOP is pending: it cuts off the START, and the bus hangs"
            }
            (true, false) => "STOP is pending: it may be sent twice",
            (false, _) if was & cr1::START != 0 => "START is pending: it may be sent twice",
            (false, _) => return,
        };
        let message = format!("I2C3: CR1 written while {why}");
        ctx.errors.report(ctx.now, message);
    }

    /// CCR and TRISE may be written only while PE is 0 (RM0090 27.6.8, 27.6.9).
    fn check_disabled(&self, register: &str, ctx: &mut Ctx<'_>) {
        if self.master.cr1 & cr1::PE != 0 {
            let message = format!("I2C3: {register} written while PE is 1: SCL is undefined");
            ctx.errors.report(ctx.now, message);
        }
    }

    fn update_lines(&self, ctx: &mut Ctx<'_>) {
        let flags = self.master.sr1;
        let has = |bits| flags & bits != 0;
        let wants = |bit| self.master.cr2 & bit != 0;
        let event =
            has(sr1::SB | sr1::ADDR | sr1::BTF) || wants(cr2::ITBUFEN) && has(sr1::TXE | sr1::RXNE);
        ctx.irq.set(IRQ_EVENT, wants(cr2::ITEVTEN) && event);
        ctx.irq
            .set(IRQ_ERROR, wants(cr2::ITERREN) && has(sr1::ERRORS));
        let sending = self.master.phase == Phase::Transmitting;
        ctx.dma.set(
            DmaRequest::I2c3Tx,
            wants(cr2::DMAEN) && sending && has(sr1::TXE),
        );
        ctx.dma
            .set(DmaRequest::I2c3Rx, wants(cr2::DMAEN) && has(sr1::RXNE));
    }
}

impl Peripheral for I2c {
    fn read(&mut self, offset: u32, size: u8, ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        let value = match access.register {
            reg::CR1 => self.master.cr1,
            reg::CR2 => self.master.cr2,
            reg::OAR1 => self.oar[0],
            reg::OAR2 => self.oar[1],
            reg::DR => u32::from(self.master.read(ctx)),
            reg::SR1 => self.read_sr1(),
            reg::SR2 => self.read_sr2(ctx),
            reg::CCR => self.master.ccr,
            reg::TRISE => self.master.trise,
            other => return Err(reg::MAP.unmodelled_read("I2C3", other)),
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
        registers::check_write(access.register, over(0))?;
        match access.register {
            reg::CR1 => self.write_cr1(over(self.master.cr1), ctx),
            reg::CR2 => self.master.cr2 = over(self.master.cr2),
            reg::OAR1 => self.oar[0] = over(self.oar[0]),
            reg::OAR2 => self.oar[1] = over(self.oar[1]),
            reg::DR => self.write_dr(over(0) as u8, ctx),
            reg::SR1 => self.master.sr1 &= over(u32::MAX) | !sr1::ERRORS,
            reg::CCR => {
                self.check_disabled("CCR", ctx);
                self.master.ccr = over(self.master.ccr);
            }
            reg::TRISE => {
                self.check_disabled("TRISE", ctx);
                self.master.trise = over(self.master.trise);
            }
            _ => {}
        }
        self.update_lines(ctx);
        Ok(())
    }

    fn event(&mut self, _tag: u32, ctx: &mut Ctx<'_>) {
        self.master.event(ctx);
        self.update_lines(ctx);
    }

    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        self.master.release_bus(ctx);
        *self = Self::new();
        self.update_lines(ctx);
    }
}

#[cfg(test)]
mod tests;
