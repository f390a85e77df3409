//! The modules of crates/app use each other in one direction only.
//!
//! Its `lib.rs` lists the folders in a table: a folder uses only folders above it. Sibling modules inside a folder do
//! not form a cycle. Code for tests may use anything.

use std::{
    fs,
    path::{Path, PathBuf},
};

use graph::{first_circle, uses_between_siblings};
use module_tree::{Module, Sources};

mod graph;
mod imports;
mod module_tree;

fn source_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/app/src")
}

fn app() -> Module {
    let root = source_folder();
    Module::load(&Sources::new(move |file| {
        fs::read_to_string(root.join(file)).ok()
    }))
}

/// The names in the first column of the table, from the top.
fn written_order(documentation: &str) -> Vec<&str> {
    let rows = documentation
        .lines()
        .filter_map(|line| line.strip_prefix("//! | "));
    rows.filter_map(|row| row.split('|').next()?.split('`').nth(1))
        .collect()
}

/// Uses of a folder from one above it.
fn upward_uses(crate_root: &Module, order: &[&str]) -> Vec<String> {
    let place = |name: &str| order.iter().position(|folder| *folder == name);
    uses_between_siblings(crate_root, crate_root)
        .into_iter()
        .filter(|edge| place(&edge.from) < place(&edge.to))
        .map(|edge| edge.to_string())
        .collect()
}

/// The modules of a cycle in each folder that has one.
fn circles(crate_root: &Module, folder: &Module) -> Vec<String> {
    let edges = uses_between_siblings(crate_root, folder);
    let own = first_circle(&edges).map(|circle| format!("{}: {circle}", folder.name()));
    let inner = folder
        .children()
        .flat_map(|child| circles(crate_root, child));
    own.into_iter().chain(inner).collect()
}

#[test]
fn the_table_lists_every_folder_once() {
    let text = fs::read_to_string(source_folder().join("lib.rs")).unwrap();
    let mut listed = written_order(&text);
    listed.sort_unstable();
    let app = app();
    let folders: Vec<_> = app.children().map(Module::name).collect();
    assert_eq!(listed, folders);
}

#[test]
fn a_folder_uses_only_folders_above_it_in_the_table() {
    let text = fs::read_to_string(source_folder().join("lib.rs")).unwrap();
    let upward = upward_uses(&app(), &written_order(&text));
    assert!(upward.is_empty(), "{upward:#?}");
}

#[test]
fn no_modules_beside_each_other_form_a_circle() {
    let app = app();
    let circles = circles(&app, &app);
    assert!(circles.is_empty(), "{circles:#?}");
}

/// A crate of these files.
fn crate_of(files: &'static [(&'static str, &'static str)]) -> Module {
    Module::load(&Sources::new(|file| {
        let found = files.iter().find(|(name, _)| Path::new(name) == file);
        found.map(|(_, text)| (*text).to_owned())
    }))
}

#[test]
fn every_way_to_name_a_module_is_seen() {
    for user in [
        "use crate::upper::Thing;",
        "use crate::{lower, upper::{self, Thing}};",
        "fn f() -> crate::upper::Thing { todo!() }",
        "fn f() { assert!(crate::upper::CHECK); }",
        "mod deep { use super::super::upper::Thing as Other; }",
        "use super::upper;",
    ] {
        let user: &'static str = user;
        let files: &'static [_] = Box::leak(Box::new([
            ("lib.rs", "mod lower; mod upper;"),
            ("lower.rs", user),
            ("upper.rs", "pub struct Thing;"),
        ]));
        let upward = upward_uses(&crate_of(files), &["lower", "upper"]);
        assert_eq!(upward.len(), 1, "{user}");
        assert!(upward_uses(&crate_of(files), &["upper", "lower"]).is_empty());
    }
}

#[test]
fn code_for_tests_does_not_count() {
    let app = crate_of(&[
        ("lib.rs", "mod lower; mod upper;"),
        (
            "lower.rs",
            "#[cfg(test)] use crate::upper::{A, B}; #[cfg(test)] mod tests; pub struct C;",
        ),
        ("lower/tests.rs", "use crate::upper::A;"),
        ("upper.rs", "use crate::lower::C;"),
    ]);
    assert!(upward_uses(&app, &["lower", "upper"]).is_empty());
    assert!(circles(&app, &app).is_empty());
}

/// `b` gets from the folder's file what that has from `a`.
#[test]
fn a_circle_through_a_name_that_the_folder_passes_on_is_found() {
    let app = crate_of(&[
        ("lib.rs", "mod folder;"),
        ("folder.rs", "mod a; mod b; pub use a::Thing;"),
        ("folder/a.rs", "use super::b::Other; pub struct Thing;"),
        ("folder/b.rs", "use super::Thing; pub struct Other;"),
    ]);
    assert_eq!(circles(&app, &app), ["folder: a → b → a"]);
}
