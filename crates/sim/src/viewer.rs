//! Shows the report of a run, whose viewer moves the robot, in the browser of this desktop.

use std::{
    env,
    ffi::OsString,
    path::{self, Path},
};

/// Opens the report, or says where it is if there is no desktop or it knows no browser.
pub fn show(report: &Path) {
    let report = path::absolute(report).unwrap_or_else(|_| report.to_owned());
    let place = report.display();
    if !is_desktop(|name| env::var_os(name)) {
        println!("no desktop here; open this in a browser: {place}");
    } else if let Err(error) = open::that_detached(&report) {
        println!("no browser opens ({error}); open this in one: {place}");
    } else {
        println!("opened {place}");
    }
}

/// Whether windows can be opened, by the variables of the session. WSL uses those of Windows.
fn is_desktop(variable: impl Fn(&str) -> Option<OsString>) -> bool {
    let has = |name: &&str| variable(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "macos") {
        !has(&"SSH_CONNECTION")
    } else {
        ["DISPLAY", "WAYLAND_DISPLAY", "WSL_DISTRO_NAME"]
            .iter()
            .any(has)
    }
}

#[cfg(all(test, not(target_os = "macos")))]
mod tests {
    use super::*;

    #[test]
    fn a_desktop_is_known_by_its_display() {
        let with = |set: &'static str, value: &'static str| {
            is_desktop(move |name| (name == set).then(|| OsString::from(value)))
        };
        assert!(with("DISPLAY", ":0") && with("WAYLAND_DISPLAY", "wayland-0"));
        assert!(with("WSL_DISTRO_NAME", "Ubuntu"));
        assert!(!with("DISPLAY", "") && !with("TERM", "xterm"));
    }
}
