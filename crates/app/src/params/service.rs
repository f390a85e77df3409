//! The parameter service loads settings from flash at boot and saves them after changes.

use embedded_storage::nor_flash::NorFlash;

use super::{
    Progress, Store,
    record::{self, LoadOutcome},
    save_scheduler::{BackOff, GroupIndex, SaveScheduler},
};
use crate::{
    domain::{FlashRequest, ParamError, ParamState, ParamStatus, RobotConfig},
    motor::layout::MotorLayout,
    tuning::{PARAMETERS, ParameterGroup, bit},
};

/// Steps that verify the contents of flash at boot. The store needs two, for the head and the last record.
const MAX_PROOFS: usize = 4;

/// The work of the next step.
#[derive(Clone, Copy, Debug)]
enum Job {
    /// The store's next step towards a new record of this group.
    Save(FlashRequest, GroupIndex, &'static ParameterGroup),
    /// The store's next step without a record, so that later saves are fast.
    TidyUp(FlashRequest),
    /// Waits for the end of a pause after a failure.
    Pause,
    Nothing,
}

/// Owns the store. Call [`step`](Self::step) every millisecond.
pub struct ParamService<F> {
    store: Store<F>,
    layout: &'static MotorLayout,
    save_scheduler: SaveScheduler,
    /// Programming and erasing back off separately: a sector that cannot be erased must not delay writing the next
    /// one.
    program_pause: BackOff,
    erase_pause: BackOff,
    status: ParamStatus,
}

impl<F: NorFlash> ParamService<F> {
    /// Reads the store. Settings without a good record get their defaults. This may program some words but erases
    /// nothing, as motors may still be turning.
    pub fn boot(flash: F, layout: &'static MotorLayout) -> (Self, RobotConfig) {
        let mut service = Self {
            store: Store::open(flash),
            layout,
            save_scheduler: SaveScheduler::new(layout.default_config()),
            program_pause: BackOff::default(),
            erase_pause: BackOff::default(),
            status: ParamStatus::default(),
        };
        let found = service.store.report();
        service.status.damaged = found.damaged;
        service.status.lost_sectors = found.lost_sectors;
        service.status.strange_sectors = found.strange_sectors;
        service.settle_torn_slots();
        let config = service.load();
        service.save_scheduler = SaveScheduler::new(config);
        service.update_status(FlashRequest::None, 0);
        (service, config)
    }

    /// Rewrites what a power cut left half programmed, so that it stays as it reads now.
    fn settle_torn_slots(&mut self) {
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
                LoadOutcome::Loaded(position) => status.loaded |= bit(position),
                LoadOutcome::Refused(position) => status.refused |= bit(position),
                LoadOutcome::Foreign => status.foreign = status.foreign.saturating_add(1),
            };
        });
        config
    }

    /// Does the work that the previous step requested, if `granted` allows it: at most one slot or one sector.
    /// Returns the request for the next step. `config`, `revision` and `restored` (of `TuningStatus`) must belong to
    /// the same moment.
    pub fn step(
        &mut self,
        config: &RobotConfig,
        revision: u32,
        restored: u32,
        granted: FlashRequest,
        now_us: u64,
    ) -> FlashRequest {
        // The defaults in use instead of a refused record look saved. Only an explicit command makes them wanted.
        let forced = restored & self.status.refused;
        self.save_scheduler
            .observe(config, revision, forced, now_us);
        let job = self.job(now_us);
        // The state is published before the work begins: an erase stalls the chip, and an observer then sees why.
        if job.is_allowed(granted) && self.status.state == job.state_at_work() {
            self.work(job, config, now_us);
        }
        self.update_status(granted, now_us);
        self.job(now_us).request()
    }

    /// State of the store, for diagnostics.
    pub fn status(&self) -> &ParamStatus {
        &self.status
    }

    /// Records the duration of [`boot`](Self::boot).
    pub fn note_boot(&mut self, boot_us: u32) {
        self.status.boot_us = boot_us;
        self.status.revision = self.status.revision.wrapping_add(1);
    }

    /// Records how long the chip stood still in the last step.
    pub fn note_stall(&mut self, stall_us: u32) {
        self.erase_pause.extend(stall_us);
        self.status.longest_stall_us = self.status.longest_stall_us.max(stall_us);
        self.status.revision = self.status.revision.wrapping_add(1);
    }

    fn job(&self, now_us: u64) -> Job {
        let due = self.save_scheduler.due(now_us);
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

    /// Returns the store's next step, unless a similar one failed a short while ago.
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
        position: Option<GroupIndex>,
        config: &RobotConfig,
    ) {
        if request == FlashRequest::Erase {
            self.status.erases = self.status.erases.wrapping_add(1);
            self.erase_pause.succeed();
        }
        match (progress, position) {
            (Progress::Stored, Some(position)) => {
                self.save_scheduler.mark_saved(position, config);
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
        position: Option<GroupIndex>,
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
            self.save_scheduler.mark_failed(position);
        }
    }

    fn update_status(&mut self, granted: FlashRequest, now_us: u64) {
        let report = self.store.report();
        let updated = ParamStatus {
            seen: self.save_scheduler.seen(),
            unsaved: self.save_scheduler.unsaved(),
            generation: report.generation,
            free_slots: report.free_slots,
            state: self.state(granted, now_us),
            ..self.status
        };
        if updated != self.status || self.status.revision == 0 {
            self.status = updated;
            self.status.revision = self.status.revision.wrapping_add(1);
        }
    }

    fn state(&self, granted: FlashRequest, now_us: u64) -> ParamState {
        let job = self.job(now_us);
        if job.is_allowed(granted) {
            return job.state_at_work();
        }
        let settles =
            self.save_scheduler.unsaved() != 0 && self.save_scheduler.due(now_us).is_none();
        match job {
            _ if settles => ParamState::Settling,
            Job::Save(..) => ParamState::WaitingForRest,
            Job::Pause => ParamState::BackingOff,
            Job::TidyUp(_) if self.save_scheduler.unsaved() != 0 => ParamState::BackingOff,
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
