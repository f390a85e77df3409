"""An arm of STS3215 servos: joints by name in place of ids and registers."""

from __future__ import annotations

import atexit
import weakref

from .. import _core
from .._core import ServoError

__all__ = ["HomePose", "ServoController", "ServoError"]


class HomePose(dict[str, int]):
    """Home of each joint in steps. It knows its arm, so that Robot.read_joint_angles can ask for positions."""

    controller: ServoController


class ServoController(_core.ServoController):
    """An arm on a bus.

    When it ends (close, the end of a with block or of the program, also after Ctrl-C), the arm holds where it is, or, with
    ending="release", loses its torque and falls.
    """

    def __init__(self, *_arguments: object, **_named: object) -> None:
        # At the end of a program objects may live on, and the arm would not be told.
        atexit.register(_close, weakref.ref(self))

    @property
    def home_pose(self) -> HomePose:  # type: ignore[override]
        pose = HomePose(super().home_pose)
        pose.controller = self
        return pose


def _close(reference: weakref.ref[ServoController]) -> None:
    controller = reference()
    if controller is not None:
        controller.close()
