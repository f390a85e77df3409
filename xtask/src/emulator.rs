//! Builds and starts the emulator's programs, `sim` and `soak`.

use std::{
    ffi::OsString,
    path::PathBuf,
    process::{Command, ExitCode},
};

use crate::{
    firmware::{self, Parts},
    job::{self, Job},
    prerequisites::{self, EMULATOR},
    tool, workspace,
};

/// Cargo profile of everything that runs on this machine: quick to build, quick enough to run.
pub const HOST_PROFILE: &str = "host";

/// Builds what is out of date and runs `program` on the image, unless the arguments name one or ask for something that
/// needs none; its exit code becomes ours.
pub fn run(program: &'static str, passed_on: &[OsString]) -> anyhow::Result<ExitCode> {
    let (build_emulator, path) = build("robot-emulator", program)?;
    let mut jobs = vec![build_emulator];
    let mut command = Command::new(path);
    command.args(passed_on);
    if needs_an_image(passed_on) {
        let (build_image, elf) = firmware::build(&Parts::chosen()?)?;
        jobs.push(build_image);
        command.arg("--elf").arg::<PathBuf>(elf);
    }
    job::run_all(jobs)?;
    tool::exit_code_of(command)
}

fn needs_an_image(passed_on: &[OsString]) -> bool {
    const WITHOUT: [&str; 4] = ["--elf", "--help", "-h", "--list-faults"];
    !passed_on.iter().any(|argument| {
        let argument = argument.to_string_lossy();
        WITHOUT.contains(&&*argument) || argument.starts_with("--elf=")
    })
}

/// The build of a program with the emulator in it, ready to start; installs what it needs.
pub fn build(package: &str, program: &str) -> anyhow::Result<(Job, PathBuf)> {
    prerequisites::ensure(&EMULATOR)?;
    let host = tool::host_triple()?;
    let mut command = tool::cargo();
    command.args(["build", "--package", package, "--bin", program]);
    command.args(["--profile", HOST_PROFILE, "--target", &host]);
    let path = workspace::host_target_dir()
        .join(&host)
        .join(HOST_PROFILE)
        .join(program);
    let job = Job {
        name: package.to_owned(),
        command,
    };
    Ok((job, path))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn needs(words: &[&str]) -> bool {
        let words: Vec<OsString> = words.iter().map(OsString::from).collect();
        needs_an_image(&words)
    }

    #[test]
    fn an_image_is_built_unless_one_is_named_or_none_is_run() {
        assert!(needs(&["--seed", "1"]));
        assert!(!needs(&["--elf", "a.elf"]));
        assert!(!needs(&["--elf=a.elf"]));
        assert!(!needs(&["--list-faults"]));
    }
}
