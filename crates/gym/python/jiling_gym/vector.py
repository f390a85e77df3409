"""Many robots."""

import gymnasium
import numpy
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from ._core import Fleet
from .environment import MOST_SEED, spaces


class FivebarVec(VectorEnv):
    """Robots that are stepped together by threads in Rust. `threads=0` takes one a processor.

    Options and `elf` as in `Fivebar`, and `episode_s`, after which an episode is truncated. One that ends begins the next in the same
    step, and `info["final_obs"]` has the last observation of those in `info["_final_obs"]`.
    """

    metadata = {"render_modes": [], "autoreset_mode": AutoresetMode.SAME_STEP}

    def __init__(self, num_envs, threads=0, seed=0, policies=None, robot="fivebar", config="flat", elf=None, **options):
        self.fleet = Fleet(
            num_envs, threads, seed, True, policies=policies, robot=robot, config=config, elf=elf, options=options
        )
        self.num_envs = num_envs
        self.single_observation_space, self.single_action_space = spaces(self.fleet)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        drawn = None if seed is None else int(self.np_random.integers(MOST_SEED))
        return self.fleet.reset(drawn, options), {}

    def step(self, actions):
        rows = numpy.ascontiguousarray(actions, numpy.float32)
        seen, last, rewards, fallen, over = self.fleet.step(rows)
        truncated = over & ~fallen
        ended = fallen | truncated
        info = {"final_obs": last, "_final_obs": ended} if ended.any() else {}
        return seen, rewards, fallen, truncated, info
