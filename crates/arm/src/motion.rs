//! Recorded motions: positions of an arm's joints against time.

mod error;
mod file;
mod follow;

use serde::{Deserialize, Serialize};

pub use error::MotionError;
pub use follow::Follower;

/// A motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    joints: Vec<String>,
    samples: Vec<Sample>,
}

/// Where the joints were at one moment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sample {
    /// Since the motion's start.
    pub time_s: f64,
    /// In the order of the motion's joints.
    pub steps: Vec<i32>,
}

impl Motion {
    pub fn new(joints: Vec<String>) -> Self {
        Self {
            joints,
            samples: Vec::new(),
        }
    }

    pub fn joints(&self) -> &[String] {
        &self.joints
    }

    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Adds a sample. It has a number for each joint, and is not older than the one before.
    pub fn push(&mut self, sample: Sample) -> Result<(), MotionError> {
        let number = self.samples.len() + 1;
        let last_s = self.samples.last().map_or(0.0, |last| last.time_s);
        if sample.steps.len() != self.joints.len() {
            return Err(MotionError::Length {
                number,
                has: sample.steps.len(),
                joints: self.joints.len(),
            });
        }
        if !(sample.time_s.is_finite() && sample.time_s >= last_s) {
            return Err(MotionError::Time {
                number,
                time_s: sample.time_s,
                last_s,
            });
        }
        self.samples.push(sample);
        Ok(())
    }

    pub fn duration_s(&self) -> f64 {
        self.samples.last().map_or(0.0, |last| last.time_s)
    }
}
