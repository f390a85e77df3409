//! A policy with its network.

use std::path::Path;

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
}

/// Reads the policy `policies/ROBOT/CONFIG` and its network, and checks that they fit. Without a `config.yaml` and a
/// `deploy.yaml`, the metadata of `policy.onnx` describe the policy.
///
/// # Errors
/// [`config::read`] or [`Model::read`] fails, or the network's input or output has another length than the description's.
pub fn load(
    policies: &Path,
    robot: &str,
    config: &str,
) -> Result<(PolicyDescription, Model), LoadError> {
    let folder = config::folder(policies, robot, config);
    let (description, model) = if config::is_described(&folder) {
        let description = config::read(policies, robot, config)?;
        let model = Model::read(&folder.join(&description.model_file))?;
        (description, model)
    } else {
        let model = Model::read(&folder.join(MODEL_FILE))?;
        let description = config::from_metadata(policies, robot, config, model.metadata())?;
        (description, model)
    };
    model.check(&Layout::new(&description), description.joints.len())?;
    Ok((description, model))
}
