//! The fault matrix is written by a program and only in English; the Chinese page has a key to it.

use crate::{
    site::{Site, root},
    spans::spans,
};
use std::{collections::BTreeSet, fs};

/// The text between the marks of the matrix on a page.
fn region(page: &str) -> String {
    let text = fs::read_to_string(root().join(page)).unwrap();
    let begin = text.find("<!-- matrix").unwrap();
    let end = text.find("<!-- matrix ends").unwrap();
    text[begin..end].to_owned()
}

/// The phrases of the matrix without times: `all 0 within … ms`, `stays off`.
fn phrases(matrix: &str) -> BTreeSet<String> {
    let rows = matrix.lines().filter(|line| line.starts_with("| `"));
    let cells = rows.flat_map(|row| row.split('|').skip(2));
    cells.flat_map(phrases_of_cell).collect()
}

fn phrases_of_cell(cell: &str) -> Vec<String> {
    let mut words = spans(cell).words;
    // Measured times, and the brackets of flags that may rise.
    while let Some((begin, rest)) = words.split_once('[') {
        let after = rest.split_once(']').map_or("", |(_, after)| after);
        words = format!("{begin}{after}");
    }
    let words = words.replace(['(', ')'], "");
    let phrases = words.split([';', ',']).map(str::trim);
    let nameless = phrases.map(|phrase| match phrase.split_once(" within ") {
        Some((what, _)) => format!("{what} within … ms"),
        None => phrase.to_owned(),
    });
    nameless.filter(|phrase| !phrase.is_empty()).collect()
}

/// The phrases that the key explains: the first cell of each row, in backticks.
fn explained(key: &str) -> BTreeSet<String> {
    let cells = key.lines().filter_map(|row| row.split('|').nth(1));
    cells.flat_map(|cell| spans(cell).code).collect()
}

#[test]
fn the_chinese_key_explains_what_the_matrix_says() {
    let phrases = phrases(&region("docs/safety.md"));
    assert!(phrases.len() > 10, "{phrases:?}");
    assert_eq!(explained(&region("docs/zh-CN/safety.md")), phrases);
}

#[test]
fn the_chinese_key_leads_to_the_matrix() {
    let site = Site::read();
    let chinese = &site.0["docs/safety.md"].chinese;
    let targets = spans(&region("docs/zh-CN/safety.md")).targets;
    let places: Vec<String> = targets
        .iter()
        .map(|target| site.place(chinese, target))
        .collect();
    // The matrix is under the last heading of both pages.
    let last = chinese.headings().count() - 1;
    assert_eq!(
        places,
        [format!(
            "docs/safety.md, heading {last}, in the other language"
        )]
    );
}

#[test]
fn phrases_are_told_from_flags_and_times() {
    let matrix = "| fault | driving |\n|---|---|\n\
                  | `x` | `a-b` (`c`); all 0 within 13 ms [wheels 7.8, joints 8.9]; stays off | runs on |\n";
    let expected = ["all 0 within … ms", "runs on", "stays off"];
    assert_eq!(phrases(matrix), expected.map(String::from).into());
    let key = "| words | 含义 |\n|---|---|\n| `runs on` | `armed` 照常 |\n";
    assert_eq!(explained(key), ["runs on".to_owned()].into());
}
