//! Where each term is in the input of the network.

use std::fmt;

use crate::{Group, HistoryOrder, PolicyDescription, Source, TermPlan};

/// A term of one age in the input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// The term.
    pub term: String,
    /// Age of the frame in runs of the network. 0 is the frame of now.
    pub age: usize,
    /// Place of the first value in the input.
    pub offset: usize,
    /// Number of values.
    pub len: usize,
    /// What each value belongs to, such as `x` or the name of a joint.
    pub values: Vec<String>,
    /// Place of the first value in a frame of all terms.
    pub(super) place_in_frame: usize,
}

/// The input of the network, term by term.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    blocks: Vec<Block>,
    /// Groups of the description: their terms' lengths, and their ages.
    pub(super) groups: Vec<GroupLayout>,
    /// Number of wheels.
    pub(super) wheels: usize,
}

/// A group's share of the input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct GroupLayout {
    pub(super) terms: Vec<(String, usize)>,
    pub(super) ages: Vec<usize>,
}

impl GroupLayout {
    /// Values of one frame.
    pub(super) fn frame_len(&self) -> usize {
        self.terms.iter().map(|(_, len)| len).sum()
    }

    pub(super) fn len(&self) -> usize {
        self.frame_len() * self.ages.len()
    }
}

impl Layout {
    /// Returns the layout of a policy's input.
    pub fn new(policy: &PolicyDescription) -> Self {
        let mut blocks = Vec::new();
        let mut group_start = 0;
        for group in &policy.observation {
            for (term, age) in in_order(group) {
                let before = group.terms.iter().take(term).map(TermPlan::len);
                let plan = &group.terms[term];
                blocks.push(Block {
                    term: plan.name.clone(),
                    age,
                    offset: blocks.last().map_or(0, Block::end),
                    len: plan.len(),
                    values: names(plan, policy),
                    place_in_frame: group_start + before.sum::<usize>(),
                });
            }
            group_start += group.terms.iter().map(TermPlan::len).sum::<usize>();
        }
        let groups = policy.observation.iter().map(|group| GroupLayout {
            terms: group
                .terms
                .iter()
                .map(|term| (term.name.clone(), term.len()))
                .collect(),
            ages: group.ages.clone(),
        });
        Self {
            blocks,
            groups: groups.collect(),
            wheels: policy.wheel_count(),
        }
    }

    /// Returns the terms in the order of the input.
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Returns the length of the input.
    pub fn len(&self) -> usize {
        self.blocks.last().map_or(0, Block::end)
    }

    /// Returns whether the input has no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the number of frames that the history holds.
    pub fn frames(&self) -> usize {
        let oldest = self.blocks.iter().map(|block| block.age).max();
        oldest.unwrap_or(0) + 1
    }

    /// Returns the name of each value of the input, such as `dof_pos[left_wheel]@-2`: term, what it belongs to, and the
    /// age where it is not 0.
    pub fn value_names(&self) -> Vec<String> {
        let names = self.blocks.iter().flat_map(|block| {
            let age = match block.age {
                0 => String::new(),
                age => format!("@-{age}"),
            };
            let values = block.values.iter();
            values.map(move |value| format!("{}[{value}]{age}", block.term))
        });
        names.collect()
    }
}

impl Block {
    fn end(&self) -> usize {
        self.offset + self.len
    }
}

/// The blocks of a group: index of the term, and age.
fn in_order(group: &Group) -> Vec<(usize, usize)> {
    let terms = 0..group.terms.len();
    let ages = group.ages.iter().copied();
    match group.order {
        HistoryOrder::Time => ages
            .flat_map(|age| terms.clone().map(move |term| (term, age)))
            .collect(),
        HistoryOrder::Term => terms
            .flat_map(|term| ages.clone().map(move |age| (term, age)))
            .collect(),
    }
}

fn names(term: &TermPlan, policy: &PolicyDescription) -> Vec<String> {
    let of_joints = |indices: &mut dyn Iterator<Item = usize>| {
        indices
            .map(|index| policy.joints[index].name.clone())
            .collect()
    };
    match &term.source {
        Source::LinearVelocity | Source::AngularVelocity | Source::Gravity => {
            ["x", "y", "z"].map(str::to_owned).to_vec()
        }
        Source::Commands => ["forward", "left", "yaw"].map(str::to_owned).to_vec(),
        Source::Positions(joints) | Source::Velocities(joints) => {
            of_joints(&mut joints.iter().copied())
        }
        Source::Actions => of_joints(&mut (0..policy.joints.len())),
    }
}

impl fmt::Display for Layout {
    /// Writes a line for each block: first and last place, values, term, age.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for block in &self.blocks {
            let Block {
                term,
                age,
                offset,
                len,
                values,
                ..
            } = block;
            let last = block.end().saturating_sub(1);
            let age = match age {
                0 => "now".to_owned(),
                1 => "1 run ago".to_owned(),
                age => format!("{age} runs ago"),
            };
            let values = values.join(" ");
            writeln!(
                f,
                "{offset:>5} … {last:<5} {len:>3}  {term:<17} {age:<10}  {values}"
            )?;
        }
        write!(f, "{:>5} values", self.len())
    }
}
