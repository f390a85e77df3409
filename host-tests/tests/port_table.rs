//! docs/port.md names places and tests that exist, and no row leaves a column empty.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// Folders of the repository: a name in backticks that begins with one of them is a path.
const FOLDERS: [&str; 7] = [
    "src",
    "crates",
    "host-tests",
    "scenarios",
    "xtask",
    "docs",
    "tests",
];
const FILES: [&str; 2] = ["memory.x", "build.rs"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

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

/// Names in backticks that are paths, with the test after `::` if there is one.
fn places(text: &str) -> Vec<(&str, Option<&str>)> {
    text.split('`')
        .skip(1)
        .step_by(2)
        .map(|name| match name.split_once("::") {
            Some((path, test)) => (path, Some(test)),
            None => (name, None),
        })
        .filter(|(path, _)| {
            let folder = path.split('/').next().unwrap_or_default();
            FOLDERS.contains(&folder) || FILES.contains(path)
        })
        .collect()
}

/// `None` if the place exists, else what is missing.
fn missing(path: &str, test: Option<&str>) -> Option<String> {
    let file = root().join(path);
    if !file.exists() {
        return Some(path.to_owned());
    }
    let test = test?;
    let text = fs::read_to_string(file).unwrap();
    let is_test = text.contains(&format!("fn {test}(")) && text.contains("#[test]");
    (!is_test).then(|| format!("{path}::{test}"))
}

fn port_table() -> String {
    fs::read_to_string(root().join("docs/port.md")).unwrap()
}

#[test]
fn every_place_and_test_exists() {
    let text = port_table();
    let missing: Vec<String> = places(&text)
        .into_iter()
        .filter_map(|(path, test)| missing(path, test))
        .collect();
    assert_eq!(missing, Vec::<String>::new());
}

#[test]
fn every_row_says_where_and_what_shows_it() {
    let text = port_table();
    let rows = rows(&text);
    assert!(rows.len() > 50, "{} rows", rows.len());
    for row in rows {
        let [what, place, shown, different] = row[..] else {
            panic!("a row of other than four columns: {row:?}");
        };
        assert!(!what.is_empty() && !different.is_empty(), "{row:?}");
        assert!(!places(place).is_empty(), "no place: {row:?}");
        assert!(!places(shown).is_empty(), "nothing shows it: {row:?}");
    }
}

#[test]
fn what_is_not_there_is_noticed() {
    assert_eq!(missing("docs/port.md", None), None);
    assert!(missing("docs/nowhere.md", None).is_some());
    let this = "host-tests/tests/port_table.rs";
    assert_eq!(missing(this, Some("what_is_not_there_is_noticed")), None);
    assert!(missing(this, Some("what_nobody_wrote")).is_some());
}
