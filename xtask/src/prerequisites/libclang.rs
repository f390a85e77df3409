//! Whether bindgen will find a libclang that it can use.

use clang::{Clang, Index, Unsaved, diagnostic::Severity};

/// What every C header begins with: the first is the compiler's own, the second the C library's.
const HEADER: &str = "#include <stddef.h>\n#include <stdint.h>\n";

/// Has libclang, found by the very search that bindgen makes, read a header.
///
/// LLVM brings files of similar names without it, and distributions pack its own headers apart from it.
pub fn is_usable() -> bool {
    loads() && Clang::new().is_ok_and(|clang| reads(&clang, HEADER))
}

/// This must be checked before `Clang::new`. Once that has failed it always fails, even after libclang has been installed,
/// and it panics if the search finds a library with a similar name (`libclang-cpp14.so`), which has no version.
fn loads() -> bool {
    clang_sys::load().is_ok()
        && clang_sys::get_library().is_some_and(|library| library.version().is_some())
}

fn reads(clang: &Clang, text: &str) -> bool {
    let index = Index::new(clang, false, false);
    let header = Unsaved::new("prerequisite.h", text);
    let parsed = index.parser("prerequisite.h").unsaved(&[header]).parse();
    parsed.is_ok_and(|unit| {
        let complaints = unit.get_diagnostics();
        complaints
            .iter()
            .all(|one| one.get_severity() < Severity::Error)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without libclang there is nothing to test; the emulator would not have been built either.
    #[test]
    fn a_header_that_is_not_there_is_noticed() {
        let Ok(clang) = Clang::new() else { return };
        assert!(reads(&clang, HEADER));
        assert!(!reads(
            &clang,
            "#include <no_such_header_of_the_compiler.h>\n"
        ));
    }
}
