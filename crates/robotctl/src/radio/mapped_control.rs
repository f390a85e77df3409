//! A control whose channel was found, and its settings.

use robot_app::domain::{NO_CHANNEL, RemoteChannel};

use super::Control;

/// A control and its channel, which is `None` if the transmitter has no such control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MappedControl {
    pub control: Control,
    pub channel: Option<RemoteChannel>,
}

impl MappedControl {
    pub(super) fn has(&self, index: usize) -> bool {
        let channel = self.channel;
        channel.is_some_and(|channel| channel.index as usize == index)
    }

    /// Returns the full names of settings and their values. A control without a channel keeps its ends.
    pub fn settings(&self) -> Vec<(String, f32)> {
        let name = self.control.name();
        let index = self.channel.map_or(NO_CHANNEL, |channel| channel.index);
        let mut settings = vec![(format!("radio.{name}-channel"), index)];
        if let Some(channel) = self.channel {
            settings.push((format!("radio.{name}-reversed"), channel.reversed));
            if self.control.has_travel() {
                settings.extend([
                    (format!("radio-travel.{name}-low"), channel.low),
                    (format!("radio-travel.{name}-centre"), channel.centre),
                    (format!("radio-travel.{name}-high"), channel.high),
                ]);
            }
        }
        // Whole numbers up to 2047 are exact.
        let exact = settings.into_iter();
        exact.map(|(name, value)| (name, value as f32)).collect()
    }

    /// Returns words such as `drive: channel 1, 172 … 992 … 1811; forward is the high count`.
    pub fn in_words(&self) -> String {
        let name = self.control.name();
        let Some(channel) = self.channel else {
            return format!("{name}: none");
        };
        let RemoteChannel {
            index,
            low,
            centre,
            high,
            reversed,
        } = channel;
        let (end, count) = (
            self.control.high_end(),
            ["high", "low"][usize::from(reversed == 1)],
        );
        let travel = if self.control.has_travel() {
            format!("{low} … {centre} … {high}")
        } else {
            format!("{low} … {high}")
        };
        format!("{name}: channel {index}, {travel}; {end} is the {count} count")
    }
}
