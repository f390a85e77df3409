//! SPI1 through its registers, with a device behind it.

use super::Spi;
use crate::{
    soc::{
        clocks::cycles_to_ps,
        dma_request::DmaRequest,
        peripheral::Peripheral,
        pins::{Pin, PinMode},
        test_bench::Bench,
        test_board::{SPI_IDENTIFY, SPI_IDENTITY},
    },
    time::NS,
};

const CR1: u32 = 0x00;
const CR2: u32 = 0x04;
const SR: u32 = 0x08;
const DR: u32 = 0x0C;
/// SSM, SSI, SPE, BR = pclk2 / 16, MSTR, mode 3.
const MODE_3_MASTER: u32 = 1 << 9 | 1 << 8 | 1 << 6 | 3 << 3 | 1 << 2 | 3;

fn ready() -> (Bench, Spi) {
    let (mut bench, mut spi) = (Bench::new(), Spi::new());
    bench.write(&mut spi, CR1, MODE_3_MASTER);
    (bench, spi)
}

fn exchange(bench: &mut Bench, spi: &mut Spi, byte: u8) -> u8 {
    bench.write(spi, DR, u32::from(byte));
    let until = bench.now + 2_000 * NS;
    bench.run(spi, until);
    bench.read(spi, DR) as u8
}

#[test]
fn a_selected_device_answers_the_byte_after_its_command() {
    let (mut bench, mut spi) = ready();
    bench.board.spi_selected = true;
    exchange(&mut bench, &mut spi, SPI_IDENTIFY);
    assert_eq!(exchange(&mut bench, &mut spi, 0), SPI_IDENTITY);
}

#[test]
fn a_byte_takes_eight_clocks_and_the_next_one_follows_at_once() {
    let (mut bench, mut spi) = ready();
    let start = bench.now;
    // 84 MHz / 16: a byte is 128 cycles of pclk2.
    let byte = cycles_to_ps(128, 84_000_000);
    bench.write(&mut spi, DR, 0x00);
    assert_eq!(bench.read(&mut spi, SR), 1 << 7 | 1 << 1);
    bench.write(&mut spi, DR, 0x00);
    assert_eq!(bench.read(&mut spi, SR), 1 << 7);
    bench.run(&mut spi, start + byte - 1);
    assert_eq!(bench.read(&mut spi, SR), 1 << 7);
    bench.run(&mut spi, start + byte);
    assert_eq!(bench.read(&mut spi, SR), 1 << 7 | 1 << 1 | 1);
    bench.run(&mut spi, start + 2 * byte);
    // The first byte was not fetched: OVR, and no longer BSY.
    assert_eq!(bench.read(&mut spi, SR), 1 << 6 | 1 << 1 | 1);
    bench.read(&mut spi, DR);
    assert_eq!(bench.read(&mut spi, SR), 1 << 6 | 1 << 1);
    assert_eq!(bench.read(&mut spi, SR), 1 << 1);
}

#[test]
fn dma_requests_follow_txe_and_rxne() {
    let (mut bench, mut spi) = ready();
    bench.write(&mut spi, CR2, 3);
    assert!(bench.dma.get(DmaRequest::Spi1Tx));
    bench.write(&mut spi, DR, 0);
    bench.write(&mut spi, DR, 0);
    assert!(!bench.dma.get(DmaRequest::Spi1Tx));
    let until = bench.now + 1_600 * NS;
    bench.run(&mut spi, until);
    assert!(bench.dma.get(DmaRequest::Spi1Tx) && bench.dma.get(DmaRequest::Spi1Rx));
    bench.read(&mut spi, DR);
    assert!(!bench.dma.get(DmaRequest::Spi1Rx));
}

#[test]
fn a_frame_written_over_another_is_reported() {
    let (mut bench, mut spi) = ready();
    for byte in [1, 2] {
        bench.write(&mut spi, DR, byte);
    }
    assert_eq!(bench.error_texts(), Vec::<&str>::new());
    bench.write(&mut spi, DR, 3);
    assert!(bench.error_texts()[0].starts_with("SPI1: DR written while TXE is 0"));
}

#[test]
fn a_new_rate_in_the_middle_of_a_frame_is_reported() {
    let (mut bench, mut spi) = ready();
    bench.write(&mut spi, DR, 1);
    bench.write(&mut spi, CR1, MODE_3_MASTER ^ 1 << 3);
    assert!(bench.error_texts()[0].contains("in the middle of a frame"));
}

#[test]
fn an_unmuxed_clock_pin_leaves_the_sensor_silent() {
    let (mut bench, mut spi) = ready();
    bench.change_pin(Pin::new('B', 3), |pin| pin.mode = PinMode::Alternate(0));
    bench.board.spi_selected = true;
    exchange(&mut bench, &mut spi, SPI_IDENTIFY);
    assert_ne!(exchange(&mut bench, &mut spi, 0), SPI_IDENTITY);
    assert!(
        bench
            .error_texts()
            .iter()
            .any(|e| e.starts_with("SPI1_SCK"))
    );
}

#[test]
fn software_nss_low_is_a_mode_fault() {
    let (mut bench, mut spi) = (Bench::new(), Spi::new());
    bench.write(&mut spi, CR1, MODE_3_MASTER & !(1 << 8));
    assert_ne!(bench.read(&mut spi, SR) & 1 << 5, 0);
    assert_eq!(bench.read(&mut spi, CR1) & (1 << 6 | 1 << 2), 0);
}

#[test]
fn unmodelled_settings_are_refused() {
    let (mut bench, mut spi) = (Bench::new(), Spi::new());
    let bidirectional = spi.write(CR1, 4, MODE_3_MASTER | 1 << 15, &mut bench.ctx());
    assert!(bidirectional.is_err());
    assert!(spi.write(CR2, 4, 1 << 4, &mut bench.ctx()).is_err());
}

#[test]
fn sixteen_bit_frames_carry_the_high_byte_first() {
    let (mut bench, mut spi) = ready();
    bench.write(&mut spi, CR1, 0);
    bench.write(&mut spi, CR1, MODE_3_MASTER | 1 << 11);
    bench.board.spi_selected = true;
    bench.write(&mut spi, DR, u32::from(SPI_IDENTIFY) << 8);
    let until = bench.now + 4_000 * NS;
    bench.run(&mut spi, until);
    // The identity answers the second byte.
    assert_eq!(bench.read(&mut spi, DR) & 0xFF, SPI_IDENTITY.into());
}
