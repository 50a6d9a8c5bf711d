"""Corner cases and recordings as map-style datasets: what PyTorch's `DataLoader` takes as it is.

>>> from aeye.datasets import CornerCases
>>> cases = CornerCases("cases", size=(256, 128))
>>> rgb, class_ids = cases[0]

Pictures are drawn when they are asked for. Workers of a `DataLoader` each open files and the graphics device for themselves;
a dataset that has been read in the parent needs `multiprocessing_context="spawn"`, as graphics devices do not survive a fork.
"""

from bisect import bisect_right
from collections import OrderedDict
from collections.abc import Callable, Iterable
from os import PathLike
from pathlib import Path
from typing import Any, Literal, TypeAlias

from aeye._aeye import Frame, Frames, Recording
from aeye._aeye import open as open_file
from aeye._errors import FileError, InputError

__all__ = ["CornerCases", "Natural", "Sample"]

Sample = Any

_Places: TypeAlias = str | PathLike[str] | Iterable[str | PathLike[str]]

# Frames that are simulated and drawn together where they are asked for in any order: a replay begins at a keyframe, up to
# 12 s before the first of them.
_AT_ONCE = 32
# Who goes on by no more than so many goes through all of them, as a worker does beside others: the ones between are theirs.
_STRIDE = 2 * _AT_ONCE
_NOT_DRAWN = object()


def _pair(frame: Frame) -> Sample:
    return frame.rgb, frame.class_ids


class _Windows:
    """Frames of one window of each of many files, by number.

    What was drawn is kept, `keep` pieces of 32 samples at most, the ones that were asked for last.
    """

    def __init__(
        self,
        folder: _Places,
        kind: Literal["recording", "case"],
        window: dict[str, Any],
        transform: Callable[[Frame], Sample] | None,
        keep: int,
    ) -> None:
        if keep < 1:
            raise InputError(f"keep={keep}; expected 1 or more pieces of {_AT_ONCE} samples")
        self._window = window
        self._transform = transform or _pair
        self._keep = keep
        self.paths: list[Path] = []
        """The files, in order of their names."""
        self._pieces: list[tuple[int, range]] = []
        self._first: list[int] = []
        count = 0
        for path, ticks in _found(folder, kind, window):
            for start in range(0, ticks, _AT_ONCE):
                piece = range(start, min(start + _AT_ONCE, ticks))
                self._pieces.append((len(self.paths), piece))
                self._first.append(count)
                count += len(piece)
            self.paths.append(path)
        self._count = count
        self._forget()

    def _forget(self) -> None:
        self._open: tuple[int, Frames] | None = None
        self._drawn: OrderedDict[int, list[Sample]] = OrderedDict()
        self._last = -1

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, index: int) -> Sample:
        number = index + self._count if index < 0 else index
        if not 0 <= number < self._count:
            raise IndexError(f"sample {index} of {self._count}")
        goes_on = 0 < number - self._last <= _STRIDE
        self._last = number
        piece = _last_at_most(self._first, number)
        samples = self._drawn.setdefault(piece, [_NOT_DRAWN] * len(self._pieces[piece][1]))
        self._drawn.move_to_end(piece)
        while len(self._drawn) > self._keep:
            self._drawn.popitem(last=False)
        at = number - self._first[piece]
        if samples[at] is _NOT_DRAWN:
            self._draw(piece, samples, range(at, at + 1) if goes_on else range(len(samples)))
        return samples[at]

    def _draw(self, piece: int, samples: list[Sample], which: range) -> None:
        file, rows = self._pieces[piece]
        if self._open is None or self._open[0] != file:
            self._open = (file, open_file(self.paths[file]).frames(**self._window))
        frames = self._open[1]
        for at in which:
            if samples[at] is _NOT_DRAWN:
                samples[at] = self._transform(frames[rows[at]])

    def path_of(self, index: int) -> Path:
        """The file that a sample is of."""
        number = range(self._count)[index]
        return self.paths[self._pieces[_last_at_most(self._first, number)][0]]

    def __getstate__(self) -> dict[str, Any]:
        # Graphics devices are of this process; a worker opens its own.
        return {name: value for name, value in vars(self).items() if name not in ("_open", "_drawn", "_last")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._forget()

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._count} samples of {len(self.paths)} files)"


class CornerCases(_Windows):
    """The frames before each takeover, of all cases (`*.mcap`) in a folder and those below it, of a case, or of a list of both.

    A list is taken in its order: `CornerCases([row["file"] for row in aeye.cases("runs", label="walker")])`.

    A sample is `transform(frame)`, or else `(rgb, class_ids)`: uint8 of shape (height, width, 3) and (height, width),
    classes being keys of `aeye.CLASSES` (PyTorch's losses want them as int64). `last` are seconds before the takeover,
    `size` is (width, height), `quality` how good pictures are and `sensor` what lens and chip do to them, as for
    `Recording.frames`. Workers that are spawned need a `transform` that can be pickled: no lambda.

    `keep` pieces of 32 samples stay in memory in each process, those that were asked for last: 100 MB at 256x128.

    Raises FileError where a folder or file is not there, InputError where there is no case, or a file is damaged.
    """

    def __init__(
        self,
        folder: _Places,
        *,
        size: tuple[int, int] = (256, 128),
        last: float = 3.0,
        fps: int = 10,
        quality: Literal["plain", "standard", "fine"] | None = None,
        sensor: str | None = None,
        transform: Callable[[Frame], Sample] | None = None,
        keep: int = 24,
    ) -> None:
        window = {"last": last, "fps": fps, "size": size, "quality": quality, "sensor": sensor}
        super().__init__(folder, "case", window, transform, keep)


class Natural(_Windows):
    """Frames of whole drives, at equal times, of all recordings (`*.mcap`) in a folder and those below it.

    Cases do not count; forks of `aeye.redrive` and episodes of `aeye.gym` do.

    A sample is what one of `CornerCases` is, of the same `quality` and `sensor`; `fps` frames a second of simulated time are taken, a divisor of 60.

    Raises FileError where the folder is not there, InputError where it holds no recording, or a file is damaged.
    """

    def __init__(
        self,
        folder: str | PathLike[str],
        *,
        size: tuple[int, int] = (256, 128),
        fps: int = 1,
        quality: Literal["plain", "standard", "fine"] | None = None,
        sensor: str | None = None,
        transform: Callable[[Frame], Sample] | None = None,
        keep: int = 24,
    ) -> None:
        window = {"last": None, "fps": fps, "size": size, "quality": quality, "sensor": sensor}
        super().__init__(folder, "recording", window, transform, keep)


def _found(places: _Places, kind: str, window: dict[str, Any]) -> list[tuple[Path, int]]:
    """The files of a kind and how many frames their window has."""
    if isinstance(places, (str, PathLike)):
        found = _named(Path(places), kind)
    else:
        found = [file for place in map(Path, places) for file in _named(place, kind)]
        if not found:
            raise InputError(f"an empty list; expected at least one {kind} (*.mcap)")
    return [(file.path, len(file.frames(**window))) for file in found]


def _below(folder: Path, kind: str) -> list[Recording]:
    """The files of a kind below a folder."""
    opened = [open_file(path) for path in sorted(folder.rglob("*.mcap"))]
    found = [file for file in opened if file.kind == kind]
    if not found:
        where = f"no {kind} among its files" if opened else "no file"
        raise InputError(f"{folder}: has {where} (*.mcap); expected at least one {kind}")
    return found


def _named(place: Path, kind: str) -> list[Recording]:
    """What a place stands for: a folder, or a file, which is to be of the kind."""
    if place.is_dir():
        return _below(place, kind)
    if not place.exists():
        raise FileError(f"{place}: no such file or folder")
    file = open_file(place)
    if file.kind != kind:
        raise InputError(f"{place}: a {file.kind}; expected a {kind}")
    return [file]


def _last_at_most(ascending: list[int], number: int) -> int:
    """Where the last of them is that is no greater than a number."""
    return bisect_right(ascending, number) - 1
