//! A chip, the store as the firmware uses it, and a ledger of the records that must be there.

use std::collections::BTreeMap;

use robot_app::{
    domain::{FlashRequest, ParamError},
    params::{Progress, Record, RecordId, Store},
};
use robot_plant::flash_chip::FlashChip;

/// Limit of steps, more than a save with a rotation takes.
const MAX_STEPS: usize = 300;

/// Records by key and variant.
pub type Contents = BTreeMap<(u8, u8), Record>;

pub type BootedStore<'a> = Store<&'a mut FlashChip>;

pub fn record(key: u8, variant: u8, version: u8, values: &[u32]) -> Record {
    Record {
        id: RecordId { key, variant },
        version,
        values: values.iter().copied().collect(),
    }
}

pub fn identity(record: &Record) -> (u8, u8) {
    (record.id.key, record.id.variant)
}

/// What `for_each` tells; a record told twice is an error of the store.
pub fn read(store: &mut BootedStore) -> Contents {
    let mut contents = Contents::new();
    store.for_each(|record| {
        let twice = contents.insert(identity(record), record.clone());
        assert_eq!(twice, None, "told twice");
    });
    contents
}

/// Boots as the firmware does: settles what a cut left half programmed, then reads the records.
pub fn boot(chip: &mut FlashChip) -> Result<(BootedStore<'_>, Contents), ParamError> {
    let mut store = Store::open(chip);
    for _ in 0..MAX_STEPS {
        if store.next(false) != FlashRequest::Program {
            let contents = read(&mut store);
            return Ok((store, contents));
        }
        store.work(None)?;
    }
    panic!("booting never ends");
}

pub fn save(store: &mut BootedStore, record: &Record) -> Result<(), ParamError> {
    for _ in 0..MAX_STEPS {
        assert!(
            store.next(true) != FlashRequest::None,
            "a save asks for nothing"
        );
        if store.work(Some(record))? == Progress::Stored {
            return Ok(());
        }
    }
    panic!("saving never ends");
}

/// Does what the store requests while nothing is to be saved.
pub fn tidy(store: &mut BootedStore) -> Result<(), ParamError> {
    for _ in 0..MAX_STEPS {
        if store.next(false) == FlashRequest::None {
            return Ok(());
        }
        store.work(None)?;
    }
    panic!("tidying never ends");
}

/// A chip with a new store, in which one sector is clean.
pub fn new_chip(seed: u64) -> FlashChip {
    let mut chip = FlashChip::parameters(seed);
    tidy(&mut Store::open(&mut chip)).expect("a good chip");
    chip
}

/// Save after save on a chip that keeps its power; gives what must be in it.
pub fn save_all(chip: &mut FlashChip, records: &[Record]) -> Contents {
    let mut contents = Contents::new();
    let mut store = Store::open(chip);
    for record in records {
        save(&mut store, record).expect("a good chip");
        tidy(&mut store).expect("a good chip");
        contents.insert(identity(record), record.clone());
    }
    contents
}

/// What a boot may find after a cut.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    /// Confirmed by the store.
    pub saved: Contents,
    /// Records whose save was begun but not confirmed. Each may be there or not.
    pub begun: Vec<Record>,
}

impl Ledger {
    pub fn of(saved: Contents) -> Self {
        Self {
            saved,
            begun: Vec::new(),
        }
    }

    pub fn save(&mut self, store: &mut BootedStore, record: &Record) -> Result<(), ParamError> {
        self.begun.push(record.clone());
        save(store, record)?;
        // What was begun earlier under this identity is overruled for good.
        self.begun.retain(|begun| begun.id != record.id);
        self.saved.insert(identity(record), record.clone());
        Ok(())
    }

    /// Makes what a boot found the contents that every later boot must find.
    pub fn settle(&mut self, found: &Contents) {
        self.saved = found.clone();
        self.begun.clear();
    }

    /// The first record that is neither the old nor the new one.
    pub fn first_loss(&self, found: &Contents) -> Option<String> {
        let identities = self.saved.keys().chain(found.keys());
        identities
            .filter(|identity| {
                let found = found.get(identity);
                let is_old = found == self.saved.get(identity);
                let is_new = found.is_some_and(|found| self.begun.contains(found));
                !is_old && !is_new
            })
            .map(|identity| {
                let (saved, found) = (self.saved.get(identity), found.get(identity));
                format!("{identity:?}: {found:?} instead of {saved:?}")
            })
            .next()
    }
}

/// Counts cases, and the records lost in them.
#[derive(Debug, Default)]
pub struct Tally {
    pub cuts: u32,
    pub lost: u32,
    pub failed_saves: u32,
    /// Number of power cuts that were reported as damage.
    pub false_alarms: u32,
    pub first: Option<String>,
}

impl Tally {
    pub fn check(&mut self, ledger: &Ledger, found: &Contents, case: &str) {
        if let Some(loss) = ledger.first_loss(found) {
            self.lost += 1;
            self.first.get_or_insert(format!("{case}: {loss}"));
        }
    }

    pub fn check_save(&mut self, saved: Result<(), ParamError>, case: &str) {
        if let Err(error) = saved {
            self.failed_saves += 1;
            self.first.get_or_insert(format!("{case}: {error:?}"));
        }
    }

    pub fn check_report(&mut self, store: &BootedStore, case: &str) {
        let lost = store.report().lost_sectors;
        if lost != 0 {
            self.false_alarms += 1;
            self.first
                .get_or_insert(format!("{case}: {lost} lost sectors"));
        }
    }

    pub fn assert_none_lost(&self, name: &str) {
        println!(
            "{name}: {} power cuts, {} records lost or rolled back, {} saves failed afterwards, {} false alarms",
            self.cuts, self.lost, self.failed_saves, self.false_alarms
        );
        let failures = (self.lost, self.failed_saves, self.false_alarms);
        assert_eq!(failures, (0, 0, 0), "{:?}", self.first);
    }
}
