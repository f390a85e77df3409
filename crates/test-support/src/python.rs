//! Python with the packages that foreign clients need, in an environment of its own below `target`.

use std::{
    fs::{self, File},
    io::{self, ErrorKind},
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    sync::LazyLock,
};

/// Packages with their versions, and all that they depend on, as `pip freeze` lists them.
const PACKAGES: &str = include_str!("python_packages.txt");
/// `can-waveshare` needs it.
const IS_NEW_ENOUGH: &str =
    "import sys; sys.version_info >= (3, 10) or sys.exit('it is ' + sys.version)";
const IMPORTS_ALL: &str = "import can, can_waveshare, serial";

/// An interpreter that imports `can`, `can_waveshare` and `serial`, in pinned versions.
pub struct Python {
    interpreter: PathBuf,
}

/// The reason why this computer has no such interpreter.
#[derive(Debug)]
struct Missing(String);

impl Python {
    /// Returns the interpreter. The first call on a computer makes the environment, and the others use it, also those of
    /// other processes.
    ///
    /// Returns `None` without Python 3.10, its module `venv`, or the network, and prints why: a test that then returns
    /// counts as skipped.
    pub fn with_packages() -> Option<Self> {
        static MADE: LazyLock<Result<PathBuf, Missing>> = LazyLock::new(|| make(&folder()));
        match &*MADE {
            Ok(interpreter) => Some(Self {
                interpreter: interpreter.clone(),
            }),
            Err(Missing(why)) => {
                println!("skipped: no Python with its packages: {why}");
                None
            }
        }
    }

    /// Returns the command that runs `script`. What it prints is not held back in a buffer.
    pub fn command(&self, script: impl AsRef<Path>) -> Command {
        let mut command = Command::new(&self.interpreter);
        // -I: nothing of the user's own packages and variables takes part.
        command.args(["-I", "-u"]).arg(script.as_ref());
        command
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/python")
}

/// Makes the environment in `folder` unless it is there already. Processes wait for each other.
fn make(folder: &Path) -> Result<PathBuf, Missing> {
    let failed = |error: io::Error| Missing(format!("{}: {error}", folder.display()));
    fs::create_dir_all(folder).map_err(failed)?;
    let lock = File::create(folder.join("lock")).map_err(failed)?;
    lock.lock().map_err(failed)?;
    let environment = folder.join("environment");
    let interpreter = environment.join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    });
    // Written last, so that an environment left half made is made anew.
    let list = environment.join("packages.txt");
    let is_made = fs::read_to_string(&list).is_ok_and(|made_of| made_of == PACKAGES)
        && run(Command::new(&interpreter).args(["-I", "-c", IMPORTS_ALL])).is_ok();
    if !is_made {
        create(&environment, &interpreter)?;
        fs::write(&list, PACKAGES).map_err(failed)?;
    }
    Ok(interpreter)
}

fn create(environment: &Path, interpreter: &Path) -> Result<(), Missing> {
    let python = if cfg!(windows) { "python" } else { "python3" };
    run(Command::new(python).args(["-c", IS_NEW_ENOUGH]))
        .map_err(|Missing(why)| Missing(format!("it needs 3.10 or newer: {why}")))?;
    run(Command::new(python)
        .args(["-m", "venv", "--clear"])
        .arg(environment))?;
    let wanted = environment.join("wanted.txt");
    fs::write(&wanted, PACKAGES).map_err(|error| Missing(error.to_string()))?;
    run(Command::new(interpreter)
        .args(["-m", "pip", "install", "--quiet", "--no-input", "--no-deps"])
        .args(["--disable-pip-version-check", "--retries", "2", "-r"])
        .arg(wanted))?;
    run(Command::new(interpreter).args(["-I", "-c", IMPORTS_ALL]))
}

/// Runs a command to its end. The reason of a failure is the last line that it printed.
fn run(command: &mut Command) -> Result<(), Missing> {
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str());
    let name = name.to_string_lossy().into_owned();
    let Output {
        status,
        stdout,
        stderr,
    } = match command.stdin(Stdio::null()).output() {
        Ok(output) => output,
        Err(e) if e.kind() == ErrorKind::NotFound => {
            return Err(Missing(format!("there is no {name} here")));
        }
        Err(e) => return Err(Missing(format!("{name}: {e}"))),
    };
    if status.success() {
        return Ok(());
    }
    let said = [stdout, stderr].concat();
    let said = String::from_utf8_lossy(&said);
    let last = said.lines().rev().find(|line| !line.trim().is_empty());
    Err(Missing(format!("{name}: {}", last.unwrap_or("it failed"))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_packages_are_those_of_the_list() {
        let Some(python) = Python::with_packages() else {
            return;
        };
        let script = folder().join("versions.py");
        fs::write(&script, VERSIONS).expect("a folder for it");
        let output = python.command(script).output().expect("it starts");
        let versions = String::from_utf8(output.stdout).expect("text");
        for package in PACKAGES.lines() {
            assert!(versions.lines().any(|line| line == package), "{versions}");
        }
    }

    const VERSIONS: &str = "\
import importlib.metadata
for package in importlib.metadata.distributions():
    print(package.metadata['Name'] + '==' + package.version)
";

    #[test]
    fn a_program_that_is_not_there_or_fails_is_named() {
        let Err(Missing(why)) = run(&mut Command::new("no-such-python")) else {
            panic!("it cannot run");
        };
        assert_eq!(why, "there is no no-such-python here");
        let mut failing = Command::new("rustc");
        let Err(Missing(why)) = run(failing.arg("no-such-file.rs")) else {
            panic!("it cannot succeed");
        };
        assert!(why.starts_with("rustc: error"), "{why}");
    }
}
