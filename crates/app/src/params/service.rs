//! Settings from flash at boot, and back to it whenever they changed.

use embedded_storage::nor_flash::NorFlash;

use super::{
    Progress, Store,
    record::{self, Verdict},
    saver::{BackOff, Position, Saver},
};
use crate::{
    domain::{FlashRequest, ParamError, ParamState, ParamStatus, RobotConfig},
    motor::layout::MotorLayout,
    tuning::{PARAMETERS, ParameterGroup, bit},
};

/// Steps that prove what is in flash at boot. The store needs two: the head and the last record.
const MAX_PROOFS: usize = 4;

/// What the next step does.
#[derive(Clone, Copy, Debug)]
enum Job {
    /// The store's next step towards a new record of this group.
    Save(FlashRequest, Position, &'static ParameterGroup),
    /// The store's next step without one, so that later saves go quickly.
    TidyUp(FlashRequest),
    /// Waits until the pause after a failure is over.
    Pause,
    Nothing,
}

/// Owns the store. Call [`step`](Self::step) every millisecond.
pub struct ParamService<F> {
    store: Store<F>,
    layout: &'static MotorLayout,
    saver: Saver,
    /// A sector that cannot be erased must not keep the next one from being written.
    program_pause: BackOff,
    erase_pause: BackOff,
    status: ParamStatus,
}

impl<F: NorFlash> ParamService<F> {
    /// Reads the store; what it has no good record for gets its default. May program some words, but erases nothing:
    /// motors may still turn.
    pub fn boot(flash: F, layout: &'static MotorLayout) -> (Self, RobotConfig) {
        let mut service = Self {
            store: Store::open(flash),
            layout,
            saver: Saver::new(layout.default_config()),
            program_pause: BackOff::default(),
            erase_pause: BackOff::default(),
            status: ParamStatus::default(),
        };
        let found = service.store.report();
        service.status.damaged = found.damaged;
        service.status.lost_sectors = found.lost_sectors;
        service.status.strange_sectors = found.strange_sectors;
        service.settle();
        let config = service.load();
        service.saver = Saver::new(config);
        service.tell(FlashRequest::None, 0);
        (service, config)
    }

    /// What a power cut left half programmed is made to last as it reads now.
    fn settle(&mut self) {
        for _ in 0..MAX_PROOFS {
            if self.store.next(false) != FlashRequest::Program {
                return;
            }
            if let Err(error) = self.store.work(None) {
                self.fail(FlashRequest::Program, error, None, 0);
                return;
            }
        }
    }

    fn load(&mut self) -> RobotConfig {
        let Self {
            store,
            layout,
            status,
            ..
        } = self;
        let mut config = layout.default_config();
        store.for_each(|found| {
            match record::load(found, &PARAMETERS, layout, &mut config) {
                Verdict::Loaded(position) => status.loaded |= bit(position),
                Verdict::Refused(position) => status.refused |= bit(position),
                Verdict::Foreign => status.foreign = status.foreign.saturating_add(1),
            };
        });
        config
    }

    /// `config`, `revision` and `restored` (of `TuningStatus`) are of the same moment; `granted` is what the control
    /// tick allows now. Does what was asked for in the step before, if that is allowed: at most one slot or one sector.
    /// Gives what the next step wants to do.
    pub fn step(
        &mut self,
        config: &RobotConfig,
        revision: u32,
        restored: u32,
        granted: FlashRequest,
        now_us: u64,
    ) -> FlashRequest {
        // What is in use instead of a refused record looks saved; only by a command it becomes what is wanted.
        let overruled = restored & self.status.refused;
        self.saver.observe(config, revision, overruled, now_us);
        let job = self.job(now_us);
        // The state is told before the work begins: an erase stops everything, and whoever looks then sees why.
        if job.is_allowed(granted) && self.status.state == job.state_at_work() {
            self.work(job, config, now_us);
        }
        self.tell(granted, now_us);
        self.job(now_us).request()
    }

    pub fn status(&self) -> &ParamStatus {
        &self.status
    }

    /// How long [`boot`](Self::boot) took.
    pub fn note_boot(&mut self, boot_us: u32) {
        self.status.boot_us = boot_us;
        self.status.revision = self.status.revision.wrapping_add(1);
    }

    /// How long the chip stood still in the last step, if it did.
    pub fn note_stall(&mut self, stall_us: u32) {
        self.erase_pause.lengthen(stall_us);
        self.status.longest_stall_us = self.status.longest_stall_us.max(stall_us);
        self.status.revision = self.status.revision.wrapping_add(1);
    }

    fn job(&self, now_us: u64) -> Job {
        let due = self.saver.due(now_us);
        if let Some((position, group)) = due
            && let Some(request) = self.next(true, now_us)
        {
            Job::Save(request, position, group)
        } else if let Some(request) = self.next(false, now_us) {
            Job::TidyUp(request)
        } else if due.is_none() && self.store.next(false) == FlashRequest::None {
            Job::Nothing
        } else {
            Job::Pause
        }
    }

    /// The store's next step, unless one like it failed a short while ago.
    fn next(&self, want_write: bool, now_us: u64) -> Option<FlashRequest> {
        let request = self.store.next(want_write);
        let may = match request {
            FlashRequest::None => false,
            FlashRequest::Program => self.program_pause.is_over(now_us),
            FlashRequest::Erase => self.erase_pause.is_over(now_us),
        };
        may.then_some(request)
    }

    fn work(&mut self, job: Job, config: &RobotConfig, now_us: u64) {
        let target = match job {
            Job::Save(_, position, group) => Some((position, group)),
            Job::TidyUp(_) => None,
            Job::Pause | Job::Nothing => return,
        };
        let new = target.map(|(_, group)| record::encode(group, config, self.layout));
        let done = self.store.work(new.as_ref());
        let position = target.map(|(position, _)| position);
        match done {
            Ok(progress) => self.succeed(job.request(), progress, position, config),
            Err(error) => self.fail(job.request(), error, position, now_us),
        }
    }

    fn succeed(
        &mut self,
        request: FlashRequest,
        progress: Progress,
        position: Option<Position>,
        config: &RobotConfig,
    ) {
        if request == FlashRequest::Erase {
            self.status.erases = self.status.erases.wrapping_add(1);
            self.erase_pause.succeed();
        }
        match (progress, position) {
            (Progress::Stored, Some(position)) => {
                self.saver.saved(position, config);
                self.status.refused &= !bit(position);
                self.program_pause.succeed();
                self.status.save_ok = self.status.save_ok.wrapping_add(1);
            }
            (Progress::Worked, _) | (Progress::Stored, None) => {}
        }
    }

    fn fail(
        &mut self,
        request: FlashRequest,
        error: ParamError,
        position: Option<Position>,
        now_us: u64,
    ) {
        self.status.save_failed = self.status.save_failed.wrapping_add(1);
        self.status.last_error = error;
        if request == FlashRequest::Erase {
            self.status.erases = self.status.erases.wrapping_add(1);
            self.erase_pause.fail(now_us);
        } else {
            self.program_pause.fail(now_us);
        }
        if let Some(position) = position {
            self.saver.failed(position);
        }
    }

    fn tell(&mut self, granted: FlashRequest, now_us: u64) {
        let report = self.store.report();
        let told = ParamStatus {
            seen: self.saver.seen(),
            unsaved: self.saver.unsaved(),
            generation: report.generation,
            free_slots: report.free_slots,
            state: self.state(granted, now_us),
            ..self.status
        };
        if told != self.status || self.status.revision == 0 {
            self.status = told;
            self.status.revision = self.status.revision.wrapping_add(1);
        }
    }

    fn state(&self, granted: FlashRequest, now_us: u64) -> ParamState {
        let job = self.job(now_us);
        if job.is_allowed(granted) {
            return job.state_at_work();
        }
        let settles = self.saver.unsaved() != 0 && self.saver.due(now_us).is_none();
        match job {
            _ if settles => ParamState::Settling,
            Job::Save(..) => ParamState::WaitingForRest,
            Job::Pause => ParamState::BackingOff,
            Job::TidyUp(_) if self.saver.unsaved() != 0 => ParamState::BackingOff,
            Job::TidyUp(_) | Job::Nothing => ParamState::Saved,
        }
    }
}

impl Job {
    fn request(self) -> FlashRequest {
        match self {
            Self::Save(request, ..) | Self::TidyUp(request) => request,
            Self::Pause | Self::Nothing => FlashRequest::None,
        }
    }

    fn is_allowed(self, granted: FlashRequest) -> bool {
        granted != FlashRequest::None && granted == self.request()
    }

    fn state_at_work(self) -> ParamState {
        if self.request() == FlashRequest::Erase {
            ParamState::Erasing
        } else {
            ParamState::Saving
        }
    }
}
