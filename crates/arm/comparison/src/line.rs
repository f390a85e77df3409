//! The emulated line as both drivers want it.

use std::{
    io::{self, Read, Write},
    sync::{Arc, Mutex},
    time::Duration,
};

use robot_arm::bus::{Wire, WireError};
use robot_servo_model::VirtualWire;
use serialport::{
    ClearBuffer, DataBits, FlowControl, Parity, Result as PortResult, SerialPort, StopBits,
};

/// A wire, what has arrived and was not read, and the time when it began.
#[derive(Clone)]
pub struct Shared(Arc<Mutex<(VirtualWire, Vec<u8>, u64)>>);

impl Shared {
    pub fn new(wire: VirtualWire) -> Self {
        let start = wire.now_ns();
        Self(Arc::new(Mutex::new((wire, Vec::new(), start))))
    }

    pub fn ms_since_start(&self) -> f64 {
        let (wire, _, start) = &*self.0.lock().unwrap();
        (wire.now_ns() - start) as f64 * 1e-6
    }

    fn now(&self) -> Duration {
        Duration::from_nanos(self.0.lock().unwrap().0.now_ns())
    }

    fn send(&self, bytes: &[u8]) {
        self.0.lock().unwrap().0.write(bytes);
    }

    /// At least one byte, or none at the deadline.
    fn receive(&self, buffer: &mut [u8], deadline_ns: u64) -> usize {
        let (wire, arrived, _) = &mut *self.0.lock().unwrap();
        if arrived.is_empty() && !buffer.is_empty() {
            let mut first = [0];
            let count = wire.read(&mut first, deadline_ns);
            arrived.extend(&first[..count]);
        }
        take_arrived(wire, arrived);
        let count = buffer.len().min(arrived.len());
        buffer[..count].copy_from_slice(&arrived[..count]);
        arrived.drain(..count);
        count
    }

    fn waiting(&self) -> usize {
        let (wire, arrived, _) = &mut *self.0.lock().unwrap();
        take_arrived(wire, arrived);
        arrived.len()
    }
}

fn take_arrived(wire: &mut VirtualWire, arrived: &mut Vec<u8>) {
    let mut more = [0; 512];
    let now = wire.now_ns();
    let count = wire.read(&mut more, now);
    arrived.extend(&more[..count]);
}

/// For this driver.
pub struct Ours(pub Shared);

impl Wire for Ours {
    fn name(&self) -> &str {
        "emulated"
    }

    fn now(&self) -> Duration {
        self.0.now()
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), WireError> {
        self.0.send(bytes);
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], deadline: Duration) -> Result<usize, WireError> {
        Ok(self.0.receive(buffer, deadline.as_nanos() as u64))
    }

    fn set_baud(&mut self, _: u32) -> Result<(), WireError> {
        Ok(())
    }

    fn reopen(&mut self) -> Result<(), WireError> {
        Ok(())
    }
}

/// For rustypot, which takes any serial port.
pub struct Line {
    shared: Shared,
    timeout: Duration,
}

impl Line {
    pub fn new(shared: Shared, timeout: Duration) -> Self {
        Self { shared, timeout }
    }
}

impl Read for Line {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let deadline = self.shared.now() + self.timeout;
        match self.shared.receive(buffer, deadline.as_nanos() as u64) {
            0 => Err(io::ErrorKind::TimedOut.into()),
            count => Ok(count),
        }
    }
}

impl Write for Line {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.shared.send(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl SerialPort for Line {
    fn name(&self) -> Option<String> {
        None
    }

    fn baud_rate(&self) -> PortResult<u32> {
        Ok(1_000_000)
    }

    fn data_bits(&self) -> PortResult<DataBits> {
        Ok(DataBits::Eight)
    }

    fn flow_control(&self) -> PortResult<FlowControl> {
        Ok(FlowControl::None)
    }

    fn parity(&self) -> PortResult<Parity> {
        Ok(Parity::None)
    }

    fn stop_bits(&self) -> PortResult<StopBits> {
        Ok(StopBits::One)
    }

    fn timeout(&self) -> Duration {
        self.timeout
    }

    fn set_baud_rate(&mut self, _: u32) -> PortResult<()> {
        Ok(())
    }

    fn set_data_bits(&mut self, _: DataBits) -> PortResult<()> {
        Ok(())
    }

    fn set_flow_control(&mut self, _: FlowControl) -> PortResult<()> {
        Ok(())
    }

    fn set_parity(&mut self, _: Parity) -> PortResult<()> {
        Ok(())
    }

    fn set_stop_bits(&mut self, _: StopBits) -> PortResult<()> {
        Ok(())
    }

    fn set_timeout(&mut self, timeout: Duration) -> PortResult<()> {
        self.timeout = timeout;
        Ok(())
    }

    fn write_request_to_send(&mut self, _: bool) -> PortResult<()> {
        Ok(())
    }

    fn write_data_terminal_ready(&mut self, _: bool) -> PortResult<()> {
        Ok(())
    }

    fn read_clear_to_send(&mut self) -> PortResult<bool> {
        Ok(true)
    }

    fn read_data_set_ready(&mut self) -> PortResult<bool> {
        Ok(true)
    }

    fn read_ring_indicator(&mut self) -> PortResult<bool> {
        Ok(false)
    }

    fn read_carrier_detect(&mut self) -> PortResult<bool> {
        Ok(true)
    }

    fn bytes_to_read(&self) -> PortResult<u32> {
        Ok(self.shared.waiting() as u32)
    }

    fn bytes_to_write(&self) -> PortResult<u32> {
        Ok(0)
    }

    fn clear(&self, _: ClearBuffer) -> PortResult<()> {
        Ok(())
    }

    fn try_clone(&self) -> PortResult<Box<dyn SerialPort>> {
        Ok(Box::new(Self::new(self.shared.clone(), self.timeout)))
    }

    fn set_break(&self) -> PortResult<()> {
        Ok(())
    }

    fn clear_break(&self) -> PortResult<()> {
        Ok(())
    }
}
