//! `cargo xtask bench`: measures what the release image and its estimator cost.

use std::process::{Command, ExitCode};

use crate::{
    emulator,
    firmware::{self, Parts},
    forwarded_args::ForwardedArgs,
    host_program, job, tool,
};

/// Builds what is out of date and runs the bench on it. Its exit code becomes ours.
pub fn run(args: &ForwardedArgs) -> anyhow::Result<ExitCode> {
    emulator::ensure_buildable()?;
    let (build, path) = host_program::build("robot-bench", "bench")?;
    let mut jobs = vec![build];
    let mut command = Command::new(path);
    command.args(&args.words);
    if !args.has(&["--help", "-h"]) {
        let (build, programs) = firmware::build_filters()?;
        jobs.push(build);
        command.arg("--programs").arg(programs);
        if !args.has(&["--quick", "--elf"]) {
            let (build, elf) = firmware::build(&Parts::chosen()?)?;
            jobs.push(build);
            command.arg("--elf").arg(elf);
        }
    }
    job::run_all(jobs)?;
    tool::exit_code_of(command)
}
