"""How many steps a second environments of Gymnasium make: `aeye/Drive-v0` beside a plain loop in Rust and simulators of others.

Usage: gym.py EPISODE_SPEED [DRIVES [REPEATS]]

All take turns, on the cores that there are, and the median of each counts, so that what else the machine does meets all of
them. A peer that is not installed, or cannot start (MetaDrive fetches its models when it first does), is left out and named.
"""

import importlib.util
import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import aeye.gym  # registers aeye/Drive-v0
import gymnasium
import numpy as np

CORES = len(os.sched_getaffinity(0))
# Before it is armed, after 3 s, nothing ends a run; so long is a round.
ROUNDS, STEPS = 3, 29


def of_the_loop(program: str, drives: int) -> float:
    command = [program, *map(str, (drives, ROUNDS, STEPS, CORES))]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["steps_a_second"]


def of_ours(drives: int) -> float:
    envs = gymnasium.make_vec("aeye/Drive-v0", drives, map="city")
    action = np.tile(np.array([0, 1, 0], np.float32), (drives, 1))
    envs.reset(seed=0)
    envs.step(action)
    begin = time.perf_counter()
    for number in range(ROUNDS):
        envs.reset(seed=number * drives)
        for _ in range(STEPS):
            envs.step(action)
    seconds = time.perf_counter() - begin
    envs.close()
    return ROUNDS * STEPS * drives / seconds


def of_env(make: Callable[[], gymnasium.Env]) -> float:
    """Steps of one environment, which is what simulators of others step in a process, for three seconds after the first one."""
    env = make()
    env.reset(seed=0)
    env.step(env.action_space.sample())
    begin, steps = time.perf_counter(), 0
    while (seconds := time.perf_counter() - begin) < 3:
        *_, terminated, truncated, _ = env.step(env.action_space.sample())
        steps += 1
        if terminated or truncated:
            env.reset()
    env.close()
    return steps / seconds


def highway(config: dict[str, Any]) -> Callable[[], gymnasium.Env]:
    def make() -> gymnasium.Env:
        import highway_env  # noqa: F401  registers its environments

        return gymnasium.make("highway-v0", config=config)

    return make


def metadrive() -> gymnasium.Env:
    from metadrive import MetaDriveEnv

    return MetaDriveEnv({"map": 7, "traffic_density": 0.3, "log_level": 50, "num_scenarios": 1})


# As many vehicles, steps and ticks a second, and pixels as ours.
LIKE_OURS = {
    "vehicles_count": 100,
    "simulation_frequency": 60,
    "policy_frequency": 10,
    "action": {"type": "ContinuousAction"},
    "observation": {
        "type": "GrayscaleObservation",
        "observation_shape": (256, 128),
        "stack_size": 1,
        "weights": [0.3, 0.6, 0.1],
        "scaling": 1.75,
    },
}
PEERS: dict[str, tuple[str, Callable[[], gymnasium.Env]]] = {
    "highway-v0, like ours: 100 vehicles, 60 Hz, pictures, one drive": ("highway_env", highway(LIKE_OURS)),
    "highway-v0 as it is: 50 vehicles, 15 Hz, list, one drive": ("highway_env", highway({})),
    "MetaDrive, lidar, one drive": ("metadrive", metadrive),
}


def unable(package: str, make: Callable[[], gymnasium.Env]) -> str | None:
    """Why a peer cannot take part."""
    if importlib.util.find_spec(package) is None:
        return "not installed"
    try:
        env = make()
        env.reset(seed=0)
        env.close()
    except Exception as error:
        return f"does not start: {error}"
    return None


def main(program: str, drives: int = 16, repeats: int = 5) -> None:
    measured: dict[str, Callable[[], float]] = {
        f"loop in Rust, true masks, {drives} drives": lambda: of_the_loop(program, drives),
        f"aeye/Drive-v0, true masks, {drives} drives": lambda: of_ours(drives),
        "aeye/Drive-v0, true masks, one drive": lambda: of_ours(1),
    }
    for name, (package, make) in PEERS.items():
        if reason := unable(package, make):
            print(f"{name}: {reason}")
        else:
            measured[name] = lambda make=make: of_env(make)
    steps: dict[str, list[float]] = {name: [] for name in measured}
    for _ in range(repeats):
        for name, measure in measured.items():
            steps[name].append(measure())
    for name, values in steps.items():
        print(f"{name:64} {statistics.median(values):8.1f} steps/s ({min(values):.1f} to {max(values):.1f})")
    loop, ours, *_ = steps.values()
    ratios = [mine / its for mine, its in zip(ours, loop, strict=True)]
    print(f"of the loop in Rust: {statistics.median(ratios):.0%} ({min(ratios):.0%} to {max(ratios):.0%})")


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:]))
