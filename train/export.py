"""Makes the network that the robot runs of a checkpoint or of factors, and checks it against onnxruntime.

    python train/export.py --factors target/train/whole.npz --out policy/fivebar/flat/policy.onnx
    python train/export.py target/train/flat --begin target/train/whole.npz --out policy.onnx
"""

import argparse
import json
import pathlib

import numpy
import onnx
import onnxruntime
from onnx import TensorProto, helper, numpy_helper

import balance
import circuit

# `policy/fivebar/flat/config.yaml` in words, for who finds the file alone.
JOINTS = "left_front_hip,left_rear_hip,right_front_hip,right_rear_hip,left_wheel,right_wheel"
OBSERVATION = "dof_pos,dof_vel,wheel_joint_vel,ang_vel,gravity_vec,actions"
SCALES = "dof_pos 1, dof_vel 0.05, ang_vel 0.25, commands 1 1 0.5, actions 0.25 rad and 10 rad/s"


def hidden_layers(checkpoint, layers):
    """Reads the MLP of a checkpoint that began with these layers, with the normalisation folded in, and its steps."""
    import jax

    import network
    import ppo

    file = numpy.load(checkpoint / "checkpoint.npz")
    # Leaves come in the order of names; sizes are those of any checkpoint.
    fixed = {"layers": [tuple(layer) for layer in layers], "mean": numpy.zeros(69), "deviation": numpy.zeros(69)}
    parameters = network.begin(jax.random.key(0), 69, 6, ppo.DEVIATIONS)
    leaves, shape = jax.tree.flatten((parameters, fixed))
    parameters, fixed = jax.tree.unflatten(shape, [file[f"arr_{index}"] for index in range(len(leaves))])
    return network.folded(parameters, fixed), int(file["steps"]), str(file["arguments"])


class Graph:
    """Nodes and constants of a graph."""

    def __init__(self):
        self.nodes, self.constants = [], []

    def constant(self, name, array):
        self.constants.append(numpy_helper.from_array(numpy.ascontiguousarray(array, numpy.float32), name))
        return name

    def node(self, kind, inputs, output, **attributes):
        self.nodes.append(helper.make_node(kind, inputs, [output], **attributes))
        return output

    def gemm(self, name, value, weights, bias):
        return self.node("Gemm", [value, self.constant(f"{name}.weights", weights), self.constant(f"{name}.biases", bias)], name)

    def searched(self, layers):
        """Layers with clips, each of which sees the input and all layers before it."""
        seen = "obs"
        for index, (weights, bias, low, high) in enumerate(layers):
            name = f"searched{index}"
            value = self.gemm(name, seen, weights.T, bias)
            value = self.node("Max", [value, self.constant(f"{name}.low", low)], f"{name}.above")
            value = self.node("Min", [value, self.constant(f"{name}.high", high)], f"{name}.within")
            seen = self.node("Concat", [seen, value], f"{name}.all", axis=1) if index + 1 < len(layers) else seen
        return value

    def learned(self, layers):
        """An MLP with ELU between its layers."""
        value = "obs"
        for index, (weights, bias) in enumerate(layers):
            value = self.gemm(f"layer{index}", value, weights, bias)
            value = self.node("Elu", [value], f"layer{index}.elu") if index + 1 < len(layers) else value
        return value


def graph(searched, learned):
    """The network as a graph with one input and one output."""
    made = Graph()
    parts = [part(layers) for part, layers in ((made.searched, searched), (made.learned, learned)) if layers]
    made.node("Sum", parts, "actions")
    inputs = [helper.make_tensor_value_info("obs", TensorProto.FLOAT, [1, 69])]
    outputs = [helper.make_tensor_value_info("actions", TensorProto.FLOAT, [1, 6])]
    return helper.make_graph(made.nodes, "policy", inputs, outputs, made.constants)


def expected(searched, learned, x):
    """The same in NumPy."""
    y = x.astype(numpy.float64)
    for index, (weights, bias) in enumerate(learned):
        y = y @ weights + bias
        if index + 1 < len(learned):
            y = numpy.where(y > 0, y, numpy.expm1(numpy.minimum(y, 0)))
    return (circuit.run(searched, x.astype(numpy.float64)) if searched else 0.0) + (y if learned else 0.0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkpoint", type=pathlib.Path, nargs="?", help="folder of ppo.py")
    parser.add_argument("--factors", "--begin", type=pathlib.Path, help="file of whole_search.py, or a network that was made of one: the policy, or with what ppo.py began")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="file of the network, .onnx")
    arguments = parser.parse_args()
    if arguments.checkpoint is None and arguments.factors is None:
        parser.error("give a checkpoint, --factors, or both")
    searched, learned, steps, factors, said = [], [], 0, {}, "{}"
    if arguments.factors:
        factors, said = balance.read(arguments.factors)
        searched = balance.network(factors)
    if arguments.checkpoint:
        learned, steps, said = hidden_layers(arguments.checkpoint, searched)
    model = helper.make_model(graph(searched, learned), opset_imports=[helper.make_opsetid("", 13)], ir_version=8)
    # No commit: the same factors make the same file. What was learned beside them is not in the factors.
    known = {} if learned else {"factors": json.dumps(factors)}
    helper.set_model_props(model, {
        "joint_names": JOINTS, "observation_names": OBSERVATION, "observations_history": "0,1,2 (newest first), then commands",
        "scales": SCALES, "steps": str(steps), "arguments": said, **known,
    })
    onnx.checker.check_model(model, full_check=True)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    onnx.save(model, arguments.out)
    session = onnxruntime.InferenceSession(arguments.out, providers=["CPUExecutionProvider"])
    worst = 0.0
    for x in numpy.random.default_rng(1).standard_normal((100, 1, 69)).astype(numpy.float32):
        worst = max(worst, float(numpy.abs(session.run(None, {"obs": x})[0] - expected(searched, learned, x)).max()))
    size = arguments.out.stat().st_size
    print(f"{arguments.out}: {size} bytes, {steps} steps of PPO, at most {worst:.1e} from NumPy in onnxruntime")
    if worst > 1e-3:
        raise SystemExit("that is too much")


if __name__ == "__main__":
    main()
