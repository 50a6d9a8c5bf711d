"""Pieces of an experiment as Ray's tasks."""

import os
import re
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path, PurePath
from typing import Any

import ray

import aeye
from aeye._errors import Error, FileError, InputError
from aeye._on_ray import connected, fetched, room
from aeye._shipped import StrPath, read, write_whole

# It reads all that there is by then and takes minutes: it is done where everything lies.
_HERE = "datasets/sets"

# What says that the rest is there is written last.
_LAST = ("/dataset.json", ".onnx")

_MAP = re.compile(r'["\']([^"\']+\.xodr)["\']', re.IGNORECASE)

Files = Mapping[str, bytes]


def experiment(
    recipe: StrPath,
    out: StrPath,
    *,
    address: str | None = None,
    cores: int = 1,
    gpus: float = 0.0,
    retries: int = 3,
    in_flight: int | None = None,
    progress: Callable[[str], None] | None = None,
) -> dict[str, Any]:
    """Does what `aeye.experiment` does with the same `recipe`, on the machines of a Ray cluster.

    Its pieces (`aeye.pieces`) are tasks, each of which takes `cores` CPUs, and `gpus` GPUs to draw with: a dataset, a training,
    a run of a campaign. What a piece needs of `out` travels to it, and what it makes travels back; the training sets are made
    here, and so are tables and report at the end. `in_flight`, `address` and `retries` are those of `campaign`. The recipe and maps
    that it names are read here; files of maps must lie below the working directory.

    Ctrl-C ends the call, and the same call does what is missing in `out`. `progress` is called with the name of each piece
    that is done (None: that is said on stderr).

    Raises what `aeye.experiment` raises, and EngineError where a piece is lost as often as it may be.
    """
    for name, value in (("cores", cores), ("in_flight", in_flight)):
        if value is not None and value < 1:
            raise InputError(f"{name}={value}; expected 1 or more")
    aeye.pieces(recipe, out)
    here = _packed(recipe)
    tell = progress or _say
    with connected(address):
        task = _do.options(num_cpus=cores, num_gpus=gpus, max_retries=retries, retry_exceptions=[FileError])
        stored: dict[str, ray.ObjectRef[dict[str, bytes]]] = {}

        def submit(piece: Mapping[str, Any]) -> "ray.ObjectRef[dict[str, bytes]]":
            """Hands a piece to Ray. What it needs is put into the object store once."""
            for need in piece["needs"]:
                if need not in stored:
                    stored[need] = ray.put(_read_below(Path(out), need))
            return task.remote(here, piece["piece"], cores, *(stored[need] for need in piece["needs"]))

        for name, files in _done(recipe, out, submit, in_flight or 2 * room(cores)):
            _write_below(files, Path(out))
            tell(name)
    return aeye.experiment(recipe, out)


def _done(
    recipe: StrPath,
    out: StrPath,
    submit: Callable[[Mapping[str, Any]], "ray.ObjectRef[dict[str, bytes]]"],
    in_flight: int,
) -> Iterator[tuple[str, Files]]:
    """Pieces as they are done, with their files, until none is left."""
    flying: dict[ray.ObjectRef[dict[str, bytes]], str] = {}
    try:
        while True:
            pieces = [piece for piece in aeye.pieces(recipe, out) if piece["piece"] not in flying.values()]
            if any(piece["piece"] == _HERE for piece in pieces):
                aeye.experiment(recipe, out, piece=_HERE)
                yield _HERE, {}
                continue
            for piece in pieces[: max(0, in_flight - len(flying))]:
                flying[submit(piece)] = piece["piece"]
            if not flying:
                return
            ray.wait(list(flying), num_returns=1)
            ready, _ = ray.wait(list(flying), num_returns=len(flying), timeout=0)
            for reference in ready:
                name = flying.pop(reference)
                yield name, fetched(reference, name)
    finally:
        # Ctrl-C, or a piece that failed: nobody waits for the others any more.
        for reference in flying:
            ray.cancel(reference)


@ray.remote
def _do(here: tuple[str, Files], piece: str, cores: int, *needs: Files) -> dict[str, bytes]:
    """Does a piece where Ray has room for it, and gives the files that it made."""
    # Mesa complains of its absence, and has no use for it without a display.
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.gettempdir())
    recipe, files = here
    try:
        with tempfile.TemporaryDirectory(prefix="aeye-") as folder, _inside(folder):
            _write_below(files, Path())
            out = Path("out")
            for need in needs:
                _write_below(need, out)
            aeye.experiment(recipe, out, jobs=cores, piece=piece)
            known = {place for need in needs for place in need}
            return {place: content for place, content in _read_below(out, "").items() if place not in known}
    except Error:
        raise
    except OSError as error:
        raise FileError(f"{error.filename}: {error.strerror}") from error


@contextmanager
def _inside(folder: str) -> Iterator[None]:
    """Paths of a recipe are those of the working directory."""
    before = os.getcwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def _packed(recipe: StrPath) -> tuple[str, Files]:
    """What a recipe is called where a piece is done, and the files that it consists of there."""
    path = Path(recipe)
    if not path.suffix and len(path.parts) == 1:
        return str(path), {}
    files = {"recipe.toml": read(path)}
    for name in _MAP.findall(files["recipe.toml"].decode(errors="replace")):
        if PurePath(name).is_absolute() or ".." in PurePath(name).parts:
            raise InputError(f"{path}: maps: {name} does not travel; expected a file below the working directory")
        files[name] = read(Path(name))
    return "recipe.toml", files


def _read_below(folder: Path, place: str) -> dict[str, bytes]:
    """A file of a folder, or all files of a folder in it, by their places."""
    top = folder / place
    paths = sorted(path for path in top.rglob("*") if path.is_file()) if top.is_dir() else [top]
    return {path.relative_to(folder).as_posix(): read(path) for path in paths}


def _write_below(files: Files, folder: Path) -> None:
    """Writes files to their places in a folder, each in one step."""
    try:
        for place in sorted(files, key=lambda place: (f"/{place}".endswith(_LAST), place)):
            path = folder / place
            path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(files[place], path)
    except OSError as error:
        raise FileError(f"{error.filename or folder}: {error.strerror}") from error


def _say(name: str) -> None:
    print(f"{name}: done", file=sys.stderr, flush=True)
