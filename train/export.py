"""Makes the network that the robot runs of a checkpoint, and checks it against onnxruntime.

    python train/export.py target/train/flat --out policy/fivebar/flat/policy.onnx
    python train/export.py --linear target/train/linear.npz --out linear.onnx
"""

import argparse
import pathlib
import subprocess

import numpy
import onnx
import onnxruntime
from onnx import TensorProto, helper, numpy_helper

# `policy/fivebar/flat/config.yaml` in words, for who finds the file alone.
JOINTS = "left_front_hip,left_rear_hip,right_front_hip,right_rear_hip,left_wheel,right_wheel"
OBSERVATION = "dof_pos,dof_vel,wheel_joint_vel,ang_vel,gravity_vec,actions"
SCALES = "dof_pos 1, dof_vel 0.05, ang_vel 0.25, commands 1 1 0.5, actions 0.25 rad and 10 rad/s"


def policy(checkpoint):
    """Reads a checkpoint's linear part and layers, with the normalisation folded in."""
    import jax

    import network
    import ppo

    file = numpy.load(checkpoint / "checkpoint.npz")
    steps = int(file["steps"])
    # Leaves come in the order of names; sizes are those of any checkpoint.
    fixed = {name: numpy.zeros(shape) for name, shape in (("weights", (6, 69)), ("biases", 6), ("mean", 69), ("deviation", 69))}
    parameters = network.begin(jax.random.key(0), 69, 6, ppo.DEVIATIONS)
    leaves, shape = jax.tree.flatten((parameters, fixed))
    parameters, fixed = jax.tree.unflatten(shape, [file[f"arr_{index}"] for index in range(len(leaves))])
    return network.folded(parameters, fixed), steps, str(file["arguments"])


def graph(linear, biases, layers):
    """The network as a graph with one input and one output."""
    nodes, constants = [], []

    def constant(name, array):
        constants.append(numpy_helper.from_array(numpy.ascontiguousarray(array, numpy.float32), name))
        return name

    names = [constant("linear.weights", linear.T), constant("linear.biases", biases)]
    nodes.append(helper.make_node("Gemm", ["obs", *names], ["linear"]))
    last = "obs"
    for index, (weights, bias) in enumerate(layers):
        out = f"layer{index}"
        names = [constant(f"{out}.weights", weights), constant(f"{out}.biases", bias)]
        nodes.append(helper.make_node("Gemm", [last, *names], [out]))
        last = out
        if index + 1 < len(layers):
            nodes.append(helper.make_node("Elu", [out], [f"{out}.elu"]))
            last = f"{out}.elu"
    nodes.append(helper.make_node("Add", ["linear", last], ["actions"]) if layers else helper.make_node("Identity", ["linear"], ["actions"]))
    inputs = [helper.make_tensor_value_info("obs", TensorProto.FLOAT, [1, linear.shape[1]])]
    outputs = [helper.make_tensor_value_info("actions", TensorProto.FLOAT, [1, linear.shape[0]])]
    return helper.make_graph(nodes, "policy", inputs, outputs, constants)


def expected(linear, biases, layers, x):
    """The same in NumPy."""
    y = x.astype(numpy.float64)
    for index, (weights, bias) in enumerate(layers):
        y = y @ weights + bias
        if index + 1 < len(layers):
            y = numpy.where(y > 0, y, numpy.expm1(numpy.minimum(y, 0)))
    return x @ linear.T + biases + (y if layers else 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkpoint", type=pathlib.Path, nargs="?", help="folder of ppo.py")
    parser.add_argument("--linear", type=pathlib.Path, help="a file of linear.py instead")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="file of the network, .onnx")
    arguments = parser.parse_args()
    if (arguments.checkpoint is None) == (arguments.linear is None):
        parser.error("give a checkpoint or --linear")
    if arguments.linear:
        file = numpy.load(arguments.linear)
        made, steps, said = (file["weights"], file["biases"], []), 0, "linear.py"
    else:
        made, steps, said = policy(arguments.checkpoint)
    model = helper.make_model(graph(*made), opset_imports=[helper.make_opsetid("", 13)], ir_version=8)
    commit = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True).stdout.strip()
    helper.set_model_props(model, {
        "joint_names": JOINTS, "observation_names": OBSERVATION, "observations_history": "0,1,2 (newest first), then commands",
        "scales": SCALES, "steps": str(steps), "arguments": said, "commit": commit or "unknown",
    })
    onnx.checker.check_model(model, full_check=True)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    onnx.save(model, arguments.out)
    session = onnxruntime.InferenceSession(arguments.out, providers=["CPUExecutionProvider"])
    worst = 0.0
    for x in numpy.random.default_rng(1).standard_normal((100, 1, made[0].shape[1])).astype(numpy.float32):
        worst = max(worst, float(numpy.abs(session.run(None, {"obs": x})[0] - expected(*made, x)).max()))
    size = arguments.out.stat().st_size
    print(f"{arguments.out}: {size} bytes, {steps} steps of training, at most {worst:.1e} from NumPy in onnxruntime")
    if worst > 1e-3:
        raise SystemExit("that is too much")


if __name__ == "__main__":
    main()
