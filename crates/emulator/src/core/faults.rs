//! Fault status registers and the faults that fill them (ARMv7-M ARM B3.2.15).

use crate::core::exception::Exception;

/// Cause of a fault, with the address if the hardware reports one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Load or store at an address where nothing responds. Stores are reported as precisely as loads, which a real
    /// write buffer cannot always do.
    DataBus {
        address: u32,
    },
    /// Instruction fetch from an address where nothing responds.
    FetchBus,
    /// Instruction fetch from memory that may not hold code.
    FetchForbidden,
    /// The frame of an exception entry could not be written.
    Stacking,
    /// The frame of an exception return could not be read.
    Unstacking,
    UndefinedInstruction,
    /// Execution without the Thumb bit.
    InvalidState,
    /// An impossible EXC_RETURN value.
    InvalidReturn,
    Unaligned,
    /// A floating-point instruction while CPACR keeps the FPU off.
    NoCoprocessor,
    /// BKPT without a debugger, which raises HardFault directly.
    Breakpoint,
}

/// CFSR, HFSR and BFAR; MMFAR is never valid without an MPU.
#[derive(Debug, Default)]
pub struct FaultStatus {
    pub cfsr: u32,
    pub hfsr: u32,
    pub bfar: u32,
}

const BFAR_VALID: u32 = 1 << 15;
pub const HFSR_FORCED: u32 = 1 << 30;
const HFSR_DEBUGEVT: u32 = 1 << 31;

impl Fault {
    /// The configurable exception it raises; `None` goes to HardFault directly.
    pub fn exception(self) -> Option<Exception> {
        match self {
            Self::DataBus { .. } | Self::FetchBus | Self::Stacking | Self::Unstacking => {
                Some(Exception::BUS_FAULT)
            }
            Self::FetchForbidden => Some(Exception::MEM_MANAGE),
            Self::UndefinedInstruction
            | Self::InvalidState
            | Self::InvalidReturn
            | Self::Unaligned
            | Self::NoCoprocessor => Some(Exception::USAGE_FAULT),
            Self::Breakpoint => None,
        }
    }
}

impl FaultStatus {
    pub fn record(&mut self, fault: Fault) {
        self.cfsr |= match fault {
            Fault::FetchForbidden => 1,
            Fault::FetchBus => 1 << 8,
            Fault::DataBus { address } => {
                self.bfar = address;
                1 << 9 | BFAR_VALID
            }
            Fault::Unstacking => 1 << 11,
            Fault::Stacking => 1 << 12,
            Fault::UndefinedInstruction => 1 << 16,
            Fault::InvalidState => 1 << 17,
            Fault::InvalidReturn => 1 << 18,
            Fault::NoCoprocessor => 1 << 19,
            Fault::Unaligned => 1 << 24,
            Fault::Breakpoint => 0,
        };
        if fault == Fault::Breakpoint {
            self.hfsr |= HFSR_DEBUGEVT;
        }
    }
}
