//! Links of a Markdown document, and paths, tests and commands in its code.

use std::collections::BTreeSet;

use robot_host_tests::links::resolved;

use crate::{anchors::anchors, command, source::missing_documents, tree::Tree};

/// Citations of a document that do not exist in the tree, one line each.
pub fn missing(tree: &Tree, path: &str, text: &str) -> Vec<String> {
    let mut found = BTreeSet::from_iter(missing_documents(tree, path, text));
    let links = links(text).filter(|link| !is_there(tree, path, link));
    found.extend(links.map(str::to_owned));
    let code = code(text);
    found.extend(code.iter().flat_map(|line| command::missing(tree, line)));
    let words = code.into_iter().flat_map(str::split_whitespace);
    found.extend(words.filter_map(|word| missing_place(tree, word)));
    found
        .into_iter()
        .map(|it| format!("{path}: {it}"))
        .collect()
}

/// Documents that the links of a document lead to.
pub fn linked(from: &str, text: &str) -> Vec<String> {
    let files = links(text).map(|link| link.split_once('#').map_or(link, |(file, _)| file));
    let documents = files.filter(|file| file.ends_with(".md") && !file.contains("://"));
    documents.filter_map(|file| resolved(from, file)).collect()
}

/// Targets of `[text](target)`.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let ends = text.split("](").skip(1);
    ends.filter_map(|rest| rest.split_once(')').map(|(target, _)| target))
}

fn is_there(tree: &Tree, from: &str, link: &str) -> bool {
    if link.contains("://") {
        return true;
    }
    let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
    let target = if file.is_empty() {
        Some(from.to_owned())
    } else {
        resolved(from, file)
    };
    target.is_some_and(|target| {
        let has_anchor = || anchors(&tree.text(&target)).iter().any(|it| it == anchor);
        tree.has(&target) && (anchor.is_empty() || has_anchor())
    })
}

/// Inline code, and the lines of code blocks.
fn code(text: &str) -> Vec<&str> {
    let mut in_block = false;
    let mut found = Vec::new();
    for line in text.lines() {
        if line.starts_with("```") {
            in_block = !in_block;
        } else if in_block {
            found.push(line);
        } else {
            found.extend(line.split('`').skip(1).step_by(2));
        }
    }
    found
}

/// `None` unless the word is a path, with a test after `::` if there is one, that is not there. A path begins with a
/// folder of the root, or names a Rust file by the end of its path. A part in capitals, such as `ROBOT`, stands for any name.
pub fn missing_place(tree: &Tree, word: &str) -> Option<String> {
    let (path, test) = match word.split_once("::") {
        Some((path, test)) => (path, Some(test)),
        None => (word, None),
    };
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "/._-".contains(letter);
    if !path.chars().all(plain) {
        return None;
    }
    let missing = || Some(word.to_owned());
    if path.ends_with(".rs") {
        let mut files = tree.files_named(path);
        let has_test = |file: &String| test.is_none_or(|test| is_test(&tree.text(file), test));
        return if files.any(has_test) { None } else { missing() };
    }
    let is_capitals =
        |part: &str| !part.is_empty() && part.chars().all(|it| it.is_ascii_uppercase());
    let stands_for_any = path.contains('/') && path.split('/').any(is_capitals);
    if tree.begins_here(path) && !stands_for_any && !tree.has(path) {
        return missing();
    }
    None
}

fn is_test(text: &str, test: &str) -> bool {
    text.contains(&format!("fn {test}(")) && text.contains("#[test]")
}

#[test]
fn what_is_not_there_is_noticed() {
    let tree = Tree::read();
    let in_document = |text: &str| missing(&tree, "docs/port.md", text).len();
    assert_eq!(
        in_document("[a](port.md), [b](../src), [c](https://embassy.dev)"),
        0
    );
    assert_eq!(in_document("[a](nowhere.md)"), 1);
    assert_eq!(in_document("[a](safety.md#the-rules) [b](#safety)"), 0);
    assert_eq!(
        in_document("[a](safety.md#no-such-rules) [b](#no-such-part)"),
        2
    );
    assert_eq!(
        in_document("`src/board.rs`, `board.rs`, `tests/not/a/root`"),
        0
    );
    assert_eq!(in_document("`src/bored.rs` and `bored.rs`"), 2);
    assert_eq!(in_document("`robots/ROBOT/base.yaml` and `docs/PAGE`"), 0);
    assert_eq!(
        in_document("`robots/Robot/base.yaml` and `docs/PAGES.md`"),
        2
    );
    assert_eq!(
        in_document("```sh\ncargo xtask sim scenarios/no-such.toml\n```"),
        1
    );
    let this = "host-tests/tests/citations/document.rs";
    assert_eq!(
        in_document(&format!("`{this}::what_is_not_there_is_noticed`")),
        0
    );
    assert_eq!(in_document(&format!("`{this}::what_nobody_wrote`")), 1);
    assert_eq!(in_document("see docs/nowhere.md"), 1);
}
