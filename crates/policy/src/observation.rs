//! What the network sees: terms, their order, their history.

mod layout;
mod mismatch;
mod reading;

pub use layout::{Block, Layout};
pub use mismatch::{Mismatch, Suspect};
pub use reading::{Commands, Reading};

use crate::{Drive, Joint, PolicyDescription, Source, TermPlan};

/// A reading from which no observation can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ObserveError {
    /// A list has another length than the policy has joints.
    #[error("{what}: {found} values for the policy's {wanted} joints")]
    Count {
        /// The list.
        what: &'static str,
        /// Joints of the policy.
        wanted: usize,
        /// Values that were given.
        found: usize,
    },
    /// The policy wants the body's velocity, and nobody knows it.
    #[error(
        "{term}: the body's velocity is not measured. Train without this term, or with an estimate of it"
    )]
    NoLinearVelocity {
        /// The term.
        term: String,
    },
    /// A value is infinite or NaN.
    #[error("{term}[{index}] is {value}")]
    NotFinite {
        /// The term.
        term: String,
        /// Place of the value in the term.
        index: usize,
        /// The value.
        value: f32,
    },
}

/// Computes the input of the network. Everything that it needs is allocated when it is made.
///
/// The history holds the first reading in all of its frames. [`reset`](Self::reset) forgets it.
#[derive(Clone, Debug)]
pub struct Observer {
    joints: Vec<Joint>,
    command_ranges: [[f32; 2]; 3],
    terms: Vec<TermPlan>,
    layout: Layout,
    /// Frames, one after another. A frame holds all terms of all groups.
    frames: Vec<f32>,
    frame_len: usize,
    /// Place of the frame of now. Older ones follow it, and the first follows the last.
    newest: usize,
    has_history: bool,
    input: Vec<f32>,
}

impl Observer {
    /// Returns an observer without a history.
    pub fn new(policy: &PolicyDescription) -> Self {
        let terms: Vec<_> = policy
            .observation
            .iter()
            .flat_map(|group| group.terms.clone())
            .collect();
        let layout = Layout::new(policy);
        let frame_len = terms.iter().map(TermPlan::len).sum();
        Self {
            joints: policy.joints.clone(),
            command_ranges: policy.command_ranges,
            frames: vec![0.0; frame_len * layout.frames()],
            input: vec![0.0; layout.len()],
            terms,
            layout,
            frame_len,
            newest: 0,
            has_history: false,
        }
    }

    /// Returns where each term is in the input.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Forgets all readings: the next one fills the history. It belongs to every start of the policy.
    pub fn reset(&mut self) {
        self.has_history = false;
    }

    /// Returns the input of the network. The reading becomes the newest frame of the history; before the first one after
    /// a reset the whole history is that first one.
    ///
    /// `last_actions` are those of [`Decoder::last_actions`](crate::action::Decoder::last_actions).
    ///
    /// # Errors
    /// A list is too long or too short, or a value is no number. Then the history is as before.
    pub fn observe(
        &mut self,
        reading: &Reading,
        commands: &Commands,
        last_actions: &[f32],
    ) -> Result<&[f32], ObserveError> {
        self.check(reading, last_actions)?;
        let depth = self.layout.frames();
        let next = (self.newest + depth - 1) % depth;
        // The oldest frame is overwritten; while it may still fail, nothing else changes.
        let start = next * self.frame_len;
        let frame = &mut self.frames[start..start + self.frame_len];
        let seen = Seen {
            joints: &self.joints,
            reading,
            commands: commands.within(&self.command_ranges),
            last_actions,
        };
        let mut place = 0;
        for term in &self.terms {
            seen.write(term, &mut frame[place..place + term.len()])?;
            place += term.len();
        }
        if !self.has_history {
            let range = start..start + self.frame_len;
            for other in 0..depth {
                self.frames
                    .copy_within(range.clone(), other * self.frame_len);
            }
        }
        self.newest = next;
        self.has_history = true;
        self.gather();
        Ok(&self.input)
    }

    fn check(&self, reading: &Reading, last_actions: &[f32]) -> Result<(), ObserveError> {
        let wanted = self.joints.len();
        for (what, found) in [
            ("joint angles", reading.joint_pos_rad.len()),
            ("joint speeds", reading.joint_vel_rps.len()),
            ("last actions", last_actions.len()),
        ] {
            if found != wanted {
                return Err(ObserveError::Count {
                    what,
                    wanted,
                    found,
                });
            }
        }
        Ok(())
    }

    /// Copies the blocks of the layout out of the history.
    fn gather(&mut self) {
        let depth = self.layout.frames();
        for block in self.layout.blocks() {
            let frame = (self.newest + block.age) % depth;
            let from = frame * self.frame_len + block.place_in_frame;
            let to = block.offset;
            self.input[to..to + block.len].copy_from_slice(&self.frames[from..from + block.len]);
        }
    }
}

/// Everything that terms are computed from.
struct Seen<'a> {
    joints: &'a [Joint],
    reading: &'a Reading,
    commands: [f32; 3],
    last_actions: &'a [f32],
}

impl Seen<'_> {
    /// Writes the values of a term.
    fn write(&self, term: &TermPlan, values: &mut [f32]) -> Result<(), ObserveError> {
        let vector;
        let source = match &term.source {
            Source::LinearVelocity => {
                let velocity = self.reading.linear_velocity_mps;
                let name = || ObserveError::NoLinearVelocity {
                    term: term.name.clone(),
                };
                vector = velocity.ok_or_else(name)?;
                Values::Of(&vector)
            }
            Source::AngularVelocity => Values::Of(&self.reading.body_rates_rps),
            Source::Gravity => {
                vector = self.reading.attitude.gravity();
                Values::Of(&vector)
            }
            Source::Commands => Values::Of(&self.commands),
            Source::Actions => Values::Of(self.last_actions),
            Source::Positions(joints) => Values::Angles(joints),
            Source::Velocities(joints) => Values::Speeds(joints),
        };
        for (index, (value, scale)) in values.iter_mut().zip(&term.scale).enumerate() {
            let raw = self.value(&source, index);
            if !raw.is_finite() {
                let term = term.name.clone();
                return Err(ObserveError::NotFinite {
                    term,
                    index,
                    value: raw,
                });
            }
            let [low, high] = term.clip_before;
            let [lowest, highest] = term.clip_after;
            *value = (raw.clamp(low, high) * scale).clamp(lowest, highest);
        }
        Ok(())
    }

    fn value(&self, source: &Values<'_>, index: usize) -> f32 {
        match source {
            Values::Of(values) => values[index],
            Values::Angles(joints) => {
                let joint = &self.joints[joints[index]];
                match joint.drive {
                    Drive::Position => {
                        self.reading.joint_pos_rad[joints[index]] - joint.default_rad
                    }
                    Drive::Speed => 0.0,
                }
            }
            Values::Speeds(joints) => self.reading.joint_vel_rps[joints[index]],
        }
    }
}

/// Where the values of a term come from.
enum Values<'a> {
    Of(&'a [f32]),
    Angles(&'a [usize]),
    Speeds(&'a [usize]),
}
