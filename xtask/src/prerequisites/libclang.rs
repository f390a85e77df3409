//! Checks that bindgen will find a libclang that it can use.

use clang::{Clang, Index, Unsaved, diagnostic::Severity};

/// Headers that every C header includes. The first is the compiler's own, the second is the C library's.
const HEADER: &str = "#include <stddef.h>\n#include <stdint.h>\n";

/// Lets libclang read a header. It finds libclang by the same search as bindgen.
///
/// Finding a file is not enough: LLVM has files of similar names, and distributions put libclang's headers into another
/// package.
pub fn is_usable() -> bool {
    loads() && Clang::new().is_ok_and(|clang| reads(&clang, HEADER))
}

/// True if there is a libclang. This must be checked before `Clang::new`. Once `Clang::new` has failed, it goes on
/// failing although libclang has been installed meanwhile. It panics where the search finds a library that only has a
/// similar name, such as `libclang-cpp14.so`, because that has no version.
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

    /// Without libclang there is nothing to test. The emulator could not be built either.
    #[test]
    fn a_missing_header_is_detected() {
        let Ok(clang) = Clang::new() else { return };
        assert!(reads(&clang, HEADER));
        assert!(!reads(
            &clang,
            "#include <no_such_header_of_the_compiler.h>\n"
        ));
    }
}
