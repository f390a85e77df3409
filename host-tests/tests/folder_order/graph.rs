//! The graph of uses between sibling modules, and its cycles.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt,
};

use crate::{imports::Import, module_tree::Module};

/// `from` uses `to`; both are inside the same module.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Use {
    pub from: String,
    pub to: String,
    /// One place of this use, for the error message.
    example: String,
}

impl fmt::Display for Use {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} → {}: {}", self.from, self.to, self.example)
    }
}

/// One use for each pair of modules inside `folder` in which anything in the first uses anything in the second.
pub fn uses_between_siblings(crate_root: &Module, folder: &Module) -> Vec<Use> {
    let depth = folder.path().len();
    let mut found = BTreeMap::new();
    for user in folder.children().flat_map(Module::all) {
        for import in &user.imports {
            let target = target(crate_root, &import.path, MAX_DETOURS);
            let [from, to] = [user.path(), &target].map(|path| path.get(depth).cloned());
            let (Some(from), Some(to)) = (from, to) else {
                continue;
            };
            if from != to && target.starts_with(folder.path()) {
                let example = format!("{} names {}", user.path().join("::"), target.join("::"));
                found.entry((from, to)).or_insert(example);
            }
        }
    }
    found
        .into_iter()
        .map(|((from, to), example)| Use { from, to, example })
        .collect()
}

/// Limit of re-exports that are followed for one name.
const MAX_DETOURS: u32 = 8;

/// The module that defines the path's last name, found through its re-exports.
fn target(crate_root: &Module, path: &[String], detours: u32) -> Vec<String> {
    let mut module = crate_root;
    for part in path {
        if let Some(child) = module.child(part) {
            module = child;
            continue;
        }
        let passes_on = |import: &&Import| import.name.as_ref() == Some(part);
        return match module.imports.iter().find(passes_on) {
            Some(import) if detours > 0 && import.path != path => {
                target(crate_root, &import.path, detours - 1)
            }
            _ => module.path().to_vec(),
        };
    }
    module.path().to_vec()
}

/// The first cycle that is found, as a chain of names.
pub fn first_circle(edges: &[Use]) -> Option<String> {
    let starts: BTreeSet<_> = edges.iter().map(|edge| edge.from.as_str()).collect();
    starts
        .into_iter()
        .find_map(|start| way_back(edges, start, &mut vec![start]))
}

fn way_back<'a>(edges: &'a [Use], start: &str, way: &mut Vec<&'a str>) -> Option<String> {
    let last = *way.last()?;
    for edge in edges.iter().filter(|edge| edge.from == last) {
        if edge.to == start {
            way.push(&edge.to);
            return Some(way.join(" → "));
        }
        if !way.contains(&edge.to.as_str()) {
            way.push(&edge.to);
            let found = way_back(edges, start, way);
            if found.is_some() {
                return found;
            }
            way.pop();
        }
    }
    None
}
