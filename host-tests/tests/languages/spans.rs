//! Parts of Markdown besides words: code in backticks and targets of links.

use std::collections::BTreeSet;

#[derive(Debug, Default, PartialEq, Eq)]
pub struct Spans {
    pub code: BTreeSet<String>,
    pub targets: BTreeSet<String>,
    /// The remaining text, with a space in place of each piece of code and each target.
    pub words: String,
}

pub fn spans(text: &str) -> Spans {
    let mut spans = Spans::default();
    let mut words = String::new();
    for (index, part) in text.split('`').enumerate() {
        if index % 2 == 1 {
            spans.code.insert(part.to_owned());
            words.push(' ');
        } else {
            words.push_str(part);
        }
    }
    let mut parts = words.split("](");
    spans.words.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let (target, rest) = part.split_once(')').unwrap_or((part, ""));
        spans.targets.insert(target.to_owned());
        spans.words.push_str("] ");
        spans.words.push_str(rest);
    }
    spans
}

#[test]
fn code_and_targets_are_told_from_words() {
    let found = spans("Type `a b` ([how](x.md#y), `c`): 5 ms, ![picture](p.svg)");
    assert_eq!(found.code, ["a b", "c"].map(String::from).into());
    assert_eq!(found.targets, ["x.md#y", "p.svg"].map(String::from).into());
    assert_eq!(found.words, "Type   ([how] ,  ): 5 ms, ![picture] ");
}
