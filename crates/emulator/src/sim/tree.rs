//! Dotted signal names as nested JSON: `truth.wheel.0.speed_mps` is field `speed_mps` of element 0 of `wheel`.

use std::collections::BTreeMap;

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
    /// A tree of the given names (each a dotted path and the place of its value).
    pub fn new<'a>(names: impl Iterator<Item = (&'a str, usize)>) -> Self {
        let mut root = BTreeMap::new();
        for (name, place) in names {
            insert(&mut root, name, place);
        }
        into_arrays(root)
    }

    /// Present values; what has none is left out of objects and null in arrays.
    pub fn json(&self, values: &Values) -> Value {
        match self {
            Self::Leaf(place) => values[*place].map_or(Value::Null, number),
            Self::Array(items) => items.iter().map(|t| t.json(values)).collect(),
            Self::Object(fields) => fields
                .iter()
                .map(|(name, tree)| (name.clone(), tree.json(values)))
                .filter(|(_, value)| !value.is_null() && *value != json!({}))
                .collect::<Map<_, _>>()
                .into(),
        }
    }

    /// JSON schema of what `json` gives.
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

/// Whole numbers without a fraction, so that counters read as counters.
fn number(value: f64) -> Value {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        json!(value as i64)
    } else {
        json!(value)
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
        assert_eq!(tree.json(&values), expected);
        assert_eq!(
            tree.schema()["properties"]["wheel"]["items"]["properties"]["rpm"]["type"],
            "number"
        );
    }
}
