//! Cuts at every step of saves around three changes of the sector; then a boot, a save, and a boot again.

use std::{fmt, ops::Range, sync::LazyLock};

use embedded_storage::nor_flash::ReadNorFlash;
use robot_plant::flash_chip::{FlashChip, Phase, sector_range};

use crate::{
    flash::erases,
    own_store::OwnStore,
    settings::{Found, KEYS, Keeper, Save},
    the_crate::SequentialStorage,
};

/// Saves before and after each change of the sector that are cut too.
const NEIGHBOURS: usize = 4;
const SECTOR_CHANGES: usize = 3;
/// Distances between the steps of a sector change, and of the recovery after it, that are cut twice.
const FIRST_CUTS_APART: usize = 4;
const SECOND_CUTS_APART: usize = 2;

/// The first save after a cut.
const NEXT: Save = Save {
    key: 0,
    number: 1_000_000,
};

/// Number of cut points, and of those after which something is wrong.
#[derive(Debug, Default)]
struct Figures {
    cuts: u32,
    /// A record acknowledged before the cut is missing or older afterwards, and nothing says so.
    lost: u32,
    /// A boot or the next save fails even after the crate's repair. The crate then advises to erase everything.
    needs_erase_all: u32,
    /// The interrupted save was there in the first boot and is gone after the next save.
    undone: u32,
    /// The save after the cut was acknowledged and is gone in the boot after it.
    next_lost: u32,
    /// An intact record that nobody stored.
    strange: u32,
}

impl Figures {
    fn harm(&self) -> u32 {
        self.lost + self.needs_erase_all + self.undone + self.next_lost + self.strange
    }
}

/// The object that a cut in the middle of a step tears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    /// The first or last word of a sector, by which the crate tells whether it is open, in use or closed.
    Marker,
    Word,
    Erase,
}

impl Step {
    /// Rare steps are torn in more ways.
    fn seeds(self) -> Range<u64> {
        match self {
            Self::Marker | Self::Erase => 0..60,
            Self::Word => 0..4,
        }
    }
}

/// The chip before a save, and the newest save of each key on it.
struct Before {
    keeper: &'static dyn Keeper,
    chip: FlashChip,
    stored: [Found; KEYS as usize],
    save: Save,
}

/// The chip after a power cut within a save.
#[derive(Clone)]
struct Cut {
    chip: FlashChip,
    /// The save had been confirmed by then.
    acknowledged: bool,
}

impl Before {
    fn steps(&self) -> Range<u64> {
        let mut chip = self.chip.clone();
        assert!(self.keeper.save(&mut chip, self.save));
        self.chip.steps()..chip.steps()
    }

    fn cut(&self, step: u64, phase: Phase, seed: u64) -> Cut {
        let mut chip = self.chip.clone();
        chip.reseed(seed);
        self.cut_chip(chip, step, phase)
    }

    /// Saves on that chip until the power cut.
    fn cut_chip(&self, mut chip: FlashChip, step: u64, phase: Phase) -> Cut {
        chip.cut_at(step, phase);
        let acknowledged = self.keeper.save(&mut chip, self.save);
        assert!(!chip.is_powered(), "step {step} never came");
        chip.power_up();
        Cut { chip, acknowledged }
    }

    /// Determined from the change that the step makes.
    fn kind(&self, step: u64) -> Step {
        let before = &mut self.cut(step, Phase::Before, 0).chip;
        let after = &mut self.cut(step, Phase::After, 0).chip;
        if erases(after) > erases(before) {
            Step::Erase
        } else if markers(after) != markers(before) {
            Step::Marker
        } else {
            Step::Word
        }
    }

    /// What a boot may find for the key; the newest last.
    fn allowed(&self, key: u8, acknowledged: bool) -> [Found; 2] {
        let old = self.stored[usize::from(key)];
        let new = Found::Save(self.save);
        match (key == self.save.key, acknowledged) {
            (true, true) => [new, new],
            (true, false) => [old, new],
            (false, _) => [old, old],
        }
    }

    /// Boots, saves and boots again.
    fn recover(&self, cut: Cut, figures: &mut Figures) {
        let mut chip = cut.chip;
        let first = self.keeper.load(&mut chip);
        let next_acknowledged = self.keeper.save(&mut chip, NEXT);
        let second = self.keeper.load(&mut chip);
        let (mut lost, mut undone) = (false, false);
        for key in 0..KEYS {
            let allowed = self.allowed(key, cut.acknowledged);
            let (found, later) = (first[usize::from(key)], second[usize::from(key)]);
            let wrong = |found| !matches!(found, Found::Error) && !allowed.contains(&found);
            lost |= wrong(found) || (key != NEXT.key && wrong(later));
            undone |=
                key != NEXT.key && found == allowed[1] && later == allowed[0] && found != later;
        }
        let error = first.contains(&Found::Error) || second.contains(&Found::Error);
        let strange = first.contains(&Found::Strange) || second.contains(&Found::Strange);
        let next = second[usize::from(NEXT.key)];
        figures.cuts += 1;
        figures.lost += u32::from(lost);
        figures.needs_erase_all += u32::from(error || !next_acknowledged);
        figures.undone += u32::from(undone);
        figures.next_lost += u32::from(next_acknowledged && next != Found::Save(NEXT));
        figures.strange += u32::from(strange);
    }
}

/// First and last words of the sectors.
fn markers(chip: &mut FlashChip) -> [[u8; 4]; 6] {
    [0, 0x3FFC, 0x4000, 0x7FFC, 0x8000, 0xBFFC].map(|offset| {
        let mut word = [0; 4];
        ReadNorFlash::read(chip, offset, &mut word).unwrap();
        word
    })
}

/// The saves around each of the first three that erase.
fn saves_around_sector_changes(keeper: &'static dyn Keeper) -> Vec<Before> {
    let mut chip = FlashChip::parameters(0);
    let mut stored = [Found::Nothing; KEYS as usize];
    let (mut all, mut changes) = (Vec::new(), Vec::<usize>::new());
    while changes.len() < SECTOR_CHANGES || changes.iter().any(|at| all.len() <= at + NEIGHBOURS) {
        let save = Save::nth(all.len() as u32);
        let before = chip.clone();
        assert!(keeper.save(&mut chip, save));
        if erases(&chip) > erases(&before) {
            changes.push(all.len());
        }
        all.push(Before {
            keeper,
            chip: before,
            stored,
            save,
        });
        stored[usize::from(save.key)] = Found::Save(save);
    }
    let near = |index: usize| changes.iter().any(|at| at.abs_diff(index) <= NEIGHBOURS);
    let picked = all.into_iter().enumerate().filter(|(i, _)| near(*i));
    picked.map(|(_, before)| before).collect()
}

static OF_THE_CRATE: LazyLock<Vec<Before>> =
    LazyLock::new(|| saves_around_sector_changes(&SequentialStorage));
static OWN: LazyLock<Vec<Before>> = LazyLock::new(|| saves_around_sector_changes(&OwnStore));

/// Figures by where the cut falls.
#[derive(Default)]
struct Table {
    between: Figures,
    word: Figures,
    marker: Figures,
    erase: Figures,
}

impl Table {
    fn of(saves: &[Before]) -> Self {
        let mut table = Self::default();
        for before in saves {
            for step in before.steps() {
                before.recover(before.cut(step, Phase::After, 0), &mut table.between);
                let kind = before.kind(step);
                let figures = match kind {
                    Step::Marker => &mut table.marker,
                    Step::Word => &mut table.word,
                    Step::Erase => &mut table.erase,
                };
                for seed in kind.seeds() {
                    before.recover(before.cut(step, Phase::Middle, seed), figures);
                }
            }
        }
        table
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f)?;
        writeln!(f, "  between two steps {:?}", self.between)?;
        writeln!(f, "  in a word of a record {:?}", self.word)?;
        writeln!(f, "  in a sector's first or last word {:?}", self.marker)?;
        write!(f, "  in an erase {:?}", self.erase)
    }
}

#[test]
fn a_word_or_an_erase_torn_by_a_power_cut_costs_acknowledged_records() {
    let table = Table::of(&OF_THE_CRATE);
    println!("sequential-storage: {table}");
    assert_eq!(table.between.harm(), 0);
    assert!(table.word.undone > 0);
    assert!(table.marker.lost > 0 && table.marker.needs_erase_all > 0);
    assert!(table.erase.lost > 0 && table.erase.needs_erase_all > 0);
}

#[test]
fn the_same_cuts_cost_the_own_store_nothing() {
    let table = Table::of(&OWN);
    println!("own store: {table}");
    for figures in [table.between, table.word, table.marker, table.erase] {
        assert!(figures.cuts > 0);
        assert_eq!(figures.harm(), 0);
    }
}

/// Noise that stays the same from read to read is enough.
#[test]
fn a_record_moved_out_of_a_sector_is_gone_if_the_erase_of_that_sector_was_cut() {
    let mut damaged = 0;
    for before in OF_THE_CRATE.iter() {
        let steps = before.steps();
        let Some(step) = steps.clone().find(|&step| before.kind(step) == Step::Erase) else {
            continue;
        };
        let mut cut = before.cut(step, Phase::Before, 0);
        let erased = before.cut(step, Phase::After, 0).chip;
        let sector = (1..=3)
            .find(|&n| erased.erases(n) > cut.chip.erases(n))
            .unwrap();
        let noise: Vec<u8> = (0..0x4000_u32)
            .map(|n| (n.wrapping_mul(2_654_435_761) >> 24) as u8 & 0x7E)
            .collect();
        cut.chip
            .set_contents(sector_range(sector).unwrap().start, &noise)
            .unwrap();
        let mut figures = Figures::default();
        before.recover(cut, &mut figures);
        damaged += figures.lost;
    }
    assert!(damaged > 0);
}

#[test]
fn two_cuts_between_steps_are_survived() {
    let mut twice = Figures::default();
    for before in OF_THE_CRATE.iter() {
        let steps = before.steps();
        if !steps.clone().any(|step| before.kind(step) == Step::Erase) {
            continue;
        }
        for step in steps.step_by(FIRST_CUTS_APART) {
            let cut = before.cut(step, Phase::After, 0);
            let mut recovered = cut.chip.clone();
            assert!(before.keeper.save(&mut recovered, before.save));
            for step in (cut.chip.steps()..recovered.steps()).step_by(SECOND_CUTS_APART) {
                let second = before.cut_chip(cut.chip.clone(), step, Phase::After);
                before.recover(second, &mut twice);
            }
        }
    }
    println!("cut twice between steps: {twice:?}");
    assert!(twice.cuts > 0);
    assert_eq!(twice.harm(), 0);
}
