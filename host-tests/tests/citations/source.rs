//! Documents, and files in backticks, that the comments of a source file cite.

use robot_host_tests::links::resolved;

use crate::{anchors::anchors, document::missing_place, tree::Tree};

/// Citations of a source file that do not exist in the tree, one line each.
pub fn missing(tree: &Tree, path: &str, text: &str) -> Vec<String> {
    let mut found = missing_documents(tree, path, text);
    let comments = text.lines().filter(|line| is_comment(line));
    let code = comments.flat_map(|line| line.split('`').skip(1).step_by(2));
    found.extend(code.filter_map(|word| missing_place(tree, word)));
    found
        .into_iter()
        .map(|it| format!("{path}: {it}"))
        .collect()
}

fn is_comment(line: &str) -> bool {
    ["//", "#", "*"]
        .iter()
        .any(|mark| line.trim_start().starts_with(mark))
}

/// Words that are the name of a document, with a section after `#` if there is one: from the root, or beside `path`.
pub fn missing_documents(tree: &Tree, path: &str, text: &str) -> Vec<String> {
    let part = |letter: char| letter.is_alphanumeric() || "/._-#".contains(letter);
    let words = text.split(|letter| !part(letter));
    let words = words.map(|word| word.trim_end_matches('.'));
    let is_missing = |word: &&str| {
        let (file, anchor) = word.split_once('#').unwrap_or((word, ""));
        let is_document = file.len() > ".md".len() && file.ends_with(".md");
        is_document && !is_there(tree, path, file, anchor)
    };
    words.filter(is_missing).map(str::to_owned).collect()
}

fn is_there(tree: &Tree, from: &str, file: &str, anchor: &str) -> bool {
    let places = [Some(file.to_owned()), resolved(from, file)];
    places.into_iter().flatten().any(|place| {
        tree.has_file(&place)
            && (anchor.is_empty() || anchors(&tree.text(&place)).iter().any(|it| it == anchor))
    })
}

#[test]
fn a_comment_that_cites_nothing_there_is_noticed() {
    let tree = Tree::read();
    let in_source = |text: &str| missing(&tree, "src/main.rs", text);
    assert!(in_source("//! See docs/safety.md#the-rules, and CONTRIBUTING.md.").is_empty());
    assert!(in_source("let name = \"notes.txt\"; // `robot_app::safety`").is_empty());
    let nowhere = format!("nowhere{}", ".md");
    assert_eq!(in_source(&format!("// {nowhere} section 7")).len(), 1);
    let safety = "docs/safety.md";
    assert_eq!(
        in_source(&format!("// {safety}{}", "#no-such-rules")).len(),
        1
    );
    assert_eq!(in_source("// as `drivers/nothing_here.rs` does").len(), 1);
}
