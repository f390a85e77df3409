//! The filters that can be compared.

use std::path::{Path, PathBuf};

/// A program of the package `robot-estimator-bench`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Filter {
    /// Name of the program's file.
    pub program: &'static str,
    /// Title of its column.
    pub title: &'static str,
}

/// The estimator of the robot.
pub const OURS: Filter = Filter {
    program: "ours",
    title: "robot",
};

/// Filters of published crates, each with its own settings.
pub const PUBLISHED_FILTERS: [Filter; 4] = [
    Filter {
        program: "vqf-rs",
        title: "vqf-rs",
    },
    Filter {
        program: "uf-vqf",
        title: "uf-ahrs Vqf",
    },
    Filter {
        program: "uf-madgwick",
        title: "Madgwick",
    },
    Filter {
        program: "uf-mahony",
        title: "Mahony",
    },
];

/// A program without a filter. It shows what start-up and mailbox cost in each program.
pub const EMPTY: Filter = Filter {
    program: "empty",
    title: "empty",
};

impl Filter {
    pub fn elf(self, programs: &Path) -> PathBuf {
        programs.join(self.program)
    }
}
