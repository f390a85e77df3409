//! The robot's settings by name, `group.setting`, and their values in words.

mod value;

pub use value::ValueError;

use robot_app::tuning::{PARAMETERS, Parameter, ParameterGroup, ParameterKind};

/// A setting and its group.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    pub group: &'static ParameterGroup,
    pub parameter: &'static Parameter,
}

impl Setting {
    pub fn full_name(&self) -> String {
        format!("{}.{}", self.group.name, self.parameter.name)
    }

    /// Describes the values it may have, without its unit.
    pub fn range(&self) -> String {
        let Parameter { min, max, kind, .. } = *self.parameter;
        match kind {
            ParameterKind::Float => format!("{min} … {max}"),
            ParameterKind::Integer => format!("a whole number, {min} … {max}"),
            ParameterKind::Sign => "1 or -1".to_owned(),
            ParameterKind::Choice(names) => names.join(", "),
        }
    }

    /// Describes the values it may have, with its unit.
    pub fn allowed(&self) -> String {
        let allowed = format!("{} {}", self.range(), self.parameter.unit);
        allowed.trim_end().to_owned()
    }
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("there is no {what} `{name}`{}", nearest.as_ref().map(|n| format!("; did you mean `{n}`?")).unwrap_or_default())]
pub struct UnknownName {
    what: &'static str,
    name: String,
    nearest: Option<String>,
}

/// Returns all settings in the order of their numbers.
pub fn all() -> impl Iterator<Item = Setting> {
    PARAMETERS.iter().flat_map(|group| {
        let parameters = group.parameters.iter();
        parameters.map(move |parameter| Setting { group, parameter })
    })
}

/// Finds a setting by its full name.
pub fn find(name: &str) -> Result<Setting, UnknownName> {
    let found = all().find(|named| named.full_name() == name);
    found.ok_or_else(|| UnknownName {
        what: "setting",
        name: name.to_owned(),
        nearest: nearest(name, all().map(|named| named.full_name())),
    })
}

pub fn find_group(name: &str) -> Result<&'static ParameterGroup, UnknownName> {
    let found = PARAMETERS.iter().find(|group| group.name == name);
    found.ok_or_else(|| UnknownName {
        what: "group",
        name: name.to_owned(),
        nearest: nearest(name, PARAMETERS.iter().map(|group| group.name.to_owned())),
    })
}

/// Returns the most similar name, or `None` if none is similar.
fn nearest(name: &str, names: impl Iterator<Item = String>) -> Option<String> {
    let scored = names.map(|candidate| (likeness(name, &candidate), candidate));
    let (score, candidate) = scored.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (score > 0.5).then_some(candidate)
}

/// Returns the share of neighbouring pairs of letters that both have (Dice's coefficient), from 0 to 1.
fn likeness(a: &str, b: &str) -> f64 {
    let pairs =
        |text: &str| -> Vec<[u8; 2]> { text.as_bytes().windows(2).map(|w| [w[0], w[1]]).collect() };
    let (ours, mut theirs) = (pairs(a), pairs(b));
    let total = (ours.len() + theirs.len()).max(1) as f64;
    let common = ours.iter().filter(|pair| {
        let place = theirs.iter().position(|other| other == *pair);
        place.map(|place| theirs.swap_remove(place)).is_some()
    });
    2.0 * common.count() as f64 / total
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_and_misspelt_ones_get_a_suggestion() {
        let found = find("wheel-geometry.track-m").unwrap();
        assert_eq!((found.group.number, found.parameter.index), (1, 1));
        let error = find("wheel-geometry.trak-m").unwrap_err().to_string();
        assert!(error.contains("`wheel-geometry.track-m`"), "{error}");
        assert_eq!(find("xyz").unwrap_err().nearest, None);
        assert_eq!(find_group("heater").unwrap().number, 7);
        let error = find_group("heatr").unwrap_err().to_string();
        assert_eq!(error, "there is no group `heatr`; did you mean `heater`?");
    }

    #[test]
    fn no_two_settings_share_a_name() {
        let mut names: Vec<_> = all().map(|named| named.full_name()).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
    }
}
