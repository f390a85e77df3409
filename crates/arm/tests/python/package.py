"""Installs jiling_arm into a folder of its own, and checks it: package.py REPOSITORY FOLDER"""

import ast
import inspect
import pathlib
import subprocess
import sys

repository, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
packages = folder / "packages"
pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-input", "--no-deps", "--no-build-isolation", "--upgrade"]
subprocess.run([*pip, "--target", str(packages), str(repository / "crates/arm")], check=True)
sys.path.insert(0, str(packages))

import numpy

import jiling_arm._core
from jiling_arm.ik.DH import DHLink
from jiling_arm.ik.et import ET
from jiling_arm.ik.robot import Robot, create_so101_5dof


def refused(kind, call, *said):
    """The call raises an error of this kind that says this."""
    try:
        call()
    except kind as error:
        assert all(part in str(error) for part in said), error
    else:
        raise SystemExit(f"{said} was not refused")


def snippets_of_the_document():
    robot = create_so101_5dof()
    q = numpy.array([0.2, -0.4, 0.5, 0.3, 0.1])
    T_end = robot.fkine(q)
    assert T_end.shape == (4, 4) and T_end.dtype == numpy.float64
    Tep = T_end.copy()
    Tep[2, 3] += 0.01
    q_sol, success, reason = robot.ikine_LM(Tep, q0=q, mask=[1, 1, 1, 0, 0, 0])
    assert success is True and reason.startswith("converged in "), reason
    assert numpy.abs(robot.fkine(q_sol)[:3, 3] - Tep[:3, 3]).max() < 1e-6
    home_pose = dict.fromkeys(robot.joint_names, 2048)
    targets = robot.q_to_servo_targets(q_sol, robot.joint_names, home_pose)
    steps = {name: round(2048 + angle * 4096 / (2 * numpy.pi)) for name, angle in zip(robot.joint_names, q_sol)}
    assert targets == steps, (targets, steps)
    back = robot.read_joint_angles(robot.joint_names, home_pose, targets)
    assert numpy.abs(back - q_sol).max() < numpy.pi / 4096 * 1.001
    refused(TypeError, lambda: robot.read_joint_angles(robot.joint_names, home_pose), "positions=controller.read_servo_positions()")


def gears_are_live():
    robot = create_so101_5dof()
    robot.gear_sign["elbow_flex"] = -1
    robot.gear_ratio["elbow_flex"] = 2.5
    targets = robot.q_to_servo_targets([numpy.pi / 10], ["elbow_flex"], {"elbow_flex": 2000})
    assert targets == {"elbow_flex": 2000 - 512}, targets
    robot.gear_sign = {"jaw": -1}
    refused(ValueError, lambda: robot.q_to_servo_targets([0], ["elbow_flex"], {"elbow_flex": 0}), "no joint jaw")


def answers_in_words():
    robot = create_so101_5dof()
    home, q0 = robot.fkine(numpy.zeros(5)), numpy.zeros(5)
    far = home.copy()
    far[0, 3] = 1.0
    for Tep, q, mask, said in [
        (far, q0, [1, 1, 1, 0, 0, 0], "out of reach: "),
        (home * numpy.nan, q0, None, "the target holds NaN"),
        (home * 2, q0, None, "the target is no pose"),
        (home, q0[:4], None, "q0 has 4 values, and 5 are needed"),
        (home, q0, [1, 1, 1], "the mask has 3 weights, and 6 are needed"),
        (home, q0, [0] * 6, "at least one is above 0"),
    ]:
        q_sol, success, reason = robot.ikine_LM(Tep, q0=q, mask=mask)
        assert success is False and said in reason and len(q_sol) == len(q), reason
    step, success, reason = robot.ik_follow(far, q0, mask=[1, 1, 1, 0, 0, 0], largest_change=0.02)
    assert not success and reason.startswith("on the way: ") and 0 < numpy.abs(step).max() <= 0.02 + 1e-12, reason
    refused(ValueError, lambda: robot.fkine([0, 0]), "q has 2 values, and 5 are needed")
    refused(ValueError, lambda: robot.ikine_LM(numpy.eye(3)), "3 x 3 numbers, and 4 x 4 are needed")


def other_arms():
    robot = create_so101_5dof()
    urdf = repository / "crates/arm/tests/data/so101.urdf"
    same = Robot.from_urdf(urdf, tip="gripper_frame_link")
    q = numpy.array([0.3, 0.2, 0.1, -0.1, 0.5])
    assert numpy.allclose(same.fkine(q), robot.fkine(q), atol=1e-12)
    assert (same.qlim == robot.qlim).all() and same.joint_names == robot.joint_names
    refused(ValueError, lambda: Robot.from_urdf(urdf), "so101.urdf: line 4: say which link is the tip")
    refused(OSError, lambda: Robot.from_urdf("no.urdf"), "no.urdf: cannot be read")
    planar = Robot([ET.Rz(), ET.tx(0.3), ET.Rz(flip=True), ET.tx(0.2)], ["a", "b"], [[-2, -2], [2, 2]])
    x, y = planar.fkine([0.5, 0.2])[:2, 3]
    assert numpy.allclose([x, y], [0.3 * numpy.cos(0.5) + 0.2 * numpy.cos(0.3), 0.3 * numpy.sin(0.5) + 0.2 * numpy.sin(0.3)])
    rows = [DHLink(a=0.3), DHLink(a=0.2, flip=True)]
    assert numpy.allclose(Robot.from_dh(rows, ["a", "b"]).fkine([0.5, 0.2]), planar.fkine([0.5, 0.2]))
    planar.tool = [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    assert numpy.allclose(planar.fkine([0, 0])[:3, 3], [0.6, 0, 0])
    speed = planar.jacob0([0, 0])[:, 0]
    assert numpy.allclose(speed, [0, 0.6, 0, 0, 0, 1]), speed


def stub_and_module_agree():
    """Each name, and each argument, is in both."""
    stub = ast.parse((packages / "jiling_arm/_core.pyi").read_text(encoding="utf-8"))
    core = jiling_arm._core

    def names(body):
        functions = {it.name for it in body if isinstance(it, (ast.FunctionDef, ast.ClassDef))}
        return functions | {it.target.id for it in body if isinstance(it, ast.AnnAssign)}

    public = lambda it: {name for name in vars(it) if not name.startswith("_")}
    assert names(stub.body) == public(core), names(stub.body) ^ public(core)
    for node in (it for it in stub.body if isinstance(it, ast.ClassDef)):
        real = getattr(core, node.name)
        told = {name for name in names(node.body) if not name.startswith("_")}
        assert told == public(real), (node.name, told ^ public(real))
        for method in (it for it in node.body if isinstance(it, ast.FunctionDef)):
            if callable(getattr(real, method.name)) and not method.name.startswith("__"):
                arguments = [it.arg for it in (*method.args.args, *method.args.kwonlyargs)]
                assert arguments == list(inspect.signature(getattr(real, method.name)).parameters), method.name


snippets_of_the_document()
gears_are_live()
answers_in_words()
other_arms()
stub_and_module_agree()
print("all of it runs")
