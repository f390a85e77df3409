//! Modules use each other in one direction only.
//!
//! The `lib.rs` of crates/app lists its folders in a table: a folder uses only folders above it. In no crate do sibling
//! modules form a cycle. Code for tests may use anything.

use std::{
    fs,
    path::{Path, PathBuf},
};

use graph::{first_circle, uses_between_siblings};
use module_tree::{Module, Sources};

mod graph;
mod imports;
mod module_tree;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn source_folder() -> PathBuf {
    repository().join("crates/app/src")
}

fn load(sources: PathBuf, root: &str) -> Module {
    let read = move |file: &Path| fs::read_to_string(sources.join(file)).ok();
    Module::load(&Sources::new(read), root)
}

fn app() -> Module {
    load(source_folder(), "lib.rs")
}

/// The source folders of all packages.
fn all_source_folders() -> Vec<PathBuf> {
    let crates = fs::read_dir(repository().join("crates")).unwrap();
    let folders = crates.map(|entry| entry.unwrap().path());
    let others = ["", "host-tests", "xtask"].map(|folder| repository().join(folder));
    folders
        .chain(others)
        .map(|folder| folder.join("src"))
        .collect()
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
    let mut found = Vec::new();
    for folder in all_source_folders() {
        let roots = ["lib.rs", "main.rs"].map(|root| folder.join(root).is_file().then_some(root));
        assert_ne!(roots, [None, None], "{}", folder.display());
        for root in roots.into_iter().flatten() {
            let package = load(folder.clone(), root);
            let circles = circles(&package, &package).into_iter();
            found.extend(circles.map(|circle| format!("{}: {circle}", folder.display())));
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// A crate of these files.
fn crate_of(files: &'static [(&'static str, &'static str)]) -> Module {
    let read = |file: &Path| {
        let found = files.iter().find(|(name, _)| Path::new(name) == file);
        found.map(|(_, text)| (*text).to_owned())
    };
    Module::load(&Sources::new(read), "lib.rs")
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
