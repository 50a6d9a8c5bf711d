"""What travels between machines that share no folder: the files that a campaign is driven with, and a shard's folder."""

import hashlib
import json
import re
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path, PurePath
from typing import Any

from aeye._aeye import External
from aeye._errors import EngineError, FileError

StrPath = str | PathLike[str]
OneOrMore = StrPath | list[StrPath]
Checkpoints = StrPath | External | list[StrPath | External]

# The file of a shard's folder that says what it is. It is written last, so that a folder with it is whole.
_WHOLE = "shard.json"

# How a scenario names its map, and a story its map and the folders of its catalogs.
_MAP = re.compile(
    r"""^\s*map\s*=\s*["'](.+\.xodr)["']|<LogicFile\s[^>]*filepath\s*=\s*["']([^"']+)["']""",
    re.IGNORECASE | re.MULTILINE,
)
_CATALOGS = re.compile(r"""<Directory\s[^>]*path\s*=\s*["']([^"']+)["']""")


@dataclass(frozen=True)
class Shipped:
    """Arguments of `aeye.campaign`, and the content of the files that they name, by places in a folder that is yet to be."""

    arguments: dict[str, Any]
    files: dict[str, bytes]

    @classmethod
    def pack(cls, arguments: Mapping[str, Any]) -> "Shipped":
        """Reads the files; names of what comes with the package stay names.

        Raises FileError where one is not there.
        """
        packed, files = dict(arguments), dict[str, bytes]()
        for key in ("checkpoint", "maps"):
            if arguments[key] is not None:
                packed[key] = [_packed(each, f"{key}/{i}", files) for i, each in enumerate(_list(arguments[key]))]
        if arguments["scenario"] is not None:
            packed["scenario"] = _packed_scenario(Path(arguments["scenario"]), files)
        return cls(packed, files)

    @contextmanager
    def unpack(self) -> Iterator[tuple[dict[str, Any], Path]]:
        """The arguments with paths of this machine, and an empty folder for results; both are gone afterwards."""
        with tempfile.TemporaryDirectory(prefix="aeye-") as name:
            folder = Path(name)
            for place, content in self.files.items():
                path = folder / place
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content)
            yield {key: self._here(value, folder) for key, value in self.arguments.items()}, folder / "out"

    def _here(self, value: Any, folder: Path) -> Any:
        if isinstance(value, list):
            return [self._here(each, folder) for each in value]
        return folder / value if isinstance(value, str) and value in self.files else value

    def identity(self) -> dict[str, Any]:
        """What makes a campaign another one, as JSON has it."""
        digests = {place: hashlib.blake2b(content).hexdigest() for place, content in self.files.items()}
        return json.loads(json.dumps({**self.arguments, "files": digests}, default=repr))


def _list(each: Any) -> list[Any]:
    return each if isinstance(each, list) else [each]


def _packed(path: Any, place: str, files: dict[str, bytes]) -> Any:
    """Takes a file up and gives its place, or what is no file as it is: a name, or a function that travels by itself."""
    if isinstance(path, External):
        return path
    path = Path(path)
    if not path.suffix and len(path.parts) == 1:
        return str(path)
    files[f"{place}/{path.name}"] = read(path)
    return f"{place}/{path.name}"


def _packed_scenario(path: Path, files: dict[str, bytes]) -> Any:
    """The same for a scenario or story; a map and catalogs that it names are looked for beside it."""
    if not path.suffix and len(path.parts) == 1:
        return str(path)
    place = _packed(path.absolute(), "scenario", files)
    text = files[place].decode(errors="replace")
    beside = [path.parent / name for pair in _MAP.findall(text) for name in pair if _is_below(name)]
    for name in filter(_is_below, _CATALOGS.findall(text)):
        beside += sorted((path.parent / name).glob("*.xosc"))
    for each in filter(Path.is_file, beside):
        files[f"scenario/{each.relative_to(path.parent)}"] = read(each)
    return place


def _is_below(name: str) -> bool:
    """Whether something with such a path lies below the folder that it counts from."""
    return bool(name) and ".." not in PurePath(name).parts and not PurePath(name).is_absolute()


def read(path: Path) -> bytes:
    """The content of a file.

    Raises FileError where it cannot be read.
    """
    try:
        return path.read_bytes()
    except OSError as error:
        raise FileError(f"{path}: {error.strerror}") from error


def folder_as_bytes(folder: Path) -> dict[str, bytes]:
    """The files of a shard's folder by their names."""
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def is_whole(folder: Path) -> bool:
    """Whether a shard's folder was written to its end."""
    return (folder / _WHOLE).exists()


def write_folder(files: Mapping[str, bytes], folder: Path) -> None:
    """Writes a shard's folder. One that is left half-written does not count as whole.

    Raises FileError where it cannot be written, EngineError where it would be no shard's.
    """
    if _WHOLE not in files:
        raise EngineError(f"{folder}: came back without {_WHOLE}; expected a shard's folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name in sorted(files, key=lambda name: name == _WHOLE):
            write_whole(files[name], folder / name)
    except OSError as error:
        raise FileError(f"{error.filename or folder}: {error.strerror}") from error


def write_whole(content: bytes, path: Path) -> None:
    """Writes a file that appears whole or not at all."""
    temporary = path.with_name(f".{path.name}.new")
    temporary.write_bytes(content)
    temporary.replace(path)
