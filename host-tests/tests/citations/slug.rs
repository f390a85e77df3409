//! Names of sections, as hosting sites make them from headings.

/// The anchor of a heading: small letters, digits, `-` and `_`, with `-` for each space.
pub fn slug(heading: &str) -> String {
    let lower = heading.trim().to_lowercase();
    let kept = |letter: &char| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_');
    let dashed = |letter: char| if letter == ' ' { '-' } else { letter };
    lower.chars().filter(kept).map(dashed).collect()
}

/// Anchors of all headings of a document, those in code excepted.
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
fn headings_become_anchors() {
    assert_eq!(slug(" A joint's zero"), "a-joints-zero");
    assert_eq!(slug("C620 and M3508"), "c620-and-m3508");
    assert_eq!(slug("接线"), "接线");
    let text = "# One\ntext\n```sh\n# no heading\n```\n## Two, three\n";
    assert_eq!(anchors(text), ["one", "two-three"]);
}
