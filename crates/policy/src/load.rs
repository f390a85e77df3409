//! A policy with its network.

use std::path::{Path, PathBuf};

use crate::{
    PolicyDescription,
    config::{self, ConfigError, MODEL_FILE},
    model::{Model, ModelError},
    observation::Layout,
};

/// A policy that cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// Its files describe none.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Its network cannot be used, or is another policy's.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The network was trained with the same joints in another order.
    #[error(
        "{}: its metadata say that its joints are {}, and the configuration has {}: joint_mapping gives the motor of each \
         joint in the network's order",
        file.display(), trained.join(", "), configured.join(", ")
    )]
    JointOrder {
        /// The network's file.
        file: PathBuf,
        /// Joints in the order of the network.
        trained: Vec<String>,
        /// Joints in the order of the configuration.
        configured: Vec<String>,
    },
}

/// Reads the policy `policies/ROBOT/CONFIG` and its network, and checks that they fit. Without a `config.yaml` and a
/// `deploy.yaml`, the metadata of `policy.onnx` describe the policy.
///
/// # Errors
/// [`config::read`] or [`Model::read`] fails, the network's input or output has another length than the description's, or
/// its metadata name the joints in another order.
pub fn load(
    policies: &Path,
    robot: &str,
    config: &str,
) -> Result<(PolicyDescription, Model), LoadError> {
    let folder = config::folder(policies, robot, config);
    let has_model = folder.join(MODEL_FILE).exists();
    let (description, model) = if config::is_described(&folder) || !has_model {
        let description = config::read(policies, robot, config)?;
        let model = Model::read(&folder.join(&description.model_file));
        let model = model.map_err(|error| error.with_inputs(Layout::new(&description).len()))?;
        (description, model)
    } else {
        let model = Model::read(&folder.join(MODEL_FILE))?;
        let description = config::from_metadata(policies, robot, config, model.metadata())?;
        (description, model)
    };
    model.check(&Layout::new(&description), description.joints.len())?;
    check_joint_order(&description, &model)?;
    Ok((description, model))
}

/// Compares the order of the joints, if the network's metadata name the same ones.
fn check_joint_order(description: &PolicyDescription, model: &Model) -> Result<(), LoadError> {
    let Some(names) = model.metadata().get("joint_names") else {
        return Ok(());
    };
    let trained: Vec<String> = names.split(',').map(|it| it.trim().to_owned()).collect();
    let joints = description.joints.iter();
    let configured: Vec<String> = joints.map(|joint| joint.name.clone()).collect();
    let sorted = |names: &[String]| {
        let mut names = names.to_vec();
        names.sort();
        names
    };
    // Trainers may have names of their own, which say nothing of the order.
    if trained == configured || sorted(&trained) != sorted(&configured) {
        return Ok(());
    }
    Err(LoadError::JointOrder {
        file: model.file().to_owned(),
        trained,
        configured,
    })
}
