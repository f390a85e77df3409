//! Checks of what a file says: each names field, value, what is allowed, and the cure.

mod balance;
mod bodies;
mod buses;
mod legs;
mod motors;

use std::fmt;

use crate::Robot;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Severity {
    /// Such a robot can be built, but will not do well.
    Warning,
    /// Such a file is refused.
    Error,
}

/// Something about a field that is not as it should be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Finding {
    /// How bad it is.
    pub(crate) severity: Severity,
    /// The field, such as `legs.thigh.mass_kg`.
    pub(crate) field: &'static str,
    /// Its value, or what follows from it.
    pub(crate) value: String,
    /// What is allowed.
    pub(crate) allowed: String,
    /// What to do.
    pub(crate) cure: &'static str,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            value,
            allowed,
            cure,
            ..
        } = self;
        write!(f, "{value}; allowed: {allowed}. {cure}")
    }
}

/// What has been found so far.
#[derive(Default)]
struct Findings(Vec<Finding>);

impl Findings {
    /// Notes a finding unless `holds`. One for each field and rule is enough.
    fn note(
        &mut self,
        severity: Severity,
        holds: bool,
        field: &'static str,
        value: String,
        allowed: impl Into<String>,
        cure: &'static str,
    ) {
        let allowed = allowed.into();
        let known = |it: &Finding| it.field == field && it.allowed == allowed;
        if !holds && !self.0.iter().any(known) {
            self.0.push(Finding {
                severity,
                field,
                value,
                allowed,
                cure,
            });
        }
    }

    /// Notes an error unless a value is more than 0 and at most `most`, which `limit` tells with its unit and reason.
    fn up_to(
        &mut self,
        most: f64,
        limit: &str,
        field: &'static str,
        (value, unit): (f64, &str),
        cure: &'static str,
    ) {
        self.note(
            Severity::Error,
            value > 0.0 && value <= most,
            field,
            format!("{value} {unit}"),
            format!("more than 0, at most {limit}"),
            cure,
        );
    }

    fn has_errors(&self) -> bool {
        self.0.iter().any(|it| it.severity == Severity::Error)
    }
}

impl Robot {
    /// Checks everything that can be known without building the robot. Figures that follow from others are checked only if
    /// those are sound.
    pub(crate) fn check(&self) -> Vec<Finding> {
        let mut findings = Findings::default();
        name(self, &mut findings);
        bodies::check(self, &mut findings);
        motors::check(self, &mut findings);
        buses::check(self, &mut findings);
        legs::check_lengths(self, &mut findings);
        if !findings.has_errors() {
            legs::check_poses(self, &mut findings);
        }
        if !findings.has_errors() {
            balance::check(self, &mut findings);
        }
        findings.0
    }
}

/// Files, pages and constants are named after it.
fn name(robot: &Robot, findings: &mut Findings) {
    let name = &robot.name;
    findings.note(
        Severity::Error,
        !name.is_empty()
            && name
                .chars()
                .all(|it| it.is_alphanumeric() || it == '-' || it == '_'),
        "name",
        format!("{name:?}"),
        "letters, digits, hyphens and underscores",
        "Enter the file's name without .toml.",
    );
}

#[cfg(test)]
mod tests;
