//! Where the files of robots are.

use std::path::{Path, PathBuf};

/// Returns the path of a robot's file, for a program that is run in the repository's root. `name` is the name of a file in
/// `robots/` without its ending, or a path.
pub fn path_of(name: &str) -> PathBuf {
    path_from(Path::new(""), name)
}

/// Returns the same for a program that is run anywhere: a name is one of the repository with this `root`.
pub fn path_from(root: &Path, name: &str) -> PathBuf {
    let path = Path::new(name);
    if path.components().count() == 1 && path.extension().is_none() {
        root.join("robots").join(format!("{name}.toml"))
    } else {
        path.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_a_file_in_robots_and_a_path_is_itself() {
        for (name, path) in [
            ("fivebar", "robots/fivebar.toml"),
            ("fivebar-rs00", "robots/fivebar-rs00.toml"),
            ("mine.toml", "mine.toml"),
            ("teams/ours.toml", "teams/ours.toml"),
        ] {
            assert_eq!(path_of(name), Path::new(path));
        }
        let root = Path::new("/firmware");
        assert_eq!(path_from(root, "fivebar"), root.join("robots/fivebar.toml"));
        assert_eq!(path_from(root, "../mine.toml"), Path::new("../mine.toml"));
    }
}
