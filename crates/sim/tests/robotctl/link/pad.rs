//! A joystick whose events come from a pipe.

use std::{
    fs::File,
    io::Write,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::ensure;

pub struct Pad {
    path: PathBuf,
    pipe: File,
}

impl Pad {
    pub fn plug_in(name: &str) -> anyhow::Result<Self> {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = std::fs::remove_file(&path);
        ensure!(Command::new("mkfifo").arg(&path).status()?.success());
        // Opened for both, a pipe waits for nobody.
        let pipe = File::options().read(true).write(true).open(&path)?;
        Ok(Self { path, pipe })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Left stick up, which is axis 1 to its negative end.
    pub fn forward(&mut self) -> anyhow::Result<()> {
        self.event(-32_767, 2, 1)
    }

    /// The left shoulder button.
    pub fn dead_man(&mut self, is_held: bool) -> anyhow::Result<()> {
        self.event(i16::from(is_held), 1, 4)
    }

    fn event(&mut self, value: i16, kind: u8, number: u8) -> anyhow::Result<()> {
        let [low, high] = value.to_ne_bytes();
        Ok(self
            .pipe
            .write_all(&[0, 0, 0, 0, low, high, kind, number])?)
    }
}
