//! CAN1 and CAN2 (bxCAN, RM0090 chapter 32): one block at CAN1's base, CAN2 at 0x400, with the bus of each.

use std::ops::Range;

use self::{
    bit_timing::BitTiming,
    controller::{Controller, Mode, ier, mcr, msr},
    filter::Filters,
};
use crate::{
    soc::{
        access::Access,
        can::bus::{CanBus, CanBusStats},
        peripheral::{Ctx, Peripheral, Unmodelled},
        registers::registers,
        scheduler::Target,
    },
    time::Ps,
    wire::CanPort,
};

mod bit_timing;
pub mod bus;
pub mod controller;
pub mod errors;
mod fifo;
pub mod filter;
mod frame_bits;
mod mailboxes;

registers! {
    MCR = 0x00,
    MSR = 0x04,
    TSR = 0x08,
    RF0R = 0x0C,
    RF1R = 0x10,
    IER = 0x14,
    ESR = 0x18,
    BTR = 0x1C,
    TI0R = 0x180,
    RI0R = 0x1B0,
    FMR = 0x200,
    FM1R = 0x204,
    FS1R = 0x20C,
    FFA1R = 0x214,
    FA1R = 0x21C,
    F0R1 = 0x240,
}

/// Registers of three transmit mailboxes and two FIFOs. Each has four words: identifier, length and time, data.
const MAILBOXES: Range<u32> = reg::TI0R..reg::RI0R;
const FIFOS: Range<u32> = reg::RI0R..reg::RI0R + 0x20;
/// Offset of CAN2's registers from those of CAN1.
const CAN2: u32 = 0x400;

/// Tags of scheduled events. Bit 0 is the bus number.
const BUS_PHASE: u32 = 0;
const QUIET_BUS: u32 = 1;

/// BTR without its reserved bits and LBKM.
const BTR_MODELLED: u32 = 0x837F_03FF;

/// Both controllers, their shared filters, their buses.
#[derive(Debug)]
pub struct Can {
    controllers: [Controller; 2],
    filters: Filters,
    buses: [CanBus; 2],
}

impl Default for Can {
    fn default() -> Self {
        Self::new()
    }
}

impl Can {
    pub fn new() -> Self {
        Self {
            controllers: [Controller::new(0), Controller::new(1)],
            filters: Filters::new(),
            buses: [CanBus::new(CanPort::Can1), CanBus::new(CanPort::Can2)],
        }
    }

    /// Counters of the bus of CAN1 (0) or CAN2 (1).
    pub fn stats(&self, bus: usize) -> CanBusStats {
        self.buses[bus].stats
    }

    /// Resets the registers of CAN1 (0) or CAN2 (1). The filters belong to CAN1.
    pub fn reset_controller(&mut self, index: usize, ctx: &mut Ctx<'_>) {
        self.controllers[index] = Controller::new(index);
        self.buses[index].board_reset();
        if index == 0 {
            self.filters = Filters::new();
        }
        self.controllers[index].update_lines(ctx);
    }

    fn wake_at(&self, at: Option<Ps>, purpose: u32, index: usize, ctx: &mut Ctx<'_>) {
        if let Some(at) = at {
            ctx.scheduler
                .at(at, Target::CanBus(index as u8), purpose << 1 | index as u32);
        }
    }

    /// Advances controller and bus `index` as far as possible at this instant.
    fn settle(&mut self, index: usize, ctx: &mut Ctx<'_>) {
        let in_frame = self.buses[index].in_frame();
        if self.controllers[index].follow_requests(in_frame, ctx) {
            self.wake_when_quiet(index, ctx);
        }
        let ends_at = self.buses[index].start_if_idle(&mut self.controllers[index], ctx);
        self.wake_at(ends_at, BUS_PHASE, index, ctx);
        self.controllers[index].update_lines(ctx);
    }

    /// Time at which the bus will have been quiet for as long as the controller requires.
    fn wake_when_quiet(&self, index: usize, ctx: &mut Ctx<'_>) {
        let controller = &self.controllers[index];
        let joins_at = match controller.mode {
            Mode::Synchronising(until) if until != Ps::MAX => Some(until),
            _ => controller.recovers_at,
        };
        self.wake_at(joins_at, QUIET_BUS, index, ctx);
    }

    fn quiet_for_long(&mut self, index: usize, ctx: &mut Ctx<'_>) {
        // A frame interrupts the quiet time, and its end restarts the count.
        if self.buses[index].in_frame() {
            return;
        }
        let controller = &mut self.controllers[index];
        match controller.mode {
            Mode::Synchronising(until) if until <= ctx.now => {
                controller.synchronised(ctx);
                self.wake_when_quiet(index, ctx);
            }
            Mode::Synchronising(_) => {}
            _ => controller.recover_if_due(ctx.now),
        }
    }

    fn read_controller(&self, index: usize, register: u32) -> Option<u32> {
        let can = &self.controllers[index];
        Some(match register {
            reg::MCR => can.mcr,
            reg::MSR => can.status(),
            reg::TSR => can.mailboxes.status(can.by_request_order()),
            reg::RF0R => can.fifos[0].status(),
            reg::RF1R => can.fifos[1].status(),
            reg::IER => can.ier,
            reg::ESR => can.errors.register(),
            reg::BTR => can.timing.0,
            _ if MAILBOXES.contains(&register) => {
                let (mailbox, word) = cluster_word(register - MAILBOXES.start);
                can.mailboxes.read(mailbox, word)
            }
            _ if FIFOS.contains(&register) => {
                let (fifo, word) = cluster_word(register - FIFOS.start);
                can.fifos[fifo].front()[word]
            }
            _ => return None,
        })
    }

    fn write_controller(
        &mut self,
        index: usize,
        register: u32,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let block = name(index);
        let refuse = |what: &str| Err(reg::MAP.unmodelled(block, register, what));
        let can = &mut self.controllers[index];
        match register {
            reg::MCR if value & mcr::RESET != 0 => self.reset_controller(index, ctx),
            reg::MCR => can.mcr = value & mcr::KEPT,
            reg::MSR => can.msr_flags &= !(value & msr::CLEARED_BY_1),
            reg::TSR => can.mailboxes.write_status(value),
            reg::RF0R => can.fifos[0].write_status(value),
            reg::RF1R => can.fifos[1].write_status(value),
            reg::IER => can.ier = value & ier::ALL,
            reg::ESR => can.errors.write_lec((value >> 4) as u8),
            reg::BTR if value & !BTR_MODELLED != 0 => return refuse("loop back mode"),
            reg::BTR if can.mode == Mode::Initialization => can.timing = BitTiming(value),
            reg::BTR => {
                let message = format!(
                    "{}: BTR written outside initialization mode: ignored",
                    can.name()
                );
                ctx.errors.report(ctx.now, message);
            }
            _ if MAILBOXES.contains(&register) => {
                let (mailbox, word) = cluster_word(register - MAILBOXES.start);
                if word == 0 && value & 0b11 == 0b11 {
                    return refuse("sending a remote frame");
                }
                if !can.mailboxes.write(mailbox, word, value) {
                    let message = format!(
                        "{}: mailbox {mailbox} written while its frame waits: ignored",
                        can.name()
                    );
                    ctx.errors.report(ctx.now, message);
                }
            }
            _ => return Err(reg::MAP.unmodelled_write(block, register, value)),
        }
        Ok(())
    }
}

fn name(index: usize) -> &'static str {
    ["CAN1", "CAN2"][index]
}

/// The mailbox of a register cluster, and the word in it.
fn cluster_word(offset: u32) -> (usize, usize) {
    ((offset / 0x10) as usize, (offset % 0x10 / 4) as usize)
}

impl Peripheral for Can {
    fn read(&mut self, offset: u32, size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        let (index, register) = ((access.register / CAN2) as usize, access.register % CAN2);
        let value = self
            .read_controller(index, register)
            .or_else(|| self.filters.read(register).filter(|_| index == 0))
            .ok_or_else(|| reg::MAP.unmodelled_read(name(index), register))?;
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
        let (index, register) = ((access.register / CAN2) as usize, access.register % CAN2);
        if index == 0 && register >= reg::FMR {
            let old = self.filters.read(register).unwrap_or(0);
            return self
                .filters
                .write(register, access.written_over(old, value), ctx)
                .ok_or_else(|| reg::MAP.unmodelled_write(name(index), register, value));
        }
        // Status bits are cleared by writing ones, so bytes outside a narrow write count as zeros.
        let old = match register {
            reg::MSR..=reg::RF1R => 0,
            _ => self.read_controller(index, register).unwrap_or(0),
        };
        self.write_controller(index, register, access.written_over(old, value), ctx)?;
        self.settle(index, ctx);
        Ok(())
    }

    fn event(&mut self, tag: u32, ctx: &mut Ctx<'_>) {
        let index = (tag & 1) as usize;
        if tag >> 1 == BUS_PHASE {
            let controller = &mut self.controllers[index];
            let again_at = self.buses[index].phase_ended(controller, &self.filters, ctx);
            self.wake_at(again_at, BUS_PHASE, index, ctx);
            self.wake_when_quiet(index, ctx);
        } else {
            self.quiet_for_long(index, ctx);
        }
        self.settle(index, ctx);
    }

    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        for index in 0..2 {
            self.reset_controller(index, ctx);
        }
    }

    fn board_advanced(&mut self, ctx: &mut Ctx<'_>) {
        for index in 0..2 {
            self.settle(index, ctx);
        }
    }
}
