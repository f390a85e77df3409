//! Licences of what is linked, and which programs the GPL reaches (docs/decisions/unicorn-engine.md).

use std::{collections::BTreeSet, path::Path, process::Command};

use serde_json::Value;

const BOARD: &str = "thumbv7em-none-eabihf";
/// The emulator's CPU core: the one licence that is an exception in deny.toml.
const GPL: &str = "unicorn-engine";

fn cargo(arguments: &[&str]) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let output = Command::new(env!("CARGO"))
        .current_dir(root)
        .args(arguments)
        .args(["--locked", "--offline"])
        .output()
        .expect("cargo starts");
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

/// Packages that are built into `package`, tests aside.
fn linked(package: &str, target: &str) -> BTreeSet<String> {
    let tree = cargo(&[
        "tree",
        "--package",
        package,
        "--target",
        target,
        "--edges",
        "normal,build",
        "--prefix",
        "none",
        "--format",
        "{p}",
    ]);
    let names = tree.lines().filter_map(|line| line.split(' ').next());
    names.map(str::to_owned).collect()
}

#[test]
fn firmware_and_tools_for_users_do_not_link_the_gpl() {
    let host = host();
    for (package, target) in [
        ("robot-firmware", BOARD),
        ("robotctl", host.as_str()),
        ("robot-replay", host.as_str()),
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
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../deny.toml");
    let text = std::fs::read_to_string(file).expect("deny.toml is there");
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

#[test]
fn every_package_has_an_allowed_licence_and_is_ours_or_from_the_registry() {
    let allowed = allowed();
    for target in [host().as_str(), BOARD] {
        let metadata = cargo(&[
            "metadata",
            "--format-version=1",
            "--filter-platform",
            target,
        ]);
        let metadata: Value = serde_json::from_str(&metadata).expect("JSON");
        let packages = metadata["packages"].as_array().expect("packages");
        assert!(packages.len() > 50, "{} packages", packages.len());
        for package in packages {
            let name = package["name"].as_str().unwrap();
            let licence = package["license"].as_str().unwrap_or("none");
            let is_exception = name.starts_with(GPL) && licence == "GPL-2.0";
            assert!(
                is_exception || is_allowed(licence, &allowed),
                "{name}: {licence}"
            );
            match package["source"].as_str() {
                Some(source) => assert!(source.starts_with("registry+"), "{name} from {source}"),
                None => assert!(package["description"].is_string(), "{name}: no description"),
            }
        }
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
