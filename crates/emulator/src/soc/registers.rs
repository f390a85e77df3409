//! Register offsets by the reference manual's names, and the errors for accesses that a block does not model.

use std::fmt::Display;

use crate::soc::peripheral::Unmodelled;

/// The registers of a kind of block: offset and name.
pub(crate) struct RegisterMap(pub(crate) &'static [(u32, &'static str)]);

impl RegisterMap {
    /// Name such as `"USART3.GTPR"`, or `"USART3+0x50"` if the manual has no register there.
    fn name(&self, block: impl Display, offset: u32) -> String {
        let word = offset & !3;
        self.0.iter().find(|(at, _)| *at == word).map_or_else(
            || format!("{block}+{offset:#x}"),
            |(_, name)| format!("{block}.{name}"),
        )
    }

    /// Error for the access `what` to the register at `offset` of `block`, which is not modelled.
    pub(crate) fn unmodelled(
        &self,
        block: impl Display,
        offset: u32,
        what: impl Into<String>,
    ) -> Unmodelled {
        Unmodelled {
            register: self.name(block, offset),
            what: what.into(),
        }
    }

    /// Error for a read of a register that is not modelled.
    pub(crate) fn unmodelled_read(&self, block: impl Display, offset: u32) -> Unmodelled {
        self.unmodelled(block, offset, "read")
    }

    /// Error for a write of `value`, which has bits that are not modelled.
    pub(crate) fn unmodelled_write(
        &self,
        block: impl Display,
        offset: u32,
        value: u32,
    ) -> Unmodelled {
        self.unmodelled(block, offset, format!("write of {value:#010x}"))
    }
}

/// Declares `mod reg` with a constant for each register offset and `MAP`, the [`RegisterMap`] of them.
macro_rules! registers {
    ($($name:ident = $offset:literal),+ $(,)?) => {
        pub(crate) mod reg {
            $(pub(crate) const $name: u32 = $offset;)+
            pub(crate) const MAP: $crate::soc::registers::RegisterMap =
                $crate::soc::registers::RegisterMap(&[$(($name, stringify!($name))),+]);
        }
    };
}

pub(crate) use registers;
