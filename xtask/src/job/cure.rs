//! Recognises what a failed build lacks by what it printed.

/// A line that a tool prints when something is missing, and what to do about it.
struct Sign {
    /// All of these words stand in one line.
    words: &'static [&'static str],
    cure: &'static str,
}

/// Each line is what the tool named in it says (cargo, rustc, cmake, bindgen, QEMU's configure, C compilers).
const SIGNS: [Sign; 13] = [
    Sign {
        words: &["pkg-config", "not found"],
        cure: "pkg-config is missing. Debian, Ubuntu: sudo apt-get install pkg-config",
    },
    Sign {
        words: &["Unable to find libclang"],
        cure: "libclang is missing. Debian, Ubuntu: sudo apt-get install libclang-dev",
    },
    Sign {
        words: &["stddef.h' file not found"],
        cure: "libclang is there without its headers. Debian, Ubuntu: sudo apt-get install libclang-dev",
    },
    Sign {
        words: &["is `cmake` not installed?"],
        cure: "cmake is missing. Debian, Ubuntu: sudo apt-get install cmake",
    },
    Sign {
        words: &["CMAKE_MAKE_PROGRAM is not set"],
        cure: "make is missing. Debian, Ubuntu: sudo apt-get install build-essential",
    },
    Sign {
        words: &["No CMAKE_C", "_COMPILER could be found"],
        cure: "a C and C++ compiler is missing. Debian, Ubuntu: sudo apt-get install build-essential",
    },
    Sign {
        words: &["linker `cc` not found"],
        cure: "a C compiler is missing. Debian, Ubuntu: sudo apt-get install build-essential",
    },
    Sign {
        words: &["fatal error:", ".h: No such file or directory"],
        cure: "the C library's headers are missing. Debian, Ubuntu: sudo apt-get install build-essential",
    },
    Sign {
        words: &["can't find crate for `core`"],
        cure: "the board's core library is missing: rustup target add thumbv7em-none-eabihf",
    },
    Sign {
        words: &["No space left on device"],
        cure: "the disk is full: a first build takes some 5 GB in the folder `target`",
    },
    Sign {
        words: &["signal: 9, SIGKILL"],
        cure: "the system ended the compiler, most likely for want of memory: a build takes 4 GB",
    },
    Sign {
        words: &["Could not resolve host"],
        cure: "no way to the package registry: the first build needs the network (or cargo's mirror settings)",
    },
    Sign {
        words: &["failed to download"],
        cure: "a package could not be fetched: the first build needs the network (or cargo's mirror settings)",
    },
];

/// Returns a sentence on what to do, if the output of a build shows what it lacks.
pub fn of(output: &str) -> Option<&'static str> {
    let shown = |sign: &&Sign| {
        let tells = |line: &str| sign.words.iter().all(|word| line.contains(word));
        output.lines().any(tells)
    };
    SIGNS.iter().find(shown).map(|sign| sign.cure)
}

#[cfg(test)]
mod tests {
    use super::of;

    #[test]
    fn what_is_missing_is_named() {
        for (output, named) in [
            (
                "CMake Error\n  ERROR: pkg-config binary 'pkg-config' not found\n  thread main panicked",
                "install pkg-config",
            ),
            (
                "thread 'main' panicked at lib.rs:604:27:\nUnable to find libclang: \"couldn't find any valid\"",
                "install libclang-dev",
            ),
            (
                "/usr/include/stdint.h:26:10: fatal error: 'stddef.h' file not found",
                "install libclang-dev",
            ),
            (
                "failed to execute command: No such file or directory\nis `cmake` not installed?",
                "cmake",
            ),
            ("error: linker `cc` not found", "C compiler"),
            ("CMake Error: No CMAKE_CXX_COMPILER could be found.", "C++"),
            (
                "rustc-LLVM ERROR: IO failure on output stream: No space left on device",
                "disk is full",
            ),
        ] {
            let cure = of(output);
            assert!(
                cure.is_some_and(|cure| cure.contains(named)),
                "{output}: {cure:?}"
            );
        }
    }

    #[test]
    fn a_mistake_in_the_source_has_no_cure() {
        assert_eq!(
            of("error[E0425]: cannot find value `pkg` in this scope"),
            None
        );
    }
}
