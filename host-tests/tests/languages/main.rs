//! English and Chinese pages name the same commands, settings, figures and places.

mod blocks;
mod compare;
mod figures;
mod matrix;
mod site;
mod spans;

use site::Site;

/// What a team needs to run its robot safely is there in both languages.
const NEEDED: [&str; 6] = [
    "README.md",
    "docs/bring-up.md",
    "docs/calibration.md",
    "docs/motors.md",
    "docs/safety.md",
    "docs/tuning.md",
];

#[test]
fn both_languages_say_the_same() {
    let site = Site::read();
    let pairs = site.0.values();
    let found: Vec<String> = pairs
        .flat_map(|pair| compare::differences(&site, pair))
        .collect();
    assert!(found.is_empty(), "\n{}\n", found.join("\n"));
}

#[test]
fn what_a_team_needs_is_there_in_chinese() {
    let site = Site::read();
    for page in NEEDED {
        assert!(site.0.contains_key(page), "{page} has no Chinese page");
    }
}
