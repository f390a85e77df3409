//! The names of all signals of a run, and their values at one instant.

use crate::machine::diagnostics::meaning::Meaning;

/// Names of all signals of a run: the world's, then the firmware's diagnostics, then the run's own.
#[derive(Clone, Debug)]
pub struct SignalTable {
    names: Vec<String>,
    world: usize,
    diag: usize,
    /// Meanings of the diagnostics' values, in the same order. The list may be shorter.
    meanings: Vec<Option<Meaning>>,
}

/// One value of each signal; `None` while the firmware is not running, or in a gap of the reference.
pub type Values = Vec<Option<f64>>;

impl SignalTable {
    pub fn new(world: &[String], diag: &[String], run: &[&str]) -> Self {
        let names = world.iter().chain(diag).cloned();
        Self {
            names: names.chain(run.iter().map(|n| n.to_string())).collect(),
            world: world.len(),
            diag: diag.len(),
            meanings: Vec::new(),
        }
    }

    /// Adds the meanings of the diagnostics' values.
    #[must_use]
    pub fn with_meanings(mut self, diag: Vec<Option<Meaning>>) -> Self {
        self.meanings = diag;
        self
    }

    /// The meaning of a signal's values, if the firmware contains it.
    pub fn meaning(&self, place: usize) -> Option<&Meaning> {
        let diag = place.checked_sub(self.world)?;
        self.meanings.get(diag)?.as_ref()
    }

    pub fn names(&self) -> &[String] {
        &self.names
    }

    pub fn index(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|n| n == name)
    }

    /// Positions of the firmware's diagnostics.
    pub fn diag_range(&self) -> std::ops::Range<usize> {
        self.world..self.world + self.diag
    }

    /// Position of the first of the run's own signals.
    pub fn run_start(&self) -> usize {
        self.world + self.diag
    }

    /// The message that a signal does not exist, with the name that may have been meant.
    pub fn missing(&self, name: &str) -> String {
        let hint = nearest(name, self.names.iter().map(String::as_str))
            .map_or(String::new(), |n| format!("; did you mean `{n}`?"));
        format!("no signal is named `{name}`{hint} (`--list-signals` lists them)")
    }
}

/// The candidate most similar to a mistyped name, if one is close.
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .map(|c| (edit_distance(name, c), c))
        .min()
        .filter(|(distance, _)| *distance <= name.len() / 3 + 1)
        .map(|(_, candidate)| candidate)
}

/// Levenshtein distance over bytes.
fn edit_distance(a: &str, b: &str) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.bytes().enumerate() {
        let mut diagonal = i;
        row[0] = i + 1;
        for (j, cb) in b.bytes().enumerate() {
            let substituted = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edit_distance_of_known_pairs() {
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(edit_distance("", "abc"), 3);
        assert_eq!(edit_distance("flaw", "lawn"), 2);
    }

    #[test]
    fn a_missing_signal_suggests_a_near_one_only() {
        let table = SignalTable::new(&["truth.body.x".into()], &[], &["emu.resets"]);
        assert!(table.missing("truth.bodi.x").contains("`truth.body.x`?"));
        assert!(!table.missing("q").contains("did you mean"));
    }
}
