//! Dotted signal names as nested JSON: `truth.wheel.0.speed_mps` is field `speed_mps` of element 0 of `wheel`.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

use super::signals::Values;

#[derive(Debug, PartialEq)]
pub enum Tree {
    /// Index into the values.
    Leaf(usize),
    Object(BTreeMap<String, Tree>),
    Array(Vec<Tree>),
}

impl Tree {
    /// Builds a tree of the given names, each a dotted path with the index of its value.
    pub fn new<'a>(names: impl Iterator<Item = (&'a str, usize)>) -> Self {
        let mut root = BTreeMap::new();
        for (name, place) in names {
            insert(&mut root, name, place);
        }
        into_arrays(root)
    }

    /// The current values as JSON. A missing value is omitted in an object and null in an array.
    pub fn with<'a>(&'a self, values: &'a Values) -> impl Serialize + 'a {
        Filled { tree: self, values }
    }

    /// Whether an object contains it.
    pub fn has_value(&self, values: &Values) -> bool {
        match self {
            Self::Leaf(place) => values[*place].is_some_and(f64::is_finite),
            Self::Array(_) => true,
            Self::Object(fields) => fields.values().any(|tree| tree.has_value(values)),
        }
    }

    /// JSON schema of the output of `json`.
    pub fn schema(&self) -> Value {
        match self {
            Self::Leaf(_) => json!({ "type": "number" }),
            Self::Array(items) => {
                json!({ "type": "array", "items": items.first().map_or(json!({}), Self::schema) })
            }
            Self::Object(fields) => {
                let properties: Map<_, _> = fields
                    .iter()
                    .map(|(name, tree)| (name.clone(), tree.schema()))
                    .collect();
                json!({ "type": "object", "properties": properties })
            }
        }
    }
}

/// A tree with the values of an instant. It is written a hundred times a second, and therefore without an intermediate
/// copy.
struct Filled<'a> {
    tree: &'a Tree,
    values: &'a Values,
}

impl Serialize for Filled<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let values = self.values;
        match self.tree {
            Tree::Leaf(place) => match values[*place] {
                Some(value) => number(value, to),
                None => to.serialize_unit(),
            },
            Tree::Array(items) => to.collect_seq(items.iter().map(|tree| Filled { tree, values })),
            Tree::Object(fields) => {
                let present = fields.iter().filter(|(_, tree)| tree.has_value(values));
                to.collect_map(present.map(|(name, tree)| (name, Filled { tree, values })))
            }
        }
    }
}

/// Writes whole numbers without a fraction, so that counters look like counters.
fn number<S: Serializer>(value: f64, to: S) -> Result<S::Ok, S::Error> {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        to.serialize_i64(value as i64)
    } else {
        to.serialize_f64(value)
    }
}

fn insert(fields: &mut BTreeMap<String, Tree>, path: &str, place: usize) {
    let Some((head, rest)) = path.split_once('.') else {
        fields.insert(path.to_owned(), Tree::Leaf(place));
        return;
    };
    let child = fields
        .entry(head.to_owned())
        .or_insert_with(|| Tree::Object(BTreeMap::new()));
    if let Tree::Object(inner) = child {
        insert(inner, rest, place);
    }
}

/// Objects whose keys are 0, 1, 2 … become arrays.
fn into_arrays(fields: BTreeMap<String, Tree>) -> Tree {
    let mut fields: BTreeMap<String, Tree> = fields
        .into_iter()
        .map(|(name, tree)| match tree {
            Tree::Object(inner) => (name, into_arrays(inner)),
            other => (name, other),
        })
        .collect();
    let is_array =
        !fields.is_empty() && (0..fields.len()).all(|i| fields.contains_key(&i.to_string()));
    if is_array {
        let items = (0..fields.len()).filter_map(|i| fields.remove(&i.to_string()));
        Tree::Array(items.collect())
    } else {
        Tree::Object(fields)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbered_parts_become_arrays_and_missing_values_vanish() {
        let names = ["wheel.0.rpm", "wheel.1.rpm", "t", "gap.x"];
        let tree = Tree::new(names.iter().enumerate().map(|(i, n)| (*n, i)));
        let values = vec![Some(1.5), Some(-2.0), Some(3.0), None];
        let expected = json!({ "t": 3, "wheel": [{ "rpm": 1.5 }, { "rpm": -2 }] });
        assert_eq!(serde_json::to_value(tree.with(&values)).unwrap(), expected);
        assert_eq!(
            tree.schema()["properties"]["wheel"]["items"]["properties"]["rpm"]["type"],
            "number"
        );
    }
}
