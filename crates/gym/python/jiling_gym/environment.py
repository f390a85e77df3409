"""One robot."""

import gymnasium
import numpy

from ._core import Fleet

# An episode ends by Gymnasium's TimeLimit; the robot's own limit never comes.
NEVER_S = 1e6
# Of every value of the observation (clip_obs).
OBSERVED = 100.0
MOST_SEED = 2**32


def spaces(fleet):
    """Returns the spaces of an observation and of an action."""
    low, high = (numpy.array(limit, numpy.float32) for limit in fleet.action_limits)
    observed = gymnasium.spaces.Box(-OBSERVED, OBSERVED, (fleet.observation_len,), numpy.float32)
    return observed, gymnasium.spaces.Box(low, high, dtype=numpy.float32)


class Fivebar(gymnasium.Env):
    """A two-wheeled robot with five-bar legs. A step lasts 20 ms.

    Options, here or in `reset(options={...})`: `start` ("mixed", "sitting", "standing"), `vary`, `push_mps`, `push_every_s`,
    `speed_mps`, `turn_rps`, `command_every_s`, `episodes_per_robot`. `info` is what only the simulator knows, by name, with
    the command. An episode ends when the robot falls or its firmware stops it. With `elf`, the path of a firmware image, the image
    runs in the emulated board in place of the app: it boots for each episode, and every episode begins sitting.
    """

    metadata = {"render_modes": []}

    def __init__(self, policies=None, robot="fivebar", config="flat", elf=None, render_mode=None, **options):
        if render_mode is not None:
            raise ValueError(f"render_mode {render_mode!r}: there are no pictures, only render_mode None")
        self.render_mode = None
        self._fleet = Fleet(
            1, 1, 0, False, policies=policies, robot=robot, config=config, elf=elf, options={"episode_s": NEVER_S, **options}
        )
        self.observation_space, self.action_space = spaces(self._fleet)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        # A robot follows from the seed alone, so that equal seeds are equal episodes.
        drawn = None if seed is None else int(self.np_random.integers(MOST_SEED))
        return self._fleet.reset(drawn, options)[0], self._info()

    def step(self, action):
        row = numpy.asarray(action, numpy.float32).reshape(1, -1)
        seen, _, reward, fallen, _ = self._fleet.step(row)
        return seen[0], float(reward[0]), bool(fallen[0]), False, self._info()

    def command(self, forward_mps, yaw_rps):
        """Commands the robot until the end of the episode; the next observation shows it."""
        self._fleet.command(0, forward_mps, yaw_rps)

    def push(self, forward_mps, left_mps):
        """Pushes the robot, so that its speed changes by this."""
        self._fleet.push(0, forward_mps, left_mps)

    def _info(self):
        forward_mps, yaw_rps = self._fleet.commands()[0]
        return {**self._fleet.truth(0), "command": {"forward_mps": forward_mps, "yaw_rps": yaw_rps}}
