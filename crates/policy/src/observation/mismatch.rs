//! A network whose input has another length than the configuration's.

use std::fmt;

use super::{Layout, layout::GroupLayout};

/// A configuration and a network that do not fit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    layout: Layout,
    model_len: usize,
    suspects: Vec<Suspect>,
}

/// One change that would make the configuration fit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Suspect {
    /// What would have to be otherwise.
    pub change: String,
    /// The input as it then would be: each term with its age, and its length.
    pub blocks: Vec<(String, usize)>,
}

impl Layout {
    /// Compares the length with that of the network's input.
    ///
    /// # Errors
    /// They differ. The error says what is where, and which term is likely at fault.
    pub fn check(&self, model_len: usize) -> Result<(), Mismatch> {
        if self.len() == model_len {
            Ok(())
        } else {
            Err(Mismatch::new(self.clone(), model_len))
        }
    }
}

impl Mismatch {
    fn new(layout: Layout, model_len: usize) -> Self {
        let suspects = suspects(&layout, model_len);
        Self {
            layout,
            model_len,
            suspects,
        }
    }

    /// Returns single changes that would make it fit, the likeliest first.
    pub fn suspects(&self) -> &[Suspect] {
        &self.suspects
    }
}

impl std::error::Error for Mismatch {}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            layout,
            model_len,
            suspects,
        } = self;
        let found = layout.len();
        writeln!(
            f,
            "the configuration gives {found} values, and the network takes {model_len}."
        )?;
        writeln!(f, "The configuration's input:\n{layout}")?;
        let Some((likeliest, others)) = suspects.split_first() else {
            return write!(
                f,
                "No single term and no other length of the history makes {model_len} of it. What was the network trained with? \
                 `observations` has to list exactly that."
            );
        };
        writeln!(
            f,
            "Likely: {}. The network's input would then be:",
            likeliest.change
        )?;
        let mut offset = 0;
        for (term, len) in &likeliest.blocks {
            let last = (offset + len).saturating_sub(1);
            writeln!(f, "{offset:>5} … {last:<5} {len:>3}  {term}")?;
            offset += len;
        }
        write!(f, "{offset:>5} values")?;
        for other in others {
            write!(f, "\nOr: {}.", other.change)?;
        }
        Ok(())
    }
}

/// Changes of one thing after which the input has the wanted length.
fn suspects(layout: &Layout, wanted: usize) -> Vec<Suspect> {
    let mut found = Vec::new();
    for (index, group) in layout.groups.iter().enumerate() {
        let others: usize = layout.len() - group.len();
        let Some(rest) = wanted.checked_sub(others) else {
            continue;
        };
        found.extend(wheels_elsewhere(layout, index, rest));
        found.extend(without_a_term(layout, index, rest));
        found.extend(other_history(layout, index, rest));
        found.extend(other_term_length(layout, index, rest));
    }
    found
}

/// Wheels in the terms of joints, or not.
fn wheels_elsewhere(layout: &Layout, index: usize, rest: usize) -> Vec<Suspect> {
    let group = &layout.groups[index];
    let (wheels, apart) = (layout.wheels, "wheel_joint_vel");
    let has_apart = group.terms.iter().any(|(name, _)| name == apart);
    let changes = if has_apart {
        let both = "the network knows the wheels in dof_pos and dof_vel as well";
        let joined = "the network knows the wheels in dof_pos and dof_vel, and no wheel_joint_vel";
        vec![
            (both, resized(group, |len| len + wheels), true),
            (joined, resized(group, |len| len + wheels), false),
        ]
    } else {
        let change = "the network knows the joints without the wheels in dof_pos and dof_vel: list wheel_joint_vel";
        let mut changed = resized(group, |len| len.saturating_sub(wheels));
        changed.terms.push((apart.to_owned(), wheels));
        vec![(change, changed, true)]
    };
    let fitting = changes
        .into_iter()
        .filter_map(|(change, mut changed, keeps_apart)| {
            changed
                .terms
                .retain(|(name, _)| keeps_apart || name != apart);
            (wheels > 0 && changed.len() == rest).then(|| Suspect {
                change: change.to_owned(),
                blocks: blocks(layout, index, &changed),
            })
        });
    fitting.collect()
}

/// The group with other lengths of the terms of joints.
fn resized(group: &GroupLayout, resize: impl Fn(usize) -> usize) -> GroupLayout {
    let mut changed = group.clone();
    for (name, len) in &mut changed.terms {
        if ["dof_pos", "dof_vel"].contains(&name.as_str()) {
            *len = resize(*len);
        }
    }
    changed
}

/// One term too many.
fn without_a_term(layout: &Layout, index: usize, rest: usize) -> Vec<Suspect> {
    let group = &layout.groups[index];
    let frames = group.ages.len();
    let terms = group.terms.iter().enumerate();
    let fitting = terms.filter(|(_, (_, len))| (group.frame_len() - len) * frames == rest);
    let suspects = fitting.map(|(term, (name, len))| {
        let mut changed = group.clone();
        changed.terms.remove(term);
        Suspect {
            change: format!(
                "the network does not know {name} ({} too many)",
                values(len * frames)
            ),
            blocks: blocks(layout, index, &changed),
        }
    });
    suspects.collect()
}

/// More or fewer frames.
fn other_history(layout: &Layout, index: usize, rest: usize) -> Option<Suspect> {
    let group = &layout.groups[index];
    let frame_len = group.frame_len();
    // A group of now alone is observations_nonstack, or has no history to begin with.
    let has_history = group.ages.len() > 1 || index == 0;
    if !has_history || frame_len == 0 || rest == 0 || !rest.is_multiple_of(frame_len) {
        return None;
    }
    let frames = rest / frame_len;
    let mut changed = group.clone();
    changed.ages = (0..frames).collect();
    Some(Suspect {
        change: format!(
            "the network has a history of {frames} frames of {}, and the configuration one of {}",
            values(frame_len),
            group.ages.len()
        ),
        blocks: blocks(layout, index, &changed),
    })
}

/// One term, or one that is missing, of another length. Terms with a value for each joint are the ones in question.
fn other_term_length(layout: &Layout, index: usize, rest: usize) -> Vec<Suspect> {
    let group = &layout.groups[index];
    let frames = group.ages.len();
    if frames == 0 || !rest.is_multiple_of(frames) {
        return Vec::new();
    }
    let frame_len = rest / frames;
    let longest = group.terms.iter().map(|(_, len)| *len).max().unwrap_or(0);
    let surplus = group.frame_len().checked_sub(frame_len);
    let Some(surplus) = surplus.filter(|it| *it > 0) else {
        return missing_term(layout, index, frame_len);
    };
    let terms = group.terms.iter().enumerate();
    // Vectors have three values in every configuration.
    let in_question = terms.filter(|(_, (_, len))| *len > surplus && *len > 3.min(longest - 1));
    let suspects = in_question.map(|(term, (name, len))| {
        let mut changed = group.clone();
        changed.terms[term].1 = len - surplus;
        Suspect {
            change: format!(
                "{name} is too long by {surplus}: it has {}, and the network may know {}",
                values(*len),
                len - surplus
            ),
            blocks: blocks(layout, index, &changed),
        }
    });
    suspects.collect()
}

fn missing_term(layout: &Layout, index: usize, frame_len: usize) -> Vec<Suspect> {
    let group = &layout.groups[index];
    let missing = frame_len - group.frame_len();
    let mut changed = group.clone();
    changed.terms.push(("?".to_owned(), missing));
    // The first group has the frames; what comes behind it is of now only.
    let place = if index == 0 {
        "each frame"
    } else {
        "observations_nonstack"
    };
    let change = format!(
        "a term of {} is missing in {place}, or terms are too short by as much",
        values(missing)
    );
    vec![Suspect {
        change,
        blocks: blocks(layout, index, &changed),
    }]
}

/// The input with one group changed. Within a group, frames follow each other.
fn blocks(layout: &Layout, index: usize, changed: &GroupLayout) -> Vec<(String, usize)> {
    let groups = layout.groups.iter().enumerate();
    let groups = groups.map(|(place, group)| if place == index { changed } else { group });
    let blocks = groups.flat_map(|group| {
        group.ages.iter().flat_map(|age| {
            let terms = group.terms.iter();
            terms.map(move |(name, len)| match age {
                0 => (name.clone(), *len),
                age => (format!("{name}, {age} before"), *len),
            })
        })
    });
    blocks.collect()
}

fn values(count: usize) -> String {
    match count {
        1 => "1 value".to_owned(),
        count => format!("{count} values"),
    }
}
