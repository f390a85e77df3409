//! Sends one request at a time over a CAN link.

use std::time::{Duration, Instant};

use robot_app::domain::CanFrame;
use robot_app::tuning::{
    BlockFrame, LIVE_PAGES, LivePage, MAX_RECORDING_S, ParameterGroup, RecordedSample, Refusal,
};

use super::{
    BankReport, BootFindings, BringUpStep, LiveReading, RecordingReport, StoreReport,
    WheelGeometry,
    request::{self, Reply, Request},
};
use crate::{
    can_link::{CanLink, CanLinkError},
    settings::Setting,
};

/// How long to wait for replies.
#[derive(Clone, Copy, Debug)]
pub struct Timeouts {
    /// The robot answers within six milliseconds.
    pub each_try: Duration,
    pub tries: u32,
}

impl Default for Timeouts {
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
    #[error("the robot does not answer: {0}")]
    Silent(String),
    #[error("this firmware shows no such live values: it is older than this robotctl")]
    TooOld,
    #[error("{what}: {}", explain(*.reason, .allowed.as_deref()))]
    Refused {
        what: String,
        reason: Result<Refusal, u8>,
        /// The values that it may have.
        allowed: Option<String>,
    },
}

impl TuningError {
    /// True if the value is allowed alone but not together with the robot's other values.
    pub(super) fn is_inconsistent(&self) -> bool {
        matches!(self, Self::Refused { reason, .. } if *reason == Ok(Refusal::Inconsistent))
    }

    fn with_allowed(mut self, values: impl Fn() -> String) -> Self {
        if let Self::Refused { allowed, .. } = &mut self {
            *allowed = Some(values());
        }
        self
    }
}

/// Says what a refusal means and what to do about it.
fn explain(reason: Result<Refusal, u8>, allowed: Option<&str>) -> String {
    let text = match reason {
        Ok(Refusal::Armed) => {
            "refused while the robot is armed or its enable switch is on: switch enable off"
        }
        Ok(Refusal::OutOfRange) => {
            return match allowed {
                Some(allowed) => format!("out of range: {allowed}"),
                None => "refused, a value is out of its range".to_owned(),
            };
        }
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
        Ok(Refusal::JointNotReady) => {
            "refused, the joint does not report or is not set up yet: is its motor powered and on the bus? \
             (`robotctl status` shows its state)"
        }
        Ok(Refusal::JointMoving) => "refused, the joint turns: hold it still",
        Ok(Refusal::Recording) => {
            "refused while the robot sends a recording of its sensors: wait for the program that started it, or 600 s at \
             most, and try again"
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
    timeouts: Timeouts,
    /// Samples of a recording in the order of their arrival.
    recorded: Vec<RecordedSample>,
    /// Frames of a block of the black box in the order of their arrival.
    block: Vec<BlockFrame>,
}

impl TuningClient {
    pub fn new(link: Box<dyn CanLink>, timeouts: Timeouts) -> Self {
        Self {
            link,
            timeouts,
            recorded: Vec::new(),
            block: Vec::new(),
        }
    }

    pub fn read(&mut self, named: Setting) -> Result<f32, TuningError> {
        let request = Request::Read {
            group: named.group.number,
            index: named.parameter.index,
        };
        let reply = self.exchange(request, || named.full_name())?;
        Ok(request::value(reply))
    }

    pub fn write(&mut self, named: Setting, value: f32) -> Result<(), TuningError> {
        let request = Request::Write {
            group: named.group.number,
            index: named.parameter.index,
            value,
        };
        let words = named.in_words(value);
        let what = || format!("{} = {words}", named.full_name());
        let written = self.exchange(request, what).map(drop);
        written.map_err(|error| error.with_allowed(|| named.allowed()))
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

    /// Gives a group of settings its defaults back, or all groups for `None`.
    pub fn restore_defaults(
        &mut self,
        group: Option<&'static ParameterGroup>,
    ) -> Result<(), TuningError> {
        let request = Request::RestoreDefaults(group.map_or(0, |group| group.number));
        let what = || group.map_or("defaults", |group| group.name).to_owned();
        self.exchange(request, what).map(drop)
    }

    /// Reads the report on saved settings. It is `None` if the firmware is too old: then it saves nothing.
    pub fn store(&mut self) -> Result<Option<StoreReport>, TuningError> {
        self.ask_newer(Request::ReadStore, StoreReport::from_bytes)
    }

    /// Reads the report on what was found in flash at boot. It is `None` if the firmware is too old.
    pub fn boot_findings(&mut self) -> Result<Option<BootFindings>, TuningError> {
        self.ask_newer(Request::ReadFindings, BootFindings::from_bytes)
    }

    /// Reads a page of one of its parts, which is 0 for a page about the whole robot. The robot may be armed. It
    /// returns `None` if the firmware is too old to have the page.
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

    /// Reads every page of every part that the firmware has, one after the other.
    pub fn live_all(&mut self) -> Result<Vec<LiveReading>, TuningError> {
        let mut readings = Vec::new();
        for page in &LIVE_PAGES {
            for part in 0..page.parts.len() {
                readings.extend(self.live(page, part)?);
            }
        }
        Ok(readings)
    }

    /// Sends a request that not every firmware knows.
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

    /// Moves the zero of a joint so that its present angle is `angle_rad` in joint coordinates. The robot must be
    /// disarmed, and the joint must report and stand still.
    pub fn zero_joint(&mut self, joint: u8, angle_rad: f32) -> Result<(), TuningError> {
        let request = Request::ZeroJoint { joint, angle_rad };
        let done = self.exchange(request, || format!("zero of joint {joint}"));
        let allowed = || "angle and zero must both be within ±12.57 rad".to_owned();
        done.map(drop).map_err(|error| error.with_allowed(allowed))
    }

    /// Makes the robot send each sample of its IMU and magnetometer for this many seconds; 0 ends that. The robot must
    /// be disarmed.
    pub fn start_recording(&mut self, seconds: u16) -> Result<(), TuningError> {
        self.recorded.clear();
        let request = Request::Record(seconds);
        let done = self.exchange(request, || "recording".to_owned());
        let allowed = || format!("at most {MAX_RECORDING_S} s");
        done.map(drop).map_err(|error| error.with_allowed(allowed))
    }

    /// Returns how many samples the robot has sent, and whether it still records.
    pub fn recording(&mut self) -> Result<RecordingReport, TuningError> {
        let reply = self.exchange(Request::ReadRecording, || "recording".to_owned())?;
        Ok(RecordingReport::from_bytes(reply))
    }

    /// Returns the samples received since the last call and until `deadline`.
    pub fn receive_samples(
        &mut self,
        deadline: Instant,
    ) -> Result<Vec<RecordedSample>, TuningError> {
        while let Some(frame) = self.link.receive(deadline)? {
            self.keep(&frame);
        }
        Ok(std::mem::take(&mut self.recorded))
    }

    /// Returns what a bank of the black box holds. The robot may be armed. It is `None` if the firmware has no black box.
    pub fn black_box(&mut self, bank: u8) -> Result<Option<BankReport>, TuningError> {
        self.ask_newer(Request::ReadBlackBox(bank), BankReport::from_bytes)
    }

    /// Reads a block of an event: so many frames from byte `at` of its bank on. The robot must be disarmed. Frames that got
    /// lost are missing. `progress` gets the number of frames received so far.
    pub fn read_block(
        &mut self,
        bank: u8,
        at: u16,
        frames: u8,
        mut progress: impl FnMut(usize),
    ) -> Result<Vec<BlockFrame>, TuningError> {
        self.block.clear();
        let request = Request::ReadBlock { bank, at, frames };
        self.exchange(request, || "black box".to_owned())?;
        let mut count = usize::MAX;
        while self.block.len() < frames.into() && self.block.len() != count {
            count = self.block.len();
            progress(count);
            let deadline = Instant::now() + self.timeouts.each_try;
            while self.block.len() < frames.into()
                && let Some(frame) = self.link.receive(deadline)?
            {
                self.keep(&frame);
                progress(self.block.len());
            }
        }
        Ok(std::mem::take(&mut self.block))
    }

    /// Makes the robot forget an event, which takes it a moment after its reply. The robot must be disarmed.
    pub fn release_event(&mut self, bank: u8, number: u16) -> Result<(), TuningError> {
        let request = Request::ReleaseEvent { bank, number };
        self.exchange(request, || format!("release of event {number}"))
            .map(drop)
    }

    /// Keeps a frame that the robot sends without a request for each.
    fn keep(&mut self, frame: &CanFrame) {
        self.recorded.extend(RecordedSample::decode(frame));
        self.block.extend(BlockFrame::decode(frame));
    }

    /// Sends the request again if no reply comes. Requests are idempotent, so a second one does no harm.
    fn exchange(
        &mut self,
        request: Request,
        what: impl Fn() -> String,
    ) -> Result<[u8; 7], TuningError> {
        for _ in 0..self.timeouts.tries {
            self.link.send(&request.frame())?;
            let deadline = Instant::now() + self.timeouts.each_try;
            while let Some(frame) = self.link.receive(deadline)? {
                match request.reply(&frame) {
                    Some(Reply::Done(bytes)) => return Ok(bytes),
                    Some(Reply::Refused(reason)) => {
                        let what = what();
                        return Err(TuningError::Refused {
                            what,
                            reason,
                            allowed: None,
                        });
                    }
                    None => self.keep(&frame),
                }
            }
        }
        Err(TuningError::Silent(self.link.why_silent()))
    }
}
