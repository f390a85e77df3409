//! Finds and installs the programs and libraries that a build needs on this machine.

mod libclang;

use std::process::Command;

use anyhow::bail;

use crate::tool;

/// Something a build needs from the system.
pub struct Prerequisite {
    pub what: &'static str,
    pub why: &'static str,
    /// Debian packages that contain it.
    pub packages: &'static [&'static str],
    pub present: fn() -> bool,
}

/// What the build of the emulator needs. Its CPU core (unicorn-engine) is written in C.
pub const EMULATOR: [Prerequisite; 4] = [
    Prerequisite {
        what: "a C and C++ compiler and make",
        why: "the emulator's CPU core is C",
        packages: &["build-essential"],
        present: || ["cc", "c++", "make"].into_iter().all(runs),
    },
    Prerequisite {
        what: "cmake",
        why: "it builds the emulator's CPU core",
        packages: &["cmake"],
        present: || runs("cmake"),
    },
    Prerequisite {
        what: "pkg-config",
        why: "the configure script of the emulator's CPU core asks for it",
        packages: &["pkg-config"],
        present: || runs("pkg-config"),
    },
    Prerequisite {
        what: "libclang with its headers",
        why: "it reads the C headers of the emulator's CPU core",
        packages: &["libclang-dev"],
        present: libclang::is_usable,
    },
];

/// Installs what is missing, or says what to install and why.
pub fn ensure(wanted: &[Prerequisite]) -> anyhow::Result<()> {
    let missing: Vec<_> = wanted.iter().filter(|item| !(item.present)()).collect();
    if missing.is_empty() {
        return Ok(());
    }
    for item in &missing {
        eprintln!("missing: {} ({})", item.what, item.why);
    }
    let packages: Vec<_> = missing.iter().flat_map(|item| item.packages).collect();
    install(&packages)?;
    match missing.iter().find(|item| !(item.present)()) {
        None => Ok(()),
        Some(item) => bail!(
            "{} is still missing after installing {}",
            item.what,
            item.packages.join(" ")
        ),
    }
}

fn install(packages: &[&&str]) -> anyhow::Result<()> {
    let list = packages
        .iter()
        .map(|name| **name)
        .collect::<Vec<_>>()
        .join(" ");
    if !runs("apt-get") {
        bail!(
            "install these with your package manager (Debian calls the packages: {list}), \
             then run the command again"
        );
    }
    let by_hand = format!("sudo apt-get update && sudo apt-get install -y {list}");
    let Some(root) = Root::find() else {
        bail!("installing needs root. Run:\n  {by_hand}\nthen run the command again");
    };
    eprintln!("installing with apt-get: {list}");
    let update = vec!["update"];
    let mut install = vec!["install", "-y", "--no-install-recommends"];
    install.extend(packages.iter().map(|name| **name));
    for arguments in [update, install] {
        let mut command = tool::command("env");
        command.arg("DEBIAN_FRONTEND=noninteractive");
        command.args(["apt-get", "-qq"]).args(arguments);
        let command = root.run(command);
        if let Err(error) = tool::printed_by(command) {
            bail!("{error:#}\nTry it by hand:\n  {by_hand}");
        }
    }
    Ok(())
}

/// A way to run a command as root.
enum Root {
    Already,
    Sudo,
}

impl Root {
    /// Returns `None` if it would ask for a password.
    fn find() -> Option<Self> {
        let mut id = tool::command("id");
        id.arg("-u");
        if tool::printed_by(id).is_ok_and(|uid| uid == "0") {
            return Some(Self::Already);
        }
        let mut sudo = tool::command("sudo");
        sudo.args(["-n", "true"]);
        tool::succeeds(sudo).then_some(Self::Sudo)
    }

    fn run(&self, command: Command) -> Command {
        match self {
            Self::Already => command,
            Self::Sudo => {
                let mut sudo = tool::command("sudo");
                sudo.arg("-n").arg(command.get_program());
                sudo.args(command.get_args());
                sudo
            }
        }
    }
}

/// True if `program --version` works.
pub fn runs(program: &str) -> bool {
    let mut command = tool::command(program);
    command.arg("--version");
    tool::succeeds(command)
}
