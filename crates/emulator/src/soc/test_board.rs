//! Boards for unit tests: one with a simple device on each bus, and one with none.

use std::{collections::VecDeque, ops::Range};

use crate::{
    soc::{
        board::{AnalogSource, Board},
        flash_cells::FlashCells,
        pins::{ExternalConnection, Pin, PinBank},
        signals::{Route, Signal, Stage},
    },
    time::{MS, Ps, US},
    wire::{CanFrame, CanPort, LineEvent, LineFormat, Parity, UartChar, UartPort},
};

/// Sectors 1–3. The contents of torn words and sectors follow from a seed.
pub struct Cells {
    bytes: Vec<u8>,
    /// Erases of sector 1, 2 and 3.
    pub erases: [u32; 3],
    noise: u32,
}

impl Default for Cells {
    fn default() -> Self {
        Self {
            bytes: vec![0xFF; 0xC000],
            erases: [0; 3],
            noise: 1,
        }
    }
}

impl Cells {
    fn place(address: u32) -> Range<usize> {
        let start = (address - 0x0800_4000) as usize;
        start..start + 4
    }

    fn set(&mut self, address: u32, word: u32) {
        self.bytes[Self::place(address)].copy_from_slice(&word.to_le_bytes());
    }

    fn draw(&mut self) -> u32 {
        self.noise ^= self.noise << 13;
        self.noise ^= self.noise >> 17;
        self.noise ^= self.noise << 5;
        self.noise
    }
}

impl FlashCells for Cells {
    fn read_word(&mut self, address: u32) -> u32 {
        let bytes = &self.bytes[Self::place(address)];
        u32::from_le_bytes(bytes.try_into().expect("four bytes"))
    }

    fn program_word(&mut self, address: u32, word: u32) {
        let before = self.read_word(address);
        self.set(address, before & word);
    }

    fn erase(&mut self, sector: u8) {
        let index = usize::from(sector - 1);
        self.bytes[index * 0x4000..][..0x4000].fill(0xFF);
        self.erases[index] += 1;
    }

    fn tear_word(&mut self, address: u32, word: u32) {
        let left_alone = self.draw();
        self.program_word(address, word | left_alone);
    }

    fn tear_sector(&mut self, sector: u8) {
        let start = 0x0800_0000 + u32::from(sector) * 0x4000;
        for address in (start..start + 0x4000).step_by(4) {
            let word = self.draw();
            self.set(address, word);
        }
    }

    fn reseed(&mut self, seed: u64) {
        self.noise = seed as u32 | 1;
    }
}

/// Crystal of both boards, Hz.
const CRYSTAL_HZ: u32 = 12_000_000;

/// A chip on a board that has nothing but a crystal.
#[derive(Default)]
pub struct NoBoard(Cells);

impl Board for NoBoard {
    fn flash_cells(&mut self) -> &mut dyn FlashCells {
        &mut self.0
    }

    fn hse_hz(&self) -> u32 {
        CRYSTAL_HZ
    }
}

/// Where a test wants to be asked again.
const GRID: Ps = 10 * US;

/// Line format of the sender at USART3: 12 bits of 10 µs a character.
const SENDER: LineFormat = LineFormat {
    baud: 100_000,
    data_bits: 8,
    parity: Parity::Even,
    stop_bits: 2,
};
const CHARACTER: Ps = 120 * US;
const FIRST_BURST: Ps = 5 * MS;
const BURST_PERIOD: Ps = 7 * MS;
/// Characters of a burst: 0x0F, 23 others, 0x00.
const BURST: u64 = 25;

/// A CAN bus. Two nodes send 0x201 and 0x202 once a millisecond on CAN1; one node on CAN2 only acknowledges. The last
/// node of either bus is off until a test starts it: it sends the identifier 0 all the time.
#[derive(Default)]
pub struct CanNodes {
    /// Whether the bus is cut or shorted for every node.
    pub broken: bool,
    /// Whether the bus has no node.
    pub empty: bool,
    /// Whether the node that floods the bus is on.
    pub flooded: bool,
    /// Time of the next frame of each sender on CAN1.
    due: [Ps; 2],
}

/// A board with the wiring of the tests: a device that answers on SPI1 and on I2C3, a sender at USART3, whatever a test
/// wants at USART1, nodes on both CAN buses, and a voltage at ADC3_IN8.
pub struct TestBoard {
    now: Ps,
    pub cells: Cells,
    /// Whether the chip select of the SPI device is low.
    pub spi_selected: bool,
    spi_command: Option<u8>,
    /// Whether a device holds SDA low.
    pub i2c_held: bool,
    i2c_register: Option<u8>,
    characters_sent: u64,
    /// What happens on the line into USART1.
    pub line: VecDeque<LineEvent>,
    /// What the chip's USARTs have sent, with the end of each character.
    pub sent: Vec<(UartPort, UartChar, Ps)>,
    pub can: [CanNodes; 2],
    /// Voltage at ADC3_IN8.
    pub analog_v: f64,
    pub vdda_v: f64,
    pub chip_temperature_c: f64,
}

impl Default for TestBoard {
    fn default() -> Self {
        let senders = CanNodes {
            due: [250 * US, 300 * US],
            ..CanNodes::default()
        };
        Self {
            now: 0,
            cells: Cells::default(),
            spi_selected: false,
            spi_command: None,
            i2c_held: false,
            i2c_register: None,
            characters_sent: 0,
            line: VecDeque::new(),
            sent: Vec::new(),
            can: [senders, CanNodes::default()],
            analog_v: 2.4,
            vdda_v: 3.3,
            chip_temperature_c: 25.0,
        }
    }
}

/// 7-bit address of the device on I2C3, and what its register 0 holds.
pub const I2C_DEVICE: u8 = 0x0E;
pub const I2C_IDENTITY: u8 = 0x10;
/// The SPI device's answer to the byte after the command [`SPI_IDENTIFY`].
pub const SPI_IDENTITY: u8 = 0x0F;
pub const SPI_IDENTIFY: u8 = 0x80;

impl TestBoard {
    fn can(&self, port: CanPort) -> &CanNodes {
        &self.can[port as usize]
    }
}

fn flooder(port: CanPort) -> usize {
    match port {
        CanPort::Can1 => 2,
        CanPort::Can2 => 1,
    }
}

impl Board for TestBoard {
    fn flash_cells(&mut self) -> &mut dyn FlashCells {
        &mut self.cells
    }

    fn hse_hz(&self) -> u32 {
        CRYSTAL_HZ
    }

    fn next_event(&self) -> Ps {
        (self.now / GRID + 1) * GRID
    }

    fn advance(&mut self, now: Ps) {
        self.now = now;
    }

    fn connect(&self, pins: &mut PinBank) {
        for pin in [('A', 0), ('A', 8), ('C', 9)] {
            pins.connect(Pin::new(pin.0, pin.1), ExternalConnection::PullUp);
        }
        for pin in [('B', 7), ('C', 11), ('D', 0), ('B', 5)] {
            pins.connect(Pin::new(pin.0, pin.1), ExternalConnection::Drives(true));
        }
    }

    fn drives(&self, pin: Pin) -> bool {
        pin == Pin::new('A', 0)
    }

    fn route(&self, signal: Signal) -> Option<Route> {
        let (pin, stage) = match signal {
            Signal::Spi1Sck => (Pin::new('B', 3), Stage::Fast),
            Signal::Spi1Miso => (Pin::new('B', 4), Stage::None),
            Signal::Spi1Mosi => (Pin::new('A', 7), Stage::Fast),
            Signal::I2c3Scl => (Pin::new('A', 8), Stage::Shared),
            Signal::I2c3Sda => (Pin::new('C', 9), Stage::Shared),
            Signal::Usart3Rx => (Pin::new('C', 11), Stage::None),
            Signal::Can1Tx => (Pin::new('D', 1), Stage::Fast),
            Signal::Can1Rx => (Pin::new('D', 0), Stage::None),
            Signal::Can2Tx => (Pin::new('B', 6), Stage::Fast),
            Signal::Can2Rx => (Pin::new('B', 5), Stage::None),
            Signal::Adc3In8 => (Pin::new('F', 10), Stage::None),
            Signal::Usart1Tx => (Pin::new('A', 9), Stage::Slow),
            Signal::Usart1Rx => (Pin::new('B', 7), Stage::None),
            Signal::Usart6Tx | Signal::Usart6Rx => return None,
        };
        Some(Route {
            pin,
            stage,
            consequence: "the device is not connected",
        })
    }

    fn analog(&self, _signal: Signal) -> AnalogSource {
        AnalogSource {
            volts: self.analog_v,
            ohms: 20_000.0,
        }
    }

    fn vdda_v(&self) -> f64 {
        self.vdda_v
    }

    fn chip_temperature_c(&self) -> f64 {
        self.chip_temperature_c
    }

    fn spi_transfer(&mut self, mosi: u8, _sck_hz: u32, _mode: u8, _now: Ps) -> u8 {
        if !self.spi_selected {
            return 0xFF;
        }
        match self.spi_command.replace(mosi) {
            Some(SPI_IDENTIFY) => SPI_IDENTITY,
            _ => 0xFF,
        }
    }

    fn i2c_address(&mut self, address: u8, read: bool, _scl_hz: u32, _now: Ps) -> bool {
        if !read {
            self.i2c_register = None;
        }
        address == I2C_DEVICE
    }

    fn i2c_write(&mut self, byte: u8, _now: Ps) -> bool {
        self.i2c_register = Some(byte);
        true
    }

    fn i2c_read(&mut self, _acknowledge: bool, _now: Ps) -> u8 {
        let register = self.i2c_register.unwrap_or_default();
        self.i2c_register = Some(register.wrapping_add(1));
        match register {
            0 => I2C_IDENTITY,
            other => other,
        }
    }

    fn i2c_bus_held(&self) -> bool {
        self.i2c_held
    }

    fn uart_event(&mut self, port: UartPort, now: Ps) -> Option<LineEvent> {
        match port {
            UartPort::Usart1 => return self.line.pop_front_if(|next| next.start() <= now),
            UartPort::Usart3 => {}
            UartPort::Usart6 => return None,
        }
        let (burst, number) = (self.characters_sent / BURST, self.characters_sent % BURST);
        let start = FIRST_BURST + burst * BURST_PERIOD + number * CHARACTER;
        if start > now {
            return None;
        }
        self.characters_sent += 1;
        let byte = match number {
            0 => 0x0F,
            24 => 0,
            _ => 0x40 + number as u8,
        };
        Some(LineEvent::Character(UartChar {
            start,
            byte,
            format: SENDER,
        }))
    }

    fn uart_sent(&mut self, port: UartPort, character: UartChar, now: Ps) {
        self.sent.push((port, character, now));
    }

    fn can_nodes(&self, port: CanPort) -> usize {
        flooder(port) + 1
    }

    fn can_broken(&self, port: CanPort) -> bool {
        self.can(port).broken
    }

    fn can_present(&self, port: CanPort, node: usize) -> bool {
        let bus = self.can(port);
        !bus.empty && (node != flooder(port) || bus.flooded)
    }

    fn can_pending(&self, port: CanPort, node: usize, now: Ps) -> Option<CanFrame> {
        if !self.can_present(port, node) {
            return None;
        }
        let id = if node == flooder(port) {
            0
        } else if port == CanPort::Can1 && self.can(port).due[node] <= now {
            0x201 + node as u32
        } else {
            return None;
        };
        Some(CanFrame {
            id,
            extended: false,
            remote: false,
            dlc: 8,
            data: [0x55; 8],
        })
    }

    fn can_sent(&mut self, port: CanPort, node: usize, _now: Ps) {
        if node != flooder(port) {
            self.can[port as usize].due[node] += MS;
        }
    }
}
