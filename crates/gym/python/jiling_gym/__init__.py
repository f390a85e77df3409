"""The Jiling robot as Gymnasium environments.

    import gymnasium, jiling_gym
    env = gymnasium.make("FivebarFlat-v0")
    envs = jiling_gym.FivebarVec(64, threads=2)

The firmware's own app runs in each, and a simulated robot around it. Observations and actions are those of
`policy/fivebar/flat/config.yaml`. The reward's formula is in `crates/gym/src/reward.rs`.
"""

from gymnasium.envs.registration import register

from .environment import Fivebar
from .vector import FivebarVec

__all__ = ["Fivebar", "FivebarVec"]

register(id="FivebarFlat-v0", entry_point="jiling_gym.environment:Fivebar", max_episode_steps=500)
