"""Writes the networks of the policies beside it: one layer that gives zeros, with as many inputs as each policy has.

`python make.py` with the package onnx; the files do not depend on its version.
"""

from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

POLICIES = Path(__file__).parent / "policies" / "fivebar"
INPUTS = {"mine": 69, "lab": 75, "named": 69}
ACTIONS = 6
JOINTS = "left_front_hip,left_rear_hip,right_front_hip,right_rear_hip,left_wheel,right_wheel"


def network(inputs):
    weight = np.zeros((ACTIONS, inputs), np.float32)
    graph = helper.make_graph(
        [helper.make_node("Gemm", ["obs", "weight"], ["actions"], transB=1)],
        "zeros",
        [helper.make_tensor_value_info("obs", TensorProto.FLOAT, [1, inputs])],
        [helper.make_tensor_value_info("actions", TensorProto.FLOAT, [1, ACTIONS])],
        [numpy_helper.from_array(weight, "weight")],
    )
    return helper.make_model(graph, ir_version=8, opset_imports=[helper.make_opsetid("", 13)])


for name, inputs in INPUTS.items():
    model = network(inputs)
    if name == "named":
        helper.set_model_props(model, {"joint_names": JOINTS})
    onnx.save(model, POLICIES / name / "policy.onnx")
