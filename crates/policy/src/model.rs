//! The network: an ONNX file, run by tract.

mod bench;
mod error;

pub use bench::{Bench, BenchReport};
pub use error::ModelError;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::Arc,
};

use tract_onnx::{
    prelude::*,
    tract_hir::internal::{Factoid, ShapeFactoid},
};

use crate::observation::{Layout, Mismatch};

/// Key of the metadata in tract's properties of a model.
const METADATA: &str = "onnx.metadata_props.";
/// The output that is taken of several.
const ACTIONS: &str = "actions";

/// A network with one input and one output of a fixed length.
pub struct Model {
    file: PathBuf,
    metadata: BTreeMap<String, String>,
    input: Arc<Tensor>,
    state: TypedSimpleState,
    output_len: usize,
}

impl Model {
    /// Reads an ONNX file, and runs it once: what a run allocates is then known to be there.
    ///
    /// # Errors
    /// The file is missing or no ONNX, TorchScript in particular; the network has several inputs, or values that are not
    /// 32-bit floats, or an operator that tract lacks.
    pub fn read(file: &Path) -> Result<Self, ModelError> {
        refuse_torch_script(file)?;
        let unusable = |error: TractError| ModelError::unusable(file, &error);
        let mut graph = graph(file).map_err(unusable)?;
        let names = |outlets: &[OutletId]| -> Vec<String> {
            let names = outlets.iter().map(|it| graph.node(it.node).name.clone());
            names.collect()
        };
        let inputs = names(&graph.inputs);
        if inputs.len() != 1 {
            return Err(ModelError::Inputs {
                file: file.to_owned(),
                inputs,
            });
        }
        let metadata = metadata(&graph);
        keep_actions(file, &mut graph)?;
        let input = Arc::new(input(&graph).map_err(unusable)?);
        let state = plan(graph, &input).map_err(unusable)?;
        let mut model = Self {
            file: file.to_owned(),
            metadata,
            input,
            state,
            output_len: 0,
        };
        model.output_len = model.first_run()?;
        Ok(model)
    }

    /// Returns the file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Returns the number of values that the network takes.
    pub fn input_len(&self) -> usize {
        self.input.len()
    }

    /// Returns the number of values that the network gives.
    pub fn output_len(&self) -> usize {
        self.output_len
    }

    /// Returns the metadata of the file, as a trainer may have written it.
    pub fn metadata(&self) -> &BTreeMap<String, String> {
        &self.metadata
    }

    /// Compares the network with a policy: the length of its input with the layout, and that of its output with the joints.
    ///
    /// # Errors
    /// They differ.
    pub fn check(&self, layout: &Layout, joints: usize) -> Result<(), ModelError> {
        let input = layout.check(self.input_len());
        input.map_err(|mismatch| self.mismatch(mismatch))?;
        if self.output_len == joints {
            Ok(())
        } else {
            Err(ModelError::Actions {
                file: self.file.clone(),
                found: self.output_len,
                wanted: joints,
            })
        }
    }

    fn mismatch(&self, mismatch: Mismatch) -> ModelError {
        ModelError::Mismatch {
            file: self.file.clone(),
            mismatch: Box::new(mismatch),
        }
    }

    /// Runs the network. Each run allocates, and frees, the same as the first.
    ///
    /// # Errors
    /// A slice has another length, or the network fails.
    pub fn run(&mut self, input: &[f32], output: &mut [f32]) -> Result<(), ModelError> {
        for (what, found, wanted) in [
            ("input", input.len(), self.input_len()),
            ("output", output.len(), self.output_len),
        ] {
            if found != wanted {
                return Err(ModelError::Length {
                    what,
                    found,
                    wanted,
                });
            }
        }
        let values = self.evaluate(input);
        values
            .and_then(|values| {
                output.copy_from_slice(slice(&values)?);
                Ok(())
            })
            .map_err(|error| ModelError::unusable(&self.file, &error))
    }

    fn evaluate(&mut self, input: &[f32]) -> TractResult<TValue> {
        let tensor = Arc::make_mut(&mut self.input);
        let mut view = tensor.try_as_plain_ram_mut()?;
        view.as_slice_mut::<f32>()?.copy_from_slice(input);
        let outputs = self
            .state
            .run(tvec!(TValue::from_const(self.input.clone())))?;
        let actions = outputs.into_iter().next();
        actions.ok_or_else(|| TractError::msg("it gives no output"))
    }

    /// Returns the length of the output.
    fn first_run(&mut self) -> Result<usize, ModelError> {
        let zeros = vec![0.0; self.input_len()];
        let values = self.evaluate(&zeros);
        let len = values.and_then(|values| Ok(slice(&values)?.len()));
        len.map_err(|error| ModelError::unusable(&self.file, &error))
    }
}

fn slice(values: &TValue) -> TractResult<&[f32]> {
    values.try_as_plain_ram()?.as_slice::<f32>()
}

fn refuse_torch_script(file: &Path) -> Result<(), ModelError> {
    let extension = file.extension().and_then(|it| it.to_str()).unwrap_or("");
    if ["pt", "pth", "jit"].contains(&extension) {
        Err(ModelError::TorchScript {
            file: file.to_owned(),
            onnx: file.with_extension("onnx"),
            inputs: None,
        })
    } else {
        Ok(())
    }
}

fn graph(file: &Path) -> TractResult<InferenceModel> {
    let mut graph = tract_onnx::onnx().model_for_path(file)?;
    // A batch of unknown size is a batch of one.
    for place in 0..graph.inputs.len() {
        let fact = graph.input_fact(place)?.clone();
        let dims = fact.shape.dims().map(|dim| match dim.concretize() {
            Some(known) if known.to_i64().is_ok() => dim.clone(),
            _ => 1.to_dim().into(),
        });
        let shape = ShapeFactoid::closed(dims.collect());
        graph.set_input_fact(place, fact.with_shape(shape))?;
    }
    Ok(graph)
}

fn metadata(graph: &InferenceModel) -> BTreeMap<String, String> {
    let entries = graph.properties.iter().filter_map(|(key, value)| {
        let key = key.strip_prefix(METADATA)?.to_owned();
        let view = value.try_as_plain_ram().ok()?;
        Some((key, view.as_slice::<String>().ok()?.first()?.clone()))
    });
    entries.collect()
}

/// Drops all outputs but the actions.
fn keep_actions(file: &Path, graph: &mut InferenceModel) -> Result<(), ModelError> {
    let label = |outlet: &OutletId| match graph.outlet_label(*outlet) {
        Some(label) => label.to_owned(),
        None => graph.node(outlet.node).name.clone(),
    };
    let outputs: Vec<String> = graph.outputs.iter().map(label).collect();
    let actions = match outputs.len() {
        1 => Some(0),
        _ => outputs.iter().position(|name| name == ACTIONS),
    };
    let Some(actions) = actions else {
        return Err(ModelError::Outputs {
            file: file.to_owned(),
            outputs,
        });
    };
    graph.outputs = vec![graph.outputs[actions]];
    Ok(())
}

fn input(graph: &InferenceModel) -> TractResult<Tensor> {
    let fact = graph.input_fact(0)?;
    let shape = fact.shape.as_concrete_finite()?;
    let shape = shape.ok_or_else(|| TractError::msg("the shape of its input is unknown"))?;
    let kind = fact.datum_type.concretize();
    if kind.is_some_and(|kind| kind != f32::datum_type()) {
        let message = format!("its input is {kind:?}, and observations are 32-bit floats");
        return Err(TractError::msg(message));
    }
    Tensor::zero::<f32>(&shape)
}

fn plan(mut graph: InferenceModel, input: &Tensor) -> TractResult<TypedSimpleState> {
    graph.set_input_fact(0, f32::fact(input.shape()).into())?;
    graph.into_optimized()?.into_runnable()?.spawn()
}
