//! The files of the repository.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

/// Folders that hold no sources.
const NOT_OURS: [&str; 2] = ["target", ".git"];

pub struct Tree {
    /// Paths from the root, with `/`.
    files: BTreeSet<String>,
    folders: BTreeSet<String>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

impl Tree {
    pub fn read() -> Self {
        let mut tree = Self {
            files: BTreeSet::new(),
            folders: BTreeSet::new(),
        };
        tree.read_folder(&root(), "");
        tree
    }

    fn read_folder(&mut self, folder: &Path, prefix: &str) {
        for entry in fs::read_dir(folder).unwrap() {
            let entry = entry.unwrap();
            let name = entry.file_name().into_string().unwrap();
            let path = format!("{prefix}{name}");
            let kind = entry.file_type().unwrap();
            if kind.is_dir() && !NOT_OURS.contains(&name.as_str()) {
                self.read_folder(&entry.path(), &format!("{path}/"));
                self.folders.insert(path);
            } else if kind.is_file() {
                self.files.insert(path);
            }
        }
    }

    pub fn files_ending_in<'a>(&'a self, ends: &'a [&str]) -> impl Iterator<Item = &'a String> {
        let ends_so = |path: &&String| ends.iter().any(|end| path.ends_with(end));
        self.files.iter().filter(ends_so)
    }

    pub fn text(&self, path: &str) -> String {
        fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
    }

    pub fn has_file(&self, path: &str) -> bool {
        self.files.contains(path)
    }

    /// A file or a folder.
    pub fn has(&self, path: &str) -> bool {
        let path = path.trim_end_matches('/');
        path.is_empty() || self.files.contains(path) || self.folders.contains(path)
    }

    /// Files whose paths end in this one, from any folder on.
    pub fn files_named<'a>(&'a self, end: &'a str) -> impl Iterator<Item = &'a String> {
        self.files.iter().filter(move |path| {
            let before = path.strip_suffix(end);
            before.is_some_and(|before| before.is_empty() || before.ends_with('/'))
        })
    }

    /// Whether a path from the root begins with one of its folders.
    pub fn begins_here(&self, path: &str) -> bool {
        let first = path.split_once('/').map(|(first, _)| first);
        first.is_some_and(|first| self.folders.contains(first))
    }
}

#[test]
fn a_file_is_found_by_the_end_of_its_path() {
    let tree = Tree::read();
    assert!(tree.has_file("host-tests/tests/citations/tree.rs"));
    assert_eq!(tree.files_named("citations/tree.rs").count(), 1);
    assert_eq!(tree.files_named("itations/tree.rs").count(), 0);
    assert!(tree.has("host-tests/tests/") && !tree.has("host-tests/nothing"));
    assert!(tree.begins_here("crates/any") && !tree.begins_here("board.rs"));
}
