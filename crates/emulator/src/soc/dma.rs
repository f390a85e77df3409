//! DMA1 and DMA2 with eight streams each. A request moves one item (RM0090 section 10).
//!
//! Memory-to-memory, double buffer, FIFO mode, peripheral bursts and peripheral flow control are not modelled.

pub mod request_map;
pub mod stream;
pub mod unserved;

use request_map::{RequestLine, Slot};
use stream::{Item, Stream};

use crate::soc::{
    access::Access,
    dma_request::DmaRequests,
    irq::Irq,
    peripheral::{Ctx, Peripheral, Unmodelled},
    registers::registers,
};

registers! {
    LISR = 0x00,
    HISR = 0x04,
    LIFCR = 0x08,
    HIFCR = 0x0C,
}

/// First bit of a stream's flags in LISR or HISR, by stream modulo 4.
const FLAG_SHIFTS: [u32; 4] = [0, 6, 16, 22];
const FLAG_BITS: u32 = 0x3D;

/// An item that a stream should move now.
#[derive(Debug)]
pub struct Beat {
    pub stream: usize,
    pub line: &'static RequestLine,
    pub item: Item,
}

#[derive(Debug)]
pub struct Dma {
    number: u8,
    streams: [Stream; 8],
    /// The request line that each stream serves on its channel.
    serves: [Option<&'static RequestLine>; 8],
}

impl Dma {
    /// 1 or 2.
    pub fn new(number: u8) -> Self {
        let streams = [Stream::default(); 8];
        Self {
            number,
            streams,
            serves: std::array::from_fn(|index| line_served(number, index, &streams[index])),
        }
    }

    pub fn stream(&self, index: u8) -> &Stream {
        &self.streams[usize::from(index)]
    }

    /// The most urgent item among all high request lines: the one with the highest PL, then of the lowest stream.
    pub fn next_beat(&self, requests: &DmaRequests) -> Option<Beat> {
        let waiting = self
            .streams
            .iter()
            .enumerate()
            .filter(|(_, stream)| stream.ready())
            .filter_map(|(index, stream)| {
                let line = self.serves[index]?;
                requests.get(line.request).then_some((index, stream, line))
            });
        let (index, stream, line) = waiting
            .max_by_key(|(index, stream, _)| (stream.priority(), std::cmp::Reverse(*index)))?;
        Some(Beat {
            stream: index,
            line,
            item: stream.next_item(),
        })
    }

    pub fn beat_done(&mut self, stream: usize, ctx: &mut Ctx<'_>) {
        self.streams[stream].item_done();
        self.announce_last(stream, ctx);
        self.drive_irq(stream, ctx);
    }

    /// Tells the peripheral whether the next item is the last one (EOT_1).
    fn announce_last(&self, stream: usize, ctx: &mut Ctx<'_>) {
        if let Some(line) = self.serves[stream] {
            ctx.dma
                .set_last(line.request, self.streams[stream].items_left() == 1);
        }
    }

    pub fn beat_failed(&mut self, stream: usize, ctx: &mut Ctx<'_>) {
        self.streams[stream].fail();
        self.drive_irq(stream, ctx);
    }

    fn drive_irq(&self, stream: usize, ctx: &mut Ctx<'_>) {
        ctx.irq
            .set(self.irq(stream), self.streams[stream].interrupts());
    }

    fn name(&self) -> String {
        format!("DMA{}", self.number)
    }

    fn stream_lacks(&self, stream: usize, offset: u32, what: &str) -> Unmodelled {
        let block = format!("DMA{} stream {stream}", self.number);
        stream::reg::MAP.unmodelled(block, offset, what)
    }

    /// RM0090 table 62.
    fn irq(&self, stream: usize) -> Irq {
        const DMA1: [Irq; 8] = [11, 12, 13, 14, 15, 16, 17, 47];
        const DMA2: [Irq; 8] = [56, 57, 58, 59, 60, 68, 69, 70];
        if self.number == 1 {
            DMA1[stream]
        } else {
            DMA2[stream]
        }
    }

    fn status(&self, high: bool) -> u32 {
        let first = if high { 4 } else { 0 };
        (0..4).fold(0, |bits, n| {
            bits | self.streams[first + n].flags << FLAG_SHIFTS[n]
        })
    }

    fn clear_flags(&mut self, high: bool, bits: u32, ctx: &mut Ctx<'_>) {
        let first = if high { 4 } else { 0 };
        for (n, shift) in FLAG_SHIFTS.iter().enumerate() {
            self.streams[first + n].flags &= !(bits >> shift & FLAG_BITS);
            self.drive_irq(first + n, ctx);
        }
    }

    fn value(&self, register: u32) -> Result<u32, Unmodelled> {
        match register {
            reg::LISR => Ok(self.status(false)),
            reg::HISR => Ok(self.status(true)),
            reg::LIFCR | reg::HIFCR => Ok(0),
            _ => {
                let refused = || reg::MAP.unmodelled_read(self.name(), register);
                let (stream, offset) = stream_register(register).ok_or_else(refused)?;
                self.streams[stream].register(offset).ok_or_else(refused)
            }
        }
    }

    fn store(&mut self, register: u32, value: u32, ctx: &mut Ctx<'_>) -> Result<(), Unmodelled> {
        match register {
            reg::LISR | reg::HISR => {}
            reg::LIFCR => self.clear_flags(false, value, ctx),
            reg::HIFCR => self.clear_flags(true, value, ctx),
            _ => {
                let (stream, offset) = stream_register(register)
                    .ok_or_else(|| reg::MAP.unmodelled_write(self.name(), register, value))?;
                let enabled = self.streams[stream]
                    .set_register(offset, value)
                    .map_err(|what| self.stream_lacks(stream, offset, what))?;
                self.serves[stream] = line_served(self.number, stream, &self.streams[stream]);
                if enabled {
                    self.announce_last(stream, ctx);
                    self.check_enabling(stream, ctx);
                }
                self.drive_irq(stream, ctx);
            }
        }
        Ok(())
    }

    /// Flags left from the transfer before must be cleared first (RM0090 10.3.17), and an empty stream does nothing.
    fn check_enabling(&mut self, index: usize, ctx: &mut Ctx<'_>) {
        let number = self.number;
        let stream = &mut self.streams[index];
        if stream.flags != 0 {
            ctx.errors.report(
                ctx.now,
                format!(
                    "DMA{number} stream {index}: enabled with flags {:#04x} of the last transfer still set",
                    stream.flags
                ),
            );
        }
        if !stream.ready() {
            ctx.errors.report(
                ctx.now,
                format!("DMA{number} stream {index}: enabled with NDTR = 0"),
            );
        }
    }
}

fn line_served(controller: u8, index: usize, stream: &Stream) -> Option<&'static RequestLine> {
    request_map::line_of(Slot {
        controller,
        stream: index as u8,
        channel: stream.channel(),
    })
}

/// Offset of stream 0's registers, and bytes of one stream's registers.
const STREAMS: u32 = 0x10;
const STREAM_BYTES: u32 = 0x18;

/// The stream that an offset belongs to, and the offset among the stream's registers.
fn stream_register(register: u32) -> Option<(usize, u32)> {
    let offset = register.checked_sub(STREAMS)?;
    let stream = (offset / STREAM_BYTES) as usize;
    (stream < 8).then_some((stream, offset % STREAM_BYTES))
}

impl Peripheral for Dma {
    fn read(&mut self, offset: u32, size: u8, _ctx: &mut Ctx<'_>) -> Result<u32, Unmodelled> {
        let access = Access::new(offset, size);
        Ok(access.read_of(self.value(access.register)?))
    }

    fn write(
        &mut self,
        offset: u32,
        size: u8,
        value: u32,
        ctx: &mut Ctx<'_>,
    ) -> Result<(), Unmodelled> {
        let access = Access::new(offset, size);
        let whole = access.written_over(self.value(access.register)?, value);
        self.store(access.register, whole, ctx)
    }

    fn event(&mut self, _tag: u32, _ctx: &mut Ctx<'_>) {}

    fn reset(&mut self, ctx: &mut Ctx<'_>) {
        *self = Self::new(self.number);
        for stream in 0..8 {
            self.drive_irq(stream, ctx);
        }
    }
}
