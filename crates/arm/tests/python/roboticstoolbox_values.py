"""Writes poses, Jacobians and errors between poses as roboticstoolbox computes them: tests/data/roboticstoolbox.json.

    pip install roboticstoolbox-python==1.5.0
    python crates/arm/tests/python/roboticstoolbox_values.py > crates/arm/tests/data/roboticstoolbox.json

The arms: SO-101 from its URDF, Puma 560 and the Stanford arm (a prismatic joint) in standard, the Panda in modified
Denavit-Hartenberg parameters, and a chain of all elementary transforms with a base and a tool.
"""

import json
import pathlib
import xml.etree.ElementTree as xml

import numpy
import roboticstoolbox
from roboticstoolbox import ET, ETS
from roboticstoolbox.models.DH import Panda, Puma560, Stanford
from roboticstoolbox.tools.p_servo import angle_axis
from spatialmath import SE3

data = pathlib.Path(__file__).parents[1] / "data"


def so101():
    """The URDF as elementary transforms; its fixed-axis angles are read as ROS defines them: Rz(y) Ry(p) Rx(r)."""
    joints = {j.find("child").get("link"): j for j in xml.parse(data / "so101.urdf").getroot().iter("joint")}
    link, path = "gripper_frame_link", []
    while link in joints:
        path.insert(0, joints[link])
        link = joints[link].find("parent").get("link")
    chain = []
    for joint in path:
        x, y, z = map(float, joint.find("origin").get("xyz").split())
        roll, pitch, yaw = map(float, joint.find("origin").get("rpy").split())
        chain += [ET.tx(x), ET.ty(y), ET.tz(z), ET.Rz(yaw), ET.Ry(pitch), ET.Rx(roll)]
        if joint.get("type") != "fixed":
            chain.append(ET.Rz())
    return ETS(chain)


def elementary():
    base = ET.SE3(SE3.Tx(0.5) * SE3.Rz(0.3))
    tool = ET.SE3(SE3.Tz(0.15) * SE3.Ry(0.2))
    # One list: products of products number their joints anew.
    first = [ET.tz(0.3), ET.Rz(), ET.Rx(0.4), ET.Ry(flip=True), ET.tx(0.2), ET.tx()]
    then = [ET.Ry(-0.7), ET.Rx(), ET.ty(0.1), ET.tz(flip=True), ET.Rz(1.1), ET.ty()]
    return ETS([base, *first, *then, tool])


def rows(name, joints, fkine, jacob0, jacobe):
    random = numpy.random.default_rng(101)
    answers = []
    for _ in range(5):
        q = random.uniform(-2.5, 2.5, joints).round(6)
        pose = fkine(q)
        pose = numpy.asarray(getattr(pose, "A", pose))
        answers.append({"q": q.tolist(), "pose": pose[:3].tolist(), "jacob0": jacob0(q).tolist(), "jacobe": jacobe(q).tolist()})
    return {"arm": name, "answers": answers}


def of(name, robot):
    return rows(name, robot.n, robot.fkine, robot.jacob0, robot.jacobe)


def errors():
    """Pairs of poses and the error between them, along the world's axes: the one that a mask weighs."""
    random = numpy.random.default_rng(102)
    answers = []
    for angle in [0.0, 1e-9, 1e-4, 0.3, 1.0, 2.0, 3.0, 3.14159, numpy.pi]:
        axis = random.normal(size=3)
        current = SE3.Rt(SE3.RPY(random.uniform(-3, 3, 3)).R, random.uniform(-1, 1, 3))
        target = SE3.Rt(SE3.AngleAxis(angle, axis).R @ current.R, random.uniform(-1, 1, 3))
        error = angle_axis(current.A, target.A)
        answers.append({"current": current.A[:3].tolist(), "target": target.A[:3].tolist(), "error": error.tolist()})
    return answers


if __name__ == "__main__":
    arms = [of("so101", so101()), of("elementary", elementary())]
    arms += [of("puma560", Puma560()), of("stanford", Stanford()), of("panda", Panda())]
    print(json.dumps({"roboticstoolbox": roboticstoolbox.__version__, "arms": arms, "errors": errors()}))
