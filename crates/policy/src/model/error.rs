//! Why a network cannot drive.

use std::path::{Path, PathBuf};

use tract_onnx::prelude::TractError;

use crate::observation::Mismatch;

/// A network that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// The file is TorchScript.
    #[error(
        "{}: TorchScript is not read here. This makes ONNX of it{}; then name the new file in model_name:\n  {}",
        file.display(),
        if inputs.is_none() { ", where N is the length of the input" } else { "" },
        conversion(file, onnx, *inputs)
    )]
    TorchScript {
        /// The file.
        file: PathBuf,
        /// The file to be made.
        onnx: PathBuf,
        /// Length of the input, where it is known.
        inputs: Option<usize>,
    },
    /// The file is missing, is no ONNX, or holds what tract cannot run.
    #[error("{}: {message}", file.display())]
    Unusable {
        /// The file.
        file: PathBuf,
        /// Why.
        message: String,
    },
    /// The network has no input, or several.
    #[error(
        "{}: its inputs are {inputs:?}, and a policy has one, the observation. A network with a state or a motion of its \
         own cannot be run here",
        file.display()
    )]
    Inputs {
        /// The file.
        file: PathBuf,
        /// Names of the inputs.
        inputs: Vec<String>,
    },
    /// The network has several outputs.
    #[error("{}: its outputs are {outputs:?}, and none of them is called \"actions\"", file.display())]
    Outputs {
        /// The file.
        file: PathBuf,
        /// Names of the outputs.
        outputs: Vec<String>,
    },
    /// The network's input is not what the configuration says.
    #[error("{}: {mismatch}", file.display())]
    Mismatch {
        /// The file.
        file: PathBuf,
        /// The difference.
        mismatch: Box<Mismatch>,
    },
    /// The network's output is not one value for each joint.
    #[error(
        "{}: the network gives {found} actions, and the configuration has {wanted} joints (num_of_dofs)",
        file.display()
    )]
    Actions {
        /// The file.
        file: PathBuf,
        /// Values of the network.
        found: usize,
        /// Joints of the policy.
        wanted: usize,
    },
    /// A slice does not fit the network.
    #[error("the {what} of the network has {wanted} values, not {found}")]
    Length {
        /// Input or output.
        what: &'static str,
        /// Values that were given.
        found: usize,
        /// Values of the network.
        wanted: usize,
    },
}

impl ModelError {
    /// Adds the length that the input has by the configuration.
    #[must_use]
    pub(crate) fn with_inputs(self, len: usize) -> Self {
        match self {
            Self::TorchScript { file, onnx, .. } => Self::TorchScript {
                file,
                onnx,
                inputs: Some(len),
            },
            other => other,
        }
    }

    pub(super) fn unusable(file: &Path, error: &TractError) -> Self {
        Self::Unusable {
            file: file.to_owned(),
            message: format!("{error:#}"),
        }
    }
}

/// The command that makes ONNX of TorchScript.
fn conversion(file: &Path, onnx: &Path, inputs: Option<usize>) -> String {
    let inputs = inputs.map_or("N".to_owned(), |it| it.to_string());
    let [file, onnx] = [file, onnx].map(|it| it.display());
    format!(
        "python3 -c \"import torch; torch.onnx.export(torch.jit.load('{file}', map_location='cpu').eval(), torch.zeros(1, {inputs}), \
         '{onnx}', input_names=['obs'], output_names=['actions'], dynamo=False)\""
    )
}
