//! State of the black box, for diagnostics and the tuning channel.

/// What a bank of the black box holds. The numbers are on the wire and never change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum BankState {
    /// Nothing.
    #[default]
    Empty = 0,
    /// The last seconds, renewed all the time.
    Recording = 1,
    /// An event whose end is still being recorded.
    Closing = 2,
    /// An event, which nothing changes any more.
    Event = 3,
}

/// What an event is about. The numbers are on the wire and never change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum EventKind {
    /// No event.
    #[default]
    None = 0,
    /// The armed robot was disarmed, and nobody asked for it.
    Stop = 1,
    /// Wheels, joints or the motors of one bus were stopped on an armed robot, or its commands ran out.
    PartialStop = 2,
    /// The chip was reset, and nobody asked for it.
    Reset = 3,
}

impl BankState {
    const ALL: [Self; 4] = [Self::Empty, Self::Recording, Self::Closing, Self::Event];

    /// Decodes a state. Returns `None` for an unknown number.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|state| *state as u8 == code)
    }
}

impl EventKind {
    const ALL: [Self; 4] = [Self::None, Self::Stop, Self::PartialStop, Self::Reset];

    /// Decodes a kind. Returns `None` for an unknown number.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| *kind as u8 == code)
    }
}

/// State of one bank.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct BankStatus {
    /// What it holds.
    pub state: BankState,
    /// What its event is about.
    pub kind: EventKind,
    /// Number of its recording. Numbers count up from power-on and wrap past 0, which stands for none.
    pub number: u16,
}

/// State of the black box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct BlackBoxStatus {
    /// The two banks.
    pub banks: [BankStatus; 2],
    /// Events overwritten by newer ones since boot before anybody released them.
    pub overwritten: u32,
}
