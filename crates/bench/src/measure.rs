//! One filter over one motion.

use std::path::Path;

use serde::Serialize;

use crate::{
    filters::{Filter, OURS},
    motion::{Fresh, Motion},
    program::{Blocks, Program},
    score::Score,
};

/// Instructions of each tick, by what was new in it.
#[derive(Clone, Debug, Default)]
pub struct Costs {
    pub update_with_mag: Vec<u32>,
    pub update: Vec<u32>,
    /// Nothing new: the attitude is carried on.
    pub extrapolation: Vec<u32>,
}

/// Instructions.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Spread {
    pub mean: f64,
    pub p99: u32,
    pub max: u32,
}

pub struct Measured {
    pub costs: Costs,
    pub score: Score,
    pub flash_bytes: usize,
    /// What the updates with magnetometer ran, if asked for.
    pub blocks: Blocks,
}

/// What a run is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    Totals,
    /// Also where the instructions of an update with magnetometer go.
    Blocks,
}

/// `progress` is told of each row. Filters that carry nothing on between samples are called at samples only.
pub fn run(
    filter: Filter,
    programs: &Path,
    motion: &Motion,
    detail: Detail,
    mut progress: impl FnMut(),
) -> anyhow::Result<Measured> {
    let mut program = Program::boot(&filter.elf(programs))?;
    let mut measured = Measured {
        costs: Costs::default(),
        score: Score::default(),
        flash_bytes: program.flash_bytes,
        blocks: Blocks::new(),
    };
    let extrapolates = filter == OURS;
    for (index, row) in motion.rows.iter().enumerate() {
        for (fresh, input) in motion.ticks(index) {
            if fresh == Fresh::Nothing && !extrapolates {
                break;
            }
            program.note_blocks(detail == Detail::Blocks && fresh == Fresh::ImuAndMag);
            let tick = program.tick(&input)?;
            measured.costs.of(fresh).push(tick.instructions);
            if fresh != Fresh::Nothing
                && let Some(reference) = row.reference_wxyz
            {
                measured.score.add(tick.q_wxyz, reference);
            }
        }
        progress();
    }
    measured.blocks = program.take_blocks();
    Ok(measured)
}

impl Costs {
    fn of(&mut self, fresh: Fresh) -> &mut Vec<u32> {
        match fresh {
            Fresh::ImuAndMag => &mut self.update_with_mag,
            Fresh::Imu => &mut self.update,
            Fresh::Nothing => &mut self.extrapolation,
        }
    }
}

impl Spread {
    /// `None` without ticks.
    pub fn of(ticks: &[u32]) -> Option<Self> {
        let mut sorted = ticks.to_vec();
        sorted.sort_unstable();
        let sum: u64 = sorted.iter().copied().map(u64::from).sum();
        Some(Self {
            mean: sum as f64 / sorted.len() as f64,
            p99: *sorted.get(sorted.len() * 99 / 100)?,
            max: *sorted.last()?,
        })
    }
}
