//! Our end of a pseudo-terminal.

use std::{
    ffi::OsStr,
    fs::{File, OpenOptions},
    io::{self, ErrorKind, Read, Write},
    os::unix::{ffi::OsStrExt, fs::OpenOptionsExt},
    path::{Path, PathBuf},
    time::Duration,
};

use rustix::{
    event::{PollFd, PollFlags, Timespec, poll},
    fs::OFlags,
    io::{Errno, ioctl_fionbio},
    pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt},
    termios::{OptionalActions, Termios, tcgetattr, tcsetattr},
};

/// Baud rate until a program sets another.
const DEFAULT_BAUD: u32 = 1_000_000;

/// Neither reading nor writing ever waits.
pub struct Terminal {
    ours: File,
    path: PathBuf,
}

impl Terminal {
    /// Creates one in raw mode at 1 Mb/s.
    pub fn open() -> io::Result<Self> {
        let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
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
        let mut settings: Termios = tcgetattr(&theirs)?;
        settings.make_raw();
        settings.set_speed(DEFAULT_BAUD)?;
        tcsetattr(&theirs, OptionalActions::Now, &settings)?;
        let ours = File::from(ours);
        Ok(Self { ours, path })
    }

    /// Path of the device that a program opens.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The baud rate that the program has set, b/s.
    pub fn baud(&self) -> io::Result<u32> {
        Ok(tcgetattr(&self.ours)?.output_speed())
    }

    /// Whether a program has its end open.
    pub fn is_open(&self) -> io::Result<bool> {
        let mut state = [PollFd::new(&self.ours, PollFlags::empty())];
        poll(&mut state, Some(&Timespec::default()))?;
        Ok(!state[0].revents().contains(PollFlags::HUP))
    }

    /// Waits until the program has written, at most so long.
    pub fn wait(&self, at_most: Duration) {
        let mut state = [PollFd::new(&self.ours, PollFlags::IN)];
        // What went wrong here goes wrong again when it reads, and is said there.
        let _ = Timespec::try_from(at_most).map(|at_most| poll(&mut state, Some(&at_most)));
    }

    /// Appends what has arrived, at most `most` bytes.
    pub fn read(&mut self, into: &mut Vec<u8>, most: u64) -> io::Result<()> {
        match (&self.ours).take(most).read_to_end(into) {
            // So says a read while no program has its end open.
            Err(error) if error.raw_os_error() == Some(Errno::IO.raw_os_error()) => Ok(()),
            Err(error) if error.kind() != ErrorKind::WouldBlock => Err(error),
            _ => Ok(()),
        }
    }

    /// Writes as much as the program's end takes now. Returns the number of bytes.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.ours.write(bytes) {
            Err(error) if error.kind() == ErrorKind::WouldBlock => Ok(0),
            written => written,
        }
    }
}
