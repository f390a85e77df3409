//! Where the links of a Markdown document lead.

/// The anchor that a hosting site gives a heading: small letters, digits, `-` and `_`, with `-` for each space.
pub fn slug(heading: &str) -> String {
    let lower = heading.trim().to_lowercase();
    let kept = |letter: &char| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_');
    let dashed = |letter: char| if letter == ' ' { '-' } else { letter };
    lower.chars().filter(kept).map(dashed).collect()
}

/// The path that `link` means in the file `from`; `None` if it leads out of the repository.
pub fn resolved(from: &str, link: &str) -> Option<String> {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in link.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            name => parts.push(name),
        }
    }
    Some(parts.join("/"))
}

#[test]
fn headings_become_anchors() {
    assert_eq!(
        slug(" A joint's zero: `joint zero`"),
        "a-joints-zero-joint-zero"
    );
    assert_eq!(slug("C620 and M3508"), "c620-and-m3508");
    assert_eq!(slug("关节零位（RS00）"), "关节零位rs00");
}

#[test]
fn links_lead_from_the_file_that_has_them() {
    assert_eq!(resolved("docs/a.md", "b.md").unwrap(), "docs/b.md");
    assert_eq!(resolved("docs/a.md", "../src/x.rs").unwrap(), "src/x.rs");
    assert_eq!(resolved("a.md", "../b.md"), None);
}
