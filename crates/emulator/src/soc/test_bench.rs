//! A chip with one peripheral for unit tests, with running clocks, a board and simulated time.

use super::{
    board::Board,
    board_errors::{BoardError, BoardErrors},
    clocks::ClockTree,
    dma_request::DmaRequests,
    irq::IrqLines,
    peripheral::{Ctx, Peripheral},
    pins::{Pin, PinBank, PinMode, PinSettings},
    scheduler::Scheduler,
    test_board::TestBoard,
};
use crate::time::Ps;

pub struct Bench {
    pub now: Ps,
    pub scheduler: Scheduler,
    pub irq: IrqLines,
    pub dma: DmaRequests,
    pub clocks: ClockTree,
    pub pins: PinBank,
    pub board: TestBoard,
    pub errors: BoardErrors,
}

impl Bench {
    /// 168 MHz, APB1 at 42 MHz, APB2 at 84 MHz; every signal of the board muxed.
    pub fn new() -> Self {
        let mut bench = Self {
            now: 0,
            scheduler: Scheduler::default(),
            irq: IrqLines::default(),
            dma: DmaRequests::default(),
            clocks: ClockTree {
                hclk_hz: 168_000_000,
                pclk1_hz: 42_000_000,
                pclk2_hz: 84_000_000,
                ..ClockTree::default()
            },
            pins: PinBank::default(),
            board: TestBoard::default(),
            errors: BoardErrors::default(),
        };
        for (port, number, af) in [
            ('B', 3, 5),
            ('B', 4, 5),
            ('A', 7, 5),
            ('A', 8, 4),
            ('A', 9, 7),
            ('B', 7, 7),
            ('C', 9, 4),
            ('C', 11, 7),
            ('D', 0, 9),
            ('D', 1, 9),
            ('B', 5, 9),
            ('B', 6, 9),
        ] {
            bench.change_pin(Pin::new(port, number), |pin| {
                pin.mode = PinMode::Alternate(af);
                pin.speed = 3;
            });
        }
        for (port, number) in [('A', 8), ('C', 9)] {
            bench.change_pin(Pin::new(port, number), |pin| pin.open_drain = true);
        }
        bench.change_pin(Pin::new('F', 10), |pin| pin.mode = PinMode::Analog);
        bench.change_pin(Pin::new('G', 6), |pin| {
            pin.mode = PinMode::Output;
            pin.high = true;
        });
        bench.board.connect(&mut bench.pins);
        bench
    }

    pub fn change_pin(&mut self, pin: Pin, change: impl FnOnce(&mut PinSettings)) {
        let mut settings = self.pins.settings(pin);
        change(&mut settings);
        self.pins.set(pin, settings);
    }

    pub fn ctx(&mut self) -> Ctx<'_> {
        Ctx {
            now: self.now,
            scheduler: &mut self.scheduler,
            irq: &mut self.irq,
            dma: &mut self.dma,
            clocks: &mut self.clocks,
            pins: &mut self.pins,
            board: &mut self.board,
            errors: &mut self.errors,
        }
    }

    pub fn read(&mut self, block: &mut dyn Peripheral, offset: u32) -> u32 {
        block
            .read(offset, 4, &mut self.ctx())
            .expect("a modelled register")
    }

    pub fn write(&mut self, block: &mut dyn Peripheral, offset: u32, value: u32) {
        block
            .write(offset, 4, value, &mut self.ctx())
            .expect("a modelled register");
    }

    /// Advances board and peripheral to `until`.
    pub fn run(&mut self, block: &mut dyn Peripheral, until: Ps) {
        self.run_while(block, until, |_| true);
    }

    /// The same, but it ends early if `go_on` returns false after an event.
    pub fn run_while(
        &mut self,
        block: &mut dyn Peripheral,
        until: Ps,
        go_on: impl Fn(&mut Self) -> bool,
    ) {
        while go_on(self) {
            let board_at = self.board.next_event();
            if board_at <= until && board_at <= self.scheduler.next() {
                self.now = board_at;
                self.board.advance(board_at);
                block.board_advanced(&mut self.ctx());
            } else if let Some(event) = self.scheduler.pop_due(until) {
                self.now = event.at;
                block.event(event.tag, &mut self.ctx());
            } else {
                self.now = until;
                return;
            }
        }
    }

    /// Board errors that fail on silicon.
    pub fn error_texts(&self) -> Vec<&str> {
        texts(self.errors.list())
    }

    pub fn suspicion_texts(&self) -> Vec<&str> {
        texts(self.errors.suspicions())
    }
}

fn texts(errors: &[BoardError]) -> Vec<&str> {
    errors.iter().map(|e| e.message.as_str()).collect()
}
