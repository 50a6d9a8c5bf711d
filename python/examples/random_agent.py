"""Lets a random agent drive, alone and in eight drives at once, and keeps the recordings.

Usage: python random_agent.py FOLDER (needs Gymnasium)
"""

import sys

import aeye
import aeye.gym  # registers aeye/Drive-v0
import gymnasium
import numpy as np


def act(random: np.random.Generator, drives: int) -> np.ndarray:
    """Steering, throttle and brake of each drive: more throttle than brake, and never both."""
    steering, pedals = random.normal(0.0, 0.05, drives), random.uniform(-0.4, 1.0, drives)
    return np.stack([steering, pedals, -pedals], axis=1).clip([-1, 0, 0], 1).astype(np.float32)


def main(folder: str) -> None:
    random = np.random.default_rng(1)
    env = gymnasium.make("aeye/Drive-v0", checkpoint="early", max_time=20, record=folder)
    observation, info = env.reset(seed=1)
    print({name: array.shape for name, array in observation.items()})
    total, over = 0.0, False
    while not over:
        observation, reward, terminated, truncated, info = env.step(act(random, 1)[0])
        total, over = total + float(reward), terminated or truncated
    print(f"seed {info['seed']}: {info['tick'] / 60:.1f} s, {info['outcome']}, reward {total:.1f}")
    print(f"  of the last step: {({name: round(term, 2) for name, term in info['reward_terms'].items() if term})}")
    recording = aeye.open(info["recording"])
    print(f"  {recording.path.name}: {len(recording.ticks)} ticks, {recording.verify()['ok'] and 'verified'}")

    envs = gymnasium.make_vec("aeye/Drive-v0", num_envs=8, max_time=20)
    envs.reset(seed=1)
    rewards = np.array([envs.step(act(random, 8))[1] for _ in range(50)])
    print("eight drives:", rewards.sum(axis=0).round(1).tolist())
    envs.close()


if __name__ == "__main__":
    main(sys.argv[1])
