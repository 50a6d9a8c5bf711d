"""The campaign of run.sh on a local Ray cluster, one of whose workers is killed while it drives.

Usage: on_ray.py OUT
"""

import os
import signal
import sys
import threading
import time
from pathlib import Path

import aeye.ray

ARGUMENTS = {"runs": 40, "seed": 7, "pedestrians": 300, "hazards": "raised", "max_time": 10}
LONGEST_S = 120.0


def parent(process: Path) -> int:
    """The parent of a process, which the name in parentheses stands before."""
    return int((process / "stat").read_text().rsplit(")", 1)[1].split()[1])


def is_ours(process: Path) -> bool:
    """Whether a process descends from this one."""
    number = int(process.name)
    while number > 1 and number != os.getpid():
        number = parent(Path("/proc", str(number)))
    return number == os.getpid()


def driving() -> list[int]:
    """Workers of this process that drive a shard now."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if (process / "cmdline").read_bytes().startswith(b"ray::_drive") and is_ours(process):
                found.append(int(process.name))
        except OSError:
            continue
    return found


def kill_one(killed: list[int]) -> None:
    """Kills the first worker that drives, a second after it began."""
    end = time.monotonic() + LONGEST_S
    while not killed and time.monotonic() < end:
        if workers := driving():
            time.sleep(1.0)
            os.kill(workers[0], signal.SIGKILL)
            killed.append(workers[0])
        time.sleep(0.1)


def main() -> None:
    killed: list[int] = []
    thread = threading.Thread(target=kill_one, args=(killed,))
    thread.start()
    aeye.ray.campaign("early", sys.argv[1], shards=10, **ARGUMENTS)
    thread.join()
    if not killed:
        sys.exit("no worker was killed; expected one that drives")


if __name__ == "__main__":
    main()
