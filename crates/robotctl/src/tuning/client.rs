//! One request at a time over a CAN link.

use std::time::{Duration, Instant};

use robot_app::tuning::{LIVE_PAGES, LivePage, ParameterGroup, Refusal};

use super::{
    BootFindings, BringUpStep, LiveReading, Named, StoreReport, WheelGeometry,
    request::{self, Reply, Request},
};
use crate::can_link::{CanLink, CanLinkError};

/// How long replies are waited for.
#[derive(Clone, Copy, Debug)]
pub struct Patience {
    /// The robot answers within six milliseconds.
    pub each_try: Duration,
    pub tries: u32,
}

impl Default for Patience {
    fn default() -> Self {
        Self {
            each_try: Duration::from_millis(250),
            tries: 4,
        }
    }
}

#[derive(Debug, thiserror::Error)]
pub enum TuningError {
    #[error(transparent)]
    Link(#[from] CanLinkError),
    #[error(
        "the robot does not answer: is it on, is this one of its two CAN buses at 1 Mbit/s, and is the bus terminated?"
    )]
    Silent,
    #[error("{what}: {}", explain(*.reason))]
    Refused {
        what: String,
        reason: Result<Refusal, u8>,
    },
}

impl TuningError {
    /// True if the value fits alone but not beside the others the robot has now.
    pub(super) fn is_inconsistent(&self) -> bool {
        matches!(self, Self::Refused { reason, .. } if *reason == Ok(Refusal::Inconsistent))
    }
}

/// What a refusal means and what to do about it.
fn explain(reason: Result<Refusal, u8>) -> String {
    let text = match reason {
        Ok(Refusal::Armed) => "refused while the robot is armed: switch enable off",
        Ok(Refusal::OutOfRange) => "refused, the value is out of its range",
        Ok(Refusal::Inconsistent) => {
            "refused, it does not fit another setting (limits in the wrong order, or a soft-iron matrix that turns the \
             field round): change that one first"
        }
        Ok(Refusal::Calibrated) => {
            "refused, the sensors' calibrations are for how they sit now: `robotctl tune defaults imu-calibration --yes` \
             and `robotctl tune defaults mag-calibration --yes` first, and calibrate again afterwards"
        }
        Ok(Refusal::NotFinite) => "refused, it is no number",
        Ok(Refusal::UnknownParameter | Refusal::UnknownCommand | Refusal::WrongLength) => {
            "the robot does not know this request: firmware and robotctl are of different versions"
        }
        Err(code) => {
            return format!("refused for reason {code}, which this robotctl does not know");
        }
    };
    text.to_owned()
}

/// The tuning channel of the robot on a bus.
pub struct TuningClient {
    link: Box<dyn CanLink>,
    patience: Patience,
}

impl TuningClient {
    pub fn new(link: Box<dyn CanLink>, patience: Patience) -> Self {
        Self { link, patience }
    }

    pub fn read(&mut self, named: Named) -> Result<f32, TuningError> {
        let request = Request::Read {
            group: named.group.number,
            index: named.parameter.index,
        };
        let reply = self.exchange(request, || named.full_name())?;
        Ok(request::value(reply))
    }

    pub fn write(&mut self, named: Named, value: f32) -> Result<(), TuningError> {
        let request = Request::Write {
            group: named.group.number,
            index: named.parameter.index,
            value,
        };
        let (min, max) = (named.parameter.min, named.parameter.max);
        let words = named.in_words(value);
        let what = || format!("{} = {words} ({min} … {max})", named.full_name());
        self.exchange(request, what).map(drop)
    }

    pub fn read_geometry(&mut self) -> Result<WheelGeometry, TuningError> {
        let reply = self.exchange(Request::ReadGeometry, || "wheel geometry".to_owned())?;
        Ok(WheelGeometry::from_bytes(reply))
    }

    pub fn write_geometry(&mut self, geometry: &WheelGeometry) -> Result<(), TuningError> {
        let request = Request::WriteGeometry(geometry.to_bytes());
        self.exchange(request, || "wheel geometry".to_owned())
            .map(drop)
    }

    /// `None` for all groups.
    pub fn restore_defaults(
        &mut self,
        group: Option<&'static ParameterGroup>,
    ) -> Result<(), TuningError> {
        let request = Request::RestoreDefaults(group.map_or(0, |group| group.number));
        let what = || group.map_or("defaults", |group| group.name).to_owned();
        self.exchange(request, what).map(drop)
    }

    /// `None` if the firmware is too old to tell: it saves nothing.
    pub fn store(&mut self) -> Result<Option<StoreReport>, TuningError> {
        self.ask_newer(Request::ReadStore, StoreReport::from_bytes)
    }

    /// `None` if the firmware is too old to tell.
    pub fn boot_findings(&mut self) -> Result<Option<BootFindings>, TuningError> {
        self.ask_newer(Request::ReadFindings, BootFindings::from_bytes)
    }

    /// What a page shows of one of its parts, 0 for a page about the whole robot. At any time, armed too. `None` if the
    /// firmware is too old to have the page.
    pub fn live(
        &mut self,
        page: &'static LivePage,
        part: usize,
    ) -> Result<Option<LiveReading>, TuningError> {
        let Some(number) = page.number(part) else {
            return Ok(None);
        };
        let read = |reply| LiveReading::new(page, part, reply);
        self.ask_newer(Request::ReadLive(number), read)
    }

    /// Every page of every part that the firmware has, one after the other.
    pub fn live_all(&mut self) -> Result<Vec<LiveReading>, TuningError> {
        let mut readings = Vec::new();
        for page in &LIVE_PAGES {
            for part in 0..page.parts.len() {
                readings.extend(self.live(page, part)?);
            }
        }
        Ok(readings)
    }

    /// A request that not every firmware knows.
    fn ask_newer<T>(
        &mut self,
        request: Request,
        read: impl FnOnce([u8; 7]) -> T,
    ) -> Result<Option<T>, TuningError> {
        match self.exchange(request, || "status".to_owned()) {
            Ok(reply) => Ok(Some(read(reply))),
            Err(TuningError::Refused {
                reason: Ok(Refusal::UnknownCommand | Refusal::UnknownParameter),
                ..
            }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    pub fn bring_up(&mut self, step: BringUpStep) -> Result<(), TuningError> {
        let request = Request::BringUp(step.to_bytes());
        self.exchange(request, || "bring-up".to_owned()).map(drop)
    }

    /// Asks again if no reply comes: requests say what to be, not what to change, so twice is as good as once.
    fn exchange(
        &mut self,
        request: Request,
        what: impl Fn() -> String,
    ) -> Result<[u8; 7], TuningError> {
        for _ in 0..self.patience.tries {
            self.link.send(&request.frame())?;
            let deadline = Instant::now() + self.patience.each_try;
            while let Some(frame) = self.link.receive(deadline)? {
                match request.reply(&frame) {
                    Some(Reply::Done(bytes)) => return Ok(bytes),
                    Some(Reply::Refused(reason)) => {
                        let what = what();
                        return Err(TuningError::Refused { what, reason });
                    }
                    None => {}
                }
            }
        }
        Err(TuningError::Silent)
    }
}
