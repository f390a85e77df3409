//! Registers, exception entry and return (ARMv7-M ARM B1.5.6 to B1.5.8).

use unicorn_engine::{RegisterARM, Unicorn};

use super::{Cpu, ENTRY_CYCLES, FP_FRAME_CYCLES, Halt, RETURN_CYCLES, State, TAIL_CHAIN_CYCLES};
use crate::core::{
    exception::Exception,
    faults::{Fault, HFSR_FORCED},
    memory::{CCM, SRAM},
    nvic::Masks,
};

const XPSR_THUMB: u32 = 1 << 24;
/// Bit of a stacked xPSR: the frame starts four bytes below the old stack pointer's word.
const XPSR_PADDED: u32 = 1 << 9;
const XPSR_FLAGS: u32 = 0xF80F_0000;
const CONTROL_NPRIV: u32 = 1;
const CONTROL_SPSEL: u32 = 1 << 1;
/// FPCA, and the bit SFPA that the engine keeps for its secure state. They must be set and cleared together; otherwise the
/// engine would start a new floating-point context in the middle of one.
const CONTROL_FPCA: u32 = 1 << 2 | 1 << 3;
const EXC_RETURN_STANDARD_FRAME: u32 = 1 << 4;
const EXC_RETURN_THREAD: u32 = 1 << 3;
const EXC_RETURN_PSP: u32 = 1 << 2;
const BASIC_FRAME: u32 = 8 * 4;
const EXTENDED_FRAME: u32 = 26 * 4;

const STACKED: [RegisterARM; 6] = [
    RegisterARM::R0,
    RegisterARM::R1,
    RegisterARM::R2,
    RegisterARM::R3,
    RegisterARM::R12,
    RegisterARM::LR,
];
const FP_STACKED: [RegisterARM; 16] = [
    RegisterARM::S0,
    RegisterARM::S1,
    RegisterARM::S2,
    RegisterARM::S3,
    RegisterARM::S4,
    RegisterARM::S5,
    RegisterARM::S6,
    RegisterARM::S7,
    RegisterARM::S8,
    RegisterARM::S9,
    RegisterARM::S10,
    RegisterARM::S11,
    RegisterARM::S12,
    RegisterARM::S13,
    RegisterARM::S14,
    RegisterARM::S15,
];

/// Every register here is 32 bits wide and known to the engine.
pub(super) fn register(engine: &Unicorn<'_, State>, register: RegisterARM) -> u32 {
    engine
        .reg_read(register)
        .expect("the engine knows the register") as u32
}

pub(super) fn masks(engine: &Unicorn<'_, State>) -> Masks {
    Masks {
        primask: register(engine, RegisterARM::PRIMASK) != 0,
        faultmask: register(engine, RegisterARM::FAULTMASK) != 0,
        basepri: register(engine, RegisterARM::BASEPRI) as u8,
    }
}

/// Whether this is thread mode without privilege. Handlers are always privileged.
pub(super) fn is_unprivileged(engine: &Unicorn<'_, State>) -> bool {
    engine.get_data().system.nvic.current() == Exception::THREAD
        && register(engine, RegisterARM::CONTROL) & CONTROL_NPRIV != 0
}

impl Cpu {
    pub(super) fn register(&self, name: RegisterARM) -> u32 {
        register(&self.engine, name)
    }

    pub(super) fn set_register(&mut self, name: RegisterARM, value: u32) {
        self.engine
            .reg_write(name, value.into())
            .expect("the engine knows the register");
    }

    /// The T bit, which the engine exposes only in the CPSR of other ARM processors.
    pub(super) fn is_thumb(&self) -> bool {
        const CPSR_THUMB: u32 = 1 << 5;
        self.register(RegisterARM::CPSR) & CPSR_THUMB != 0
    }

    /// Sets xPSR and makes the engine notice a change of mode, which only a write of the flags alone does.
    fn set_xpsr(&mut self, value: u32) {
        self.set_register(RegisterARM::XPSR_NZCVQG, value);
        self.set_register(RegisterARM::APSR_NZCV, value);
    }

    pub(super) fn reset_registers(&mut self) {
        self.set_xpsr(XPSR_THUMB);
        self.set_register(RegisterARM::CONTROL, 0);
        for mask in [
            RegisterARM::PRIMASK,
            RegisterARM::FAULTMASK,
            RegisterARM::BASEPRI,
        ] {
            self.set_register(mask, 0);
        }
        for name in STACKED {
            self.set_register(name, 0);
        }
        self.set_register(RegisterARM::LR, u32::MAX);
        self.set_register(RegisterARM::FPSCR, 0);
        let sp = self.word(0).unwrap_or(0) & !3;
        let entry = self.word(4).unwrap_or(0);
        self.set_register(RegisterARM::MSP, sp);
        self.set_register(RegisterARM::PSP, 0);
        self.set_register(RegisterARM::PC, entry | 1);
    }

    fn word(&self, addr: u32) -> Option<u32> {
        let mut bytes = [0; 4];
        self.read_memory(addr, &mut bytes)
            .then(|| u32::from_le_bytes(bytes))
    }

    fn is_thread(&self) -> bool {
        self.state().system.nvic.current() == Exception::THREAD
    }

    /// Stacks the context and starts the handler.
    pub(super) fn enter(&mut self, exception: Exception) -> Result<(), Halt> {
        let control = self.register(RegisterARM::CONTROL);
        let uses_psp = self.is_thread() && control & CONTROL_SPSEL != 0;
        let extended = control & CONTROL_FPCA != 0;
        let xpsr = self.register(RegisterARM::XPSR);
        if is_unprivileged(&self.engine) {
            // The engine exposes the stack pointers to privileged code only, and a handler is privileged.
            self.set_xpsr(xpsr & XPSR_FLAGS | XPSR_THUMB | exception.number());
        }
        let stacked = self.push_frame(uses_psp, extended, xpsr);
        if !stacked {
            self.state_mut().system.faults.record(Fault::Stacking);
        }
        let mut exc_return = 0xFFFF_FFE1;
        exc_return |= if extended {
            0
        } else {
            EXC_RETURN_STANDARD_FRAME
        };
        exc_return |= if self.is_thread() {
            EXC_RETURN_THREAD
        } else {
            0
        };
        exc_return |= if uses_psp { EXC_RETURN_PSP } else { 0 };
        self.state_mut()
            .spend(ENTRY_CYCLES + if extended { FP_FRAME_CYCLES } else { 0 });
        if !stacked && !self.handles_stacking_fault(exception) {
            return self.start_handler(Exception::HARD_FAULT, exc_return);
        }
        self.start_handler(exception, exc_return)
    }

    /// A frame that could not be written is a BusFault on top of the entry: unless the entry is to a fault handler
    /// of at least its priority, HardFault runs instead and the entry stays pending.
    fn handles_stacking_fault(&mut self, exception: Exception) -> bool {
        if matches!(exception, Exception::HARD_FAULT | Exception::NMI) {
            return true;
        }
        let system = &mut self.state_mut().system;
        system.nvic.pend(exception);
        system.faults.hfsr |= HFSR_FORCED;
        false
    }

    fn start_handler(&mut self, exception: Exception, exc_return: u32) -> Result<(), Halt> {
        let vector_at = self.state().system.vector_table() + 4 * exception.number();
        let Some(vector) = self.word(vector_at) else {
            return Err(self.halt(format!(
                "lock-up: no vector for {} at 0x{vector_at:08X}",
                exception.name()
            )));
        };
        let xpsr = self.register(RegisterARM::XPSR) & XPSR_FLAGS;
        self.set_register(
            RegisterARM::CONTROL,
            self.register(RegisterARM::CONTROL) & !(CONTROL_FPCA | CONTROL_SPSEL),
        );
        self.set_xpsr(xpsr | XPSR_THUMB | exception.number());
        self.set_register(RegisterARM::LR, exc_return);
        self.set_register(RegisterARM::PC, vector | 1);
        let state = self.state_mut();
        state.system.nvic.activate(exception);
        state.event = true;
        state.attention = true;
        if self.state().system.debug.catches(exception) {
            self.enter_debug_state(&format!("the first instruction of {}", exception.name()));
        }
        if vector & 1 == 0 {
            return self.raise(Fault::InvalidState);
        }
        Ok(())
    }

    /// Returns false if the frame does not fit into RAM. The stack pointer moves anyway, as on silicon.
    fn push_frame(&mut self, uses_psp: bool, extended: bool, xpsr: u32) -> bool {
        let stack = if uses_psp {
            RegisterARM::PSP
        } else {
            RegisterARM::MSP
        };
        let before = self.register(stack);
        let size = if extended {
            EXTENDED_FRAME
        } else {
            BASIC_FRAME
        };
        let aligns = extended || self.state().system.aligns_stack();
        let padded = aligns && before & 4 != 0;
        let frame = before.wrapping_sub(size) & if aligns { !7 } else { !3 };
        let mut words: Vec<u32> = STACKED.iter().map(|&name| self.register(name)).collect();
        words.push(self.pc());
        words.push(xpsr & !XPSR_PADDED | if padded { XPSR_PADDED } else { 0 });
        if extended {
            words.extend(FP_STACKED.iter().map(|&name| self.register(name)));
            words.extend([self.register(RegisterARM::FPSCR), 0]);
        }
        self.set_register(stack, frame);
        let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
        is_ram(frame, size) && self.engine.mem_write(frame.into(), &bytes).is_ok()
    }

    /// Handles a branch to an EXC_RETURN value, which ends the handler. A pending exception runs next without unstacking.
    pub(super) fn return_from_exception(&mut self, exc_return: u32) -> Result<(), Halt> {
        const VALID: [u32; 6] = [
            0xFFFF_FFE1,
            0xFFFF_FFE9,
            0xFFFF_FFED,
            0xFFFF_FFF1,
            0xFFFF_FFF9,
            0xFFFF_FFFD,
        ];
        let to_thread = exc_return & EXC_RETURN_THREAD != 0;
        let ended = self.state().system.nvic.current();
        self.retire(ended);
        if !VALID.contains(&exc_return) || to_thread != self.state().system.nvic.returns_to_base() {
            self.set_register(RegisterARM::LR, exc_return);
            self.state_mut().system.faults.record(Fault::InvalidReturn);
            return self.start_handler(Exception::HARD_FAULT, exc_return);
        }
        let masks = masks(&self.engine);
        if let Some(next) = self.state().system.deliverable(masks) {
            self.state_mut().spend(TAIL_CHAIN_CYCLES);
            return self.start_handler(next, exc_return);
        }
        if !self.pop_frame(exc_return) {
            self.state_mut().system.faults.record(Fault::Unstacking);
            return self.start_handler(Exception::HARD_FAULT, exc_return);
        }
        if to_thread {
            self.sleep_on_exit();
        }
        Ok(())
    }

    fn retire(&mut self, ended: Exception) {
        if ended != Exception::NMI {
            self.set_register(RegisterARM::FAULTMASK, 0);
        }
        let state = self.state_mut();
        let line_high = ended
            .irq()
            .is_some_and(|irq| state.soc.as_ref().is_some_and(|soc| soc.irq.level(irq)));
        state.system.nvic.retire(line_high);
        state.event = true;
        state.attention = true;
    }

    fn pop_frame(&mut self, exc_return: u32) -> bool {
        let extended = exc_return & EXC_RETURN_STANDARD_FRAME == 0;
        let size = if extended {
            EXTENDED_FRAME
        } else {
            BASIC_FRAME
        };
        let to_psp = exc_return & EXC_RETURN_PSP != 0;
        let stack = if to_psp {
            RegisterARM::PSP
        } else {
            RegisterARM::MSP
        };
        let frame = self.register(stack);
        let mut bytes = vec![0; size as usize];
        if !is_ram(frame, size) || !self.read_memory(frame, &mut bytes) {
            return false;
        }
        let words: Vec<u32> = bytes
            .chunks_exact(4)
            .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect();
        for (name, &value) in STACKED.iter().zip(&words) {
            self.set_register(*name, value);
        }
        let (pc, xpsr) = (words[6], words[7]);
        if extended {
            for (name, &value) in FP_STACKED.iter().zip(&words[8..]) {
                self.set_register(*name, value);
            }
            self.set_register(RegisterARM::FPSCR, words[24]);
        }
        self.set_register(
            stack,
            frame + size + if xpsr & XPSR_PADDED != 0 { 4 } else { 0 },
        );
        self.resume(pc, xpsr & !XPSR_PADDED, to_psp, extended);
        self.state_mut()
            .spend(RETURN_CYCLES + if extended { FP_FRAME_CYCLES } else { 0 });
        true
    }

    fn resume(&mut self, pc: u32, xpsr: u32, to_psp: bool, fp_active: bool) {
        let exception = Exception::from_number(xpsr & 0x1FF).unwrap_or(Exception::THREAD);
        let before = self.register(RegisterARM::CONTROL) & !(CONTROL_FPCA | CONTROL_SPSEL);
        // Privilege is dropped last, because afterwards the engine ignores writes to CONTROL.
        self.set_register(RegisterARM::CONTROL, before & !CONTROL_NPRIV);
        self.set_xpsr(xpsr | XPSR_THUMB);
        let mut control = before;
        control |= if fp_active { CONTROL_FPCA } else { 0 };
        control |= if to_psp { CONTROL_SPSEL } else { 0 };
        self.set_register(RegisterARM::CONTROL, control);
        self.set_register(RegisterARM::PC, pc | 1);
        self.state_mut().system.nvic.resume(exception);
    }
}

fn is_ram(addr: u32, size: u32) -> bool {
    SRAM.contains(addr, size) || CCM.contains(addr, size)
}
