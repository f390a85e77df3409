"""LeRobot's own driver calibrates and moves an arm: lerobot_arm.py PORT FILE. The test turns the shafts while it looks on."""

import dataclasses
import json
import sys
from unittest.mock import MagicMock

import deepdiff  # noqa: F401  (it looks for the real NumPy)

# The driver takes two functions from a module that imports these for others.
for module in ["accelerate", "datasets", "datasets.utils", "datasets.utils.logging", "numpy", "torch"]:
    sys.modules[module] = MagicMock()

from lerobot.motors import Motor, MotorCalibration, MotorNormMode  # noqa: E402
from lerobot.motors.feetech import FeetechMotorsBus, OperatingMode  # noqa: E402

port, file = sys.argv[1:]
JOINTS = ["shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll", "gripper"]


def arm(calibration=None):
    motors = {
        joint: Motor(place + 1, "sts3215", MotorNormMode.DEGREES)
        for place, joint in enumerate(JOINTS)
    }
    bus = FeetechMotorsBus(port, motors, calibration)
    bus.connect()
    return bus


def step(name):
    """Tells the test what has been done, and waits until it goes on."""
    print(name, flush=True)
    assert sys.stdin.readline() == "go\n"


bus = arm()
assert bus.broadcast_ping() == {place + 1: 777 for place in range(6)}
bus.disable_torque()
bus.configure_motors()
for joint in JOINTS:
    bus.write("Operating_Mode", joint, OperatingMode.POSITION.value)

# As its `lerobot-calibrate` does, all joints but the roll of the wrist.
offsets = bus.set_half_turn_homings()
assert set(bus.sync_read("Present_Position", normalize=False).values()) == {2047}
turned = [joint for joint in JOINTS if joint != "wrist_roll"]
print("turn", flush=True)
mins, maxes = bus.record_ranges_of_motion(turned)
mins["wrist_roll"], maxes["wrist_roll"] = 0, 4095
calibration = {
    joint: MotorCalibration(bus.motors[joint].id, 0, offsets[joint], mins[joint], maxes[joint])
    for joint in JOINTS
}
bus.write_calibration(calibration)
with open(file, "w") as f:
    json.dump({joint: dataclasses.asdict(c) for joint, c in calibration.items()}, f, indent=4)
bus.disconnect()
step("calibrated")

# The arm has been without power. The file says the same as the servos.
with open(file) as f:
    calibration = {joint: MotorCalibration(**c) for joint, c in json.load(f).items()}
bus = arm(calibration)
assert bus.is_calibrated, bus.read_calibration()
bus.enable_torque()
goals = {joint: 2047 + 40 * (place - 2) for place, joint in enumerate(JOINTS)}
bus.sync_write("Goal_Position", goals, normalize=False)
for _ in range(100_000):
    now = bus.sync_read("Present_Position", normalize=False)
    if all(abs(now[joint] - goals[joint]) <= 4 for joint in JOINTS):
        break
else:
    raise AssertionError(now)
degrees = bus.sync_read("Present_Position")
assert all(abs(angle) < 60 for angle in degrees.values()), degrees
step("moved")

# The gripper is stuck, and its overload ends the read.
try:
    bus.read("Min_Position_Limit", "gripper")
except RuntimeError as error:
    assert "Overload" in str(error), error
else:
    raise AssertionError("an overload that it does not see")
step("overloaded")

# A servo is missing.
try:
    arm()
except RuntimeError as error:
    assert "Missing motor IDs" in str(error) and "- 3 " in str(error), error
else:
    raise AssertionError("a missing servo that it does not see")
print("done", flush=True)
