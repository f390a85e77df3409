from os import PathLike
from typing import Any

import numpy
from numpy.typing import ArrayLike, NDArray

_Array = NDArray[numpy.float64]

class ET:
    """An elementary transform: ET.Rz(0.3) is fixed, and ET.Rz() a joint. Angles in rad, lengths in m."""

    @staticmethod
    def Rx(eta: float | None = None, flip: bool = False) -> ET: ...
    @staticmethod
    def Ry(eta: float | None = None, flip: bool = False) -> ET: ...
    @staticmethod
    def Rz(eta: float | None = None, flip: bool = False) -> ET: ...
    @staticmethod
    def tx(eta: float | None = None, flip: bool = False) -> ET: ...
    @staticmethod
    def ty(eta: float | None = None, flip: bool = False) -> ET: ...
    @staticmethod
    def tz(eta: float | None = None, flip: bool = False) -> ET: ...
    @staticmethod
    def SE3(pose: ArrayLike) -> ET:
        """A fixed pose, 4 x 4."""
    @property
    def isjoint(self) -> bool: ...

class DHLink:
    """A row of Denavit-Hartenberg parameters, in m and rad."""

    def __new__(
        cls,
        d: float = 0.0,
        alpha: float = 0.0,
        theta: float = 0.0,
        a: float = 0.0,
        prismatic: bool = False,
        flip: bool = False,
    ) -> DHLink: ...

class Robot:
    """A serial arm. Angles in rad, lengths in m; poses are those of the tool in the world, 4 x 4."""

    def __new__(cls, ets: list[ET], joint_names: list[str], qlim: Any = None, name: str = "arm") -> Robot:
        """A chain of elementary transforms. qlim is [[lower, ...], [upper, ...]], and -pi to pi without it."""
    @staticmethod
    def from_dh(
        links: list[DHLink], joint_names: list[str], qlim: Any = None, modified: bool = False, name: str = "arm"
    ) -> Robot:
        """A chain of standard Denavit-Hartenberg rows, or of modified ones (Craig's)."""
    @staticmethod
    def from_urdf(path: str | PathLike[str], base: str | None = None, tip: str | None = None) -> Robot:
        """The arm between two links of a URDF file: without base from its root, without tip to its only end."""
    @property
    def name(self) -> str: ...
    @property
    def n(self) -> int:
        """Joints of the arm."""
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def qlim(self) -> _Array:
        """Limits: [[lower, ...], [upper, ...]]."""
    gear_sign: dict[str, float]
    """1 if a servo's steps grow with the joint's angle, -1 if they shrink."""
    gear_ratio: dict[str, float]
    """Turns of a servo's shaft for one of the joint."""
    base: _Array
    """Where the base is in the world."""
    tool: _Array
    """Where the tool is in the chain's last frame."""
    def fkine(self, q: ArrayLike) -> _Array: ...
    def jacob0(self, q: ArrayLike) -> _Array:
        """6 x n along the world's axes: velocity above, angular velocity below."""
    def jacobe(self, q: ArrayLike) -> _Array:
        """As jacob0, along the tool's axes."""
    def ikine_LM(
        self,
        Tep: ArrayLike,
        q0: ArrayLike | None = None,
        mask: ArrayLike | None = None,
        *,
        tol: float = 1e-6,
        searches: int = 100,
        seed: int = 0,
    ) -> tuple[_Array, bool, str]:
        """Joint values for a pose: (q, success, reason). The mask weighs [x, y, z, rx, ry, rz].

        q is within the limits: at Tep, or as close to it as was found. q0 is the middle of the limits if it is not given. It
        may end on another branch than q0: a moving arm takes ik_follow."""
    def ik_follow(
        self,
        Tep: ArrayLike,
        q: ArrayLike,
        mask: ArrayLike | None = None,
        *,
        largest_change: float = 0.05,
        tol: float = 1e-6,
    ) -> tuple[_Array, bool, str]:
        """One step from q towards a pose: (q, success, reason). No joint moves further than largest_change."""
    def q_to_servo_targets(
        self, q_rad: ArrayLike, joint_names: list[str], home_pose: dict[str, int]
    ) -> dict[str, int]:
        """Steps: home + sign * ratio * q * 4096 / (2 pi), to the nearest one."""
    def read_joint_angles(
        self, joint_names: list[str], home_pose: dict[str, int], positions: dict[str, int] | None = None
    ) -> _Array:
        """Angles: sign * (steps - home) / (ratio * 4096 / (2 pi)), of positions, or as a ServoController reads them now if
        home_pose is its own."""

def create_so101_5dof() -> Robot:
    """The SO-101 without its gripper: five joints."""

class ServoError(RuntimeError):
    """A servo did not answer as it should. The others can still be asked."""

class ServoController:
    """An arm on a bus. Positions are steps, 4096 a turn, by the joint's name.

    A port that fails raises ConnectionError, a servo that does not answer ServoError, and a wrong argument or calibration
    ValueError. What was done otherwise than asked is a warning (UserWarning). Ctrl-C stops a motion where it is."""

    def __new__(
        cls,
        port: str,
        baudrate: int = 1000000,
        config_path: str | PathLike[str] = "servo_config.json",
        ending: str = "hold",
    ) -> ServoController: ...
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def home_pose(self) -> dict[str, int]: ...
    @property
    def has_torque(self) -> bool: ...
    def move_all_home(self) -> None:
        """As fast as the servos can, which can strike."""
    def soft_move_to_home(self, step_count: int = 20, interval: float = 0.05) -> None:
        """Over so many goals, interval seconds apart."""
    def soft_move_to_pose(self, targets: dict[str, int], step_count: int = 20, interval: float = 0.05) -> None: ...
    def fast_move_to_pose(self, targets: dict[str, int], speed: int = 0) -> None:
        """All joints begin at the same moment. speed is in steps/s, and 0 is as fast as the servo can."""
    def read_servo_positions(self) -> dict[str, int]: ...
    def read_states(self) -> dict[str, dict[str, float]]:
        """position_steps, speed_steps_s, load_permille, voltage_v, temperature_c and current_ma of each joint."""
    def limit_position(self, name: str, steps: int) -> int:
        """The target within the joint's limits, with a warning if it was not."""
    def enable_torque(self) -> None:
        """Without a jump: each joint's goal becomes the place where it is."""
    def hold(self) -> None:
        """The arm stops and stays."""
    def release(self) -> None:
        """Torque off: the arm falls."""
    def recover(self, name: str) -> str:
        """Brings a joint back that protects itself, and says what became of it. For a moment it has no torque."""
    def reconnect(self, timeout: float = 10.0) -> None:
        """Waits for a port that was pulled out, and opens it again."""
    def close(self) -> None: ...
    def __enter__(self) -> ServoController: ...
    def __exit__(self, *_why: object) -> None: ...
