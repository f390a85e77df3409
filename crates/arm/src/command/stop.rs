//! Ctrl-C and termination, which end a command cleanly.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use anyhow::{Context, Result};

/// True once the user or the system wants the command to end.
#[derive(Clone)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// From now on, Ctrl-C only sets this flag.
    pub fn catch() -> Result<Self> {
        let flag = Arc::new(AtomicBool::new(false));
        let caught = flag.clone();
        ctrlc::set_handler(move || caught.store(true, Ordering::Relaxed))
            .context("cannot catch Ctrl-C")?;
        Ok(Self(flag))
    }

    pub fn is_caught(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    pub fn flag(&self) -> Arc<AtomicBool> {
        self.0.clone()
    }
}
