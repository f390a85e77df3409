//! The parameter task of a robot, with the flash it works on.

use std::{
    cell::{Cell, RefCell},
    rc::Rc,
};

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use robot_app::{
    domain::{FlashRequest, ParamState, ParamStatus, RobotConfig, TuningStatus},
    motor::layout::{MotorLayout, ROBOT_LAYOUT},
    params::ParamService,
    tuning::PARAMETERS,
};
use robot_plant::flash_chip::{FlashChip, PARAMETER_SECTORS};

/// The flash controller and the cells behind it. Clones are the same chip.
#[derive(Clone)]
pub struct Chip {
    pub cells: Rc<RefCell<FlashChip>>,
    /// Whether the chip reports an error instead of programming.
    pub refuses_words: Rc<Cell<bool>>,
}

#[derive(Debug)]
pub struct Refused;

impl NorFlashError for Refused {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl ErrorType for Chip {
    type Error = Refused;
}

impl ReadNorFlash for Chip {
    const READ_SIZE: usize = FlashChip::READ_SIZE;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Refused> {
        let mut cells = self.cells.borrow_mut();
        ReadNorFlash::read(&mut *cells, offset, bytes).map_err(|_| Refused)
    }

    fn capacity(&self) -> usize {
        self.cells.borrow().capacity()
    }
}

impl NorFlash for Chip {
    const WRITE_SIZE: usize = FlashChip::WRITE_SIZE;
    const ERASE_SIZE: usize = FlashChip::ERASE_SIZE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Refused> {
        let mut cells = self.cells.borrow_mut();
        NorFlash::erase(&mut *cells, from, to).map_err(|_| Refused)
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Refused> {
        if self.refuses_words.get() {
            return Err(Refused);
        }
        NorFlash::write(&mut *self.cells.borrow_mut(), offset, bytes).map_err(|_| Refused)
    }
}

impl Chip {
    pub fn blank() -> Self {
        Self {
            cells: Rc::new(RefCell::new(FlashChip::parameters(1))),
            refuses_words: Rc::default(),
        }
    }

    /// A copy of the chip with the same cells and another random sequence.
    pub fn copy(&self, seed: u64) -> Self {
        let mut cells = self.cells.borrow().clone();
        cells.reseed(seed);
        Self {
            cells: Rc::new(RefCell::new(cells)),
            refuses_words: Rc::default(),
        }
    }

    pub fn erases(&self) -> u32 {
        let cells = self.cells.borrow();
        PARAMETER_SECTORS.map(|sector| cells.erases(sector)).sum()
    }

    /// Sectors 1 to 3.
    pub fn dump(&self) -> Vec<u8> {
        let mut bytes = vec![0; 3 * 16 * 1024];
        ReadNorFlash::read(&mut *self.cells.borrow_mut(), 0, &mut bytes).unwrap();
        bytes
    }
}

pub struct Robot {
    pub chip: Chip,
    service: ParamService<Chip>,
    pub config: RobotConfig,
    revision: u32,
    restored: u32,
    now_us: u64,
    asked: FlashRequest,
    /// Whether the robot is disarmed and at a standstill.
    pub rests: bool,
}

impl Robot {
    pub fn boot(chip: &Chip) -> Self {
        Self::boot_with(chip, &ROBOT_LAYOUT)
    }

    /// A robot that has been at rest for long enough after boot to have a sector ready.
    pub fn ready(chip: &Chip) -> Self {
        let mut robot = Self::boot(chip);
        robot.save();
        robot
    }

    pub fn boot_with(chip: &Chip, layout: &'static MotorLayout) -> Self {
        let (service, config) = ParamService::boot(chip.clone(), layout);
        Self {
            chip: chip.clone(),
            service,
            config,
            revision: 0,
            restored: 0,
            now_us: 2_000_000,
            asked: FlashRequest::None,
            rests: true,
        }
    }

    pub fn change(&mut self, change: impl FnOnce(&mut RobotConfig)) {
        change(&mut self.config);
        self.revision = self.revision.wrapping_add(1);
    }

    /// Sets groups to their defaults, as the tuning channel does. Bit n stands for position n in `PARAMETERS`.
    pub fn restore(&mut self, groups: u32) {
        let defaults = RobotConfig::default();
        for (position, group) in PARAMETERS.iter().enumerate() {
            if groups & 1 << position != 0 {
                group.copy(&defaults, &mut self.config);
            }
        }
        self.restored |= groups;
        self.revision = self.revision.wrapping_add(1);
    }

    /// Takes over the settings that the control tick publishes.
    pub fn take(&mut self, config: &RobotConfig, tuning: &TuningStatus) {
        self.config = *config;
        (self.revision, self.restored) = (tuning.revision, tuning.restored);
    }

    pub fn step(&mut self) {
        self.step_with(if self.rests {
            self.asked
        } else {
            FlashRequest::None
        });
    }

    /// Runs one millisecond, in which at most one slot may be programmed or one sector erased.
    pub fn step_with(&mut self, granted: FlashRequest) {
        let before = (self.chip.cells.borrow().programs(), self.chip.erases());
        self.now_us += 1_000;
        self.asked = self.service.step(
            &self.config,
            self.revision,
            self.restored,
            granted,
            self.now_us,
        );
        let words = self.chip.cells.borrow().programs() - before.0;
        let erases = self.chip.erases() - before.1;
        assert!(words <= 32, "{words} words at once");
        match granted {
            FlashRequest::None => assert_eq!((words, erases), (0, 0)),
            FlashRequest::Program => assert_eq!(erases, 0),
            FlashRequest::Erase => assert!(erases <= 1),
        }
    }

    pub fn run_ms(&mut self, duration_ms: u32) {
        for _ in 0..duration_ms {
            self.step();
        }
    }

    /// Runs until everything is saved and a spare sector is ready.
    pub fn save(&mut self) {
        for _ in 0..10_000 {
            self.step();
            let status = self.service.status();
            if status.state == ParamState::Saved && self.asked == FlashRequest::None {
                return;
            }
        }
        panic!("not saved: {:?}", self.service.status());
    }

    /// Notes that the chip stood still in the last step.
    pub fn note_stall_ms(&mut self, stall_ms: u32) {
        self.service.note_stall(stall_ms * 1_000);
    }

    pub fn status(&self) -> ParamStatus {
        *self.service.status()
    }

    pub fn asked(&self) -> FlashRequest {
        self.asked
    }

    pub fn now_us(&self) -> u64 {
        self.now_us
    }

    pub fn seconds(&self) -> f64 {
        self.now_us as f64 / 1e6
    }
}
