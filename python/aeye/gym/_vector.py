"""Many drives."""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Literal

import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from aeye._aeye import External
from aeye._errors import InputError
from aeye.gym._drives import Drives, Observation, Told
from aeye.gym._drives import actions as action_space
from aeye.gym._env import DriveEnv, draw_seed
from aeye.gym._rewards import End, Reward

Infos = dict[str, Any]


class DriveVectorEnv(VectorEnv[Observation, NDArray[np.float32], NDArray[Any]]):
    """So many drives of `DriveEnv`, `num_envs` of them, stepped together over the cores.

    Each drives what a `DriveEnv` with its seed drives, whatever their number. Observations, actions and infos are those of
    `DriveEnv` with one more axis in front, as Gymnasium's vector environments have them.

    `jobs` are stepped at the same time (None: one a core). `autoreset_mode` is one of Gymnasium's: an episode that is over
    begins anew with the next step (the default), in the same step (`final_obs` and `final_info` tell of the last one), or only by
    `reset` with `options={"reset_mask": ...}`. With `copy=False` each step writes into the arrays that it gave before.

    All else is as of `DriveEnv`. Raises FileError where a file is not there, InputError for a value that cannot be.
    """

    def __init__(
        self,
        num_envs: int = 1,
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
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        jobs: int | None = None,
    ) -> None:
        self._drives = Drives(
            num_envs,
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
            jobs=jobs,
            map=map,
            scenario=scenario,
            hazards=hazards,
            weather=weather,
            pedestrians=pedestrians,
            max_time=max_time,
            brake_threshold=brake_threshold,
            steer_threshold=steer_threshold,
        )
        self.num_envs = num_envs
        self.render_mode = render_mode
        self._mode = AutoresetMode(autoreset_mode)
        self._copy = copy
        self.metadata = {**DriveEnv.metadata, "render_fps": 60 / ticks, "autoreset_mode": self._mode}
        self.single_observation_space = self._drives.observation_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.single_action_space = action_space()
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._over = np.ones(num_envs, np.bool_)
        self._randoms: list[np.random.Generator | None] = [None] * num_envs
        self._random_seeds: list[int] = [-1] * num_envs

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observation, Infos]:
        """Starts drives; recordings of those before end.

        `seed` is that of the first drive, the others have the numbers that follow; or one for each (None: drawn). `options` are
        those of `DriveEnv.reset`, for all drives; `reset_mask` of them, a bool array of shape (num_envs,), says which drives start
        (default: all).

        Raises InputError for seeds or options that cannot be, EngineError where there is no graphics driver.
        """
        options = dict(options or {})
        places = self._asked(options.pop("reset_mask", None))
        seeds = self._seeded(seed)
        self._begin()
        self._drives.reset(places, [self._draw(place, seeds[place]) for place in places], options)
        self._over[places] = False
        return self._drives.observation(), _masked(self._drives.table(), self._mask_of(places))

    def step(
        self, actions: NDArray[np.float32]
    ) -> tuple[Observation, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], Infos]:
        """Holds the controls of each drive for the ticks of a step.

        Raises InputError for actions of another shape or such as are no numbers, and where an episode is over and not reset.
        """
        actions = np.asarray(actions, dtype=np.float32)
        if actions.shape != self.action_space.shape:
            raise InputError(f"actions of shape {actions.shape}; expected {self.action_space.shape}")
        anew = np.flatnonzero(self._over).tolist() if self._mode is AutoresetMode.NEXT_STEP else []
        going = [place for place in range(self.num_envs) if place not in anew]
        rewards = np.zeros(self.num_envs)
        terminated, truncated = np.zeros((2, self.num_envs), np.bool_)
        self._begin()
        infos: Infos = {}
        if going:
            told = self._drives.step(going, actions[going])
            rewards[going], terminated[going], truncated[going] = told.rewards, told.terminated, told.truncated
            infos = self._told(going, told)
        self._over = terminated | truncated
        if self._mode is AutoresetMode.SAME_STEP:
            anew = np.flatnonzero(self._over).tolist()
            self._over[:] = False
        if anew:
            self._drives.reset(anew, [self._draw(place, None) for place in anew], None)
        infos |= _masked(self._drives.table(), np.ones(self.num_envs, np.bool_))
        return self._drives.observation(), rewards, terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """A picture of each drive, as `DriveEnv.render` gives it."""
        return tuple(self._drives.draw(place) for place in range(self.num_envs)) if self.render_mode else None

    def close_extras(self, **_: Any) -> None:
        """Ends the drives; their recordings are kept."""
        self._drives.close()

    @property  # type: ignore[misc]
    def np_random(self) -> tuple[np.random.Generator, ...]:  # type: ignore[override]
        """What draws the seeds of each drive."""
        return tuple(self._random(place) for place in range(self.num_envs))

    @property
    def np_random_seed(self) -> tuple[int, ...]:  # type: ignore[override]
        """What that was seeded with."""
        return tuple(self._random_seeds) if all(self.np_random) else ()

    def _begin(self) -> None:
        """Makes room for what is told; what is not written anew stays as it was."""
        if self._copy:
            before = self._drives.arrays
            self._drives.arrays = self._drives.blank()
            for new, old in zip(self._drives.arrays, before, strict=True):
                if new is not None and old is not None and self._mode is AutoresetMode.DISABLED:
                    new[...] = old

    def _told(self, places: list[int], told: Told) -> Infos:
        """The terms of rewards, and how episodes ended."""
        over = told.terminated | told.truncated
        rows = np.flatnonzero(over).tolist()
        ended = [places[row] for row in rows]
        infos: Infos = {}
        for row, place, end in zip(rows, ended, self._drives.finish(ended) if ended else [], strict=True):
            if self._mode is AutoresetMode.SAME_STEP:
                last = {name: array.copy() for name, array in self._drives.observation(place).items()}
                end = {"final_obs": last, "final_info": self._drives.info(place, told, row) | end}
            infos = self._add_info(infos, end, place)
        # Those that begin anew tell of their start.
        shown = ~over if self._mode is AutoresetMode.SAME_STEP else np.ones_like(over)
        return infos | self._terms(np.array(places)[shown], {name: term[shown] for name, term in told.terms.items()})

    def _terms(self, places: NDArray[np.intp], terms: dict[str, NDArray[np.float64]]) -> Infos:
        if not places.size:
            return {}
        columns = {name: np.zeros(self.num_envs) for name in terms}
        for name, term in terms.items():
            columns[name][places] = term
        return _masked({"reward_terms": columns}, self._mask_of(places))

    def _mask_of(self, places: list[int] | NDArray[np.intp]) -> NDArray[np.bool_]:
        mask = np.zeros(self.num_envs, np.bool_)
        mask[places] = True
        return mask

    def _asked(self, mask: Any) -> list[int]:
        if mask is None:
            return list(range(self.num_envs))
        mask = np.asarray(mask)
        if mask.shape != (self.num_envs,) or mask.dtype != np.bool_ or not mask.any():
            raise InputError(f"reset_mask of {mask.dtype} and shape {mask.shape}; expected bool, ({self.num_envs},), some True")
        return np.flatnonzero(mask).tolist()

    def _seeded(self, seed: int | Sequence[int | None] | None) -> list[int | None]:
        if seed is None:
            return [None] * self.num_envs
        if isinstance(seed, int | np.integer):
            return [int(seed) + place for place in range(self.num_envs)]
        if len(seed) != self.num_envs:
            raise InputError(f"{len(seed)} seeds; expected one, or one for each of {self.num_envs} drives")
        return list(seed)

    def _draw(self, place: int, seed: int | None) -> int:
        """The seed of a drive: the one that is given, which others are drawn from later, or a drawn one."""
        if seed is None:
            return draw_seed(self._random(place))
        self._randoms[place], self._random_seeds[place] = seeding.np_random(seed)
        return seed

    def _random(self, place: int) -> np.random.Generator:
        random = self._randoms[place]
        if random is None:
            random, self._random_seeds[place] = seeding.np_random()
            self._randoms[place] = random
        return random


def _masked(table: Infos, mask: NDArray[np.bool_]) -> Infos:
    """Columns as Gymnasium's infos: beside each `name` stands `_name`, which drives have an entry."""
    columns = {name: _masked(column, mask) if isinstance(column, dict) else column for name, column in table.items()}
    return columns | {f"_{name}": mask.copy() for name in table}
