//! Bit timing, filters and interrupts of the two CAN peripherals.

use bxcan::filter::Mask32;
use bxcan::{Fifo, Interrupts, StandardId};
use embassy_stm32::pac;
use robot_app::domain::BusId;

use super::peripherals::{Can1, Can2};
use super::port::CanPort;
use super::receive;

/// 1 Mb/s from the 42 MHz APB1 clock: prescaler 3, 1 + 10 + 3 quanta, sample point 78.6 %
/// (docs/hardware.md#can-bit-timing). Every field of CAN_BTR holds its value minus one; SJW is 1.
const BTR_1_MBPS: u32 = (3 - 1) | (10 - 1) << 16 | (3 - 1) << 20;

/// First filter bank of CAN2.
const CAN2_FIRST_BANK: u8 = 14;

const RECEIVE_INTERRUPTS: Interrupts = Interrupts::from_bits_truncate(
    Interrupts::FIFO0_MESSAGE_PENDING.bits()
        | Interrupts::FIFO0_OVERRUN.bits()
        | Interrupts::FIFO1_MESSAGE_PENDING.bits()
        | Interrupts::FIFO1_OVERRUN.bits(),
);

/// Configures both peripherals and lets them join their buses in the background.
///
/// The receive interrupts must still be masked. Clocks must run and pins be muxed.
/// `bxcan`'s own `enable` is not used: it waits for a quiet bus and turns on automatic bus-off recovery.
pub fn start(can1: Can1, can2: Can2) -> (CanPort, CanPort) {
    let mut can1 = bxcan::Can::builder(can1)
        .set_bit_timing(BTR_1_MBPS)
        .set_automatic_retransmit(true)
        .leave_disabled();
    let mut can2 = bxcan::Can::builder(can2)
        .set_bit_timing(BTR_1_MBPS)
        .set_automatic_retransmit(true)
        .leave_disabled();

    let (even, odd) = (even_ids(), odd_ids());
    let mut filters = can1.modify_filters();
    filters.set_split(CAN2_FIRST_BANK);
    filters.enable_bank(0, Fifo::Fifo0, even);
    filters.enable_bank(1, Fifo::Fifo1, odd);
    let mut slave_filters = filters.slave_filters();
    slave_filters.enable_bank(CAN2_FIRST_BANK, Fifo::Fifo0, even);
    slave_filters.enable_bank(CAN2_FIRST_BANK + 1, Fifo::Fifo1, odd);
    drop(filters);

    can1.enable_interrupts(RECEIVE_INTERRUPTS);
    can2.enable_interrupts(RECEIVE_INTERRUPTS);
    let (_, can1_fifo0, can1_fifo1) = can1.split();
    let (_, can2_fifo0, can2_fifo1) = can2.split();
    let can1_queues = [receive::install(can1_fifo0), receive::install(can1_fifo1)];
    let can2_queues = [receive::install(can2_fifo0), receive::install(can2_fifo1)];
    (
        CanPort::new(BusId::Can1, pac::CAN1, can1_queues),
        CanPort::new(BusId::Can2, pac::CAN2, can2_queues),
    )
}

/// Standard data frames with an even identifier go to FIFO 0 and the others to FIFO 1, so that a burst finds
/// six hardware places instead of three.
fn even_ids() -> Mask32 {
    standard_ids_with_lowest_bit(StandardId::ZERO)
}

fn odd_ids() -> Mask32 {
    standard_ids_with_lowest_bit(LOWEST_BIT)
}

const LOWEST_BIT: StandardId = match StandardId::new(1) {
    Some(id) => id,
    None => StandardId::ZERO,
};

fn standard_ids_with_lowest_bit(bit: StandardId) -> Mask32 {
    let mut mask = Mask32::frames_with_std_id(bit, LOWEST_BIT);
    mask.data_frames_only();
    mask
}
