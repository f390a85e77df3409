//! `deploy.yaml`, as unitree_rl_lab exports it. A robot's `base.yaml` says what it does not: names, limits, wheels.

use std::{fmt, marker::PhantomData, path::Path};

use serde::{
    Deserialize, Deserializer,
    de::{MapAccess, Visitor},
};
use serde_json::Value;

use super::{
    ConfigError,
    base::Base,
    isaac::{Export, ExportedJoint, ExportedTerm, UNLIMITED},
    keys::parse,
};
use crate::{ActionPlan, Drive, PolicyDescription};

const POSITION: &str = "JointPositionAction";
const SPEED: &str = "JointVelocityAction";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Deploy {
    /// Motor of each joint of the export.
    joint_ids_map: Vec<usize>,
    step_dt: f32,
    /// In the order of the motors.
    stiffness: Vec<f32>,
    /// In the order of the motors.
    damping: Vec<f32>,
    default_joint_pos: Vec<f32>,
    #[serde(default)]
    commands: Commands,
    actions: Ordered<Action>,
    observations: Ordered<Term>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Commands {
    base_velocity: Option<BaseVelocity>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BaseVelocity {
    ranges: Ranges,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Ranges {
    lin_vel_x: [f32; 2],
    lin_vel_y: [f32; 2],
    ang_vel_z: [f32; 2],
    /// Of a command that is not observed.
    #[serde(rename = "heading")]
    _heading: Option<[f32; 2]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Action {
    clip: Option<Vec<[f32; 2]>>,
    /// Patterns; `joint_ids` says what they matched.
    #[serde(rename = "joint_names")]
    _joint_names: Vec<String>,
    scale: Vec<f32>,
    offset: Vec<f32>,
    joint_ids: Value,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Term {
    #[serde(default)]
    params: Params,
    clip: Option<[f32; 2]>,
    scale: Vec<f32>,
    #[serde(default)]
    history_length: usize,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Params {
    /// There is one command.
    #[serde(rename = "command_name")]
    _command_name: Option<String>,
    asset_cfg: Option<Asset>,
}

/// Other entries name the robot and its bodies.
#[derive(Deserialize)]
struct Asset {
    joint_ids: Option<Value>,
}

/// Reads `file`, the export of a policy called `name` that runs the network in `model_file`.
pub(super) fn read(
    policies: &Path,
    robot: &str,
    file: &Path,
    [name, model_file]: [&str; 2],
) -> Result<PolicyDescription, ConfigError> {
    let base = Base::read(policies, robot)?;
    let deploy: Deploy = parse(file)?;
    let shown = file.display().to_string();
    let file = File { name: &shown };
    let export = file.export(&base, &deploy)?;
    let observed = deploy.observations.0.iter();
    let terms: Vec<_> = observed
        .map(|(name, term)| file.term(name, term, deploy.joint_ids_map.len()))
        .collect::<Result<_, _>>()?;
    let decimation = file.decimation(&base, deploy.step_dt)?;
    let ranges = deploy.commands.base_velocity.map_or([UNLIMITED; 3], |it| {
        [
            it.ranges.lin_vel_x,
            it.ranges.lin_vel_y,
            it.ranges.ang_vel_z,
        ]
    });
    if ranges.iter().any(|[low, high]| low > high) {
        return Err(file.complaint("commands: a range ends below its start"));
    }
    export.describe(&base, [name, model_file], decimation, &terms, ranges)
}

struct File<'a> {
    name: &'a str,
}

impl<'a> File<'a> {
    fn complaint(&self, message: impl Into<String>) -> ConfigError {
        ConfigError::Malformed {
            file: self.name.to_owned(),
            message: message.into(),
        }
    }

    fn check_length(&self, key: &str, found: usize, wanted: usize) -> Result<(), ConfigError> {
        if found == wanted {
            Ok(())
        } else {
            Err(self.complaint(format!(
                "{key}: {found} values, and it has to have {wanted}"
            )))
        }
    }

    /// Periods of the control loop in one of the network.
    fn decimation(&self, base: &Base, step_s: f32) -> Result<u32, ConfigError> {
        let periods = step_s / base.control_period_s;
        let whole = periods.round();
        if (1.0..=1e6).contains(&whole) && (periods - whole).abs() < 1e-3 {
            Ok(whole as u32)
        } else {
            Err(self.complaint(format!(
                "step_dt: {step_s} s is no multiple of dt, {} s, in {}",
                base.control_period_s, base.file
            )))
        }
    }

    /// Joints in the order of the actions.
    fn export(&self, base: &'a Base, deploy: &Deploy) -> Result<Export<'a>, ConfigError> {
        let count = base.joints.len();
        for (key, list) in [
            ("joint_ids_map", deploy.joint_ids_map.len()),
            ("stiffness", deploy.stiffness.len()),
            ("damping", deploy.damping.len()),
            ("default_joint_pos", deploy.default_joint_pos.len()),
        ] {
            self.check_length(key, list, count)?;
        }
        let mut joints = Vec::new();
        let mut places = vec![None; count];
        for (term, action) in &deploy.actions.0 {
            let drive = match term.as_str() {
                POSITION => Drive::Position,
                SPEED => Drive::Speed,
                _ => {
                    let message =
                        format!("actions: {term} is unknown. Known are {POSITION} and {SPEED}");
                    return Err(self.complaint(message));
                }
            };
            for (index, plan) in self.plans(term, action, count)? {
                let joint = self.joint(base, deploy, index, drive, plan)?;
                if places[index].replace(joints.len()).is_some() {
                    let message = format!("actions: {} has two actions", joint.base.name);
                    return Err(self.complaint(message));
                }
                joints.push(joint);
            }
        }
        let places: Option<Vec<usize>> = places.into_iter().collect();
        let places = places.ok_or_else(|| self.complaint("actions: a joint has none"))?;
        Ok(Export {
            file: self.name,
            joints,
            places,
        })
    }

    fn joint(
        &self,
        base: &'a Base,
        deploy: &Deploy,
        index: usize,
        drive: Drive,
        action: ActionPlan,
    ) -> Result<ExportedJoint<'a>, ConfigError> {
        let motor = deploy.joint_ids_map[index];
        let joint = base.of_motor(motor).ok_or_else(|| {
            self.complaint(format!(
                "joint_ids_map: {} knows no motor {motor}",
                base.file
            ))
        })?;
        if joint.drive != drive {
            let [is, has] = match drive {
                Drive::Position => ["a wheel", POSITION],
                Drive::Speed => ["no wheel", SPEED],
            };
            return Err(self.complaint(format!(
                "actions: {} is {is} (wheel_indices in {}), and has a {has}",
                joint.name, base.file
            )));
        }
        Ok(ExportedJoint {
            base: joint,
            default_rad: deploy.default_joint_pos[index],
            kp: deploy.stiffness[motor],
            kd: deploy.damping[motor],
            action,
        })
    }

    /// Joints of an action term, by their places in the export, with what their actions mean.
    fn plans(
        &self,
        term: &str,
        action: &Action,
        count: usize,
    ) -> Result<Vec<(usize, ActionPlan)>, ConfigError> {
        let joints = self.joints(
            &format!("actions: {term}: joint_ids"),
            &action.joint_ids,
            count,
        )?;
        let clips = action
            .clip
            .clone()
            .unwrap_or_else(|| vec![UNLIMITED; joints.len()]);
        for (key, found) in [
            ("scale", action.scale.len()),
            ("offset", action.offset.len()),
            ("clip", clips.len()),
        ] {
            self.check_length(&format!("actions: {term}: {key}"), found, joints.len())?;
        }
        if clips.iter().any(|[low, high]| low > high) {
            return Err(self.complaint(format!(
                "actions: {term}: clip: a range ends below its start"
            )));
        }
        let plans = joints.into_iter().enumerate().map(|(n, joint)| {
            let plan = ActionPlan {
                clip: UNLIMITED,
                scale: action.scale[n],
                offset: action.offset[n],
                target_range: clips[n],
            };
            (joint, plan)
        });
        Ok(plans.collect())
    }

    fn term(
        &self,
        name: &'a str,
        term: &Term,
        count: usize,
    ) -> Result<ExportedTerm<'a>, ConfigError> {
        let key = format!("observations: {name}");
        let ids = term
            .params
            .asset_cfg
            .as_ref()
            .and_then(|it| it.joint_ids.as_ref());
        let joints = ids.map(|ids| self.joints(&format!("{key}: joint_ids"), ids, count));
        let clip = term.clip.unwrap_or(UNLIMITED);
        if clip[0] > clip[1] {
            return Err(self.complaint(format!("{key}: clip: it ends below its start")));
        }
        Ok(ExportedTerm {
            name,
            joints: joints.transpose()?,
            scale: Some(term.scale.clone()),
            clip,
            history: term.history_length,
        })
    }

    /// Numbers of joints. Python's slice of all is written as three nulls.
    fn joints(&self, key: &str, ids: &Value, count: usize) -> Result<Vec<usize>, ConfigError> {
        let is_all = ids
            .as_array()
            .is_some_and(|it| it.len() == 3 && it.iter().all(Value::is_null));
        if is_all {
            return Ok((0..count).collect());
        }
        let numbers = Vec::<usize>::deserialize(ids).ok();
        let numbers = numbers.filter(|numbers| numbers.iter().all(|it| *it < count));
        numbers.ok_or_else(|| {
            self.complaint(format!(
                "{key}: {ids} is no list of joints from 0 to {}",
                count - 1
            ))
        })
    }
}

/// A map in the order of the file.
struct Ordered<T>(Vec<(String, T)>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Ordered<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = Ordered<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a map")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Ordered(entries))
            }
        }
        deserializer.deserialize_map(Entries(PhantomData))
    }
}
