//! The robot that an image is for, and that the world therefore simulates. A controller in another robot's body shows nothing.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use robot_description::{Robot, RobotError};
use robot_emulator::core::image::{Image, ImageError};

use crate::scenario::{RobotChoice, Scenario};

/// The static of `src/robot_identity.rs`: fingerprint, then name.
const SYMBOL: &str = "g_robotapp_robot";
const FINGERPRINT_BYTES: usize = 8;
const NAME_BYTES: usize = 24;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// Where the robots with a name are.
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots");

/// Why image and world are not of one robot.
#[derive(Debug, thiserror::Error)]
pub enum ImageRobotError {
    #[error("cannot read the image {path}: {source}", path = .path.display())]
    Read {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("cannot load the image: {0}")]
    Image(#[from] ImageError),
    #[error(
        "the image does not say which robot it is for: it is older than this program; build it again"
    )]
    Unknown,
    #[error(transparent)]
    Robot(#[from] RobotError),
    #[error(
        "the scenario puts joints of another make on the robot (`joints = …`): leave that out, or --robot"
    )]
    OtherJoints,
    #[error(
        "the image is for the robot `{0}`, and no file in robots/ has its name and figures: name its file with --robot FILE, \
         and build the image again if the file has changed since (`cargo xtask sim --robot FILE` does both)"
    )]
    NoFile(String),
    #[error(
        "the simulated robot `{0}` has other figures than when the image was built: build it again, as \
         `cargo xtask sim --robot NAME|FILE` does"
    )]
    Changed(String),
    #[error(
        "the image is for the robot `{image}`, and the simulated robot is `{world}`: `cargo xtask sim --robot NAME|FILE`, \
         with the name or file of `{world}`, builds an image for it; without `robot = …` a scenario has the image's robot"
    )]
    Other { image: String, world: String },
}

/// What the image says.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Identity {
    name: String,
    fingerprint: u64,
}

/// Returns the robot that the image is for. `wanted` is a name in `robots/` or a file; without it, the file is looked for in
/// `robots/`.
///
/// # Errors
/// The file is that of another robot, cannot be read, or is not found.
pub fn of_image(elf: &Path, wanted: Option<&str>) -> Result<Arc<Robot>, ImageRobotError> {
    for_image(&read_identity(elf)?, wanted)
}

/// Puts the image's robot into the scenario, unless the scenario names one. `wanted` comes before both.
///
/// # Errors
/// The simulated robot would not be the one that the image is for, or its file cannot be read.
pub fn agree(
    scenario: &mut Scenario,
    elf: &Path,
    wanted: Option<&str>,
) -> Result<(), ImageRobotError> {
    scenario.robot = chosen(scenario, &read_identity(elf)?, wanted)?;
    Ok(())
}

fn chosen(
    scenario: &Scenario,
    image: &Identity,
    wanted: Option<&str>,
) -> Result<Arc<Robot>, ImageRobotError> {
    let own = Arc::clone(&scenario.robot);
    match (scenario.robot_choice, wanted) {
        (RobotChoice::OtherJoints, Some(_)) => Err(ImageRobotError::OtherJoints),
        (RobotChoice::OtherJoints, None) => Ok(own),
        (RobotChoice::Named, None) => checked(own, image),
        (RobotChoice::Named, Some(_)) | (RobotChoice::OfTheImage, _) => for_image(image, wanted),
    }
}

fn for_image(image: &Identity, wanted: Option<&str>) -> Result<Arc<Robot>, ImageRobotError> {
    match wanted {
        Some(wanted) => checked(Arc::new(read(wanted)?), image),
        None => found(image.fingerprint)
            .map(Arc::new)
            .ok_or_else(|| ImageRobotError::NoFile(image.name.clone())),
    }
}

fn checked(robot: Arc<Robot>, image: &Identity) -> Result<Arc<Robot>, ImageRobotError> {
    let (world, image_name) = (robot.name.clone(), image.name.clone());
    if robot.fingerprint() == image.fingerprint {
        Ok(robot)
    } else if world == image_name {
        Err(ImageRobotError::Changed(world))
    } else {
        let image = image_name;
        Err(ImageRobotError::Other { image, world })
    }
}

/// The robot of a name in `robots/`, or of a path.
fn read(wanted: &str) -> Result<Robot, RobotError> {
    Robot::read(&robot_description::path_from(Path::new(ROOT), wanted))
}

/// The robot in `robots/` that has this fingerprint, whatever its file is called.
fn found(fingerprint: u64) -> Option<Robot> {
    let entries = fs::read_dir(FOLDER).ok()?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .filter_map(|path| Robot::read(&path).ok())
        .find(|robot| robot.fingerprint() == fingerprint)
}

fn read_identity(elf: &Path) -> Result<Identity, ImageRobotError> {
    let bytes = fs::read(elf).map_err(|source| ImageRobotError::Read {
        path: elf.to_owned(),
        source,
    })?;
    identity(&Image::parse(&bytes)?).ok_or(ImageRobotError::Unknown)
}

fn identity(image: &Image) -> Option<Identity> {
    let address = image.symbol(SYMBOL)?;
    let segment = image.segments.iter().find(|segment| {
        let length = u32::try_from(segment.data.len()).unwrap_or(u32::MAX);
        (segment.address..segment.address.saturating_add(length)).contains(&address)
    })?;
    let from = usize::try_from(address - segment.address).ok()?;
    let bytes = segment.data.get(from..)?;
    let (fingerprint, rest) = bytes.split_first_chunk::<FINGERPRINT_BYTES>()?;
    let name = rest.get(..NAME_BYTES)?;
    let end = name.iter().position(|byte| *byte == 0);
    let name = name.get(..end.unwrap_or(NAME_BYTES))?;
    Some(Identity {
        name: String::from_utf8_lossy(name).into_owned(),
        fingerprint: u64::from_le_bytes(*fingerprint),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scenario(keys: &str) -> Scenario {
        let text = format!("name = \"n\"\nseconds = 1\nplant = \"stand\"\n{keys}");
        Scenario::parse(&text, "s.toml").expect("it parses")
    }

    fn image_for(robot: &str) -> Identity {
        let robot = read(robot).expect("it is there");
        Identity {
            fingerprint: robot.fingerprint(),
            name: robot.name,
        }
    }

    fn simulated(keys: &str, image: &Identity, wanted: Option<&str>) -> Result<String, String> {
        let robot = chosen(&scenario(keys), image, wanted);
        robot
            .map(|robot| robot.name.clone())
            .map_err(|error| error.to_string())
    }

    #[test]
    fn a_scenario_without_a_robot_has_that_of_the_image() {
        for name in ["fivebar", "fivebar-rs00"] {
            let ran = simulated("", &image_for(name), None);
            assert_eq!(ran.as_deref(), Ok(name));
        }
    }

    #[test]
    fn a_robot_that_is_wanted_or_named_must_be_that_of_the_image() {
        let (fivebar, rs00) = (image_for("fivebar"), image_for("fivebar-rs00"));
        let named = "robot = \"fivebar-rs00\"";
        for (keys, wanted) in [("", Some("fivebar-rs00")), (named, None)] {
            assert_eq!(
                simulated(keys, &rs00, wanted).as_deref(),
                Ok("fivebar-rs00")
            );
            let error = simulated(keys, &fivebar, wanted).expect_err("it is another robot");
            assert!(error.contains("for the robot `fivebar`"), "{error}");
            assert!(error.contains("--robot NAME|FILE"), "{error}");
        }
        let file = format!("{FOLDER}/fivebar.toml");
        let ran = simulated(named, &fivebar, Some(&file));
        assert_eq!(ran.as_deref(), Ok("fivebar"), "what is wanted comes first");
    }

    #[test]
    fn a_file_that_has_changed_since_is_refused() {
        let mut older = image_for("fivebar");
        older.fingerprint ^= 1;
        let error = simulated("", &older, Some("fivebar")).expect_err("it has changed");
        assert!(error.contains("build it again"), "{error}");
        let error = simulated("", &older, None).expect_err("it has changed");
        assert!(error.contains("--robot FILE"), "{error}");
    }

    #[test]
    fn only_joints_of_another_make_may_differ_from_the_image() {
        let joints = "joints = \"rs00\"";
        let fivebar = image_for("fivebar");
        let ran = simulated(joints, &fivebar, None);
        assert_eq!(ran.as_deref(), Ok("fivebar-rs00"));
        let error = simulated(joints, &fivebar, Some("fivebar")).expect_err("it cannot be both");
        assert!(error.contains("leave that out"), "{error}");
    }
}
