//! `armctl sim`: an arm of emulated servos behind a serial port of its own, to try everything without hardware.

#[cfg(unix)]
mod line;
#[cfg(unix)]
mod plugs;
#[cfg(unix)]
mod screen;
#[cfg(unix)]
mod start;
#[cfg(unix)]
mod view;

#[cfg(unix)]
pub use start::Sim;

/// Takes any options, and says why it does not start.
#[cfg(not(unix))]
#[derive(clap::Args)]
pub struct Sim {
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    _options: Vec<std::ffi::OsString>,
}

#[cfg(not(unix))]
impl Sim {
    pub fn run(self) -> anyhow::Result<()> {
        anyhow::bail!(
            "emulated servos need a pseudo-terminal, which Windows does not have: run armctl sim, and what talks to it, in WSL"
        )
    }
}
