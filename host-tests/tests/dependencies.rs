//! Licences of linked packages, and the programs that contain GPL code (docs/decisions/unicorn-engine.md).

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use serde_json::Value;

const BOARD: &str = "thumbv7em-none-eabihf";
const FIRMWARE: &str = "robot-firmware";
/// The emulator's CPU core: the one licence that is an exception in deny.toml.
const GPL: &str = "unicorn-engine";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Output of cargo. It fetches packages only if another build has not done so.
fn cargo(arguments: &[&str]) -> String {
    let run = |more: &[&str]| -> Output {
        let mut command = Command::new(env!("CARGO"));
        command.current_dir(root()).args(arguments).arg("--locked");
        command.args(more).output().expect("cargo starts")
    };
    let mut output = run(&["--offline"]);
    if !output.status.success() {
        output = run(&[]);
    }
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "cargo {arguments:?}: {complaint}");
    String::from_utf8(output.stdout).expect("cargo writes UTF-8")
}

/// The target that this test itself is built for.
fn host() -> String {
    let verbose = Command::new("rustc").arg("-vV").output();
    let verbose = String::from_utf8(verbose.expect("rustc starts").stdout).unwrap();
    let host = verbose.lines().find_map(|line| line.strip_prefix("host: "));
    host.expect("rustc names its host").to_owned()
}

/// A line of `cargo tree`.
#[derive(PartialEq, Eq, PartialOrd, Ord, Debug)]
struct Package {
    name: String,
    /// Source of the package, if it is not the registry.
    elsewhere: Option<String>,
    licence: String,
}

impl Package {
    /// `name v1.2.3 (where it comes from)|licence`, where the registry and procedural macros say nothing of interest.
    fn read(line: &str) -> Self {
        let (package, licence) = line.split_once('|').expect("a licence");
        let mut words = package.splitn(3, ' ');
        let name = words.next().expect("a name").to_owned();
        let notes = words.nth(1).unwrap_or_default();
        let mut places = notes.split(['(', ')']).map(str::trim);
        let elsewhere = places.find(|it| !it.is_empty() && *it != "proc-macro");
        Self {
            name,
            elsewhere: elsewhere.map(str::to_owned),
            licence: licence.trim_end_matches(" (*)").to_owned(),
        }
    }
}

/// Packages in `selection` on a target.
fn tree(selection: &[&str], edges: &str, target: &str) -> BTreeSet<Package> {
    let options = ["--prefix", "none", "--format", "{p}|{l}"];
    let place = ["--edges", edges, "--target", target];
    let arguments: Vec<&str> = [&["tree"], selection, &place, &options].concat();
    let printed = cargo(&arguments);
    let lines = printed.lines().filter(|line| !line.is_empty());
    lines.map(Package::read).collect()
}

/// Names of the packages built into `package`, without tests.
fn linked(package: &str, target: &str) -> BTreeSet<String> {
    let tree = tree(&["--package", package], "normal,build", target);
    tree.into_iter().map(|package| package.name).collect()
}

#[test]
fn firmware_and_tools_for_users_do_not_link_the_gpl() {
    let host = host();
    for (package, target) in [
        (FIRMWARE, BOARD),
        ("robotctl", host.as_str()),
        ("robot-replay", host.as_str()),
        ("robot-gym", host.as_str()),
    ] {
        let linked = linked(package, target);
        assert!(linked.contains("robot-app"), "{package}: {linked:?}");
        let reached: Vec<_> = linked.iter().filter(|it| it.starts_with(GPL)).collect();
        assert!(reached.is_empty(), "{package} links {reached:?}");
    }
    assert!(linked("robot-emulator", &host).contains(GPL));
}

/// The licences that `deny.toml` allows for all packages.
fn allowed() -> Vec<String> {
    let text = std::fs::read_to_string(root().join("deny.toml")).expect("deny.toml is there");
    let file: toml::Table = text.parse().expect("deny.toml is TOML");
    let allowed = file["licenses"]["allow"].as_array().expect("a list");
    let names = allowed.iter().map(|name| name.as_str().unwrap().to_owned());
    names.collect()
}

fn is_allowed(licence: &str, allowed: &[String]) -> bool {
    let expression = spdx::Expression::parse_mode(licence, spdx::ParseMode::LAX)
        .unwrap_or_else(|error| panic!("{licence}: {error}"));
    expression.evaluate(|wanted| allowed.iter().any(|it| *it == wanted.to_string()))
}

/// Packages of this workspace.
fn ours() -> Vec<Value> {
    let metadata = cargo(&["metadata", "--format-version=1", "--no-deps"]);
    let mut metadata: Value = serde_json::from_str(&metadata).expect("JSON");
    match metadata["packages"].take() {
        Value::Array(packages) => packages,
        other => panic!("{other}"),
    }
}

#[test]
fn every_package_has_an_allowed_licence_and_is_ours_or_from_the_registry() {
    let allowed = allowed();
    let ours = ours();
    let is_ours = |name: &str| ours.iter().any(|package| package["name"] == name);
    let everything = ["--workspace", "--exclude", FIRMWARE];
    for (selection, edges, target) in [
        (&everything[..], "normal,build,dev", host().as_str()),
        (&["--package", FIRMWARE], "normal,build", BOARD),
    ] {
        let packages = tree(selection, edges, target);
        assert!(packages.len() > 50, "{} packages", packages.len());
        for Package {
            name,
            elsewhere,
            licence,
        } in &packages
        {
            let is_exception = name.starts_with(GPL) && licence == "GPL-2.0";
            let is_good = is_exception || is_allowed(licence, &allowed);
            assert!(is_good, "{name}: {licence}");
            let known = elsewhere.is_none() || is_ours(name);
            assert!(known, "{name} comes from {elsewhere:?}");
        }
    }
}

#[test]
fn every_package_of_ours_says_what_it_is() {
    for package in ours() {
        assert!(package["description"].is_string(), "{}", package["name"]);
    }
}

#[test]
fn a_licence_that_is_not_on_the_list_is_noticed() {
    let allowed = allowed();
    assert!(is_allowed("MIT OR GPL-3.0-only", &allowed));
    assert!(is_allowed("MIT/Apache-2.0", &allowed));
    assert!(!is_allowed("MIT AND GPL-3.0-only", &allowed));
    assert!(!is_allowed("GPL-2.0-only", &allowed));
}

#[test]
fn a_line_of_the_tree_is_read() {
    let package = |line| Package::read(line);
    let plain = package("serde v1.0.1|MIT OR Apache-2.0");
    assert_eq!((plain.name.as_str(), &plain.elsewhere), ("serde", &None));
    assert_eq!(
        package("x v0.1.0 (proc-macro)|MIT (*)"),
        package("x v0.1.0|MIT")
    );
    let fetched = package("y v0.1.0 (https://example.org/y#abc)|MIT").elsewhere;
    assert_eq!(fetched.as_deref(), Some("https://example.org/y#abc"));
}
