//! Recognises what a failed build lacks by what it printed.

/// A line that a tool prints when something is missing, and what to do about it.
struct Symptom {
    /// All of these words stand in one line.
    words: &'static [&'static str],
    advice: &'static str,
}

/// Each line is what the tool named in it says (cargo, rustc, cmake, bindgen, QEMU's configure, C compilers).
const SYMPTOMS: [Symptom; 13] = [
    Symptom {
        words: &["pkg-config", "not found"],
        advice: "pkg-config is missing. Debian, Ubuntu: sudo apt-get install pkg-config",
    },
    Symptom {
        words: &["Unable to find libclang"],
        advice: "libclang is missing. Debian, Ubuntu: sudo apt-get install libclang-dev",
    },
    Symptom {
        words: &["stddef.h' file not found"],
        advice: "libclang is there without its headers. Debian, Ubuntu: sudo apt-get install libclang-dev",
    },
    Symptom {
        words: &["is `cmake` not installed?"],
        advice: "cmake is missing. Debian, Ubuntu: sudo apt-get install cmake",
    },
    Symptom {
        words: &["CMAKE_MAKE_PROGRAM is not set"],
        advice: "make is missing. Debian, Ubuntu: sudo apt-get install build-essential",
    },
    Symptom {
        words: &["No CMAKE_C", "_COMPILER could be found"],
        advice: "a C and C++ compiler is missing. Debian, Ubuntu: sudo apt-get install build-essential",
    },
    Symptom {
        words: &["linker `cc` not found"],
        advice: "a C compiler is missing. Debian, Ubuntu: sudo apt-get install build-essential",
    },
    Symptom {
        words: &["fatal error:", ".h: No such file or directory"],
        advice: "the C library's headers are missing. Debian, Ubuntu: sudo apt-get install build-essential",
    },
    Symptom {
        words: &["can't find crate for `core`"],
        advice: "the board's core library is missing: rustup target add thumbv7em-none-eabihf",
    },
    Symptom {
        words: &["No space left on device"],
        advice: "the disk is full: a first build takes some 5 GB in the folder `target`",
    },
    Symptom {
        words: &["signal: 9, SIGKILL"],
        advice: "the system ended the compiler, most likely for want of memory: a build takes 4 GB",
    },
    Symptom {
        words: &["Could not resolve host"],
        advice: "no way to the package registry: the first build needs the network (or cargo's mirror settings)",
    },
    Symptom {
        words: &["failed to download"],
        advice: "a package could not be fetched: the first build needs the network (or cargo's mirror settings)",
    },
];

/// Returns a sentence on what to do, if the output of a build shows what it lacks.
pub fn advice(output: &str) -> Option<&'static str> {
    let shown = |symptom: &&Symptom| {
        let tells = |line: &str| symptom.words.iter().all(|word| line.contains(word));
        output.lines().any(tells)
    };
    SYMPTOMS.iter().find(shown).map(|symptom| symptom.advice)
}

#[cfg(test)]
mod tests {
    use super::advice;

    #[test]
    fn a_missing_dependency_is_named() {
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
            let advice = advice(output);
            assert!(
                advice.is_some_and(|advice| advice.contains(named)),
                "{output}: {advice:?}"
            );
        }
    }

    #[test]
    fn a_compile_error_is_no_missing_dependency() {
        assert_eq!(
            advice("error[E0425]: cannot find value `pkg` in this scope"),
            None
        );
    }
}
