"""One drive."""

from collections.abc import Mapping
from os import PathLike
from typing import Any, Literal, cast

import gymnasium
import numpy as np
from numpy.typing import NDArray

from aeye._aeye import External
from aeye._errors import InputError
from aeye.gym._drives import Drives, Observation, actions
from aeye.gym._rewards import End, Reward


class DriveEnv(gymnasium.Env[Observation, NDArray[np.float32]]):
    """A drive in which an agent has one of the two seats and a bot the other; `aeye/Drive-v0` of Gymnasium.

    In the seat `semantic` the agent drives by what a checkpoint predicts, and the safety bot takes over when it becomes
    dangerous, which ends the episode. In the seat `safety` the semantic bot drives, and the agent sees the real image;
    its brake or steering beyond a threshold is a takeover, after which it has to bring the car to a stop.

    Observations are dictionaries of `mask` (uint8 of shape (height, width), keys of `aeye.CLASSES`: what is on the
    semantic driver's screen, 100 ms old), `rgb` (uint8 of shape (height, width, 3), what the safety driver sees: the
    present) or both, and `hud` (float32 of shape (11,)): `speed_mps`, `limit_mps`, the next traffic light as
    `light_red`, `light_yellow` and `light_green` (one of them is 1, or none) and `light_distance_m` to its line, the
    way at the junction ahead as `turn_left`, `turn_straight` and `turn_right` (one of them is 1) and `turn_distance_m`,
    and `bearing_deg` of the route 12 m ahead, positive to the right. It is what the HUD shows: whole km/h (here in m/s), and
    distances in steps of 10 m, below 20 m of 5 m.

    Actions are float32 of shape (3,): steering in [-1, 1], positive to the right, throttle and brake in [0, 1]. They are held
    for `ticks` ticks of 1/60 s, 1 to 60; beyond its range each counts as its end. The semantic driver's indicators are set by themselves.

    `checkpoint` is `early`, `full`, `truth`, an ONNX file or an `External`; `map` a bundled map or an OpenDRIVE file, or `scenario` a
    scenario file; `hazards` is `none`, `natural` or `raised`, `weather` one with a name; a run takes at most `max_time`
    seconds, 4 to 86,400 (None: the scenario's, 600 unless it says otherwise). `observe` is `mask`, `rgb` or `both` (None: what the seat's driver sees), `size` (width, height) of
    images (None: that of masks), `quality` how good images are, and the pictures that the checkpoint looks at, and `sensor` what lens
    and chip do to them, as for `Recording.frames`. With `record`, each episode is kept in that folder as a recording that `aeye verify` and all
    other commands take.

    `weights` replace some of `aeye.gym.WEIGHTS[seat]`. `reward` replaces the whole reward: a callable that takes
    `aeye.gym.Facts` and gives an array of shape (n,), or a dictionary of such, whose sum is the reward. `termination` and
    `truncation` take facts and give a bool array of shape (n,), where an episode ends early (None: when the semantic driver's
    agent is taken over; never). The end of the run ends it in any case: terminated after a takeover or collision, truncated
    when its time or the road is over.

    `info` has `tick`, `hash` and `seed`, `facts` (`aeye.gym.Facts` without `tick`, `hash` and the columns of the HUD), and after
    a step `reward_terms`; at the end of an episode also `outcome` (`intervened`, `missed`: a collision that nobody
    prevented, `censored`: the time or the road was over, or empty where it ended before the run), and `recording`, the path, where it is kept.

    Raises FileError where a file is not there, InputError for a value that cannot be.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 10}

    def __init__(
        self,
        *,
        seat: Literal["semantic", "safety"] = "semantic",
        observe: Literal["mask", "rgb", "both"] | None = None,
        size: tuple[int, int] | None = None,
        quality: Literal["plain", "standard", "fine"] | None = None,
        sensor: str | None = None,
        checkpoint: str | PathLike[str] | External = "truth",
        map: str | PathLike[str] | None = None,
        scenario: str | PathLike[str] | None = None,
        hazards: str | None = None,
        weather: str | None = None,
        pedestrians: int | None = None,
        max_time: float | None = None,
        brake_threshold: float | None = None,
        steer_threshold: float | None = None,
        ticks: int = 6,
        weights: Mapping[str, float] | None = None,
        reward: Reward | None = None,
        termination: End | None = None,
        truncation: End | None = None,
        record: str | PathLike[str] | None = None,
        render_mode: str | None = None,
        camera: Literal["driver", "chase", "top"] = "chase",
        render_size: tuple[int, int] = (512, 256),
    ) -> None:
        self._drives = Drives(
            1,
            seat=seat,
            observe=observe,
            size=size,
            quality=quality,
            sensor=sensor,
            checkpoint=checkpoint,
            ticks=ticks,
            weights=weights,
            reward=reward,
            termination=termination,
            truncation=truncation,
            record=record,
            camera=camera,
            render_mode=render_mode,
            render_size=render_size,
            jobs=1,
            map=map,
            scenario=scenario,
            hazards=hazards,
            weather=weather,
            pedestrians=pedestrians,
            max_time=max_time,
            brake_threshold=brake_threshold,
            steer_threshold=steer_threshold,
        )
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": 60 / ticks}
        self.observation_space = cast(gymnasium.Space[Observation], self._drives.observation_space)
        self.action_space = cast(gymnasium.Space[NDArray[np.float32]], actions())

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Starts a drive; a recording of the one before ends.

        `seed` is that of the scenario, as of `aeye drive --seed`; without one it is drawn. `options` replace `map`,
        `scenario`, `hazards`, `weather`, `pedestrians` or `max_time` for this episode.

        Raises InputError for options that cannot be, EngineError where there is no graphics driver.
        """
        super().reset(seed=seed)
        self._drives.arrays = self._drives.blank()
        self._drives.reset([0], [draw_seed(self.np_random) if seed is None else seed], options)
        return self._drives.observation(0), self._drives.info(0)

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Holds the controls for the ticks of a step.

        Raises InputError for an action of another shape or one that is no number, and after the end of an episode.
        """
        controls = np.asarray(action, dtype=np.float32)
        if controls.shape != self.action_space.shape:
            raise InputError(f"action of shape {controls.shape}; expected (3,): steering, throttle, brake")
        self._drives.arrays = self._drives.blank()
        told = self._drives.step([0], controls[np.newaxis])
        info = self._drives.info(0, told)
        terminated, truncated = bool(told.terminated[0]), bool(told.truncated[0])
        if terminated or truncated:
            info |= self._drives.finish([0])[0]
        return self._drives.observation(0), float(told.rewards[0]), terminated, truncated, info

    def render(self) -> NDArray[np.uint8] | None:
        """A picture from `camera`, uint8 of shape (height, width, 3), where the render mode is `rgb_array`."""
        return self._drives.draw(0) if self.render_mode else None

    def close(self) -> None:
        """Ends the drive; its recording is kept."""
        self._drives.close()


def draw_seed(random: np.random.Generator) -> int:
    """A seed for a scenario."""
    return int(random.integers(2**31))
