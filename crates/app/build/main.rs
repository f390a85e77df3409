//! Turns the files of robots (`robots/*.toml`) into constants.

mod gains;
mod layout;
mod literal;
mod profile;

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use robot_description::{Examined, Robot};

/// The robot of an image that no `ROBOT` names another one for.
const DEFAULT: &str = "fivebar";

/// Constants of a profile and of a layout.
struct Constants {
    profile: &'static str,
    layout: &'static str,
}

const FIVEBAR: Constants = Constants {
    profile: "FIVEBAR",
    layout: "ROBOT_LAYOUT",
};
const FIVEBAR_RS00: Constants = Constants {
    profile: "FIVEBAR_RS00",
    layout: "RS00_LAYOUT",
};
const CHOSEN: Constants = Constants {
    profile: "CHOSEN",
    layout: "CHOSEN_LAYOUT",
};

fn main() -> ExitCode {
    match generate() {
        Ok(()) => ExitCode::SUCCESS,
        Err(complaint) => {
            for line in complaint.lines() {
                println!("cargo::error={line}");
            }
            ExitCode::FAILURE
        }
    }
}

fn generate() -> Result<(), String> {
    println!("cargo::rerun-if-env-changed=ROBOT");
    let chosen = env::var("ROBOT").unwrap_or_else(|_| DEFAULT.to_owned());
    let (mut profiles, mut layouts) = (String::new(), String::new());
    for (constants, name) in [
        (FIVEBAR, "fivebar"),
        (FIVEBAR_RS00, "fivebar-rs00"),
        (CHOSEN, chosen.as_str()),
    ] {
        let robot = read(name)?;
        profiles += &profile::constant(&constants, &robot)?;
        layouts += &layout::constant(&constants, &robot);
    }
    write("profiles.rs", &profiles)?;
    write("layouts.rs", &layouts)
}

/// Reads the robot of a name in `robots/` or of a path from the repository's root.
fn read(name: &str) -> Result<Robot, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let path = root.join(robot_description::path_of(name));
    println!("cargo::rerun-if-changed={}", path.display());
    let shown = path.strip_prefix(&root).unwrap_or(&path).display();
    let text = fs::read_to_string(&path)
        .map_err(|error| format!("{shown}: cannot be read: {error}. ROBOT={name} names it"))?;
    let examined = Examined::parse(&text, &shown.to_string()).map_err(|error| error.to_string())?;
    for warning in &examined.warnings {
        println!("cargo::warning={warning}");
    }
    Ok(examined.robot)
}

fn write(file: &str, text: &str) -> Result<(), String> {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join(file), text).map_err(|error| format!("{file}: {error}"))
}
