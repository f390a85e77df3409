//! Packages, tests and developer commands that the commands of a document name.

use crate::tree::Tree;

/// The file in which `cargo xtask` lists its commands.
const XTASK: &str = "xtask/src/main.rs";

/// Names in a command, such as the one after `--test`, that do not exist in the tree.
pub fn missing(tree: &Tree, command: &str) -> Vec<String> {
    let words: Vec<&str> = command.split_whitespace().collect();
    if !words.contains(&"cargo") {
        return Vec::new();
    }
    let pairs = words.windows(2).filter_map(|pair| match pair {
        [word, name] => Some((*word, *name)),
        _ => None,
    });
    let named = |word: &&str| ["-p", "--package"].contains(word);
    let packages = pairs.clone().filter(|(word, _)| named(word));
    let folders: Vec<String> = packages
        .filter_map(|(_, name)| folder_of(tree, name))
        .collect();
    let is_missing = |(word, name): &(&str, &str)| match *word {
        "-p" | "--package" => folder_of(tree, name).is_none(),
        "--test" => !has_test(tree, &folders, name),
        "xtask" => name.starts_with(char::is_alphabetic) && !has_command(tree, name),
        _ => false,
    };
    let pairs = pairs.filter(is_missing);
    pairs.map(|(word, name)| format!("{word} {name}")).collect()
}

fn folder_of(tree: &Tree, package: &str) -> Option<String> {
    let line = format!("name = \"{package}\"");
    let mut manifests = tree.files_named("Cargo.toml");
    let manifest = manifests.find(|path| tree.text(path).lines().any(|it| it == line))?;
    manifest.strip_suffix("Cargo.toml").map(str::to_owned)
}

/// Whether one of the packages in `folders` has the test, or any package if `folders` is empty.
fn has_test(tree: &Tree, folders: &[String], name: &str) -> bool {
    [format!("tests/{name}.rs"), format!("tests/{name}/main.rs")]
        .iter()
        .flat_map(|end| tree.files_named(end).map(move |path| (path, end)))
        .any(|(path, end)| {
            let folder = path.strip_suffix(end.as_str()).unwrap_or_default();
            folders.is_empty() || folders.iter().any(|it| it == folder)
        })
}

/// The command `sim` is the variant `Sim`.
fn has_command(tree: &Tree, name: &str) -> bool {
    let mut letters = name.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    let variant: String = first.into_iter().chain(letters).collect();
    let text = tree.text(XTASK);
    let mut lines = text.lines().map(str::trim);
    lines.any(|line| {
        line.strip_prefix(&variant)
            .is_some_and(|rest| rest.starts_with([',', '(']))
    })
}

#[test]
fn a_command_of_nothing_there_is_noticed() {
    let tree = Tree::read();
    let in_command = |command: &str| missing(&tree, command).len();
    let good = "cargo test -p robot-host-tests --target host-tuple --test citations -- name";
    assert_eq!(in_command(good), 0);
    assert_eq!(in_command("cargo xtask sim --list-faults"), 0);
    assert_eq!(in_command("cargo xtask fly"), 1);
    assert_eq!(in_command("cargo test -p robot-no --test nothing"), 2);
    assert_eq!(
        in_command("cargo test -p robot-snapshot --test citations"),
        1
    );
    assert_eq!(in_command("mkdir -p folder"), 0);
}
