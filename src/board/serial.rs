//! The two UARTs in use: the radio receiver on USART3, the PC link on USART1 (docs/hardware.md#connectors,
//! docs/hardware.md#dma).

use embassy_stm32::dma::{Channel, Request};
use embassy_stm32::gpio::{AfType, Flex, OutputType, Pull, Speed};
use embassy_stm32::interrupt::typelevel::Handler;
use embassy_stm32::interrupt::{self, InterruptExt};
use embassy_stm32::{Peri, pac, peripherals, rcc};
use robot_app::input::RemoteFormat;
use static_cell::StaticCell;

use super::{Irqs, lend};
use crate::drivers::uart::{
    ErrorReports, Parity, StopBits, UartFormat, UartReceiver, UartTransmitter,
};
use crate::exchange::{LINK_LINE, RADIO_LINE};

/// Alternate function of USART1 and USART3.
const USART_AF: u8 = 7;

/// UART of the radio receiver.
const RADIO_UART: pac::usart::Usart = pac::USART3;
/// Channel of USART3_RX on DMA1 stream 1 (RM0090 table 42).
const RADIO_DMA_REQUEST: Request = 4;
/// Room for five SBUS frames.
const RADIO_BUFFER_LEN: usize = 128;

/// UART of the PC link, whose connector is labelled UART2.
const LINK_UART: pac::usart::Usart = pac::USART1;
/// Channel of USART1_RX on DMA2 stream 5, and of USART1_TX on stream 7 (RM0090 table 43).
const LINK_DMA_REQUEST: Request = 4;
/// Bytes of 5.5 ms at full line rate. The task takes them every millisecond.
const LINK_BUFFER_LEN: usize = 256;
/// The longest frame that is sent.
const LINK_FRAME_LEN: usize = 94;

/// The byte stream of the radio receiver.
pub type RadioReceiver = UartReceiver<RADIO_BUFFER_LEN>;

/// Both halves of the PC link.
pub struct LinkUart {
    pub receiver: LinkReceiver,
    pub transmitter: LinkTransmitter,
}

pub type LinkReceiver = UartReceiver<LINK_BUFFER_LEN>;
pub type LinkTransmitter = UartTransmitter<LINK_FRAME_LEN>;

/// Handler of the radio receiver's UART.
pub struct RadioInterrupt;

impl Handler<interrupt::typelevel::USART3> for RadioInterrupt {
    // SAFETY: `bind_interrupts` alone calls it, from the UART's interrupt; the body is safe code.
    unsafe fn on_interrupt() {
        RADIO_LINE.serve(RADIO_UART);
    }
}

/// Handler of the PC link's UART.
pub struct LinkInterrupt;

impl Handler<interrupt::typelevel::USART1> for LinkInterrupt {
    // SAFETY: `bind_interrupts` alone calls it, from the UART's interrupt; the body is safe code.
    unsafe fn on_interrupt() {
        LINK_LINE.serve(LINK_UART);
    }
}

/// SBUS is 8E2, DBUS 8E1, both at 100 kBd (docs/hardware.md#sbus, docs/hardware.md#dbus).
fn radio_format(format: RemoteFormat) -> UartFormat {
    UartFormat {
        baud: 100_000,
        parity: Parity::Even,
        stop_bits: match format {
            RemoteFormat::Sbus => StopBits::Two,
            RemoteFormat::Dbus => StopBits::One,
        },
    }
}

const LINK_FORMAT: UartFormat = UartFormat {
    baud: 460_800,
    parity: Parity::None,
    stop_bits: StopBits::One,
};

pub fn start_radio(
    rx: Peri<'static, peripherals::PC11>,
    dma: Peri<'static, peripherals::DMA1_CH1>,
    format: RemoteFormat,
) -> RadioReceiver {
    static BUFFER: StaticCell<[u8; RADIO_BUFFER_LEN]> = StaticCell::new();
    rcc::enable_and_reset::<peripherals::USART3>();
    lend(Flex::new(rx), USART_AF, AfType::input(Pull::Up));
    let clock = rcc::frequency::<peripherals::USART3>();
    radio_format(format).apply(RADIO_UART, clock.0);
    let radio = RadioReceiver::start(
        RADIO_UART,
        &RADIO_LINE,
        Channel::new(dma, Irqs),
        RADIO_DMA_REQUEST,
        BUFFER.init([0; RADIO_BUFFER_LEN]),
        ErrorReports::Interrupt,
    );
    // SAFETY: no critical section or lock relies on this interrupt being masked.
    unsafe { interrupt::USART3.enable() };
    radio
}

/// The pins and DMA streams of the PC link.
pub struct LinkPins {
    pub rx: Peri<'static, peripherals::PB7>,
    pub tx: Peri<'static, peripherals::PA9>,
    pub rx_dma: Peri<'static, peripherals::DMA2_CH5>,
    pub tx_dma: Peri<'static, peripherals::DMA2_CH7>,
}

pub fn start_link(pins: LinkPins) -> LinkUart {
    static RECEIVED: StaticCell<[u8; LINK_BUFFER_LEN]> = StaticCell::new();
    static SENDING: StaticCell<[u8; LINK_FRAME_LEN]> = StaticCell::new();
    rcc::enable_and_reset::<peripherals::USART1>();
    // The pull-up keeps an open input quiet.
    lend(Flex::new(pins.rx), USART_AF, AfType::input(Pull::Up));
    let clock = rcc::frequency::<peripherals::USART1>();
    LINK_FORMAT.apply(LINK_UART, clock.0);
    let link = LinkUart {
        // Errors are polled: at 46,000 bytes/s, each with an error, interrupts would take 4 % of the CPU.
        receiver: LinkReceiver::start(
            LINK_UART,
            &LINK_LINE,
            Channel::new(pins.rx_dma, Irqs),
            LINK_DMA_REQUEST,
            RECEIVED.init([0; LINK_BUFFER_LEN]),
            ErrorReports::Polled,
        ),
        transmitter: LinkTransmitter::start(
            LINK_UART,
            Channel::new(pins.tx_dma, Irqs),
            LINK_DMA_REQUEST,
            SENDING.init([0; LINK_FRAME_LEN]),
        ),
    };
    // After the transmitter, which holds its pin high while it has nothing to send.
    lend(
        Flex::new(pins.tx),
        USART_AF,
        AfType::output(OutputType::PushPull, Speed::Low),
    );
    // SAFETY: no critical section or lock relies on this interrupt being masked.
    unsafe { interrupt::USART1.enable() };
    link
}
