//! Numbers that no motor can follow, in whichever file they stand.

use super::ConfigError;
use crate::{Joint, PolicyDescription, TermPlan};

/// Refuses a number that is NaN, infinite or negative where that has no meaning. In a control loop it would be a target.
pub(super) fn check(policy: PolicyDescription) -> Result<PolicyDescription, ConfigError> {
    let joints = policy.joints.iter().flat_map(in_joint);
    let terms = policy.observation.iter().flat_map(|group| &group.terms);
    let terms = terms.flat_map(in_term);
    let names = ["forward", "left", "turn"];
    let commands = names.iter().zip(policy.command_ranges);
    let commands = commands.map(|(name, range)| limits("commands", name, range));
    match joints.chain(terms).chain(commands).flatten().next() {
        None => Ok(policy),
        Some(message) => Err(ConfigError::Malformed {
            file: policy.name,
            message,
        }),
    }
}

fn in_joint(joint: &Joint) -> Vec<Option<String>> {
    let name = &joint.name;
    let any = |what, value| number(name, what, value, f32::MIN);
    let least_0 = |what, value| number(name, what, value, 0.0);
    vec![
        any("default angle", joint.default_rad),
        any("scale", joint.action.scale),
        any("offset", joint.action.offset),
        least_0("stiffness", joint.kp),
        least_0("damping", joint.kd),
        least_0("stiffness of getting up", joint.fixed_kp),
        least_0("damping of getting up", joint.fixed_kd),
        least_0("torque limit", joint.torque_limit_nm),
        limits(name, "clip", joint.action.clip),
        limits(name, "target", joint.action.target_range),
    ]
}

fn in_term(term: &TermPlan) -> Vec<Option<String>> {
    let scale = term.scale.iter();
    let scale = scale.map(|scale| number(&term.name, "scale", *scale, f32::MIN));
    let clips = [term.clip_before, term.clip_after].map(|clip| limits(&term.name, "clip", clip));
    scale.chain(clips).collect()
}

fn number(of: &str, what: &str, value: f32, least: f32) -> Option<String> {
    let wrong = !value.is_finite() || value < least;
    wrong.then(|| format!("{of}: its {what} is {value}"))
}

fn limits(of: &str, what: &str, [low, high]: [f32; 2]) -> Option<String> {
    let holds = low <= high;
    (!holds).then(|| format!("{of}: limits of its {what} are {low} and {high}"))
}
