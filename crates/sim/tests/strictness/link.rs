//! Wrong lines about the PC link and the chip's own temperature.

use super::*;

/// A PC sends from 0.3 s on.
const WITH_PC: &str = "
name = \"strictness\"
seconds = 0.8
plant = \"stand\"
[[at]]
t = 0.3
pc = { wheels = [0.0, 0.0] }
";

const GPIOA_AFRH: u32 = 0x4002_0024;
const GPIOB_MODER: u32 = 0x4002_0400;
const GPIOB_PUPDR: u32 = 0x4002_040C;
const GPIOB_AFRL: u32 = 0x4002_0420;
const USART1_BRR: u32 = 0x4001_1008;
const USART1_CR1: u32 = 0x4001_100C;
const DMA2_S5CR: u32 = 0x4002_6488;
const DMA2_S7CR: u32 = 0x4002_64B8;
const DMA2_S7M0AR: u32 = 0x4002_64C4;

/// What fails in a run with a PC and these register bits overridden.
fn failing_with_pc(patches: &[RegisterPatch]) -> Vec<String> {
    reported_in(WITH_PC, patches).failing
}

#[test]
fn the_shipped_image_gets_on_with_a_pc() {
    assert_eq!(reported_in(WITH_PC, &[]), Reported::default());
}

/// PA9 on AF8 (bits 7:4), PB7 an input (bits 15:14), as it is if the firmware takes PA10.
#[test]
fn pins_of_the_link_with_another_function() {
    must_report_all(&[
        (
            GPIOA_AFRH,
            0xF << 4,
            8 << 4,
            &["USART1_TX: PA9 is AF8, needs AF7"],
        ),
        (
            GPIOB_MODER,
            3 << 14,
            0,
            &["USART1_RX: PB7 is an input, needs AF7"],
        ),
    ]);
    must_report(
        patch(GPIOB_AFRL, 0xF << 28, 8 << 28),
        &["USART1_RX: PB7 is AF8, needs AF7"],
    );
}

/// 84 MHz / 168 = 500,000 Bd.
#[test]
fn wrong_rate_of_the_link() {
    let failing = failing_with_pc(&[patch(USART1_BRR, 0xFFFF, 168)]);
    must_name(
        &failing,
        &["USART1 sends 500000 8N1, the PC listens at 460800 8N1"],
    );
    must_name(
        &failing,
        &["USART1: sender sends 460800 8N1, receiver is set to 500000 8N1"],
    );
}

/// PCE, bit 10: the eighth bit is a parity bit.
#[test]
fn a_link_with_parity() {
    must_report(
        patch(USART1_CR1, 1 << 10, 1 << 10),
        &["USART1 sends 461538 7E1, the PC listens at 460800 8N1"],
    );
}

/// CHSEL, bits 27:25: on stream 7 channel 5 is USART6_TX.
#[test]
fn wrong_dma_channel_of_what_is_sent() {
    let patch = patch(DMA2_S7CR, 7 << 25, 5 << 25);
    must_report(patch, &["USART1_TX", "DMA2 stream 7", "set to channel 5"]);
}

/// On stream 5 channel 7 is a timer's.
#[test]
fn wrong_dma_channel_of_what_is_received() {
    let failing = failing_with_pc(&[patch(DMA2_S5CR, 7 << 25, 7 << 25)]);
    must_name(
        &failing,
        &["USART1_RX", "DMA2 stream 5", "set to channel 7"],
    );
}

#[test]
fn frames_in_ccm() {
    must_report(
        patch(DMA2_S7M0AR, 0xFFFF_0000, 0x1000_0000),
        &["DMA2 stream 7 (USART1_TX)", "is in CCM"],
    );
}

/// Without its pull-up (bits 15:14) PB7 floats while no cable is plugged in.
#[test]
fn a_link_without_a_pull_up_is_suspicious() {
    assert_suspicious(patch(GPIOB_PUPDR, 3 << 14, 0), &["USART1_RX: PB7 floats"]);
}

/// ADC1_SMPR1 bits 20:18: 3 cycles at 21 MHz.
#[test]
fn a_temperature_sampled_too_shortly() {
    assert_suspicious(
        patch(0x4001_200C, 7 << 18, 0),
        &["ADC1: the temperature sensor is sampled for less than 10 us"],
    );
}

/// ADC_CCR bit 23.
#[test]
fn internal_sources_that_are_not_connected() {
    let failing = reported(&[patch(0x4001_2304, 1 << 23, 0)]).failing;
    must_name(
        &failing,
        &["the temperature sensor converted while TSVREFE is 0"],
    );
    must_name(&failing, &["VREFINT converted while TSVREFE is 0"]);
}
