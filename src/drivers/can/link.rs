//! The state of one CAN link: joining the bus, error state, bus-off and the way back.

use embassy_stm32::pac::can::Can;

/// First wait before rejoining after bus-off, doubled each time the link fails again.
const FIRST_BACK_OFF_US: u64 = 50_000;
const LONGEST_BACK_OFF_US: u64 = 1_600_000;
/// After this time on the bus, the next bus-off starts with the first wait again.
const TRUSTED_AFTER_US: u64 = 5_000_000;

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    /// Waiting for 11 recessive bits in a row.
    Joining,
    Up {
        since_us: u64,
    },
    /// Off the bus because of its error counters. Frames are refused until the back-off is over.
    BusOff {
        retry_at_us: u64,
    },
    /// Initialisation mode was requested, which resets the error counters.
    Resetting,
    /// Initialisation mode was left; the hardware counts 128 × 11 recessive bits.
    Rejoining,
    /// On the bus, but still reported as off, so that only zero torque is sent until a frame is acknowledged.
    OnTrial,
}

/// The link state machine of one CAN peripheral.
pub struct Link {
    can: Can,
    state: State,
    back_off_us: u64,
    bus_off_count: u32,
}

impl Link {
    /// Wakes the peripheral; it joins when the bus is quiet for 11 bits.
    pub fn join(can: Can) -> Self {
        can.mcr().modify(|w| {
            w.set_abom(false);
            w.set_sleep(false);
        });
        Self {
            can,
            state: State::Joining,
            back_off_us: FIRST_BACK_OFF_US,
            bus_off_count: 0,
        }
    }

    /// Whether frames can be sent.
    pub fn is_on_bus(&self) -> bool {
        matches!(self.state, State::Up { .. } | State::OnTrial)
    }

    /// True from bus-off until a frame has shown that the bus works again.
    pub fn is_bus_off(&self) -> bool {
        !matches!(self.state, State::Up { .. } | State::Joining)
    }

    /// Notes that a frame was sent and acknowledged.
    pub fn frame_got_through(&mut self, now_us: u64) {
        if self.state == State::OnTrial {
            self.state = State::Up { since_us: now_us };
        }
    }

    /// How often the link went bus-off since boot.
    pub fn bus_off_count(&self) -> u32 {
        self.bus_off_count
    }

    /// Reads the hardware state and takes the next step if one is due. Never waits.
    pub fn step(&mut self, now_us: u64) {
        let can = self.can;
        match self.state {
            State::Joining if !can.msr().read().slak() => {
                self.state = State::Up { since_us: now_us }
            }
            State::Up { since_us } if can.esr().read().boff() => {
                if now_us.saturating_sub(since_us) >= TRUSTED_AFTER_US {
                    self.back_off_us = FIRST_BACK_OFF_US;
                }
                self.enter_bus_off(now_us);
            }
            State::OnTrial if can.esr().read().boff() => self.enter_bus_off(now_us),
            State::BusOff { retry_at_us } if now_us >= retry_at_us => {
                can.mcr().modify(|w| w.set_inrq(true));
                self.state = State::Resetting;
            }
            State::Resetting if can.msr().read().inak() => {
                can.mcr().modify(|w| w.set_inrq(false));
                self.state = State::Rejoining;
            }
            State::Rejoining if !can.msr().read().inak() && !can.esr().read().boff() => {
                self.state = State::OnTrial;
            }
            _ => {}
        }
    }

    fn enter_bus_off(&mut self, now_us: u64) {
        self.bus_off_count = self.bus_off_count.wrapping_add(1);
        self.state = State::BusOff {
            retry_at_us: now_us.saturating_add(self.back_off_us),
        };
        self.back_off_us = self.back_off_us.saturating_mul(2).min(LONGEST_BACK_OFF_US);
    }
}
