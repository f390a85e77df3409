//! USART1 at the 4-pin UART2, with a PC's serial adapter at the other end.

use super::*;

const APB2ENR: u32 = RCC + 0x44;
const GPIOB: u32 = 0x4002_0400;
const USART1: u32 = 0x4001_1000;
const SR: u32 = USART1;
const DR: u32 = USART1 + 0x04;
const BRR: u32 = USART1 + 0x08;
const CR1: u32 = USART1 + 0x0C;
/// UE, TE, RE.
const ON: u32 = 1 << 13 | 1 << 3 | 1 << 2;
const RXNE: u32 = 1 << 5;

/// PA9 and PB7 on AF7, PB7 with its pull-up.
fn with_pins() -> Bench {
    let mut bench = board();
    bench.set_bits(APB2ENR, 1 << 4);
    bench.set_bits(GPIOA, 0b10 << 18);
    bench.set_bits(GPIOA + 0x24, 7 << 4);
    bench.set_bits(GPIOB, 0b10 << 14);
    bench.set_bits(GPIOB + 0x20, 7 << 28);
    bench.set_bits(GPIOB + 0x0C, 0b01 << 14);
    bench
}

impl Bench {
    fn start_usart(&mut self, brr: u32) {
        self.write(BRR, brr);
        self.write(CR1, ON);
    }

    fn doubts(&self) -> Vec<&str> {
        let doubts = self.soc.errors.suspicions().iter();
        doubts.map(|e| e.message.as_str()).collect()
    }
}

#[test]
fn a_pc_and_the_board_hear_each_other() {
    let mut bench = with_pins();
    bench.start_usart(182);
    let now = bench.now;
    bench.world().serial_adapter().set_plugged(true);
    bench.world().serial_adapter().send(&[0xA5], now);
    bench.write(DR, 0xFE);
    bench.run_until(now + 30 * US);
    assert_eq!(bench.read(SR) & RXNE, RXNE);
    assert_eq!(bench.read(DR), 0xA5);
    let heard = bench.world().serial_adapter().take();
    let (at, byte) = heard.expect("a byte");
    assert_eq!((byte, (at - now) / US), (0xFE, 21));
    assert_eq!(bench.errors(), Vec::<&str>::new());
    assert_eq!(bench.doubts(), Vec::<&str>::new());
}

/// 84 MHz / 168 = 500,000 Bd.
#[test]
fn a_rate_that_no_pc_understands_is_reported_though_none_is_there() {
    let mut bench = with_pins();
    bench.start_usart(168);
    bench.write(DR, 0xFE);
    bench.run_until(bench.now + MS);
    let expected = "USART1 sends 500000 8N1, the PC listens at 460800 8N1: it hears garbage";
    assert_eq!(bench.errors(), [expected]);
}

#[test]
fn the_receive_line_floats_until_a_cable_or_a_pull_up_holds_it() {
    for (plugged, pulled) in [(false, false), (true, false), (false, true)] {
        let mut bench = with_pins();
        bench.write(GPIOB + 0x0C, u32::from(pulled) << 14);
        bench.world().serial_adapter().set_plugged(plugged);
        bench.start_usart(182);
        bench.run_until(bench.now + 2 * MS);
        let floats = bench
            .doubts()
            .iter()
            .any(|d| d.starts_with("USART1_RX: PB7 floats"));
        assert_eq!(floats, !plugged && !pulled);
    }
}

/// PA10 and PB6 carry USART1 too, and lead to the USB connector and to CAN2 on this board.
#[test]
fn other_pins_of_usart1_lead_elsewhere() {
    let mut bench = board();
    bench.set_bits(APB2ENR, 1 << 4);
    bench.set_bits(GPIOA, 0b10 << 20);
    bench.set_bits(GPIOA + 0x24, 7 << 8);
    bench.set_bits(GPIOB, 0b10 << 12);
    bench.set_bits(GPIOB + 0x20, 7 << 24);
    bench.start_usart(182);
    bench.write(DR, 0xFE);
    bench.run_until(bench.now + 2 * MS);
    let expected = [
        "USART1_TX: PA9 is an input, needs AF7: the PC hears nothing",
        "USART1_RX: PB7 is an input, needs AF7: the PC is not heard",
    ];
    assert_eq!(bench.errors(), expected);
}
