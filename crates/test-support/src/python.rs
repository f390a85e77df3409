//! Python with the packages that a test needs, in environments of their own below `target`.

use std::{
    env,
    fs::{self, File},
    io::{self, ErrorKind, Write},
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    sync::LazyLock,
};

/// Packages for one purpose, and what is made of them.
struct Packages {
    /// Folder of the environment, below `target`.
    folder: &'static str,
    /// Packages with their versions, and all that they depend on, as `pip freeze` lists them.
    list: &'static str,
    /// Oldest version of Python that is new enough for the list.
    oldest: (u8, u8),
    /// Python runs it if the environment is whole.
    imports_all: &'static str,
}

const CLIENTS: Packages = Packages {
    folder: "python",
    list: include_str!("python_packages.txt"),
    // `can-waveshare` needs it.
    oldest: (3, 10),
    imports_all: "import can, can_waveshare, serial",
};

const SCIENCE: Packages = Packages {
    folder: "python-science",
    list: include_str!("python_science_packages.txt"),
    // NumPy and SciPy need it.
    oldest: (3, 11),
    imports_all: "import mujoco, numpy, scipy, yourdfpy",
};

const OPTIMAL: Packages = Packages {
    folder: "python-optimal",
    list: include_str!("python_optimal_packages.txt"),
    // NumPy needs it.
    oldest: (3, 11),
    imports_all: "import casadi, numpy",
};

const NETWORKS: Packages = Packages {
    folder: "python-networks",
    list: include_str!("python_network_packages.txt"),
    // NumPy needs it.
    oldest: (3, 11),
    imports_all: "import numpy, onnx, onnxruntime",
};

const SERVOS: Packages = Packages {
    folder: "python-servos",
    list: include_str!("python_servo_packages.txt"),
    // LeRobot needs it.
    oldest: (3, 10),
    // LeRobot's driver itself imports PyTorch, which a test replaces.
    imports_all: "import deepdiff, lerobot, scservo_sdk, serial, tqdm",
};

const BUILD: Packages = Packages {
    folder: "python-build",
    list: include_str!("python_build_packages.txt"),
    // NumPy needs it.
    oldest: (3, 11),
    imports_all: "import maturin, numpy",
};

const TRAINING: Packages = Packages {
    folder: "python-training",
    list: include_str!("../../../train/requirements.txt"),
    // NumPy, JAX and SciPy need it.
    oldest: (3, 11),
    imports_all: "import gymnasium, jax, matplotlib, maturin, onnx, onnxruntime, optax",
};

/// An interpreter that imports the packages of one purpose, in pinned versions.
pub struct Python {
    interpreter: PathBuf,
}

/// The reason why this computer has no such interpreter.
#[derive(Debug)]
struct Missing(String);

impl Python {
    /// Returns an interpreter that imports `can`, `can_waveshare` and `serial`. The first call on a computer makes the
    /// environment, and the others use it, also those of other processes.
    ///
    /// Returns `None` without Python 3.10, its module `venv`, or the network, and prints why: a test that then returns
    /// counts as skipped.
    pub fn with_packages() -> Option<Self> {
        static MADE: LazyLock<Result<PathBuf, Missing>> = LazyLock::new(|| make(&CLIENTS));
        found(&MADE)
    }

    /// As [`with_packages`](Self::with_packages), but imports `mujoco`, `numpy`, `scipy` and `yourdfpy`, and needs Python
    /// 3.11. MuJoCo computes, but opens no window.
    pub fn with_science() -> Option<Self> {
        static MADE: LazyLock<Result<PathBuf, Missing>> = LazyLock::new(|| make(&SCIENCE));
        found(&MADE)
    }

    /// As [`with_packages`](Self::with_packages), but imports `casadi` and `numpy`, and needs Python 3.11.
    pub fn with_optimal_control() -> Option<Self> {
        static MADE: LazyLock<Result<PathBuf, Missing>> = LazyLock::new(|| make(&OPTIMAL));
        found(&MADE)
    }

    /// As [`with_packages`](Self::with_packages), but imports `numpy`, `onnx` and `onnxruntime`, and needs Python 3.11.
    pub fn with_networks() -> Option<Self> {
        static MADE: LazyLock<Result<PathBuf, Missing>> = LazyLock::new(|| make(&NETWORKS));
        found(&MADE)
    }

    /// As [`with_packages`](Self::with_packages), but imports `scservo_sdk`, the SDK of Feetech servos, and has LeRobot without
    /// what only its training needs.
    pub fn with_servo_clients() -> Option<Self> {
        static MADE: LazyLock<Result<PathBuf, Missing>> = LazyLock::new(|| make(&SERVOS));
        found(&MADE)
    }

    /// As [`with_packages`](Self::with_packages), but imports `maturin` and `numpy`, and needs Python 3.11: it builds packages
    /// of this repository.
    pub fn with_build() -> Option<Self> {
        static MADE: LazyLock<Result<PathBuf, Missing>> = LazyLock::new(|| make(&BUILD));
        found(&MADE)
    }

    /// As [`with_packages`](Self::with_packages), but with the packages that `train/requirements.txt` lists, and needs Python
    /// 3.11.
    pub fn with_training() -> Option<Self> {
        static MADE: LazyLock<Result<PathBuf, Missing>> = LazyLock::new(|| make(&TRAINING));
        found(&MADE)
    }

    /// Returns the command that runs `script`, a file or a folder with `__main__.py`. What it prints is not held back in a buffer.
    pub fn command(&self, script: impl AsRef<Path>) -> Command {
        let mut command = Command::new(&self.interpreter);
        // -I: nothing of the user's own packages and variables takes part.
        command.args(["-I", "-u"]).arg(script.as_ref());
        command.env("MUJOCO_GL", "disable");
        command
    }

    /// As [`command`](Self::command), for a script that installs packages of this repository: pip finds maturin's program, and
    /// builds where the tests were built, where most crates are there already.
    ///
    /// # Panics
    /// There is no rustc.
    pub fn building_command(&self, script: impl AsRef<Path>) -> Command {
        let mut command = self.command(script);
        let programs = self.interpreter.parent().map(Path::to_owned);
        let path = env::var_os("PATH").unwrap_or_default();
        let path = env::join_paths(programs.into_iter().chain(env::split_paths(&path)));
        command.env("PATH", path.expect("no quotes in PATH"));
        let asked = Command::new("rustc")
            .args(["--print", "host-tuple"])
            .output()
            .expect("a rustc");
        let host = String::from_utf8(asked.stdout).expect("text");
        command.env("CARGO_BUILD_TARGET", host.trim());
        command
    }

    /// Runs `command`, writes `question` to its input, and returns what it prints.
    ///
    /// # Panics
    /// It fails. The message is what it wrote to its standard error.
    pub fn answer(mut command: Command, question: &str) -> Vec<u8> {
        command.stdin(Stdio::piped());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("it starts");
        let mut stdin = child.stdin.take().expect("a pipe");
        stdin.write_all(question.as_bytes()).expect("it reads");
        drop(stdin);
        let output = child.wait_with_output().expect("it ends");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{stderr}");
        output.stdout
    }
}

fn found(made: &Result<PathBuf, Missing>) -> Option<Python> {
    match made {
        Ok(interpreter) => Some(Python {
            interpreter: interpreter.clone(),
        }),
        Err(Missing(why)) => {
            println!("skipped: no Python with its packages: {why}");
            None
        }
    }
}

impl Packages {
    fn folder(&self) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../target")
            .join(self.folder)
    }
}

/// Makes the environment unless it is there already. Processes wait for each other.
fn make(packages: &Packages) -> Result<PathBuf, Missing> {
    let folder = packages.folder();
    let failed = |error: io::Error| Missing(format!("{}: {error}", folder.display()));
    fs::create_dir_all(&folder).map_err(failed)?;
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
    let is_made = fs::read_to_string(&list).is_ok_and(|made_of| made_of == packages.list)
        && imports_all(packages, &interpreter).is_ok();
    if !is_made {
        create(packages, &environment, &interpreter)?;
        fs::write(&list, packages.list).map_err(failed)?;
    }
    Ok(interpreter)
}

fn create(packages: &Packages, environment: &Path, interpreter: &Path) -> Result<(), Missing> {
    let python = if cfg!(windows) { "python" } else { "python3" };
    let (major, minor) = packages.oldest;
    let is_new_enough = format!(
        "import sys; sys.version_info >= ({major}, {minor}) or sys.exit('it is ' + sys.version)"
    );
    run(Command::new(python).args(["-c", &is_new_enough]))
        .map_err(|Missing(why)| Missing(format!("it needs {major}.{minor} or newer: {why}")))?;
    run(Command::new(python)
        .args(["-m", "venv", "--clear"])
        .arg(environment))?;
    let wanted = environment.join("wanted.txt");
    fs::write(&wanted, packages.list).map_err(|error| Missing(error.to_string()))?;
    run(Command::new(interpreter)
        .args(["-m", "pip", "install", "--quiet", "--no-input", "--no-deps"])
        .args(["--disable-pip-version-check", "--retries", "2", "-r"])
        .arg(wanted))?;
    imports_all(packages, interpreter)
}

fn imports_all(packages: &Packages, interpreter: &Path) -> Result<(), Missing> {
    run(Command::new(interpreter)
        .args(["-I", "-c", packages.imports_all])
        .env("MUJOCO_GL", "disable"))
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
        for (python, packages) in [
            (Python::with_packages(), &CLIENTS),
            (Python::with_science(), &SCIENCE),
            (Python::with_optimal_control(), &OPTIMAL),
            (Python::with_networks(), &NETWORKS),
            (Python::with_servo_clients(), &SERVOS),
            (Python::with_build(), &BUILD),
            (Python::with_training(), &TRAINING),
        ] {
            let Some(python) = python else { continue };
            let script = packages.folder().join("versions.py");
            fs::write(&script, VERSIONS).expect("a folder for it");
            let output = python.command(script).output().expect("it starts");
            let versions = String::from_utf8(output.stdout).expect("text");
            for package in packages.list.lines() {
                assert!(versions.lines().any(|line| line == package), "{versions}");
            }
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
