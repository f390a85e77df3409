//! Documents and comments cite only what is in the tree: documents, their sections, files, folders and tests.

mod anchors;
mod command;
mod document;
mod port_table;
mod source;
mod tree;

use std::collections::BTreeSet;

use tree::Tree;

/// Tests of citations: their examples cite what is not there.
const EXAMPLES: [&str; 3] = [
    "host-tests/src/links.rs",
    "host-tests/tests/citations/",
    "host-tests/tests/languages/",
];

#[test]
fn documents_cite_what_is_there() {
    let tree = Tree::read();
    let documents: Vec<&String> = tree.files_ending_in(&[".md"]).collect();
    assert!(documents.len() > 15, "{documents:?}");
    let missing: Vec<String> = documents
        .into_iter()
        .flat_map(|path| document::missing(&tree, path, &tree.text(path)))
        .collect();
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

/// Every page can be reached from the README through other documents.
#[test]
fn every_page_is_linked() {
    let tree = Tree::read();
    let mut reached = BTreeSet::from(["README.md".to_owned()]);
    let mut next: Vec<String> = reached.iter().cloned().collect();
    while let Some(page) = next.pop() {
        let linked = document::linked(&page, &tree.text(&page));
        let there = linked.into_iter().filter(|page| tree.has_file(page));
        next.extend(there.filter(|page| reached.insert(page.clone())));
    }
    let pages = tree.files_ending_in(&[".md"]);
    let pages = pages.filter(|path| path.starts_with("docs/") || !path.contains('/'));
    let alone: Vec<_> = pages.filter(|path| !reached.contains(*path)).collect();
    assert!(alone.is_empty(), "no link leads to {alone:?}");
}

#[test]
fn comments_cite_what_is_there() {
    let tree = Tree::read();
    let kinds = [".rs", ".toml", ".yml", ".py", ".c", ".h", ".x", ".ci/run"];
    let sources = tree.files_ending_in(&kinds);
    let sources = sources.filter(|path| !EXAMPLES.iter().any(|folder| path.starts_with(folder)));
    let sources: Vec<&String> = sources.collect();
    assert!(sources.len() > 300, "{} sources", sources.len());
    let missing: Vec<String> = sources
        .into_iter()
        .flat_map(|path| source::missing(&tree, path, &tree.text(path)))
        .collect();
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}
