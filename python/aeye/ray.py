"""Campaigns and experiments on a Ray cluster: the machines of one that runs, or all cores of this one.

>>> import aeye.ray
>>> done = aeye.ray.campaign(["early", "full"], "runs", runs=400, seed=7)
>>> outcome = aeye.ray.experiment("smoke", "experiment")

Shards of the campaign are Ray's tasks. What they drive comes back through the object store, and is put together where this is
called: the files and figures are those of `aeye.campaign`. Pieces of an experiment are tasks, too. Ray is an extra: `pip install aeye[ray]`.
"""

import json
import os
import sys
import tempfile
from collections import deque
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Literal

import aeye
from aeye._errors import Error, FileError, InputError
from aeye._shipped import Checkpoints, OneOrMore, Shipped, StrPath, folder_as_bytes, is_whole, write_folder, write_whole

if find_spec("ray") is None:
    raise ImportError("Ray is not installed; aeye.ray needs it: pip install aeye[ray]")
import ray  # noqa: E402

from aeye._on_ray import connected, fetched, room  # noqa: E402
from aeye._pieces import experiment  # noqa: E402

__all__ = ["campaign", "experiment"]

# Shards where nobody says how many: few enough to be quick to collect, small enough to lose little with a worker.
_SHARDS = 256

Progress = Callable[[int, int], None]


def campaign(
    checkpoint: Checkpoints,
    out: StrPath,
    *,
    runs: int | None = None,
    vary: int | None = None,
    shards: int | None = None,
    address: str | None = None,
    km: float | None = None,
    cases: int | None = None,
    pedestrian_cases: int | None = None,
    maps: OneOrMore | None = None,
    scenario: StrPath | None = None,
    pedestrians: int | None = None,
    hazards: Literal["none", "natural", "raised"] | None = None,
    weather: str | None = None,
    quality: Literal["plain", "standard", "fine"] | None = None,
    sensor: str | None = None,
    max_time: float = 240.0,
    seed: int = 1,
    cores: int = 1,
    gpus: float = 0.0,
    retries: int = 3,
    in_flight: int | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Does what `aeye.campaign` does with the same arguments, on the machines of a Ray cluster.

    `runs`, or `vary` of a story, of which one must be given, are driven in `shards` (None: one for each run, 256 at most), a
    task each, which takes `cores` CPUs, on which it simulates as many worlds, and `gpus` GPUs to draw with. At most
    `in_flight` tasks are handed to Ray at the same time (None: twice as many as it has room for). `address` is that of a
    cluster (None: the one that this process is connected to, that of `RAY_ADDRESS`, one that runs on this machine, or else one
    that is started here and ends with the call). Checkpoints, maps and the scenario are read here and travel along.

    A task whose worker or machine is lost, or had no room on its disk, is tried again up to `retries` times. Shards that are done
    come to the folder `OUT.shards`; Ctrl-C ends the call, and the same call drives only what is missing there. That folder may
    be deleted when all is done. `progress` is called with how many shards are done, and of how many (None: that is said on
    stderr).

    Raises what `aeye.campaign` raises, and EngineError where a shard is lost as often as it may be.
    """
    count = runs if vary is None else vary
    if count is None or (runs is not None and vary is not None):
        raise InputError(f"runs={runs}, vary={vary}; expected one of them")
    for name, value in (("runs", runs), ("vary", vary), ("shards", shards), ("cores", cores), ("in_flight", in_flight)):
        if value is not None and value < 1:
            raise InputError(f"{name}={value}; expected 1 or more")
    arguments = {
        "checkpoint": checkpoint,
        "runs": runs,
        "vary": vary,
        "km": km,
        "cases": cases,
        "pedestrian_cases": pedestrian_cases,
        "maps": maps,
        "scenario": scenario,
        "pedestrians": pedestrians,
        "hazards": hazards,
        "weather": weather,
        "quality": quality,
        "sensor": sensor,
        "max_time": max_time,
        "seed": seed,
    }
    shipped = Shipped.pack(arguments)
    of = shards or min(count, _SHARDS)
    folder = Path(f"{Path(out)}.shards")
    _keep_request({"shards": of, **shipped.identity()}, folder)
    done = {i for i in range(1, of + 1) if is_whole(folder / str(i))}
    tell = progress or _say
    tell(len(done), of)
    if len(done) < of:
        with connected(address):
            submit = _submitter(shipped, of, cores, gpus, retries)
            missing = deque(i for i in range(1, of + 1) if i not in done)
            for i, files in _driven(missing, submit, in_flight or 2 * room(cores)):
                write_folder(files, folder / str(i))
                done.add(i)
                tell(len(done), of)
    return aeye.collect([folder / str(i) for i in range(1, of + 1)], out)


@ray.remote
def _drive(shipped: Shipped, shard: tuple[int, int], cores: int) -> dict[str, bytes]:
    """Drives a shard where Ray has room for it, and gives the files of its folder."""
    # Mesa complains of its absence, and has no use for it without a display.
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.gettempdir())
    try:
        with shipped.unpack() as (arguments, out):
            aeye.campaign(out=out, shard=shard, jobs=cores, **arguments)
            return folder_as_bytes(out)
    except Error:
        raise
    except OSError as error:
        raise FileError(f"{error.filename}: {error.strerror}") from error


Submit = Callable[[int], "ray.ObjectRef[dict[str, bytes]]"]


def _submitter(shipped: Shipped, of: int, cores: int, gpus: float, retries: int) -> Submit:
    """Hands a shard to Ray. The files of this machine are put into the object store once."""
    task = _drive.options(num_cpus=cores, num_gpus=gpus, max_retries=retries, retry_exceptions=[FileError])
    stored = ray.put(shipped)
    return lambda i: task.remote(stored, (i, of), cores)


def _driven(missing: deque[int], submit: Submit, in_flight: int) -> Iterator[tuple[int, dict[str, bytes]]]:
    """Shards as they are done, with their files; no more than so many are handed over at the same time."""
    flying: dict[ray.ObjectRef[dict[str, bytes]], int] = {}
    try:
        while missing or flying:
            while missing and len(flying) < in_flight:
                i = missing.popleft()
                flying[submit(i)] = i
            ready, _ = ray.wait(list(flying), num_returns=1)
            for reference in ready:
                i = flying.pop(reference)
                yield i, fetched(reference, f"shard {i}")
    finally:
        # Ctrl-C, or a shard that failed: nobody waits for the others any more.
        for reference in flying:
            ray.cancel(reference)


def _keep_request(request: dict[str, Any], folder: Path) -> None:
    """Says in a folder of shards of which call they are; refuses one of another call."""
    path = folder / "request.json"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not path.exists():
            write_whole(json.dumps(request, indent=2).encode(), path)
        known = json.loads(path.read_bytes())
    except OSError as error:
        raise FileError(f"{path}: {error.strerror}") from error
    except ValueError:
        raise InputError(f"{path}: is damaged; expected a new folder, or {folder} without its content") from None
    for key in sorted(known.keys() | request.keys()):
        there, here = known.get(key), request.get(key)
        if there != here:
            raise InputError(f"{path}: {key} is {there} there, {here} here; expected a new folder, or the same call")


def _say(done: int, of: int) -> None:
    """Says how far it has come: on a terminal in one line that changes."""
    line = f"{done} of {of} shards"
    end = "\n" if done == of or not sys.stderr.isatty() else "\r"
    print(line, end=end, file=sys.stderr, flush=True)
