//! Nested vectored interrupt controller: which exceptions are pending, enabled and active, and which is taken first.

use crate::{
    core::exception::{EXCEPTION_COUNT, Exception},
    soc::irq::IRQ_COUNT,
};

/// Group priority as the processor compares it; lower runs first. Reset −3, NMI −2, HardFault −1, thread 256.
pub type Priority = i16;

const THREAD_PRIORITY: Priority = 256;
/// The STM32F407 keeps the upper four bits of every priority.
const PRIORITY_BITS: u8 = 0xF0;
const IRQ_BITS: u128 = ((1 << IRQ_COUNT) - 1) << 16;

/// PRIMASK, FAULTMASK and BASEPRI.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Masks {
    pub primask: bool,
    pub faultmask: bool,
    pub basepri: u8,
}

/// Sets of exceptions, with one bit for each exception number.
#[derive(Debug)]
pub struct Nvic {
    pending: u128,
    enabled: u128,
    active: u128,
    priority: [u8; EXCEPTION_COUNT],
    /// AIRCR.PRIGROUP.
    group: u8,
    /// Innermost active exception: what IPSR reads.
    current: Exception,
}

impl Default for Nvic {
    /// After reset: interrupts and configurable faults disabled, the rest of the system exceptions enabled.
    fn default() -> Self {
        let always = [
            Exception::NMI,
            Exception::HARD_FAULT,
            Exception::SV_CALL,
            Exception::PEND_SV,
            Exception::SYS_TICK,
        ];
        Self {
            pending: 0,
            enabled: always.into_iter().map(bit).fold(0, |a, b| a | b),
            active: 0,
            priority: [0; EXCEPTION_COUNT],
            group: 0,
            current: Exception::THREAD,
        }
    }
}

fn bit(exception: Exception) -> u128 {
    1 << exception.number()
}

impl Nvic {
    pub fn current(&self) -> Exception {
        self.current
    }

    pub fn pend(&mut self, exception: Exception) {
        self.pending |= bit(exception);
    }

    pub fn unpend(&mut self, exception: Exception) {
        self.pending &= !bit(exception);
    }

    pub fn is_pending(&self, exception: Exception) -> bool {
        self.pending & bit(exception) != 0
    }

    pub fn is_active(&self, exception: Exception) -> bool {
        self.active & bit(exception) != 0
    }

    pub fn is_enabled(&self, exception: Exception) -> bool {
        self.enabled & bit(exception) != 0
    }

    pub fn set_enabled(&mut self, exception: Exception, enabled: bool) {
        if enabled {
            self.enabled |= bit(exception);
        } else {
            self.enabled &= !bit(exception);
        }
    }

    /// Makes interrupts pending whose request line rose. Returns true if one of them was not pending before.
    pub fn lines_rose(&mut self, irqs: u128) -> bool {
        let before = self.pending;
        self.pending |= irqs << 16 & IRQ_BITS;
        self.pending != before
    }

    /// Interrupts 32·`word` … 32·`word` + 31 of the pending, enabled or active set.
    pub fn pending_word(&self, word: u32) -> u32 {
        irq_word(self.pending, word)
    }

    pub fn enabled_word(&self, word: u32) -> u32 {
        irq_word(self.enabled, word)
    }

    pub fn active_word(&self, word: u32) -> u32 {
        irq_word(self.active, word)
    }

    pub fn set_pending_word(&mut self, word: u32, bits: u32) {
        self.pending |= irq_bits(word, bits);
    }

    /// A request whose line (`levels`, by interrupt number) is still high stays pending.
    pub fn clear_pending_word(&mut self, word: u32, bits: u32, levels: impl Fn(u8) -> bool) {
        for i in (0..32).filter(|i| bits >> i & 1 == 1) {
            let Some(exception) = Exception::from_number(16 + 32 * word + i) else {
                continue;
            };
            let held = exception.irq().is_some_and(&levels) && !self.is_active(exception);
            if !held {
                self.unpend(exception);
            }
        }
    }

    pub fn enable_word(&mut self, word: u32, bits: u32) {
        self.enabled |= irq_bits(word, bits);
    }

    pub fn disable_word(&mut self, word: u32, bits: u32) {
        self.enabled &= !irq_bits(word, bits);
    }

    pub fn priority_register(&self, exception: Exception) -> u8 {
        self.priority[exception.index()]
    }

    pub fn set_priority_register(&mut self, exception: Exception, value: u8) {
        self.priority[exception.index()] = value & PRIORITY_BITS;
    }

    pub fn priority_group(&self) -> u8 {
        self.group
    }

    pub fn set_priority_group(&mut self, group: u8) {
        self.group = group & 7;
    }

    /// The part of a priority that decides about preemption (ARMv7-M ARM B1.5.4).
    fn group_priority(&self, value: u8) -> Priority {
        Priority::from(value) & (0xFF << (self.group + 1))
    }

    fn priority_of(&self, exception: Exception) -> Priority {
        match exception {
            Exception::NMI => -2,
            Exception::HARD_FAULT => -1,
            _ => self.group_priority(self.priority[exception.index()]),
        }
    }

    /// Priority of the innermost active code before masks.
    pub fn active_priority(&self) -> Priority {
        numbers(self.active)
            .map(|e| self.priority_of(e))
            .min()
            .unwrap_or(THREAD_PRIORITY)
    }

    /// The priority that an exception must exceed to be taken (ARMv7-M ARM `ExecutionPriority`).
    pub fn execution_priority(&self, masks: Masks) -> Priority {
        let mut boosted = THREAD_PRIORITY;
        if masks.basepri != 0 {
            boosted = self.group_priority(masks.basepri);
        }
        if masks.primask {
            boosted = 0;
        }
        if masks.faultmask {
            boosted = -1;
        }
        boosted.min(self.active_priority())
    }

    /// Whether `exception` would be taken at once if it were raised now.
    pub fn can_take(&self, exception: Exception, masks: Masks) -> bool {
        self.is_enabled(exception) && self.priority_of(exception) < self.execution_priority(masks)
    }

    /// The pending, enabled exception that is taken first, by group priority, then subpriority, then number.
    fn first_pending(&self) -> Option<Exception> {
        numbers(self.pending & self.enabled)
            .min_by_key(|&e| (self.priority_of(e), self.priority[e.index()], e.number()))
    }

    /// The exception that the processor takes now.
    pub fn deliverable(&self, masks: Masks) -> Option<Exception> {
        self.first_pending()
            .filter(|&e| self.priority_of(e) < self.execution_priority(masks))
    }

    /// Whether a pending exception would preempt the active code if no mask were set.
    pub fn waits_for_masks_only(&self) -> bool {
        self.deliverable(Masks::default()).is_some()
    }

    /// Whether a WFI ends: an exception is pending that PRIMASK alone may hold back (ARMv7-M ARM B1.5.19).
    pub fn wakes_from_wfi(&self, masks: Masks) -> bool {
        self.deliverable(Masks {
            primask: false,
            ..masks
        })
        .is_some()
    }

    /// Notes that the processor begins to run `exception`.
    pub fn activate(&mut self, exception: Exception) {
        self.unpend(exception);
        self.active |= bit(exception);
        self.current = exception;
    }

    /// Notes that the handler of the current exception has ended. `line_high` says whether its request is still raised.
    pub fn retire(&mut self, line_high: bool) {
        let ended = self.current;
        self.active &= !bit(ended);
        if line_high {
            self.pend(ended);
        }
    }

    /// IPSR as unstacked by an exception return.
    pub fn resume(&mut self, exception: Exception) {
        self.current = exception;
    }

    /// ICSR.VECTPENDING.
    pub fn vect_pending(&self) -> u32 {
        self.first_pending().map_or(0, Exception::number)
    }

    /// ICSR.ISRPENDING.
    pub fn irq_pending(&self) -> bool {
        self.pending & IRQ_BITS != 0
    }

    /// ICSR.RETTOBASE: no other exception is active.
    pub fn returns_to_base(&self) -> bool {
        self.active & !bit(self.current) == 0
    }
}

fn irq_bits(word: u32, bits: u32) -> u128 {
    if word < 3 {
        u128::from(bits) << (32 * word + 16) & IRQ_BITS
    } else {
        0
    }
}

fn irq_word(set: u128, word: u32) -> u32 {
    if word < 3 {
        ((set & IRQ_BITS) >> (32 * word + 16)) as u32
    } else {
        0
    }
}

fn numbers(set: u128) -> impl Iterator<Item = Exception> {
    let mut rest = set;
    std::iter::from_fn(move || {
        let number = rest.trailing_zeros();
        rest &= rest.wrapping_sub(1);
        Exception::from_number(number)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn irq(number: u8) -> Exception {
        Exception::from_irq(number)
    }

    /// Interrupts enabled and pending at the given priority bytes.
    fn pending(requests: &[(u8, u8)]) -> Nvic {
        let mut nvic = Nvic::default();
        for &(number, priority) in requests {
            nvic.set_priority_register(irq(number), priority);
            nvic.set_enabled(irq(number), true);
            nvic.pend(irq(number));
        }
        nvic
    }

    #[test]
    fn lower_value_goes_first_then_lower_number() {
        let nvic = pending(&[(9, 0x40), (30, 0x20), (31, 0x20)]);
        assert_eq!(nvic.deliverable(Masks::default()), Some(irq(30)));
    }

    #[test]
    fn only_a_higher_priority_preempts() {
        let mut nvic = pending(&[(5, 0x20)]);
        nvic.activate(irq(5));
        nvic.set_priority_register(irq(6), 0x20);
        nvic.set_enabled(irq(6), true);
        nvic.pend(irq(6));
        assert_eq!(nvic.deliverable(Masks::default()), None);
        nvic.set_priority_register(irq(6), 0x10);
        assert_eq!(nvic.deliverable(Masks::default()), Some(irq(6)));
    }

    #[test]
    fn grouping_takes_the_subpriority_out_of_preemption() {
        let mut nvic = pending(&[(5, 0x30)]);
        nvic.activate(irq(5));
        nvic.set_priority_register(irq(6), 0x20);
        nvic.set_enabled(irq(6), true);
        nvic.pend(irq(6));
        assert_eq!(nvic.deliverable(Masks::default()), Some(irq(6)));
        // PRIGROUP 5: two bits of group, two of subpriority; 0x20 and 0x30 share a group.
        nvic.set_priority_group(5);
        assert_eq!(nvic.deliverable(Masks::default()), None);
    }

    #[test]
    fn masks_hold_back_what_they_cover() {
        let nvic = pending(&[(5, 0x20)]);
        let masked = |masks| nvic.deliverable(masks).is_none();
        assert!(masked(Masks {
            primask: true,
            ..Masks::default()
        }));
        assert!(masked(Masks {
            faultmask: true,
            ..Masks::default()
        }));
        assert!(masked(Masks {
            basepri: 0x20,
            ..Masks::default()
        }));
        assert!(!masked(Masks {
            basepri: 0x30,
            ..Masks::default()
        }));
        assert!(nvic.wakes_from_wfi(Masks {
            primask: true,
            ..Masks::default()
        }));
        let mut nmi = Nvic::default();
        nmi.pend(Exception::NMI);
        assert!(
            nmi.deliverable(Masks {
                faultmask: true,
                ..Masks::default()
            })
            .is_some()
        );
    }

    #[test]
    fn priorities_keep_four_bits() {
        let mut nvic = Nvic::default();
        nvic.set_priority_register(irq(3), 0xFF);
        assert_eq!(nvic.priority_register(irq(3)), 0xF0);
    }

    #[test]
    fn a_raised_line_pends_again_when_its_handler_returns_and_cannot_be_cleared() {
        let mut nvic = pending(&[(5, 0x20)]);
        nvic.activate(irq(5));
        assert!(!nvic.is_pending(irq(5)));
        nvic.retire(true);
        assert!(nvic.is_pending(irq(5)));
        nvic.clear_pending_word(0, 1 << 5, |_| true);
        assert!(nvic.is_pending(irq(5)));
        nvic.clear_pending_word(0, 1 << 5, |_| false);
        assert!(!nvic.is_pending(irq(5)));
    }
}
