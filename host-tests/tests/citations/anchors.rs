//! Anchors of the sections of a document.

use robot_host_tests::links::slug;

/// Anchors of all headings of a document, except those in code blocks.
pub fn anchors(text: &str) -> Vec<String> {
    let mut in_code = false;
    let mut found = Vec::new();
    for line in text.lines() {
        if line.starts_with("```") {
            in_code = !in_code;
        }
        let title = line.trim_start_matches('#');
        if !in_code && line.starts_with('#') && title.starts_with(' ') {
            found.push(slug(title));
        }
    }
    found
}

#[test]
fn code_has_no_headings() {
    let text = "# One\ntext\n```sh\n# no heading\n```\n## Two, three\n";
    assert_eq!(anchors(text), ["one", "two-three"]);
}
