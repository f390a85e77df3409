//! The estimator's errors on every trial of the folder that `build.rs` found.

use std::fmt::{self, Display, Formatter};

use anyhow::Context;
use robot_replay::{At, Figures, Mode, load, run};

pub struct TrialErrors {
    pub name: String,
    pub at_samples: Figures,
    pub every_tick: Figures,
}

/// Never empty.
pub struct Errors {
    pub trials: Vec<TrialErrors>,
}

pub fn errors_of_all(mode: Mode, gyro_offset_dps: [f32; 3]) -> anyhow::Result<Errors> {
    let trials = load(env!("RECORDED_MOTION").as_ref())?;
    let of_trial = |trial| {
        let run = run(&trial, mode, gyro_offset_dps);
        let score = |at| {
            run.score(&trial, at)
                .with_context(|| format!("no reference in {}", trial.name))
        };
        Ok(TrialErrors {
            at_samples: score(At::Samples)?,
            every_tick: score(At::EveryTick)?,
            name: trial.name,
        })
    };
    let trials = trials
        .into_iter()
        .map(of_trial)
        .collect::<anyhow::Result<_>>()?;
    Ok(Errors { trials })
}

impl Errors {
    pub fn mean_at_samples(&self) -> Figures {
        self.mean(|trial| trial.at_samples)
    }

    pub fn mean_every_tick(&self) -> Figures {
        self.mean(|trial| trial.every_tick)
    }

    fn mean(&self, figures: fn(&TrialErrors) -> Figures) -> Figures {
        let all: Vec<Figures> = self.trials.iter().map(figures).collect();
        Figures::mean(&all).expect("there are trials")
    }
}

/// RMSE in degrees at every tick: total, heading, inclination.
impl Display for Errors {
    fn fmt(&self, to: &mut Formatter) -> fmt::Result {
        let mut line = |name: &str, f: Figures| {
            let (total, heading, inclination) = (f.total_deg, f.heading_deg, f.inclination_deg);
            writeln!(to, "{name:50} {total:8.3} {heading:8.3} {inclination:8.3}")
        };
        for trial in &self.trials {
            line(&trial.name, trial.every_tick)?;
        }
        line("mean", self.mean_every_tick())
    }
}
