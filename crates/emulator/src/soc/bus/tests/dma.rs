use crate::time::MS;

use super::*;

const USART3: u32 = 0x4000_4800;
const GPIOC: u32 = 0x4002_0800;
const DMA1: u32 = 0x4002_6000;
/// CR of stream 1.
const S1CR: u32 = DMA1 + 0x28;
const RING: u32 = 0x2000_1000;
/// Channel 4, memory increment, circular, half, complete and error interrupts, enabled.
const RECEIVE: u32 = 4 << 25 | 1 << 10 | 1 << 8 | 0b11100 | 1;
const STREAM1_IRQ: u8 = 12;

/// USART3 receives 100,000 baud 8E2 on PC11, DMA requests on.
fn receiving() -> Bench {
    let mut bench = Bench::new();
    bench.clock_up();
    bench.set_bits(AHB1ENR, 1 << 2 | 1 << 21);
    bench.set_bits(APB1ENR, 1 << 18);
    bench.write(GPIOC, 0b10 << 22);
    bench.write(GPIOC + 0x24, 7 << 12);
    bench.write(USART3 + 0x08, 420);
    bench.write(USART3 + 0x10, 0b10 << 12);
    bench.write(USART3 + 0x14, 1 << 6);
    bench.write(USART3 + 0x0C, 1 << 13 | 1 << 12 | 1 << 10 | 1 << 2);
    bench
}

fn start_stream(bench: &mut Bench, memory: u32, items: u32, cr: u32) {
    bench.write(S1CR + 0x08, USART3 + 0x04);
    bench.write(S1CR + 0x0C, memory);
    bench.write(S1CR + 0x04, items);
    bench.write(S1CR, cr);
}

#[test]
fn a_circular_stream_keeps_the_last_bytes() {
    let mut bench = receiving();
    start_stream(&mut bench, RING, 50, RECEIVE);
    bench.run_for(40 * MS);
    let ring = bench.ram.at(RING, 50).unwrap().to_vec();
    // Bursts of 25 bytes, two to a ring: 0x0F at the front and 0x00 at the end repeat at the same distance.
    let header = (0..25)
        .find(|n| ring[*n] == 0x0F && ring[n + 25] == 0x0F)
        .expect("header");
    assert_eq!(ring[(header + 24) % 50], 0x00);
    assert!(bench.soc.irq.level(STREAM1_IRQ));
    // HTIF1 and TCIF1 of LISR, no TEIF1.
    assert_eq!(bench.read(DMA1) >> 6 & 0x3D, 0b11_0000);
    bench.write(DMA1 + 0x08, 0x3D << 6);
    assert!(!bench.soc.irq.level(STREAM1_IRQ));
    assert_eq!(bench.errors(), Vec::<&str>::new());
}

#[test]
fn a_normal_stream_ends_and_disables_itself() {
    let mut bench = receiving();
    start_stream(&mut bench, RING, 10, RECEIVE & !(1 << 8));
    bench.run_for(20 * MS);
    assert_eq!(bench.read(S1CR) & 1, 0);
    assert_eq!(bench.read(S1CR + 0x04), 0);
    assert_eq!(bench.ram.at(RING + 10, 10).unwrap(), [0; 10]);
    assert_eq!(
        bench
            .ram
            .at(RING, 25)
            .unwrap()
            .iter()
            .filter(|b| **b == 0x0F)
            .count(),
        1
    );
}

#[test]
fn stopping_a_stream_reports_completion_and_keeps_the_count() {
    let mut bench = receiving();
    start_stream(&mut bench, RING, 50, RECEIVE);
    bench.run_for(8 * MS);
    let left = bench.read(S1CR + 0x04);
    let received = bench
        .ram
        .at(RING, 50)
        .unwrap()
        .iter()
        .position(|b| *b == 0x0F);
    assert!(received.is_some());
    bench.write(S1CR, 0b10100);
    assert_eq!(bench.read(DMA1) >> 11 & 1, 1, "TCIF1");
    assert_eq!(bench.read(S1CR + 0x04), left);
}

#[test]
fn ccm_is_out_of_reach() {
    let mut bench = receiving();
    start_stream(&mut bench, 0x1000_0100, 50, RECEIVE);
    bench.run_for(20 * MS);
    assert!(bench.has_error("DMA1 stream 1 (USART3_RX): memory address 0x10000100 is in CCM"));
    assert_eq!(bench.read(DMA1) >> 9 & 1, 1, "TEIF1");
    assert_eq!(bench.read(S1CR) & 1, 0);
    assert_eq!(bench.ram.at(0x1000_0100, 50).unwrap(), [0; 50]);
}

#[test]
fn the_wrong_channel_is_named() {
    let mut bench = receiving();
    start_stream(&mut bench, RING, 50, RECEIVE & !(7 << 25) | 5 << 25);
    bench.run_for(20 * MS);
    assert!(
        bench.has_error("USART3_RX requests on DMA1 stream 1 channel 4, which is set to channel 5")
    );
    assert_eq!(bench.ram.at(RING, 50).unwrap(), [0; 50]);
}

#[test]
fn fifo_mode_is_refused() {
    let mut bench = receiving();
    // FCR.DMDIS.
    bench.write(S1CR + 0x14, 1 << 2);
    let now = bench.now;
    let error = bench
        .soc
        .write(S1CR, 4, RECEIVE, now, &mut bench.ram)
        .unwrap_err();
    assert_eq!(
        error.to_string(),
        "DMA1 stream 1.CR: FIFO mode is not modelled"
    );
}

#[test]
fn a_stream_that_was_never_enabled_is_named() {
    let mut bench = receiving();
    bench.run_for(20 * MS);
    assert!(bench.has_error("USART3_RX requests on DMA1 stream 1 channel 4, which is not enabled"));
}

#[test]
fn settings_are_locked_while_a_stream_runs() {
    let mut bench = receiving();
    start_stream(&mut bench, RING, 50, RECEIVE);
    bench.write(S1CR + 0x0C, RING + 0x100);
    bench.write(S1CR, RECEIVE & !(1 << 10));
    assert_eq!(bench.read(S1CR + 0x0C), RING);
    assert_eq!(bench.read(S1CR), RECEIVE);
}
