//! Reads and writes calibration files.

use std::{fs, path::Path};

use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{MapAccess, Visitor},
    ser::SerializeMap,
};
use serde_json::{Value, ser::PrettyFormatter};

use super::{
    Calibration, CalibrationError, Format, JointCalibration, LARGEST_OFFSET, Problem,
    STEPS_PER_TURN,
};
use crate::bus::LAST_ID;

/// The joints of a file in its order.
struct Entries(Vec<(String, Value)>);

impl<'de> Deserialize<'de> for Entries {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Entries;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "an object with a joint for each name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(Reader)
    }
}

impl Calibration {
    /// Reads a file of either format.
    pub fn load(path: &Path) -> Result<Self, CalibrationError> {
        let text = fs::read_to_string(path).map_err(|source| CalibrationError::Read {
            path: path.to_owned(),
            source,
        })?;
        Self::parse(&text, &path.display().to_string())
    }

    /// Reads the text of a file. `file` names it in errors.
    pub fn parse(text: &str, file: &str) -> Result<Self, CalibrationError> {
        let Entries(entries) =
            serde_json::from_str(text).map_err(|source| CalibrationError::Json {
                file: file.to_owned(),
                source,
            })?;
        let has_drive_mode = |entry: &Value| entry.get("drive_mode").is_some();
        let format = match entries.first() {
            None => {
                return Err(CalibrationError::Empty {
                    file: file.to_owned(),
                });
            }
            Some((_, first)) if has_drive_mode(first) => Format::LeRobot,
            Some(_) => Format::Plain,
        };
        let mut joints = Vec::new();
        for (name, value) in entries {
            let joint = read_joint(&value, format).map_err(|problem| CalibrationError::Joint {
                file: file.to_owned(),
                joint: name.clone(),
                problem,
            })?;
            joints.push((name, joint));
        }
        let calibration = Self { format, joints };
        calibration.check(file)?;
        Ok(calibration)
    }

    /// Writes a file as LeRobot does: JSON, four spaces deep.
    pub fn save(&self, path: &Path) -> Result<(), CalibrationError> {
        let failed = |source| CalibrationError::Write {
            path: path.to_owned(),
            source,
        };
        // A power cut leaves the old file or the new one.
        let new = path.with_extension("json.new");
        fs::write(&new, self.to_json()).map_err(failed)?;
        fs::rename(&new, path).map_err(failed)
    }

    /// Returns the text of the file.
    pub fn to_json(&self) -> String {
        let mut text = Vec::new();
        let formatter = PrettyFormatter::with_indent(b"    ");
        let mut serializer = serde_json::Serializer::with_formatter(&mut text, formatter);
        // Writing numbers and names into memory has no way to fail.
        let _ = self.serialize(&mut serializer);
        String::from_utf8_lossy(&text).into_owned()
    }

    /// Checks what the format asks of the values, and the joints against each other.
    pub(super) fn check(&self, file: &str) -> Result<(), CalibrationError> {
        for (place, (name, joint)) in self.joints.iter().enumerate() {
            let before = self.joints.iter().take(place);
            let problem = check_joint(joint, self.format).err().or_else(|| {
                before.clone().find_map(|(other, earlier)| {
                    if other == name {
                        Some(Problem::Twice)
                    } else if earlier.id == joint.id {
                        let (id, other) = (joint.id, other.clone());
                        Some(Problem::SameId { id, other })
                    } else {
                        None
                    }
                })
            });
            if let Some(problem) = problem {
                return Err(CalibrationError::Joint {
                    file: file.to_owned(),
                    joint: name.clone(),
                    problem,
                });
            }
        }
        Ok(())
    }
}

impl Serialize for Calibration {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.joints.len()))?;
        for (name, joint) in &self.joints {
            map.serialize_entry(name, &Fields(joint, self.format))?;
        }
        map.end()
    }
}

/// The fields of a joint in LeRobot's order.
struct Fields<'a>(&'a JointCalibration, Format);

impl Serialize for Fields<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(joint, format) = self;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("id", &joint.id)?;
        if *format == Format::LeRobot {
            map.serialize_entry("drive_mode", &joint.drive_mode)?;
        }
        map.serialize_entry("homing_offset", &joint.homing_offset)?;
        map.serialize_entry("range_min", &joint.range_min)?;
        map.serialize_entry("range_max", &joint.range_max)?;
        map.end()
    }
}

const FIELDS: [&str; 5] = [
    "id",
    "drive_mode",
    "homing_offset",
    "range_min",
    "range_max",
];

fn read_joint(value: &Value, format: Format) -> Result<JointCalibration, Problem> {
    let object = value.as_object().ok_or_else(|| Problem::NoObject {
        value: value.to_string(),
    })?;
    if let Some(field) = object.keys().find(|key| !FIELDS.contains(&key.as_str())) {
        let field = field.clone();
        return Err(Problem::Unknown { field });
    }
    let read = |field: &'static str| {
        let value = object.get(field).ok_or(Problem::Missing { field })?;
        let number = value.as_i64().and_then(|n| i32::try_from(n).ok());
        number.ok_or_else(|| wrong(field, value, format))
    };
    let small = |field: &'static str| {
        let value = read(field)?;
        u8::try_from(value).map_err(|_| wrong(field, &value.into(), format))
    };
    if format == Format::Plain && object.contains_key("drive_mode") {
        return Err(Problem::Mixed);
    }
    Ok(JointCalibration {
        id: small("id")?,
        drive_mode: match format {
            Format::LeRobot => small("drive_mode")?,
            Format::Plain => 0,
        },
        homing_offset: read("homing_offset")?,
        range_min: read("range_min")?,
        range_max: read("range_max")?,
    })
}

/// What a field takes, and what to do about another value.
fn allowed(field: &str, format: Format) -> (i64, i64, &'static str) {
    let last_step = match format {
        Format::Plain => STEPS_PER_TURN,
        Format::LeRobot => STEPS_PER_TURN - 1,
    };
    let largest = i64::from(LARGEST_OFFSET);
    match (field, format) {
        ("id", _) => (
            0,
            LAST_ID.into(),
            "`armctl scan` lists the ids of your servos",
        ),
        ("drive_mode", _) => (0, 1, "0 is as built, 1 turns the other way"),
        ("homing_offset", Format::Plain) => (
            -largest - 1,
            largest,
            "home is at 2048 + homing_offset, which has to be within one turn; calibrate this joint again",
        ),
        ("homing_offset", Format::LeRobot) => (
            -largest,
            largest,
            "a servo stores no larger offset: put the joint into the middle of its travel and calibrate it again, or turn its \
             horn on its shaft",
        ),
        _ => (
            0,
            last_step.into(),
            "a turn has 4096 steps; where the travel crosses the seam between 4095 and 0, calibrate with --format lerobot",
        ),
    }
}

fn wrong(field: &'static str, value: &Value, format: Format) -> Problem {
    let (least, most, cure) = allowed(field, format);
    Problem::Value {
        field,
        value: value.to_string(),
        least,
        most,
        cure,
    }
}

fn check_joint(joint: &JointCalibration, format: Format) -> Result<(), Problem> {
    let fields = [
        ("id", joint.id.into()),
        ("drive_mode", joint.drive_mode.into()),
        ("homing_offset", joint.homing_offset),
        ("range_min", joint.range_min),
        ("range_max", joint.range_max),
    ];
    for (field, value) in fields {
        let (least, most, _) = allowed(field, format);
        if !(least..=most).contains(&i64::from(value)) {
            return Err(wrong(field, &value.into(), format));
        }
    }
    let (min, max) = (joint.range_min, joint.range_max);
    if min < max {
        Ok(())
    } else {
        Err(Problem::EmptyRange { min, max })
    }
}
