//! Each row of docs/port.md names the new place of a statement, the test that shows it and the differences.

use crate::tree::Tree;

/// Cells of each row below a table's head.
fn rows(text: &str) -> Vec<Vec<&str>> {
    let next_lines = text.lines().skip(1).chain([""]);
    text.lines()
        .zip(next_lines)
        .filter(|(line, next)| line.starts_with("| ") && !next.starts_with("|--"))
        .map(|(line, _)| {
            let cells = line.trim_matches('|').split('|');
            cells.map(str::trim).collect()
        })
        .collect()
}

/// Whether a cell names a path of the tree in backticks.
fn names_a_place(tree: &Tree, cell: &str) -> bool {
    cell.split('`').skip(1).step_by(2).any(|name| {
        let (path, _) = name.split_once("::").unwrap_or((name, ""));
        tree.has(path)
    })
}

#[test]
fn every_row_says_where_and_what_shows_it() {
    let tree = Tree::read();
    let text = tree.text("docs/port.md");
    let rows = rows(&text);
    assert!(rows.len() > 50, "{} rows", rows.len());
    for row in rows {
        let [what, place, shown, different] = row[..] else {
            panic!("a row of other than four columns: {row:?}");
        };
        assert!(!what.is_empty() && !different.is_empty(), "{row:?}");
        assert!(names_a_place(&tree, place), "no place: {row:?}");
        assert!(names_a_place(&tree, shown), "nothing shows it: {row:?}");
    }
}
