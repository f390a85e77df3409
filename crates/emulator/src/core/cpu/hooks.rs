//! Callbacks of the engine: block boundaries, register accesses, faults and engine-internal exceptions.

use unicorn_engine::{HookType, MemType, Prot, RegisterARM, TlbEntry, TlbType, Unicorn, uc_error};

use super::{Block, State, Stop, alignment, context, fault_injection, it_state};
use crate::{
    core::{
        faults::Fault,
        memory::{CCM, DATA_FLASH, DATA_FLASH_ALIAS, EngineMemory, Region, SRAM},
        system::{Surroundings, System},
    },
    soc::{bus::Soc, guest_memory::GuestMemory, peripheral::Unmodelled, reset::ResetCause},
    time::Ps,
};

const PERIPHERALS: (u64, u64) = (0x4000_0000, 0x2000_0000);
const PRIVATE_PERIPHERALS: (u64, u64) = (0xE000_0000, 0x0010_0000);

pub(super) fn install(engine: &mut Unicorn<'static, State>) -> Result<(), uc_error> {
    let (base, size) = PERIPHERALS;
    engine.mmio_map(base, size, Some(read_peripheral), Some(write_peripheral))?;
    let (base, size) = PRIVATE_PERIPHERALS;
    engine.mmio_map(base, size, Some(read_private), Some(write_private))?;
    for region in [DATA_FLASH, DATA_FLASH_ALIAS] {
        let (base, size) = (region.base.into(), region.size.into());
        engine.mmio_map(base, size, Some(load_data_flash), Some(store_data_flash))?;
    }
    engine.ctl_set_tlb_type(TlbType::VIRTUAL)?;
    engine.add_tlb_hook(0, u64::from(u32::MAX), page_rights)?;
    engine.add_block_hook(1, 0, block_begins)?;
    // A hook over RAM, even one for accesses that cannot happen there, would slow every store down.
    let above = |region: Region| u64::from(region.base) + u64::from(region.size);
    for (first, last) in [
        (0, u64::from(CCM.base) - 1),
        (above(CCM), u64::from(SRAM.base) - 1),
        (above(SRAM), u64::from(u32::MAX)),
    ] {
        engine.add_mem_hook(HookType::MEM_INVALID, first, last, refused_access)?;
    }
    engine.add_intr_hook(engine_exception)?;
    Ok(())
}

/// Maps every page to its own address. The engine uses a slow path for each store to a page that may hold code, and the
/// Cortex-M's own map allows code in RAM. RAM is therefore marked as not executable here. A fetch from it still reaches
/// the memory map, which refuses it.
fn page_rights(engine: &mut Unicorn<'_, State>, page: u64, access: MemType) -> Option<TlbEntry> {
    if access != MemType::FETCH {
        it_state::clear(engine);
    }
    let is_ram = [SRAM, CCM].iter().any(|ram| ram.contains(page as u32, 1));
    let perms = if is_ram && access != MemType::FETCH {
        Prot::READ | Prot::WRITE
    } else {
        Prot::ALL
    };
    Some(TlbEntry { paddr: page, perms })
}

fn block_begins(engine: &mut Unicorn<'_, State>, address: u64, size: u32) {
    let aligned = alignment::held_after(engine);
    let state = engine.get_data_mut();
    state.settle();
    if !aligned && state.stop.is_none() {
        state.stop = Some(Stop::Fault(Fault::Unaligned));
        leave(engine);
    }
    if engine.get_data().stop.is_some() {
        return;
    }
    let state = engine.get_data_mut();
    if state.clock.cycles >= state.due_cycle || state.attention {
        boundary(engine);
        if engine.get_data().stop.is_some() {
            leave(engine);
            return;
        }
    }
    let start = address as u32;
    if fault_injection::is_due(engine, start) {
        leave(engine);
        return;
    }
    let state = engine.get_data_mut();
    if state.system.debug.breaks_in(start, start + size) {
        // Silicon stops before the instruction, the emulator before its block.
        state.stop = Some(Stop::Breakpoint);
        leave(engine);
        return;
    }
    let (cost, accesses) = match engine.get_data().costs.known(start, size) {
        Some(known) => known,
        None => {
            let code = engine
                .mem_read_as_vec(address, size as usize)
                .unwrap_or_default();
            engine.get_data_mut().costs.learn(start, &code)
        }
    };
    if !alignment::holds_before(engine, accesses) {
        // Silicon faults at the access, the emulator before its block.
        engine.get_data_mut().stop = Some(Stop::Fault(Fault::Unaligned));
        leave(engine);
        return;
    }
    let state = engine.get_data_mut();
    if cost.uses_fpu && !state.system.fpu_on() {
        // Taken before the block instead of before its first floating-point instruction.
        state.stop = Some(Stop::Fault(Fault::NoCoprocessor));
        leave(engine);
        return;
    }
    state.event |= cost.sends_event;
    if state.watched_entry == Some(start) {
        state
            .stats
            .entered(state.clock.now(), state.system.nvic.current());
    }
    state.block = Block {
        start,
        end: start + size,
        instructions: cost.instructions,
        cycles: cost.cycles,
        aligned_after: accesses.after,
    };
}

/// Events that are due, then interrupts that may be taken.
fn boundary(engine: &mut Unicorn<'_, State>) {
    run_due(engine);
    let state = engine.get_data_mut();
    if state.stop.is_some() {
        return;
    }
    if !state.standstill.is_over() {
        state.stop = Some(Stop::Standstill);
    } else if state.clock.cycles >= state.limit_cycle {
        state.stop = Some(Stop::Limit);
    } else if !state.system.nvic.waits_for_masks_only() {
        state.attention = false;
    } else {
        let masks = context::masks(engine);
        let state = engine.get_data_mut();
        if state.system.deliverable(masks).is_some() {
            state.stop = Some(Stop::Interrupt);
        }
    }
}

/// Lets chip, board and SysTick come up to the present.
pub(super) fn run_due(engine: &mut Unicorn<'_, State>) {
    let state = engine.get_data_mut();
    if state.clock.cycles < state.due_cycle {
        return;
    }
    if state.system.run_due(state.clock.cycles) {
        state.attention = true;
    }
    if state.clock.now() >= state.soc_event
        && let Err(access) = with_soc(engine, |soc, now, memory| soc.run_due(now, memory))
    {
        engine.get_data_mut().stop = Some(Stop::Unmodelled(access));
    }
    engine.get_data_mut().refresh_due();
}

/// Hands the chip out together with the memories, and takes note of what it did to clock, interrupts and schedule.
pub(super) fn with_soc<R>(
    engine: &mut Unicorn<'_, State>,
    work: impl FnOnce(&mut Soc, Ps, &mut dyn GuestMemory) -> R,
) -> R {
    let now = engine.get_data().clock.now();
    let mut soc = engine
        .get_data_mut()
        .soc
        .take()
        .expect("the chip does not call itself");
    let result = work(&mut soc, now, &mut EngineMemory(engine));
    let state = engine.get_data_mut();
    state.note_soc(&mut soc);
    state.soc = Some(soc);
    result
}

impl State {
    fn note_soc(&mut self, soc: &mut Soc) {
        let risen = soc.irq.take_risen();
        if risen != 0 && self.system.nvic.lines_rose(risen) {
            self.attention = true;
            self.event |= self.system.pending_is_event();
        }
        let stalled_until = soc.flash().stalled_until();
        self.standstill.flash_works_until(stalled_until);
        self.attention |= stalled_until.is_some();
        if let Some(cause) = soc.take_reset_request() {
            self.stop = Some(Stop::Reset(cause));
        }
        let clock_changed = soc.clocks.hclk_hz != self.clock.hz();
        if clock_changed {
            self.clock.set_hz(soc.clocks.hclk_hz);
            self.stats.clock_changed();
        }
        let event = soc.next_event();
        if clock_changed || event != self.soc_event {
            self.soc_event = event;
            self.refresh_due();
        }
    }
}

fn leave(engine: &mut Unicorn<'_, State>) {
    if let Err(error) = engine.emu_stop() {
        engine.get_data_mut().stop =
            Some(Stop::Engine(format!("the engine does not stop: {error:?}")));
    }
}

fn leave_if_stopped(engine: &mut Unicorn<'_, State>) {
    if engine.get_data().stop.is_some() {
        leave(engine);
    }
}

fn refuse(engine: &mut Unicorn<'_, State>, access: Unmodelled) {
    engine.get_data_mut().stop = Some(Stop::Unmodelled(access));
}

/// Ends a load; of what is not modelled the core gets 0 and stops.
fn loaded(engine: &mut Unicorn<'_, State>, value: Result<u32, Unmodelled>) -> u64 {
    let value = value.unwrap_or_else(|access| {
        refuse(engine, access);
        0
    });
    leave_if_stopped(engine);
    value.into()
}

/// Ends a store.
fn stored(engine: &mut Unicorn<'_, State>, done: Result<(), Unmodelled>) {
    if let Err(access) = done {
        refuse(engine, access);
    }
    leave_if_stopped(engine);
}

fn read_peripheral(engine: &mut Unicorn<'_, State>, offset: u64, size: usize) -> u64 {
    it_state::clear(engine);
    let addr = (PERIPHERALS.0 + offset) as u32;
    let value = with_soc(engine, |soc, now, memory| {
        soc.read(addr, size as u8, now, memory)
    });
    loaded(engine, value)
}

fn write_peripheral(engine: &mut Unicorn<'_, State>, offset: u64, size: usize, value: u64) {
    it_state::clear(engine);
    let addr = (PERIPHERALS.0 + offset) as u32;
    let done = with_soc(engine, |soc, now, memory| {
        soc.write(addr, size as u8, value as u32, now, memory)
    });
    stored(engine, done);
}

fn load_data_flash(engine: &mut Unicorn<'_, State>, offset: u64, size: usize) -> u64 {
    it_state::clear(engine);
    let addr = DATA_FLASH.base + offset as u32;
    let value = with_soc(engine, |soc, now, memory| {
        soc.load_data_flash(addr, size as u8, now, memory)
    });
    loaded(engine, value)
}

fn store_data_flash(engine: &mut Unicorn<'_, State>, offset: u64, size: usize, value: u64) {
    it_state::clear(engine);
    let addr = DATA_FLASH.base + offset as u32;
    let done = with_soc(engine, |soc, now, memory| {
        soc.store_data_flash(addr, size as u8, value as u32, now, memory)
    });
    stored(engine, done);
}

fn read_private(engine: &mut Unicorn<'_, State>, offset: u64, size: usize) -> u64 {
    it_state::clear(engine);
    let addr = (PRIVATE_PERIPHERALS.0 + offset) as u32;
    if context::is_unprivileged(engine) {
        return refuse_unprivileged(engine, addr);
    }
    let value = with_system(engine, |system, around| {
        system.read(addr, size as u8, around)
    });
    loaded(engine, value)
}

fn write_private(engine: &mut Unicorn<'_, State>, offset: u64, size: usize, value: u64) {
    it_state::clear(engine);
    let addr = (PRIVATE_PERIPHERALS.0 + offset) as u32;
    let system = &engine.get_data().system;
    if !system.may_be_written_unprivileged(addr) && context::is_unprivileged(engine) {
        refuse_unprivileged(engine, addr);
        return;
    }
    let soc = engine.get_data().soc.as_ref();
    let value = soc.map_or(value as u32, |soc| soc.patched(addr, value as u32));
    let done = with_system(engine, |system, around| {
        system.write(addr, size as u8, value, around)
    });
    if let Err(access) = done {
        refuse(engine, access);
    }
    let state = engine.get_data_mut();
    if state.system.take_reset_request() {
        state.stop = Some(Stop::Reset(ResetCause::Software));
    }
    state.attention = true;
    state.refresh_due();
    leave_if_stopped(engine);
}

/// The private peripheral bus answers privileged code only: a BusFault, and nothing read or written. It is taken when
/// the block has run to its end.
fn refuse_unprivileged(engine: &mut Unicorn<'_, State>, address: u32) -> u64 {
    engine.get_data_mut().stop = Some(Stop::Fault(Fault::DataBus { address }));
    leave(engine);
    0
}

fn with_system<R>(
    engine: &mut Unicorn<'_, State>,
    work: impl FnOnce(&mut System, &Surroundings<'_>) -> R,
) -> R {
    let State {
        system, soc, clock, ..
    } = engine.get_data_mut();
    let line_high = |irq| soc.as_ref().is_some_and(|soc| soc.irq.level(irq));
    work(
        system,
        &Surroundings {
            cycles: clock.cycles,
            line_high: &line_high,
        },
    )
}

/// Accesses outside the map or against its rights. Returning false ends the run with the PC on the instruction.
fn refused_access(
    engine: &mut Unicorn<'_, State>,
    kind: MemType,
    address: u64,
    size: usize,
    value: i64,
) -> bool {
    let address = address as u32;
    let stop = match kind {
        MemType::FETCH_UNMAPPED => Stop::Fault(Fault::FetchBus),
        MemType::FETCH_PROT => Stop::Fault(Fault::FetchForbidden),
        MemType::WRITE_PROT => Stop::Unmodelled(Unmodelled {
            register: format!("flash 0x{address:08X}"),
            what: format!("write of {size} bytes, 0x{value:X},"),
        }),
        _ if is_bit_band(address) => Stop::Unmodelled(Unmodelled {
            register: format!("bit-band alias 0x{address:08X}"),
            what: "access".to_owned(),
        }),
        _ => Stop::Fault(Fault::DataBus { address }),
    };
    engine.get_data_mut().stop = Some(stop);
    false
}

fn is_bit_band(address: u32) -> bool {
    address >> 25 == 0x2200_0000 >> 25
}

/// Exceptions the engine raises itself (numbers of QEMU's `target/arm/cpu.h`).
fn engine_exception(engine: &mut Unicorn<'_, State>, number: u32) {
    const UNDEFINED: u32 = 1;
    const SUPERVISOR_CALL: u32 = 2;
    const PREFETCH_ABORT: u32 = 3;
    const DATA_ABORT: u32 = 4;
    const BREAKPOINT: u32 = 7;
    const EXCEPTION_EXIT: u32 = 8;
    const NO_COPROCESSOR: u32 = 17;
    const UNALIGNED: u32 = 22;
    let stop = match number {
        EXCEPTION_EXIT => Stop::ExceptionReturn(context::register(engine, RegisterARM::PC) | 1),
        SUPERVISOR_CALL => Stop::SupervisorCall,
        BREAKPOINT if engine.get_data().system.debug.is_enabled() => Stop::Breakpoint,
        BREAKPOINT => Stop::Fault(Fault::Breakpoint),
        UNDEFINED => Stop::Fault(Fault::UndefinedInstruction),
        PREFETCH_ABORT => Stop::Fault(Fault::FetchForbidden),
        DATA_ABORT | UNALIGNED => Stop::Fault(Fault::Unaligned),
        NO_COPROCESSOR => Stop::Fault(Fault::NoCoprocessor),
        _ => Stop::Engine(format!("the engine raised exception {number}")),
    };
    engine.get_data_mut().stop = Some(stop);
    leave(engine);
}
