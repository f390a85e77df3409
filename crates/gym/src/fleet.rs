//! Many environments, stepped in threads.

use std::path::Path;

use rayon::{ThreadPool, ThreadPoolBuilder, prelude::*};
use robot_policy::PolicyDescription;

use crate::{Environment, GymError, Options};

/// Environments that are stepped together.
pub struct Fleet {
    /// Whether an environment whose episode ends begins the next in the same step.
    pub resets: bool,
    environments: Vec<Environment>,
    pool: ThreadPool,
    observation_len: usize,
}

/// What a step of all environments led to, one row for each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Observations, after the reset of those that have ended.
    pub observations: Vec<f32>,
    /// Observations before that reset.
    pub last_observations: Vec<f32>,
    /// Rewards.
    pub rewards: Vec<f64>,
    /// Who has fallen.
    pub fallen: Vec<bool>,
    /// Whose time was over.
    pub over: Vec<bool>,
}

impl Fleet {
    /// Boots so many robots in so many threads, 0 for one a processor. The seeds of the environments follow from `seed`.
    ///
    /// # Errors
    /// As [`Environment::new`].
    ///
    /// # Panics
    /// The operating system gives no threads.
    pub fn new(
        policy: &PolicyDescription,
        options: Options,
        seed: u64,
        count: usize,
        threads: usize,
    ) -> Result<Self, GymError> {
        Self::of(policy, options, seed, count, threads, None)
    }

    /// The same, with an image on emulated boards as in [`Environment::on_board`].
    pub(crate) fn of(
        policy: &PolicyDescription,
        options: Options,
        seed: u64,
        count: usize,
        threads: usize,
        elf: Option<&Path>,
    ) -> Result<Self, GymError> {
        let builder = ThreadPoolBuilder::new().num_threads(threads);
        let pool = builder.build().expect("threads");
        let environments = pool.install(|| boot(policy, options, seed, count, elf))?;
        let first = environments.first();
        Ok(Self {
            resets: true,
            observation_len: first.map_or(0, |it| it.observation().len()),
            environments,
            pool,
        })
    }

    /// Values of an observation.
    pub fn observation_len(&self) -> usize {
        self.observation_len
    }

    /// The environments.
    pub fn environments(&self) -> &[Environment] {
        &self.environments
    }

    /// The environments, to command or push them.
    pub fn environments_mut(&mut self) -> &mut [Environment] {
        &mut self.environments
    }

    /// The present observations, one row after another.
    pub fn observations(&self) -> Vec<f32> {
        let rows = self.environments.iter().map(Environment::observation);
        rows.flatten().copied().collect()
    }

    /// Begins another episode of each.
    ///
    /// # Errors
    /// A robot does not arm.
    pub fn reset(&mut self) -> Result<(), GymError> {
        let environments = &mut self.environments;
        self.pool
            .install(|| environments.par_iter_mut().try_for_each(Environment::reset))
    }

    /// Steps each environment with its row of actions.
    ///
    /// # Errors
    /// The actions are too many, too few, or no numbers; or the next robot of an environment does not arm.
    pub fn step(&mut self, actions: &[f32]) -> Result<Rows, GymError> {
        let count = self.environments.len();
        let width = self
            .environments
            .first()
            .map_or(0, Environment::actions_len);
        if actions.len() != count * width {
            return Err(GymError::Length {
                what: "actions",
                wanted: count * width,
                found: actions.len(),
            });
        }
        let len = self.observation_len;
        let mut rows = Rows {
            observations: vec![0.0; count * len],
            last_observations: vec![0.0; count * len],
            rewards: vec![0.0; count],
            fallen: vec![false; count],
            over: vec![false; count],
        };
        let resets = self.resets;
        let environments = &mut self.environments;
        self.pool.install(|| {
            environments
                .par_iter_mut()
                .zip(actions.par_chunks(width))
                .zip(rows.observations.par_chunks_mut(len))
                .zip(rows.last_observations.par_chunks_mut(len))
                .zip(rows.rewards.par_iter_mut())
                .zip(rows.fallen.par_iter_mut().zip(rows.over.par_iter_mut()))
                .try_for_each(|(((((environment, actions), seen), last), reward), ends)| {
                    let step = environment.step(actions)?;
                    last.copy_from_slice(environment.observation());
                    *reward = step.reward;
                    *ends.0 = step.fallen;
                    *ends.1 = environment.is_over();
                    if resets && (*ends.0 || *ends.1) {
                        environment.reset()?;
                    }
                    seen.copy_from_slice(environment.observation());
                    Ok::<(), GymError>(())
                })
        })?;
        Ok(rows)
    }
}

fn boot(
    policy: &PolicyDescription,
    options: Options,
    seed: u64,
    count: usize,
    elf: Option<&Path>,
) -> Result<Vec<Environment>, GymError> {
    (0..count)
        .into_par_iter()
        .map(|index| Environment::of(policy, options, seed_of(seed, index as u64), elf))
        .collect()
}

/// Seeds of neighbours have nothing in common.
fn seed_of(seed: u64, index: u64) -> u64 {
    seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(index.wrapping_mul(0xd1b5_4a32_d192_ed03))
}
