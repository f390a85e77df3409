//! The robot's report on what it found in flash at boot (docs/tuning.md, `32`).

use std::fmt;

use robot_app::tuning::PARAMETERS;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BootFindings {
    /// Sectors damaged by something other than a power cut.
    pub lost_sectors: u8,
    /// Places of the sector in use that are neither empty nor a record; the count stays at 255.
    pub damaged: u8,
    /// Records kept for another firmware or other motors; the count stays at 255.
    pub foreign: u8,
    /// Names of the groups whose record is not used; `Err` is a number this tool does not know.
    pub refused: Vec<Result<&'static str, u8>>,
}

impl BootFindings {
    /// Parses the bytes after the command.
    pub(super) fn from_bytes([lost_sectors, damaged, foreign, a, b, c, d]: [u8; 7]) -> Self {
        let refused = u32::from_le_bytes([a, b, c, d]);
        let numbers = (0..32).filter(|number| refused & 1 << number != 0);
        Self {
            lost_sectors,
            damaged,
            foreign,
            refused: numbers.map(name).collect(),
        }
    }

    pub fn refused_names(&self) -> Vec<String> {
        let name = |group: &Result<&str, u8>| match group {
            Ok(name) => (*name).to_owned(),
            Err(number) => format!("group {number}"),
        };
        self.refused.iter().map(name).collect()
    }

    /// Returns what the user must know, or `None` if all is well.
    pub fn warnings(&self) -> Option<String> {
        let mut warnings = Vec::new();
        if self.lost_sectors != 0 {
            warnings.push(format!(
                "RUINED SECTORS   {}: newer values may be lost and older ones in use; check all with \
                 `robotctl tune list`",
                self.lost_sectors
            ));
        }
        if !self.refused.is_empty() {
            warnings.push(format!(
                "REFUSED          {}: defaults are in use, and the robot does not arm; set the group's values, or \
                 accept the defaults with `robotctl tune defaults GROUP --yes`",
                self.refused_names().join(", ")
            ));
        }
        (!warnings.is_empty()).then(|| warnings.join("\n"))
    }
}

fn name(number: u8) -> Result<&'static str, u8> {
    let group = PARAMETERS.iter().find(|group| group.number == number);
    group.map(|group| group.name).ok_or(number)
}

impl fmt::Display for BootFindings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "found at boot:")?;
        if let Some(warnings) = self.warnings() {
            write!(f, "\n{warnings}")?;
        }
        writeln!(f, "\ndamaged places   {}", self.damaged)?;
        write!(f, "foreign records  {}", self.foreign)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // docs/tuning.md: a ruined sector, 2 damaged places, 3 foreign records, groups 7, 16 and 30 refused.
    #[test]
    fn the_documented_bytes_are_understood() {
        let findings = BootFindings::from_bytes([1, 2, 3, 0x80, 0, 0x01, 0x40]);
        let expected = BootFindings {
            lost_sectors: 1,
            damaged: 2,
            foreign: 3,
            refused: vec![Ok("heater"), Ok("joint-left-front"), Err(30)],
        };
        assert_eq!(findings, expected);
        let text = findings.to_string();
        assert!(text.contains("RUINED SECTORS   1: newer values may be lost"));
        assert!(text.contains("heater, joint-left-front, group 30: defaults are in use"));
    }

    #[test]
    fn nothing_found_raises_no_alarm() {
        let text = BootFindings::from_bytes([0; 7]).to_string();
        assert!(!text.contains("RUINED") && !text.contains("REFUSED"));
    }
}
