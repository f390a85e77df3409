//! Flash, SRAM, CCM and system memory as the CPU and the other bus masters see them (RM0090 2.3).

use unicorn_engine::{Prot, Unicorn, uc_error};

use crate::soc::{
    adc::{temperature_counts, vrefint_counts},
    guest_memory::GuestMemory,
};

/// A range of the address space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// First address.
    pub base: u32,
    /// Bytes.
    pub size: u32,
}

impl Region {
    /// Whether all `len` bytes from `addr` on lie in this range.
    pub fn contains(self, addr: u32, len: u32) -> bool {
        addr >= self.base
            && u64::from(addr) + u64::from(len) <= u64::from(self.base) + u64::from(self.size)
    }

    /// Whether any of the `len` bytes from `addr` on lies in this range.
    pub fn overlaps(self, addr: u32, len: u32) -> bool {
        u64::from(addr) < u64::from(self.base) + u64::from(self.size)
            && u64::from(addr) + u64::from(len) > u64::from(self.base)
    }
}

/// Main memory, 1 MiB in one bank (RM0090 3.3).
pub const FLASH: Region = Region {
    base: 0x0800_0000,
    size: 0x10_0000,
};
/// With BOOT0 = 0 the flash is also visible at address 0.
pub const FLASH_ALIAS: Region = Region {
    base: 0,
    size: 0x10_0000,
};
/// Sectors 1–3: their cells belong to the flash interface, and every access of the core goes there.
pub const DATA_FLASH: Region = Region {
    base: 0x0800_4000,
    size: 0xC000,
};
/// [`DATA_FLASH`] as seen at address 0.
pub const DATA_FLASH_ALIAS: Region = Region {
    base: 0x4000,
    ..DATA_FLASH
};
/// Core-coupled memory, out of reach of DMA.
pub const CCM: Region = Region {
    base: 0x1000_0000,
    size: 0x1_0000,
};
/// SRAM1 and SRAM2.
pub const SRAM: Region = Region {
    base: 0x2000_0000,
    size: 0x2_0000,
};
/// System bootloader, OTP and device signature.
const SYSTEM_MEMORY: Region = Region {
    base: 0x1FFF_0000,
    size: 0x8000,
};
/// Not a memory of the chip: it holds the endless loop in which a function hangs.
pub const HANG: Region = Region {
    base: 0x1F00_0000,
    size: 0x1000,
};
const UNIQUE_ID: u32 = 0x1FFF_7A10;
const FLASH_SIZE_KIB: u32 = 0x1FFF_7A22;
/// VREFINT as the maker measured it at 3.3 V and 30 °C, in counts (DS8626 table 76).
const VREFIN_CAL: u32 = 0x1FFF_7A2A;
/// The temperature sensor as the maker measured it at 3.3 V, in counts: TS_CAL1 at 30 °C, TS_CAL2 at 110 °C (DS8626,
/// temperature sensor calibration values).
const TS_CAL: [(u32, f64); 2] = [(0x1FFF_7A2C, 30.0), (0x1FFF_7A2E, 110.0)];

/// Maps the memories and fills them as they are at power-on: flash and OTP erased, RAM full of noise. Sectors 1–3 are
/// left out. SRAM is not executable, because otherwise the engine would check every store for changed code.
pub fn map<D>(engine: &mut Unicorn<'_, D>) -> Result<(), uc_error> {
    for (region, rights) in [
        (SYSTEM_MEMORY, Prot::READ),
        (HANG, Prot::READ | Prot::EXEC),
        (SRAM, Prot::READ | Prot::WRITE),
        (CCM, Prot::READ | Prot::WRITE),
    ] {
        engine.mem_map(region.base.into(), region.size.into(), rights)?;
    }
    for (flash, hole) in [(FLASH, DATA_FLASH), (FLASH_ALIAS, DATA_FLASH_ALIAS)] {
        for part in around(flash, hole) {
            engine.mem_map(part.base.into(), part.size.into(), Prot::READ | Prot::EXEC)?;
            engine.mem_write(part.base.into(), &vec![0xFF; part.size as usize])?;
        }
    }
    let system = vec![0xFF; SYSTEM_MEMORY.size as usize];
    engine.mem_write(SYSTEM_MEMORY.base.into(), &system)?;
    for region in [SRAM, CCM] {
        engine.mem_write(region.base.into(), &power_on_noise(region))?;
    }
    engine.mem_write(HANG.base.into(), &endless_loop())?;
    engine.mem_write(UNIQUE_ID.into(), b"EMULATEDBRD1")?;
    engine.mem_write(FLASH_SIZE_KIB.into(), &1024_u16.to_le_bytes())?;
    for (address, celsius) in TS_CAL {
        engine.mem_write(address.into(), &temperature_counts(celsius).to_le_bytes())?;
    }
    engine.mem_write(VREFIN_CAL.into(), &vrefint_counts(3.3).to_le_bytes())
}

/// The parts of `whole` below and above `hole`.
fn around(whole: Region, hole: Region) -> [Region; 2] {
    let (hole_end, end) = (hole.base + hole.size, whole.base + whole.size);
    [
        Region {
            base: whole.base,
            size: hole.base - whole.base,
        },
        Region {
            base: hole_end,
            size: end - hole_end,
        },
    ]
}

/// NOPs and a branch back to the first. The loop is long enough to be emulated fast, and much shorter than any deadline.
fn endless_loop() -> Vec<u8> {
    const NOPS: usize = 62;
    const NOP: u16 = 0xBF00;
    const BRANCH_BACK: u16 = 0xE000 | 0x7FF & (NOPS as u16 + 2).wrapping_neg();
    [NOP; NOPS]
        .into_iter()
        .chain([BRANCH_BACK])
        .flat_map(u16::to_le_bytes)
        .collect()
}

/// Contents of the RAM after power-on: noise that is the same in every run.
pub fn power_on_noise(region: Region) -> Vec<u8> {
    let mut state = region.base | 1;
    let mut word = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state
    };
    (0..region.size / 4)
        .flat_map(|_| word().to_le_bytes())
        .collect()
}

/// The memories as DMA reaches them through the engine, without sectors 1–3.
pub struct EngineMemory<'u, 'a, D>(pub &'u mut Unicorn<'a, D>);

impl<D> GuestMemory for EngineMemory<'_, '_, D> {
    fn read(&mut self, addr: u32, out: &mut [u8]) -> bool {
        is_memory(addr, out.len()) && self.0.mem_read(addr.into(), out).is_ok()
    }

    fn write(&mut self, addr: u32, data: &[u8]) -> bool {
        is_memory(addr, data.len())
            && !FLASH.contains(addr, data.len() as u32)
            && self.0.mem_write(addr.into(), data).is_ok()
    }
}

fn is_memory(addr: u32, len: usize) -> bool {
    let len = len as u32;
    let in_memory = [FLASH, SRAM, CCM, SYSTEM_MEMORY]
        .iter()
        .any(|r| r.contains(addr, len));
    in_memory && !DATA_FLASH.overlaps(addr, len)
}
