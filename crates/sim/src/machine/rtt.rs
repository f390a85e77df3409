//! SEGGER RTT: the ring buffer through which the image logs.

use robot_emulator::{core::cpu::Cpu, soc::guest_memory::GuestMemory};

/// Offsets in the control block: identifier (16 bytes), two counts, then the first up channel.
const UP_BUFFER: u32 = 24 + 4;
const UP_SIZE: u32 = 24 + 8;
const UP_WRITE: u32 = 24 + 12;
const UP_READ: u32 = 24 + 16;
const UP_FLAGS: u32 = 24 + 20;
/// The image waits for the reader when the ring is full, if it implements that.
const BLOCK_IF_FULL: u32 = 2;
/// Larger than any ring on a chip with 192 KiB of RAM. A control block with a greater size is not initialised yet.
const LARGEST_RING: u32 = 0x1_0000;

/// Up channel 0 of the control block at `control_block`.
#[derive(Debug)]
pub struct Rtt {
    control_block: u32,
}

impl Rtt {
    pub fn new(control_block: u32) -> Self {
        Self { control_block }
    }

    /// Makes the image wait when the ring is full, as a reader does that must not lose data. The next boot clears this.
    pub fn ask_to_block(&self, cpu: &mut Cpu) {
        let flags = self.control_block + UP_FLAGS;
        cpu.memory().write(flags, &BLOCK_IF_FULL.to_le_bytes());
    }

    /// Takes the bytes that the image has written, so that its ring never fills.
    pub fn drain(&self, cpu: &mut Cpu, out: &mut Vec<u8>) {
        let [buffer, size, write, read] = [UP_BUFFER, UP_SIZE, UP_WRITE, UP_READ]
            .map(|offset| word(cpu, self.control_block + offset));
        if write == read || size > LARGEST_RING || write >= size || read >= size {
            return;
        }
        let (first, second) = if write > read {
            (read..write, 0..0)
        } else {
            (read..size, 0..write)
        };
        for range in [first, second] {
            let start = out.len();
            out.resize(start + range.len(), 0);
            if !cpu.read_memory(buffer + range.start, &mut out[start..]) {
                out.truncate(start);
                return;
            }
        }
        cpu.memory()
            .write(self.control_block + UP_READ, &write.to_le_bytes());
    }
}

fn word(cpu: &Cpu, addr: u32) -> u32 {
    let mut bytes = [0; 4];
    if cpu.read_memory(addr, &mut bytes) {
        u32::from_le_bytes(bytes)
    } else {
        0
    }
}
