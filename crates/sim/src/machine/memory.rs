//! Damage to the board's memory.

use robot_emulator::soc::guest_memory::GuestMemory;

use super::Machine;

impl Machine {
    /// Flips bits of the byte at `offset` of the first static whose demangled name ends so. Returns false if there is none.
    pub fn flip_bits(&mut self, name_ends: &str, offset: u32, bits: u8) -> bool {
        let Some((start, size)) = self.image.static_item(name_ends) else {
            return false;
        };
        let mut byte = [0];
        let mut memory = self.cpu.memory();
        if offset >= size || !memory.read(start + offset, &mut byte) {
            return false;
        }
        memory.write(start + offset, &[byte[0] ^ bits])
    }
}
