//! Runs one filter over one motion and measures it.

use std::path::Path;

use robot_replay::{At, Figures, Mode, Run};
use serde::Serialize;

use crate::{
    filters::{Filter, OURS},
    motion::{Motion, NewSamples},
    program::{Blocks, Program},
};

/// The instructions of each tick, sorted by what was new in it.
#[derive(Clone, Debug, Default)]
pub struct Costs {
    pub update_with_mag: Vec<u32>,
    pub update: Vec<u32>,
    /// Ticks without a new sample, in which the attitude is extrapolated.
    pub extrapolation: Vec<u32>,
}

/// Mean, 99th percentile and maximum of an instruction count.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Spread {
    pub mean: f64,
    pub p99: u32,
    pub max: u32,
}

pub struct Measured {
    pub motion: String,
    pub costs: Costs,
    /// Errors against the recording's reference, if it has one.
    pub at_samples: Option<Figures>,
    pub at_1_khz: Option<Figures>,
    pub flash_bytes: usize,
    /// Empty unless [`Detail::Blocks`] was asked for.
    pub profile: Profile,
}

/// The blocks of code that ran.
#[derive(Clone, Debug, Default)]
pub struct Profile {
    /// Blocks that ran in updates with magnetometer.
    pub updates: Blocks,
    /// Blocks that ran in ticks without a new sample.
    pub between: Blocks,
    pub worst: WorstTick,
}

/// The tick that took the most instructions.
#[derive(Clone, Debug, Default)]
pub struct WorstTick {
    pub instructions: u32,
    pub blocks: Blocks,
}

/// Selects how much a run notes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    Totals,
    /// Notes also which blocks of code ran.
    Blocks,
}

/// Runs `filter` over `motion` and calls `progress` after each tick. A filter that does not extrapolate is called at
/// samples only, and keeps its last attitude between them.
pub fn run(
    filter: Filter,
    programs: &Path,
    motion: &Motion,
    detail: Detail,
    mut progress: impl FnMut(),
) -> anyhow::Result<Measured> {
    let mut program = Program::boot(&filter.elf(programs))?;
    program.note_blocks(detail == Detail::Blocks);
    let mut costs = Costs::default();
    let mut profile = Profile::default();
    let mut ticks = Vec::new();
    let mut q_wxyz = [1.0, 0.0, 0.0, 0.0];
    for (t_us, fresh, input) in motion.ticks() {
        if fresh != NewSamples::Nothing || filter == OURS {
            let tick = program.tick(&input)?;
            costs.of(fresh).push(tick.instructions);
            if detail == Detail::Blocks {
                profile.add(fresh, tick.instructions, program.take_blocks());
            }
            q_wxyz = tick.q_wxyz.map(f64::from);
        }
        ticks.push(robot_replay::Tick {
            t_us,
            q_wxyz,
            gyro_bias_rps: [0.0; 3],
            valid: true,
        });
        progress();
    }
    let mode = Mode::NineAxis;
    let run = Run { mode, ticks };
    let score = |at| match motion {
        Motion::Recorded(trial) => run.score(trial, at),
        Motion::Computed { .. } => None,
    };
    Ok(Measured {
        motion: motion.name().to_owned(),
        costs,
        at_samples: score(At::Samples),
        at_1_khz: score(At::EveryTick),
        flash_bytes: program.flash_bytes,
        profile,
    })
}

impl Profile {
    fn add(&mut self, fresh: NewSamples, instructions: u32, blocks: Blocks) {
        let sum = match fresh {
            NewSamples::ImuAndMag => Some(&mut self.updates),
            NewSamples::Imu => None,
            NewSamples::Nothing => Some(&mut self.between),
        };
        if let Some(sum) = sum {
            for (block, runs) in &blocks {
                *sum.entry(*block).or_default() += runs;
            }
        }
        if instructions > self.worst.instructions {
            self.worst = WorstTick {
                instructions,
                blocks,
            };
        }
    }
}

impl Costs {
    fn of(&mut self, fresh: NewSamples) -> &mut Vec<u32> {
        match fresh {
            NewSamples::ImuAndMag => &mut self.update_with_mag,
            NewSamples::Imu => &mut self.update,
            NewSamples::Nothing => &mut self.extrapolation,
        }
    }
}

impl Spread {
    /// Returns `None` if there are no ticks.
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
