//! How much of a long test runs.

/// Whether all of it runs, as `cargo xtask test --whole` asks for. Otherwise a sample does, so that all tests end within an hour.
pub fn is_whole() -> bool {
    std::env::var_os("ROBOT_WHOLE").is_some()
}
