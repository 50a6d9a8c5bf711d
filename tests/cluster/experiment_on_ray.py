"""The experiment of run.sh on a local Ray cluster.

Usage: experiment_on_ray.py RECIPE OUT
"""

import sys

import aeye.ray


def main() -> None:
    done: list[str] = []
    aeye.ray.experiment(sys.argv[1], sys.argv[2], progress=done.append)
    tasks = {name.split("/")[0] for name in done}
    if tasks != {"datasets", "networks", "campaign-1", "campaign-2"} or len(done) != len(set(done)):
        sys.exit(f"pieces were {done}; expected each once, and some of every stage")


if __name__ == "__main__":
    main()
