//! Writes the status for scripts: a table for each page, by the firmware's names. A value that the robot does not know
//! is `null`.

use robot_app::tuning::LiveValue;
use serde_json::{Map, Value, json};

use super::Status;
use crate::tuning::LiveReading;

impl Status {
    /// `{"power": {"battery-v": 24.1}, "joint": {"left-front": {"state": "disabled", …}, …}, …}`; what stands for
    /// several parts has a table for each.
    pub fn to_json(&self) -> Value {
        let mut pages = Map::new();
        for reading in &self.pages {
            let values: Map<String, Value> = reading
                .values()
                .map(|(field, value)| (field.to_owned(), json_of(reading, field, value)))
                .collect();
            match reading.page.parts.get(reading.part) {
                None | Some(&"") => {
                    pages.insert(reading.page.name.to_owned(), Value::Object(values));
                }
                Some(part) => {
                    let parts = pages
                        .entry(reading.page.name)
                        .or_insert_with(|| Value::Object(Map::new()));
                    parts[*part] = Value::Object(values);
                }
            }
        }
        if let Some(store) = &self.store {
            let saved = json!({
                "saved": store.is_saved(),
                "unsaved-groups": store.unsaved,
                "state": store.state_in_words(),
                "last-error": store.error_in_words(),
            });
            pages.insert("settings".to_owned(), saved);
        }
        if let Some(findings) = &self.findings {
            let found = json!({
                "ruined-sectors": findings.lost_sectors,
                "damaged-places": findings.damaged,
                "foreign-records": findings.foreign,
                "refused-groups": findings.refused_names(),
            });
            pages.insert("found-at-boot".to_owned(), found);
        }
        Value::Object(pages)
    }
}

fn json_of(reading: &LiveReading, field: &str, value: LiveValue) -> Value {
    match value {
        LiveValue::Count(count) => count.into(),
        LiveValue::Measure(measured) => measured.into(),
        LiveValue::Choice(_) => reading.choice(field).into(),
        LiveValue::Set(_) => reading.set(field).into(),
    }
}
