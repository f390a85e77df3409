"""Moves an emulated arm with the document's calls: controller.py PACKAGES PORT FOLDER"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import threading
import warnings

packages, port, folder = sys.argv[1:]
sys.path.insert(0, packages)

import numpy

from jiling_arm.driver.ftservo_controller import ServoController, ServoError
from jiling_arm.ik.robot import create_so101_5dof

names = ["shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll", "gripper"]
config = {name: {"id": n, "homing_offset": 0, "range_min": 100, "range_max": 4000} for n, name in enumerate(names, 1)}
config_path = pathlib.Path(folder) / "left_arm.json"
config_path.write_text(json.dumps(config), encoding="utf-8")


def refused(kind, call, *said):
    try:
        call()
    except kind as error:
        assert all(part in str(error) for part in said), error
    else:
        raise SystemExit(f"{said} was not refused")


def settle(controller, targets):
    """Waits until the joints are there; the model moves in real time."""
    for _ in range(2000):
        positions = controller.read_servo_positions()
        if all(abs(positions[name] - steps) < 20 for name, steps in targets.items()):
            return
    raise SystemExit(f"{positions} and not {targets}")


refused(FileNotFoundError, lambda: ServoController(port, config_path="no.json"), "no.json")
refused(ConnectionError, lambda: ServoController("/dev/no-such-port", config_path=config_path), "/dev/no-such-port")
refused(ValueError, lambda: ServoController(port, config_path=config_path, ending="fall"), "hold or release")

controller = ServoController(port=port, baudrate=1000000, config_path=str(config_path))
robot = create_so101_5dof()
controller.move_all_home()
settle(controller, controller.home_pose)
controller.soft_move_to_home(step_count=3, interval=0.01)

# The document's loop: read, solve, send.
q_current = robot.read_joint_angles(robot.joint_names, controller.home_pose)
assert q_current.shape == (5,) and numpy.abs(q_current).max() < 0.05, q_current
Tep = robot.fkine(q_current)
Tep[2, 3] += 0.02
q_sol, success, reason = robot.ikine_LM(Tep, q0=q_current, mask=[1, 1, 1, 0, 0, 0])
assert success, reason
targets = robot.q_to_servo_targets(q_sol, robot.joint_names, controller.home_pose)
controller.fast_move_to_pose(targets, speed=0)
settle(controller, targets)

targets = {"shoulder_pan": 2048, "shoulder_lift": 2000}
controller.fast_move_to_pose(targets, speed=1000)
refused(ValueError, lambda: controller.fast_move_to_pose({"jaw": 1}), "jaw", "shoulder_pan")
refused(ValueError, lambda: controller.fast_move_to_pose(targets, speed=-1), "speed = -1")
refused(ValueError, lambda: controller.soft_move_to_home(0), "step_count = 0")
refused(ValueError, lambda: controller.soft_move_to_home(interval=-1.0), "interval = -1")
with warnings.catch_warnings(record=True) as warned:
    warnings.simplefilter("always")
    assert controller.limit_position("shoulder_pan", 5000) == 4000
assert "shoulder_pan" in str(warned[0].message) and warned[0].category is UserWarning, warned
states = controller.read_states()
assert set(states) == set(names) and 5 < states["gripper"]["voltage_v"] < 15, states

# Other threads run during a motion, and Ctrl-C ends it and is not swallowed. Shells start background jobs without Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)
ticks = 0


def count():
    global ticks
    while ticks < 50:
        ticks += 1
    signal.raise_signal(signal.SIGINT)


thread = threading.Timer(0.05, count)
thread.start()
try:
    controller.soft_move_to_home(step_count=400, interval=0.05)
except KeyboardInterrupt:
    assert ticks == 50
else:
    raise SystemExit("Ctrl-C was swallowed")
thread.join()
controller.soft_move_to_home(step_count=2, interval=0.0)

assert controller.has_torque
controller.close()
refused(ValueError, controller.read_servo_positions, "closed")
with ServoController(port, config_path=config_path, ending="release") as arm:
    arm.enable_torque()
# A program that ends lets go as well, although the module still holds its arm.
program = f"""
import sys
sys.path.insert(0, {packages!r})
from jiling_arm.driver.ftservo_controller import ServoController
arm = ServoController({port!r}, config_path={str(config_path)!r}, ending="release")
arm.enable_torque()
arm.itself = arm
raise KeyboardInterrupt
"""
ended = subprocess.run([sys.executable, "-I", "-c", program], capture_output=True, text=True, env=dict(os.environ))
assert "KeyboardInterrupt" in ended.stderr, ended.stderr
print("the arm moved")
