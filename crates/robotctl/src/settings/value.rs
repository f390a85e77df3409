//! Converts a setting's value from and into words.

use robot_app::tuning::ParameterKind;

use super::Setting;

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ValueError {
    #[error("`{0}` is no number")]
    NoNumber(String),
    #[error("`{text}` is not a value of {name}, which is one of {names}")]
    NoChoice {
        text: String,
        name: String,
        names: String,
    },
}

impl Setting {
    /// Parses a number, or the name of a choice. It does not check whether the setting may have the number.
    pub fn parse(&self, text: &str) -> Result<f32, ValueError> {
        if let Ok(number) = text.parse::<f32>() {
            return Ok(number);
        }
        let ParameterKind::Choice(names) = self.parameter.kind else {
            return Err(ValueError::NoNumber(text.to_owned()));
        };
        let place = names.iter().position(|name| *name == text);
        let place = place.ok_or_else(|| ValueError::NoChoice {
            text: text.to_owned(),
            name: self.full_name(),
            names: names.join(", "),
        })?;
        Ok(place as f32)
    }

    /// Returns the name of a choice, or else the number.
    pub fn in_words(&self, value: f32) -> String {
        let name = match self.parameter.kind {
            ParameterKind::Choice(names) if value >= 0.0 && value.fract() == 0.0 => {
                names.get(value as usize).copied()
            }
            _ => None,
        };
        name.map_or_else(|| value.to_string(), str::to_owned)
    }
}

#[cfg(test)]
mod tests {
    use crate::settings::find;

    /// The numbers are from docs/tuning.md.
    #[test]
    fn a_choice_is_parsed_by_name_or_number() {
        let board = find("mounting.board").unwrap();
        assert_eq!(board.parse("x-right-z-down"), Ok(13.0));
        assert_eq!(board.parse("13"), Ok(13.0));
        assert_eq!(board.in_words(13.0), "x-right-z-down");
        assert_eq!(board.in_words(24.0), "24");
        assert_eq!(board.in_words(0.5), "0.5");
        assert_eq!(board.in_words(-1.0), "-1");
        let mag = find("mounting.mag").unwrap();
        assert_eq!(mag.parse("unset"), Ok(24.0));
        let error = board.parse("unset").unwrap_err().to_string();
        assert!(
            error.starts_with("`unset` is not a value of mounting.board"),
            "{error}"
        );
        assert!(
            error.contains("x-forward-z-up, x-forward-z-down"),
            "{error}"
        );
        let target = find("heater.target-c").unwrap();
        assert_eq!(target.parse("-4.5"), Ok(-4.5));
        assert_eq!(target.in_words(45.0), "45");
        let error = target.parse("warm").unwrap_err().to_string();
        assert_eq!(error, "`warm` is no number");
    }
}
