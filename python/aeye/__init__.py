"""Recordings and corner cases of A-Eye as arrays, their pictures, networks and metrics.

>>> import aeye
>>> case = aeye.open("early-0003.case.mcap")
>>> network = aeye.Segmenter("early")
>>> for frame in case.frames(last=3.0, fps=10):
...     wrong = network.predict(frame.rgb) != frame.class_ids
"""

from aeye._aeye import (
    CLASSES,
    Camera,
    Frame,
    Frames,
    Recording,
    Segmenter,
    __version__,
    evaluate,
    open,
)
from aeye._errors import DivergedError, EngineError, Error, FileError, InputError

__all__ = [
    "CLASSES",
    "Camera",
    "DivergedError",
    "EngineError",
    "Error",
    "FileError",
    "Frame",
    "Frames",
    "InputError",
    "Recording",
    "Segmenter",
    "__version__",
    "evaluate",
    "open",
]
