"""The Gymnasium environment `aeye/Drive-v0`: an agent in one of the two seats, a bot in the other.

>>> import aeye.gym
>>> import gymnasium
>>> env = gymnasium.make("aeye/Drive-v0", checkpoint="early")
>>> observation, info = env.reset(seed=1)
>>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

`gymnasium.make_vec("aeye/Drive-v0", num_envs=8)` steps many drives together, over the cores. A seed gives the drive that
`aeye drive --seed` gives. The package does not need Gymnasium for anything else; `pip install aeye[gym]` brings it along.
"""

from importlib.util import find_spec

if find_spec("gymnasium") is None:
    raise ImportError("Gymnasium is not installed; aeye.gym needs it: pip install aeye[gym]")

import gymnasium

from aeye.gym._env import DriveEnv
from aeye.gym._rewards import WEIGHTS, Facts
from aeye.gym._vector import DriveVectorEnv

__all__ = ["WEIGHTS", "DriveEnv", "DriveVectorEnv", "Facts"]

if "aeye/Drive-v0" not in gymnasium.registry:
    gymnasium.register(
        id="aeye/Drive-v0", entry_point="aeye.gym:DriveEnv", vector_entry_point="aeye.gym:DriveVectorEnv"
    )
