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
pub enum Severity {
    /// Such a robot can be built, but will not do well.
    Warning,
    /// Such a file is refused.
    Error,
}

/// Something about a field that is not as it should be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// The field, such as `legs.thigh.mass_kg`.
    pub field: &'static str,
    /// Its value, or what follows from it.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
    /// What to do.
    pub cure: &'static str,
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
    /// Notes an error unless `holds`. One for each field and rule is enough.
    fn must(
        &mut self,
        holds: bool,
        field: &'static str,
        value: String,
        allowed: impl Into<String>,
        cure: &'static str,
    ) {
        self.note(Severity::Error, holds, field, value, allowed.into(), cure);
    }

    /// Notes a warning unless `holds`.
    fn should(
        &mut self,
        holds: bool,
        field: &'static str,
        value: String,
        allowed: impl Into<String>,
        cure: &'static str,
    ) {
        self.note(Severity::Warning, holds, field, value, allowed.into(), cure);
    }

    fn note(
        &mut self,
        severity: Severity,
        holds: bool,
        field: &'static str,
        value: String,
        allowed: String,
        cure: &'static str,
    ) {
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

    fn has_errors(&self) -> bool {
        self.0.iter().any(|it| it.severity == Severity::Error)
    }
}

impl Robot {
    /// Checks everything that can be known without building the robot. Figures that follow from others are checked only if
    /// those are sound.
    pub fn check(&self) -> Vec<Finding> {
        let mut findings = Findings::default();
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

#[cfg(test)]
mod tests;
