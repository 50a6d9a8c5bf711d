"""The native half of the package `aeye`, which is what to import."""

from collections.abc import Callable, Iterator
from os import PathLike
from pathlib import Path
from typing import Any, Literal, Protocol, TypeAlias, TypedDict, final, type_check_only

import numpy as np
from numpy.typing import NDArray

from aeye._tables import Table

__all__ = [
    "CLASSES",
    "Camera",
    "Episodes",
    "External",
    "Frame",
    "Frames",
    "Recording",
    "Segmenter",
    "Setting",
    "__version__",
    "campaign",
    "cases",
    "collect",
    "compare",
    "evaluate",
    "experiment",
    "open",
    "pieces",
    "redrive",
]

__version__: str

CLASSES: dict[int, str]
"""The 23 classes, tags of CARLA 0.9.10: what they are called by the number that masks have."""

@type_check_only
class SeatControls(TypedDict):
    steering: NDArray[np.float32]
    throttle: NDArray[np.float32]
    brake: NDArray[np.float32]
    hand_brake: NDArray[np.bool_]
    reverse: NDArray[np.bool_]
    seen: NDArray[np.bool_]
    indicate_left: NDArray[np.bool_]
    indicate_right: NDArray[np.bool_]
    horn: NDArray[np.bool_]
    lights: NDArray[np.bool_]
    wipers: NDArray[np.bool_]

@type_check_only
class Controls(TypedDict):
    semantic: SeatControls
    safety: SeatControls

@type_check_only
class Events(TypedDict):
    tick: NDArray[np.uint64]
    kind: NDArray[np.str_]
    actor: NDArray[np.uint32]
    speed_mps: NDArray[np.float32]

@type_check_only
class Masks(TypedDict):
    tick_shown: NDArray[np.uint64]
    tick_of_frame: NDArray[np.uint64]
    digest: NDArray[np.uint64]

@type_check_only
class Labels(TypedDict):
    label: Literal["walker", "vehicle", "rules", "boredom"]
    comment: str
    perception_caused: bool | None

@type_check_only
class Ego(TypedDict):
    position_m: NDArray[np.float32]
    rotation_xyzw: NDArray[np.float32]
    speed_mps: float
    wheel_angle_rad: float

@type_check_only
class Actors(TypedDict):
    id: NDArray[np.uint32]
    instance_id: NDArray[np.uint16]
    kind: NDArray[np.str_]
    position_m: NDArray[np.float32]
    rotation_xyzw: NDArray[np.float32]
    size_m: NDArray[np.float32]
    speed_mps: NDArray[np.float32]

@final
class Camera:
    """The camera of a frame, a pinhole behind a lens, in the axes that OpenCV uses: x to the right, y down, z along the view."""

    @property
    def width(self) -> int:
        """Pixels a row."""

    @property
    def height(self) -> int:
        """Rows."""

    @property
    def intrinsics(self) -> NDArray[np.float64]:
        """The matrix K, float64 of shape (3, 3), pixels. The middle of the first pixel is at (0.5, 0.5)."""

    @property
    def distortion(self) -> NDArray[np.float64]:
        """What its lens does, float64 of shape (5,): k1, k2, p1, p2 and k3 of OpenCV, 0 of an ideal one."""

    @property
    def world_from_camera(self) -> NDArray[np.float64]:
        """From camera to world, float64 of shape (4, 4), metres: x east, y north, z up."""

@final
class Frame:
    """A picture of a tick, its ground truth, and what there is in the scene.

    The arrays are the renderer's own memory.
    """

    @property
    def tick(self) -> int:
        """The tick, 60 a second."""

    @property
    def time_s(self) -> float:
        """Simulated time since the start of the run, seconds."""

    @property
    def rgb(self) -> NDArray[np.uint8]:
        """Colour, uint8 of shape (height, width, 3): red, green, blue (sRGB)."""

    @property
    def class_ids(self) -> NDArray[np.uint8]:
        """Class of each pixel, uint8 of shape (height, width): keys of `aeye.CLASSES`."""

    @property
    def instance_ids(self) -> NDArray[np.uint16]:
        """Instance of each pixel, uint16 of shape (height, width).

        0 for none, up to 32767 an actor's number, from 32768 on a parked car's, 65535 the ego car.
        """

    @property
    def depth_m(self) -> NDArray[np.float32]:
        """Distance along the view, float32 of shape (height, width), metres; infinite for the sky."""

    @property
    def camera(self) -> Camera:
        """Where it was taken from, and how."""

    @property
    def ego(self) -> Ego:
        """The ego car.

        `position_m`, shape (3,), is below the middle of its rear axle; `rotation_xyzw`, shape (4,), a quaternion from
        its axes (x ahead, y left, z up) to the world's; `wheel_angle_rad` is positive to the right.
        """

    @property
    def actors(self) -> Actors:
        """The other road users, a row each.

        `instance_id` is that of `instance_ids`; `position_m`, shape (n, 3), the middle of the footprint;
        `rotation_xyzw` has the shape (n, 4); `size_m`, shape (n, 3), is length, width and height. Parked cars are among
        them only where they were hit; their open doors (`Door`) are, with the instance of the car.
        """

@final
class Frames:
    """The frames of a window, as a sequence: each is drawn when it is asked for, and none is kept."""

    @property
    def ticks(self) -> NDArray[np.uint64]:
        """Their ticks, uint64 of shape (n,), ascending."""

    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> Frame: ...
    def __iter__(self) -> Iterator[Frame]: ...

@final
class Recording:
    """A recording or corner case. Nothing of it can be changed."""

    @property
    def path(self) -> Path:
        """The file."""

    @property
    def kind(self) -> Literal["recording", "case"]:
        """`recording` or `case`."""

    @property
    def finished(self) -> bool:
        """Whether its writer came to its end; if not, up to a second is missing."""

    @property
    def map(self) -> str:
        """Name of the map."""

    @property
    def seed(self) -> int:
        """Seed of the scenario."""

    @property
    def scenario(self) -> str:
        """What the run started from, as TOML."""

    @property
    def first_tick(self) -> int:
        """The tick of the state that it starts from, 0 in recordings; it can be drawn, and has no controls."""

    @property
    def ticks(self) -> NDArray[np.uint64]:
        """Ticks, 60 a second, uint64 of shape (n,): of the rows of `controls` and `hashes`."""

    @property
    def controls(self) -> Controls:
        """What both drivers did at each tick, all of shape (n,).

        `steering` is in [-1, 1], positive to the right, `throttle` and `brake` are in [0, 1].
        """

    @property
    def hashes(self) -> NDArray[np.uint32]:
        """The low 32 bits of the hash of the world's state at each tick, uint32 of shape (n,)."""

    @property
    def events(self) -> Events:
        """What happened, a row each: `actor` is 0 for none, `speed_mps` that of the ego car."""

    @property
    def masks(self) -> Masks:
        """The masks that came onto the semantic driver's screen, a row each."""

    @property
    def labels(self) -> Labels | None:
        """What was said about the takeover; None where nothing was said.

        `perception_caused` is None where nobody tried.
        """

    def inspect(self, *, reveal: bool = False) -> dict[str, Any]:
        """What is in the file, as `aeye inspect --json` prints it.

        It is simulated for that, which takes a while. The checkpoint of blind drives is told with `reveal` only.
        """

    def verify(self, *, rewind: int | None = None) -> dict[str, Any]:
        """Simulates it again and compares every tick, as `aeye verify` does, and gives what that prints with `--json`.

        With `rewind`, 1 to 600, it also goes back so many ticks again and again.

        Raises DivergedError where a tick differs (which one and how it says), EngineError where another version of the
        simulation made the file.
        """

    def frames(
        self,
        *,
        last: float | None = 3.0,
        from_: float | None = None,
        to: float | None = None,
        fps: int = 10,
        size: tuple[int, int] = (256, 128),
        quality: Literal["plain", "standard", "fine"] | None = None,
        sensor: str | None = None,
        camera: Literal["driver", "chase", "top"] = "driver",
    ) -> Frames:
        """The frames of a window.

        Those are the last seconds before the takeover (or the collision that nobody prevented, else the end), as `aeye
        rerender` draws them, or, with `from_` or `to` or with `last=None`, those between two times of the run (seconds;
        None: its start, its end), cut to what the file holds: a case begins at `first_tick`. `size` is (width, height)
        in pixels, `quality` how good they are (None: as usual), `sensor` what lens and chip do, as in `noise=4,k1=-0.1` (None:
        nothing), `fps` a divisor of 60.

        Raises InputError where there is nothing in the window, or a value cannot be.
        """

    def frame(
        self,
        tick: int,
        *,
        size: tuple[int, int] = (256, 128),
        quality: Literal["plain", "standard", "fine"] | None = None,
        sensor: str | None = None,
        camera: Literal["driver", "chase", "top"] = "driver",
    ) -> Frame:
        """The picture of a tick.

        Raises InputError where the file has no such tick, EngineError where another version of the simulation made it
        (of its cases, the ticks with a stored scene can be drawn) or no graphics driver is there.
        """

@final
class Segmenter:
    """A segmentation network: `early` or `full`, which come with the package, or an ONNX file that takes one image.

    Raises FileError where there is no such file, InputError where it is no such network.
    """

    def __new__(cls, checkpoint: str | PathLike[str]) -> Segmenter: ...
    @property
    def name(self) -> str:
        """`early`, `full`, or the file's name without its ending."""

    @property
    def digest(self) -> str:
        """BLAKE3 of the file, hexadecimal."""

    @property
    def classes(self) -> dict[int, str]:
        """The classes that it tells apart: what they are called by the number that masks have."""

    def predict(self, rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """The class of every pixel, uint8 of shape (height, width), of a picture.

        That is uint8 of shape (height, width, 3): red, green, blue. Pictures of a size that the network does not take
        are resampled for it.

        Raises InputError for any other array, EngineError where the network fails.
        """

@final
class External:
    """A function in the place of a checkpoint, for `campaign`, `compare`, `redrive`, `evaluate` and `aeye.gym`.

    So a network of PyTorch, JAX or TensorRT drives without an ONNX file.

    `function` takes a picture, uint8 of shape (height, width, 3): red, green, blue, and gives the class of every pixel,
    uint8 of shape (height, width): keys of `aeye.CLASSES`. Threads call it, several at once where there are `jobs`; what it
    raises ends the call and is raised there. In a drive pictures have the `size`, (width, height) in pixels.

    Recordings and results say `name` and `version`, which no file stands behind: a function that changes needs another
    version, or results of the old one are taken for its own.

    Raises InputError for a name that no file can have or that is a checkpoint's of this package, and for a size that
    cannot be.
    """

    def __new__(
        cls,
        function: Callable[[NDArray[np.uint8]], NDArray[np.uint8]],
        *,
        name: str,
        version: str,
        size: tuple[int, int] = (256, 128),
    ) -> External: ...
    @property
    def function(self) -> Callable[[NDArray[np.uint8]], NDArray[np.uint8]]:
        """The function."""

    @property
    def name(self) -> str:
        """What it is called in results."""

    @property
    def version(self) -> str:
        """Which one of that name it is."""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the pictures that it looks at in a drive, pixels."""

    def __getnewargs_ex__(self) -> tuple[tuple[Callable[..., Any]], dict[str, Any]]:
        """What it is made of, to travel to other processes with its function."""

_Checkpoint: TypeAlias = str | PathLike[str] | External

@final
class Setting:
    """What drives start from, for `aeye.gym`.

    A bundled map or an OpenDRIVE file (`map`), or a `scenario` file, and what is to be otherwise than it says.

    Raises FileError where a file is not there, InputError for a value that cannot be.
    """

    def __new__(
        cls,
        *,
        map: str | PathLike[str] | None = None,
        scenario: str | PathLike[str] | None = None,
        hazards: str | None = None,
        weather: str | None = None,
        pedestrians: int | None = None,
        max_time: float | None = None,
        brake_threshold: float | None = None,
        steer_threshold: float | None = None,
    ) -> Setting: ...

@type_check_only
class Arrays(Protocol):
    """A tuple of masks, images, HUDs and figures, each with a row for each place."""

    def __iter__(self) -> Iterator[NDArray[Any] | None]: ...

@final
class Episodes:
    """So many places for drives that are stepped together, for `aeye.gym`.

    `jobs` of them at the same time (None: one a core). An agent has the `seat` and holds its controls for `ticks` of a step, a
    bot has the other. `masks` and `images` say what is observed; images have a `size`, (width, height) (None: that of masks).
    What is seen has the `quality` (None: the usual), and lens and chip do to it what `sensor` says (None: nothing); `record` is a folder for recordings. `draw` takes pictures of `render_size` from a `camera` (`driver`, `chase` or `top`).

    Raises FileError where a file is not there, InputError for a value that cannot be.
    """

    HUD: list[str]
    HUD_RANGES: list[list[float]]
    FIGURES: list[str]

    def __new__(
        cls,
        places: int,
        *,
        seat: str = "semantic",
        checkpoint: _Checkpoint | None = None,
        ticks: int = 6,
        masks: bool = True,
        images: bool = False,
        size: tuple[int, int] | None = None,
        quality: str | None = None,
        sensor: str | None = None,
        record: str | PathLike[str] | None = None,
        camera: str = "chase",
        render_size: tuple[int, int] = (512, 256),
        jobs: int | None = None,
    ) -> Episodes: ...
    @property
    def mask_size(self) -> tuple[int, int]:
        """Width and height of masks, pixels: those that the checkpoint takes."""

    @property
    def image_size(self) -> tuple[int, int]:
        """Width and height of images, pixels."""

    def reset(self, places: list[int], seeds: list[int], setting: Setting, arrays: Arrays) -> None:
        """Starts drives at places and writes what is to be seen into the rows of `arrays`.

        Each has a seed. Those that still go on there end.

        Raises EngineError where there is no graphics driver, FileError where a recording cannot be written.
        """

    def step(self, places: list[int], actions: NDArray[np.float32], arrays: Arrays) -> None:
        """Steps the drives at places by `actions`, float32 of shape (n, 3): steering, throttle and brake of each.

        Raises InputError where no drive goes on, EngineError where it cannot be drawn or seen.
        """

    def finish(self, places: list[int]) -> list[Path | None]:
        """Ends the drives at places and tells where their recordings are.

        None of those that are not recorded, have not begun or are over.

        Raises FileError where a recording cannot be written.
        """

    def draw(self, place: int) -> NDArray[np.uint8]:
        """A picture of the drive at a place from the camera, uint8 of shape (height, width, 3).

        Raises InputError where no drive goes on, EngineError where it cannot be drawn.
        """

def open(path: str | PathLike[str]) -> Recording:
    """Opens a recording or corner case and checks every byte of it.

    One whose writer was stopped is read as far as it goes (`finished` tells).

    Raises FileError where it cannot be read, InputError where it is damaged or no recording.
    """

def campaign(
    checkpoint: _Checkpoint | list[_Checkpoint],
    out: str | PathLike[str],
    *,
    runs: int | None = None,
    vary: int | None = None,
    km: float | None = None,
    cases: int | None = None,
    pedestrian_cases: int | None = None,
    maps: str | PathLike[str] | list[str | PathLike[str]] | None = None,
    scenario: str | PathLike[str] | None = None,
    pedestrians: int | None = None,
    hazards: Literal["none", "natural", "raised"] | None = None,
    weather: str | None = None,
    quality: Literal["plain", "standard", "fine"] | None = None,
    sensor: str | None = None,
    max_time: float = 240.0,
    seed: int = 1,
    jobs: int | None = None,
    shard: tuple[int, int] | None = None,
) -> dict[str, Any]:
    """Lets bots drive through checkpoints until there are so many runs, kilometres or cases of each.

    As `aeye campaign` does, and gives what that prints with `--json`; `runs` of it is a `Table`. Recordings, corner cases
    and `campaign.json` go to the folder `out`. Ctrl-C ends it; what was driven stays, and the same call goes on there.

    `checkpoint` are `early`, `full`, `truth`, ONNX files or `External`, `maps` names of bundled maps or OpenDRIVE files (None: the
    scenario's, or all bundled ones), `weather` is one with a name, `quality` how good the pictures are that networks look
    at, and `sensor` what lens and chip do to them, as in `noise=4,k1=-0.1` (None: nothing). `vary` are as many runs, each with values drawn for those
    parameters of the scenario's story that have ranges. A run takes at most `max_time` simulated seconds.
    `jobs` worlds are simulated at the same time (None: one a core); the results do not depend on it.

    With `shard`, (i, n), it drives every n-th run alone, up to `runs` or `vary`, into a folder for `collect`, and gives what `aeye
    campaign --shard --json` prints.

    Raises InputError for a value that cannot be, FileError where a file is not there or cannot be written,
    MissingRunsError where `runs` do not come to the goal.
    """

def collect(
    folders: str | PathLike[str] | list[str | PathLike[str]],
    out: str | PathLike[str],
    *,
    jobs: int | None = None,
) -> dict[str, Any]:
    """Puts together what the shards of a campaign drove.

    As `aeye campaign --collect` does: the files of one process in the folder `out`, and what that prints with `--json`;
    `runs` of it is a `Table`. It drives nothing and needs no graphics driver.

    `folders` are those of shards, or hold such folders. `jobs` runs are read at the same time (None: one a core).

    Raises MissingRunsError where runs are not there yet, EngineError where the folders are not of one
    campaign and program.
    """

def experiment(
    recipe: str | PathLike[str],
    out: str | PathLike[str],
    *,
    jobs: int | None = None,
    piece: str | None = None,
) -> dict[str, Any]:
    """Does what a recipe says in the folder `out`, or what is left of it there.

    As `aeye experiment` does, and gives what that prints with `--json`. Ctrl-C ends it; the same call goes on there.

    `recipe` is a preset (`smoke`, `small`, `desk`, `paper`) or a TOML file. `jobs` drives are made at the same time (None: one a
    core); the results do not depend on it.

    With `piece`, the name of one of `pieces`, that one is done alone, and what `aeye experiment --piece --json` prints is
    given; other processes may do others in the same folder.

    Raises InputError for a value that cannot be, FileError where a file is not there or cannot be written, EngineError
    where what a piece needs is not there.
    """

def pieces(recipe: str | PathLike[str], out: str | PathLike[str]) -> list[dict[str, Any]]:
    """The pieces of an experiment that are not done yet in the folder `out` and can be done now.

    Each with what it needs there, as `aeye experiment --pieces --json` prints them. When none is left, `experiment` does
    the rest.

    Raises InputError for a value that cannot be, FileError where a file is not there.
    """

def compare(
    cases: str | PathLike[str] | list[str | PathLike[str]],
    checkpoints: list[_Checkpoint],
    out: str | PathLike[str],
    *,
    verdict: str | list[str] | None = None,
    gates: list[str] | None = None,
    no_worse_than: str | None = None,
    size: tuple[int, int] | None = None,
    quality: Literal["plain", "standard", "fine"] | None = None,
    sensor: str | None = None,
    jobs: int | None = None,
    shard: tuple[int, int] | None = None,
) -> dict[str, Any]:
    """Which corner cases a checkpoint fixes and breaks against another.

    As `aeye compare` does, and gives what that prints with `--json`; `cases` of it is a `Table`. `compare.json` and
    `report.html` go to the folder `out`; the same call with more cases or checkpoints looks only at those. Ctrl-C ends it.

    `cases` are files, or folders with cases anywhere below; `checkpoints` two or more, the first of which is the baseline:
    `early`, `full`, `truth`, ONNX files or `External`. Only those cases count on whose takeover a campaign came to one of the
    verdicts `verdict`, where it is given. `gates` are conditions on all others, as in `ped_iou>=0.5`, and
    `no_worse_than` names a checkpoint than which no other may be worse; `gates` of what is given says which were passed.
    Pictures have the `size`, (width, height) (None: that of the first network), and the `quality` (None: the usual), and lens
    and chip do to them what `sensor` says, as in `noise=4,k1=-0.1` (None: nothing). `jobs` frames are looked at at the same
    time (None: one a core); the results do not depend on it.

    With `shard`, (i, n), it looks at every n-th file alone and gives what `aeye compare --shard --json` prints; folders of all
    shards, copied into one, are what the same call without `shard` finishes.

    Raises InputError for a value that cannot be, FileError where a file is not there, EngineError where no case can be
    drawn.
    """

def redrive(
    files: str | PathLike[str] | list[str | PathLike[str]],
    out: str | PathLike[str],
    *,
    without_intervention: bool = False,
    checkpoint: _Checkpoint | None = None,
    recorded: _Checkpoint | list[_Checkpoint] | None = None,
    vary: int = 0,
    after: float = 10.0,
    jobs: int | None = None,
    shard: tuple[int, int] | None = None,
) -> dict[str, Any]:
    """Drives recordings or cases on from before their intervention.

    As `aeye redrive` does, and gives what that prints with `--json`; `forks` of it is a `Table`. Their recordings go to
    the folder `out`. Ctrl-C ends it; what was driven stays.

    Either `without_intervention`: what would have happened if the safety driver had done nothing? Or through a
    `checkpoint`: is there an intervention again? `recorded` are those among which checkpoints of the recordings may be found.
    Each file has `vary` further forks, 0 to 30, and a fork goes on for `after` seconds, 1 to 60.

    With `shard`, (i, n), it drives every n-th file alone and gives what `aeye redrive --shard --json` prints; folders of all
    shards, copied into one, are what the same call without `shard` finishes.

    Raises InputError for a value that cannot be, FileError where a file is not there, EngineError where none of them can
    be driven on.
    """

def cases(
    folders: str | PathLike[str] | list[str | PathLike[str]],
    *,
    index: str | PathLike[str] | None = None,
    scan: bool = True,
    label: str | list[str] | None = None,
    verdict: str | list[str] | None = None,
    map: str | list[str] | None = None,
    weather: str | list[str] | None = None,
    hazards: str | list[str] | None = None,
    checkpoint: str | list[str] | None = None,
    perception_caused: str | bool | list[str | bool] | None = None,
    overlooked: str | list[str] | None = None,
    ttc_below: float | None = None,
    fork_ttc_below: float | None = None,
    reviewed: str | list[str] | None = None,
    tag: str | list[str] | None = None,
    near: str | PathLike[str] | None = None,
    unique: bool = False,
    sort: str = "file",
    descending: bool = False,
    limit: int | None = None,
    measure: bool = False,
    recorded: _Checkpoint | list[_Checkpoint] | None = None,
    set_review: str | None = None,
    add_tag: str | list[str] | None = None,
    remove_tag: str | list[str] | None = None,
    reveal: bool = False,
    jobs: int | None = None,
) -> Table:
    """Finds corner cases by what is known of them.

    As `aeye cases` does, and gives a `Table` with a dictionary for each, as that prints with `--json`; `file` of it
    is the path. The index of the `folders`, in the file `index` (None: `cases.sqlite` in the one folder), is
    brought up to date first, unless `scan` is False; files in folders that cannot be read are left out with a warning.
    With files among `folders` only these cases are meant. Ctrl-C ends it; what was read or measured stays.

    Everything holds that is given, and of a list one is enough. `label`: walker, vehicle, rules, boredom.
    `verdict`: necessary, near-miss, early, needless, in-vain. `map`, `checkpoint`: names (or 8 or more digits that a
    checkpoint's digest begins with). `weather`: rain, wet, dry, fog, night, day, or the name of a weather. `hazards`:
    none, natural, raised, own. `perception_caused`: yes, no, unknown, True, False. `overlooked`: any, walker, vehicle or a kind
    of road user, as in `child:200` with so many pixels of them. `ttc_below` and `fork_ttc_below`: seconds to
    collision, measured, and without the takeover. `reviewed`: yes, no, accepted, rejected, unclear. `tag`: tags.
    `near`: cases whose situation is nearly that of this file; `unique`: one of each group that are nearly the same.
    `sort`: file, ttc, fork-ttc, speed, overlooked, distance; `descending` and `limit` of it.

    `measure` simulates and draws those cases that were not measured, through the checkpoints of their drives, which
    are found among `recorded` if they do not come with the package. `set_review`, `add_tag` and `remove_tag` say
    what came of looking at the cases. `reveal` tells the checkpoints of blind drives.

    Raises InputError for a value that cannot be, FileError where a file is not there, EngineError where the index
    cannot be read or nothing can be drawn.
    """

def evaluate(
    checkpoint: _Checkpoint,
    dataset: str | PathLike[str],
    *,
    split: str = "val",
    jobs: int | None = None,
) -> dict[str, Any]:
    """Measures a checkpoint on a split of a dataset in the layout of Cityscapes.

    The checkpoint is `early`, `full`, `truth`, an ONNX file or an `External`. Gives what `aeye eval --json` prints: IoU of each class,
    confusion matrix, recall of pedestrians. `jobs` frames are looked at at the same time (None: one a core); the result
    does not depend on it. Ctrl-C ends it.

    Raises FileError where checkpoint or dataset is not there, InputError for a checkpoint that cannot be, EngineError
    where the dataset has no such split, or is not whole.
    """
