//! The host's end of a bus in simulated time.

use crate::{bus::Bus, fault::Fault};

/// A serial port on a bus, without a clock: time passes only when it is told to, or while it waits for bytes.
///
/// ```
/// use robot_servo_model::{Servo, Bus, VirtualWire, Version};
///
/// let servo = Servo::new(Version::Volts12, 2048.0).with_return_delay(0);
/// let mut wire = VirtualWire::new(Bus::new(vec![servo], 1));
/// wire.write(&[0xFF, 0xFF, 0x01, 0x02, 0x01, 0xFB]); // ping 1
/// let mut answer = [0; 6];
/// assert_eq!(wire.read(&mut answer, wire.now_ns() + 1_000_000), 6);
/// assert_eq!(answer, [0xFF, 0xFF, 0x01, 0x02, 0x00, 0xFC]);
/// // Six bytes there, 2 µs of return delay, six bytes back, 10 µs each.
/// assert_eq!(wire.now_ns(), 122_000);
/// ```
pub struct VirtualWire {
    bus: Bus,
}

impl VirtualWire {
    /// Returns the host's end of a bus.
    pub fn new(bus: Bus) -> Self {
        Self { bus }
    }

    /// Time, ns since the bus began.
    pub fn now_ns(&self) -> u64 {
        self.bus.now_ns()
    }

    /// The bus, to start faults and look at servos.
    pub fn bus(&mut self) -> &mut Bus {
        &mut self.bus
    }

    /// Changes the baud rate, b/s, for what is written and read from now on.
    pub fn set_baud(&mut self, baud: u32) {
        self.bus.set_host_baud(baud);
    }

    /// Gives bytes to the port, which sends them one after the other. Takes no time.
    pub fn write(&mut self, bytes: &[u8]) {
        self.bus.send(bytes);
    }

    /// Waits until all that was written is on the wire.
    pub fn flush(&mut self) {
        self.bus.advance(self.bus.sent_ns());
    }

    /// Reads bytes until `into` is full or it is `deadline_ns`, and returns their number. Time then is that of the last byte, or
    /// the deadline. With a deadline that has passed it reads what has arrived, and no time passes.
    pub fn read(&mut self, into: &mut [u8], deadline_ns: u64) -> usize {
        let mut read = 0;
        while read < into.len() {
            if let Some((_, byte)) = self.bus.take_heard() {
                into[read] = byte;
                read += 1;
                continue;
            }
            match self.bus.next_change_ns() {
                Some(next_ns) if next_ns <= deadline_ns => self.bus.advance(next_ns),
                _ => {
                    self.bus.advance(deadline_ns);
                    break;
                }
            }
        }
        read
    }

    /// Lets time pass, ns.
    pub fn wait(&mut self, for_ns: u64) {
        self.bus.advance(self.bus.now_ns() + for_ns);
    }

    /// Drops what has arrived and was not read.
    pub fn discard_input(&mut self) {
        self.bus.discard_heard();
    }

    /// Starts a fault at once, and ends it after a time, ns.
    pub fn fault_for(&mut self, fault: Fault, for_ns: u64) {
        let now_ns = self.bus.now_ns();
        self.bus
            .schedule(fault, now_ns, now_ns.saturating_add(for_ns));
    }
}
