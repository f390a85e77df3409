"""Writes networks with random weights, and what onnxruntime computes with them.

`python make.py FOLDER` writes FOLDER/NAME.onnx for each network and FOLDER/expected.json with inputs and outputs.
"""

import json
import sys
from pathlib import Path

import numpy as np
import onnx
import onnxruntime
from onnx import TensorProto, helper, numpy_helper

SAMPLES = 5


def value(name, shape):
    return helper.make_tensor_value_info(name, TensorProto.FLOAT, shape)


def layers(random, sizes):
    """Weights and biases of a network, as a trainer starts them."""
    for inputs, outputs in zip(sizes, sizes[1:]):
        spread = 1.0 / np.sqrt(inputs)
        yield (
            random.uniform(-spread, spread, (outputs, inputs)).astype(np.float32),
            random.uniform(-spread, spread, outputs).astype(np.float32),
        )


def by_gemm(random, sizes):
    """The form that PyTorch exports: Gemm with transposed weights, ELU between."""
    nodes, weights, last = [], [], "obs"
    for n, (weight, bias) in enumerate(layers(random, sizes)):
        weights += [numpy_helper.from_array(weight, f"w{n}"), numpy_helper.from_array(bias, f"b{n}")]
        is_last = n == len(sizes) - 2
        out = "actions" if is_last else f"y{n}"
        nodes.append(helper.make_node("Gemm", [last, f"w{n}", f"b{n}"], [out], transB=1))
        if not is_last:
            nodes.append(helper.make_node("Elu", [out], [f"x{n}"], alpha=1.0))
        last = f"x{n}"
    return nodes, weights


def by_matmul(random, sizes):
    """A normaliser, then MatMul and Add, tanh between."""
    mean = random.normal(0.0, 0.5, sizes[0]).astype(np.float32)
    spread = random.uniform(0.5, 2.0, sizes[0]).astype(np.float32)
    weights = [numpy_helper.from_array(mean, "mean"), numpy_helper.from_array(spread, "spread")]
    nodes = [
        helper.make_node("Sub", ["obs", "mean"], ["centred"]),
        helper.make_node("Div", ["centred", "spread"], ["normal"]),
    ]
    last = "normal"
    for n, (weight, bias) in enumerate(layers(random, sizes)):
        weights += [numpy_helper.from_array(weight.T.copy(), f"w{n}"), numpy_helper.from_array(bias, f"b{n}")]
        is_last = n == len(sizes) - 2
        nodes.append(helper.make_node("MatMul", [last, f"w{n}"], [f"m{n}"]))
        nodes.append(helper.make_node("Add", [f"m{n}", f"b{n}"], ["actions" if is_last else f"y{n}"]))
        if not is_last:
            nodes.append(helper.make_node("Tanh", [f"y{n}"], [f"x{n}"]))
        last = f"x{n}"
    return nodes, weights


def network(nodes, weights, inputs, outputs, metadata=()):
    graph = helper.make_graph(nodes, "policy", inputs, outputs, weights)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 11)], ir_version=8)
    for key, text in dict(metadata).items():
        entry = model.metadata_props.add()
        entry.key, entry.value = key, text
    onnx.checker.check_model(model)
    return model


def networks():
    random = np.random.default_rng(105)
    elu = by_gemm(random, [105, 512, 256, 128, 6])
    yield "elu-105", network(*elu, [value("obs", [1, 105])], [value("actions", [1, 6])])
    tanh = by_matmul(random, [69, 64, 32, 6])
    yield "tanh-69", network(*tanh, [value("obs", ["batch", 69])], [value("actions", ["batch", 6])])
    flat = by_matmul(random, [22, 16, 6])
    yield "flat-22", network(*flat, [value("obs", [22])], [value("actions", [6])])
    nodes, weights = by_gemm(random, [22, 16, 6])
    nodes.append(helper.make_node("Neg", ["obs"], ["joint_pos"]))
    outputs = [value("joint_pos", [1, 22]), value("actions", [1, 6])]
    metadata = {"joint_names": "a,b,c", "action_scale": "0.250,0.500,5.000"}
    swapped = {"joint_names": "left_front_hip,right_front_hip,left_rear_hip,right_rear_hip,left_wheel,right_wheel"}
    tanh = by_matmul(random, [69, 8, 6])
    yield "swapped-69", network(*tanh, [value("obs", [1, 69])], [value("actions", [1, 6])], swapped)
    yield "two-outputs", network(nodes, weights, [value("obs", [1, 22])], outputs, metadata)


def refused():
    """Networks that cannot drive."""
    random = np.random.default_rng(22)
    nodes, weights = by_gemm(random, [22, 16, 6])
    nodes.append(helper.make_node("Add", ["time_step", "time_step"], ["joint_pos"]))
    inputs = [value("obs", [1, 22]), value("time_step", [1, 1])]
    yield "two-inputs", network(nodes, weights, inputs, [value("actions", [1, 6]), value("joint_pos", [1, 1])])
    nodes, weights = by_gemm(random, [22, 16, 6])
    nodes += [helper.make_node("Neg", ["actions"], ["mean"]), helper.make_node("Abs", ["actions"], ["spread"])]
    yield "no-actions", network(nodes, weights, [value("obs", [1, 22])], [value("mean", [1, 6]), value("spread", [1, 6])])


def expected(model, random):
    """Inputs, and the actions of onnxruntime."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    session = onnxruntime.InferenceSession(model.SerializeToString(), options, providers=["CPUExecutionProvider"])
    shape = [1 if isinstance(size, str) else size for size in session.get_inputs()[0].shape]
    for _ in range(SAMPLES):
        observation = random.normal(0.0, 1.0, shape).astype(np.float32)
        actions = session.run(["actions"], {"obs": observation})[0]
        yield {"input": observation.ravel().tolist(), "output": actions.ravel().tolist()}


def main(folder):
    random = np.random.default_rng(1)
    samples = {}
    for name, model in networks():
        onnx.save(model, folder / f"{name}.onnx")
        samples[name] = list(expected(model, random))
    for name, model in refused():
        onnx.save(model, folder / f"{name}.onnx")
    (folder / "expected.json").write_text(json.dumps(samples))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
