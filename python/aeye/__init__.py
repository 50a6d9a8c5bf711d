"""Recordings and corner cases of A-Eye as arrays, their pictures, networks and metrics.

>>> import aeye
>>> case = aeye.open("early-0003.case.mcap")
>>> network = aeye.Segmenter("early")
>>> for frame in case.frames(last=3.0, fps=10):
...     wrong = network.predict(frame.rgb) != frame.class_ids
"""

from aeye import datasets
from aeye._aeye import (
    CLASSES,
    Camera,
    External,
    Frame,
    Frames,
    Recording,
    Segmenter,
    __version__,
    campaign,
    cases,
    collect,
    compare,
    evaluate,
    experiment,
    open,
    pieces,
    redrive,
)
from aeye._errors import DivergedError, EngineError, Error, FileError, InputError, MissingRunsError
from aeye._tables import Table

__all__ = [
    "CLASSES",
    "Camera",
    "DivergedError",
    "EngineError",
    "Error",
    "External",
    "FileError",
    "Frame",
    "Frames",
    "InputError",
    "MissingRunsError",
    "Recording",
    "Segmenter",
    "Table",
    "__version__",
    "campaign",
    "cases",
    "collect",
    "compare",
    "datasets",
    "evaluate",
    "experiment",
    "open",
    "pieces",
    "redrive",
]
