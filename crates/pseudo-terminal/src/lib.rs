//! Our end of a pseudo-terminal. A tool on the PC uses the other end as a serial device.
//!
//! Windows has none: there this crate is empty.

#![cfg(unix)]

use std::{
    ffi::OsStr,
    fs::{File, OpenOptions},
    io::{self, ErrorKind, Read, Write},
    os::{
        fd::OwnedFd,
        unix::{ffi::OsStrExt, fs::OpenOptionsExt},
    },
    path::{Path, PathBuf},
    time::Duration,
};

use rustix::{
    event::{PollFd, PollFlags, Timespec, poll},
    fs::OFlags,
    io::{Errno, ioctl_fionbio},
    pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt},
    termios::{OptionalActions, tcgetattr, tcsetattr},
};

/// Neither reading nor writing ever waits for the other end.
pub struct Terminal {
    ours: File,
    path: PathBuf,
}

impl Terminal {
    /// Creates a pseudo-terminal in raw mode: without echo, line editing or conversion of bytes.
    pub fn open() -> io::Result<Self> {
        let ours: OwnedFd = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&ours)?;
        unlockpt(&ours)?;
        ioctl_fionbio(&ours, true)?;
        let name = ptsname(&ours, Vec::new())?;
        let path = PathBuf::from(OsStr::from_bytes(name.to_bytes()));
        let theirs = OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags(OFlags::NOCTTY.bits().cast_signed())
            .open(&path)?;
        let mut settings = tcgetattr(&theirs)?;
        settings.make_raw();
        tcsetattr(&theirs, OptionalActions::Now, &settings)?;
        Ok(Self {
            ours: File::from(ours),
            path,
        })
    }

    /// Sets the baud rate that tools find, b/s.
    pub fn set_baud(&self, baud: u32) -> io::Result<()> {
        let mut settings = tcgetattr(&self.ours)?;
        settings.set_speed(baud)?;
        Ok(tcsetattr(&self.ours, OptionalActions::Now, &settings)?)
    }

    /// The baud rate that a tool has set, b/s.
    pub fn baud(&self) -> io::Result<u32> {
        Ok(tcgetattr(&self.ours)?.output_speed())
    }

    /// Path of the device that a tool opens.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether a tool has its end open.
    pub fn is_open(&self) -> io::Result<bool> {
        let mut state = [PollFd::new(&self.ours, PollFlags::empty())];
        poll(&mut state, Some(&Timespec::default()))?;
        Ok(!state[0].revents().contains(PollFlags::HUP))
    }

    /// Waits until bytes have arrived, at most so long.
    pub fn wait(&self, at_most: Duration) -> io::Result<()> {
        let at_most = Timespec::try_from(at_most).map_err(io::Error::other)?;
        match poll(
            &mut [PollFd::new(&self.ours, PollFlags::IN)],
            Some(&at_most),
        ) {
            Err(Errno::INTR) | Ok(_) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    /// Appends the bytes that have arrived, at most `most`.
    pub fn read(&mut self, into: &mut Vec<u8>, most: u64) -> io::Result<()> {
        match (&self.ours).take(most).read_to_end(into) {
            Err(e) if e.kind() != ErrorKind::WouldBlock && !nobody_there(&e) => Err(e),
            _ => Ok(()),
        }
    }

    /// Writes as many bytes as the line accepts now. Returns their number.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.ours.write(bytes) {
            Err(e) if e.kind() == ErrorKind::WouldBlock => Ok(0),
            written => written,
        }
    }
}

/// What a read returns while no tool has its end open.
fn nobody_there(error: &io::Error) -> bool {
    error.raw_os_error() == Some(Errno::IO.raw_os_error())
}
