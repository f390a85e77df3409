"""LeRobot's own driver gives a servo from the factory its id: lerobot_setup.py PORT."""

import sys
from unittest.mock import MagicMock

import deepdiff  # noqa: F401  (it looks for the real NumPy)

for module in ["accelerate", "datasets", "datasets.utils", "datasets.utils.logging", "numpy", "torch"]:
    sys.modules[module] = MagicMock()

from lerobot.motors import Motor, MotorNormMode  # noqa: E402
from lerobot.motors.feetech import FeetechMotorsBus  # noqa: E402

motors = {"wrist_flex": Motor(4, "sts3215", MotorNormMode.DEGREES)}
bus = FeetechMotorsBus(sys.argv[1], motors)
bus.setup_motor("wrist_flex")
assert bus.ping("wrist_flex") == 777
bus.port_handler.closePort()
print("done")
