//! What a user types while the arm runs.

use std::str::FromStr;

use robot_servo_model::{Bus, FAULT_NAMES, Fault};
use thiserror::Error;

use super::plugs::Plugs;

/// Shown behind the options.
pub const HELP: &str = "\
While it runs, type a fault and Enter to start it, and the same again to end it:
  drop=0.5%  corrupt=1%  delay=1%:5ms  drop-packet=0.5%  corrupt-packet=1%  echo
  gone=N  wrong-id=N:ID  duplicate-id=N:ID  brown-out  supply=7.4V  blocked=N  hot=N:80C
N counts servos from the base, 1 to 6. Further: `next` plugs in the next servo alone (--factory),
`all` plugs in all of them, `quit` ends it.

Examples:
  armctl sim                            six servos, ids 1 to 6; then: armctl scan --port PATH
  armctl sim --at /tmp/arm              the port is /tmp/arm in every run
  armctl sim --factory                  new servos, to try armctl set-id --from 1 --to 2
  armctl sim --arm left_arm.json        the servos of that arm
  armctl sim --corrupt 1% --drop 0.5%   a bad cable
  armctl sim --fault supply=16V         the wrong adapter";

/// A line with a meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line {
    /// Starts a fault, or ends it if it is in force.
    Fault(Fault),
    /// Plugs in the next servo alone.
    Next,
    /// Plugs in all servos.
    All,
    Quit,
    Nothing,
}

/// A line without one.
#[derive(Debug, Error)]
#[error("{text} is none of {}, next, all, quit", FAULT_NAMES.join(", "))]
pub struct UnknownLine {
    text: String,
}

impl FromStr for Line {
    type Err = UnknownLine;

    fn from_str(text: &str) -> Result<Self, UnknownLine> {
        match text.trim() {
            "" => Ok(Self::Nothing),
            "all" => Ok(Self::All),
            "next" => Ok(Self::Next),
            "q" | "quit" => Ok(Self::Quit),
            text => match text.parse() {
                Ok(fault) => Ok(Self::Fault(fault)),
                Err(_) => Err(UnknownLine {
                    text: text.to_owned(),
                }),
            },
        }
    }
}

impl Line {
    /// Does it, and says so.
    pub fn act(self, bus: &mut Bus, plugs: &mut Plugs) -> String {
        match self {
            Self::Fault(fault) => toggle(bus, plugs, fault),
            Self::Next => plugs.next(bus),
            Self::All => plugs.all(bus),
            Self::Quit | Self::Nothing => String::new(),
        }
    }
}

fn toggle(bus: &mut Bus, plugs: &Plugs, fault: Fault) -> String {
    let in_force = plugs.hide(bus.faults().collect());
    let same = in_force.iter().find(|(_, other)| *other == fault);
    match same {
        Some((id, _)) => {
            bus.end(*id);
            format!("{fault} ends")
        }
        None => {
            bus.start(fault);
            format!("{fault} starts")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_meaning_is_answered_with_what_has() {
        let error = "gone".parse::<Line>().expect_err("no servo is named");
        assert!(error.to_string().starts_with("gone is none of drop=0.5%"));
        assert_eq!(" quit ".parse::<Line>().ok(), Some(Line::Quit));
        assert_eq!("".parse::<Line>().ok(), Some(Line::Nothing));
    }

    #[test]
    fn the_help_names_every_fault() {
        for name in FAULT_NAMES {
            assert!(HELP.contains(name), "{name}");
        }
    }

    #[test]
    fn a_fault_that_is_typed_again_ends() {
        let mut bus = Bus::new(vec![], 1);
        let mut plugs = Plugs::new(&mut bus, false);
        let echo = Line::Fault(Fault::Echo);
        for (said, count) in [("echo starts", 1), ("echo ends", 0)] {
            assert_eq!(echo.act(&mut bus, &mut plugs), said);
            assert_eq!(bus.faults().count(), count);
        }
    }
}
