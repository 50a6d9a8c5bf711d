"""What one drive and many have in common."""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, NamedTuple

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from aeye._aeye import CLASSES, Episodes, External, Setting
from aeye._errors import InputError
from aeye.gym._rewards import End, Facts, Reward, ends, never, taken_over, terms_of, weighted

Observation = dict[str, NDArray[Any]]

# By their numbers in figures; the last one is that of a run that still goes on.
OUTCOMES = ("intervened", "missed", "censored", "")

# What `options` of a reset may replace.
_OPTIONS = ("map", "scenario", "hazards", "weather", "pedestrians", "max_time")


class Arrays(NamedTuple):
    """Where observations and figures go, a row for each drive."""

    mask: NDArray[np.uint8] | None
    rgb: NDArray[np.uint8] | None
    hud: NDArray[np.float32]
    figures: NDArray[np.float64]


class Told(NamedTuple):
    """What a step of some drives came to, an entry for each of them."""

    rewards: NDArray[np.float64]
    terms: dict[str, NDArray[np.float64]]
    terminated: NDArray[np.bool_]
    truncated: NDArray[np.bool_]


class Drives:
    """Drives in so many places, and what an agent observes and is rewarded for."""

    def __init__(
        self,
        places: int,
        *,
        seat: str,
        observe: str | None,
        size: tuple[int, int] | None,
        quality: str | None,
        sensor: str | None,
        checkpoint: str | PathLike[str] | External,
        ticks: int,
        weights: Mapping[str, float] | None,
        reward: Reward | None,
        termination: End | None,
        truncation: End | None,
        record: str | PathLike[str] | None,
        camera: str,
        render_mode: str | None,
        render_size: tuple[int, int],
        jobs: int | None,
        **setting: Any,
    ) -> None:
        if render_mode not in (None, "rgb_array"):
            raise InputError(f"render_mode={render_mode!r}; expected rgb_array or None")
        for name, function in (("reward", reward), ("termination", termination), ("truncation", truncation)):
            if function is not None and not callable(function):
                raise InputError(f"{name}={function!r}; expected something to call, or None")
        observed = _observed(seat if observe is None else None, observe)
        self.episodes = Episodes(
            places,
            seat=seat,
            checkpoint=checkpoint,
            ticks=ticks,
            masks="mask" in observed,
            images="rgb" in observed,
            size=size,
            quality=quality,
            sensor=sensor,
            record=record,
            camera=camera,
            render_size=render_size,
            jobs=jobs,
        )
        self.observation_space = _space(self.episodes, observed)
        self._shapes: dict[str, Any] = {name: space.shape for name, space in self.observation_space.spaces.items()}
        self._places = places
        self._reward = reward or weighted(seat, weights)
        self._termination = termination or (taken_over if seat == "semantic" else never)
        self._truncation = truncation or never
        self._setting = setting
        self._settings: dict[tuple[tuple[str, str], ...], Setting] = {(): Setting(**setting)}
        self.render_mode = render_mode
        self._pictures: list[NDArray[np.uint8] | None] = [None] * places
        self._seeds = [0] * places
        self.arrays = self.blank()

    def blank(self) -> Arrays:
        """New arrays, whose contents mean nothing yet."""

        def array(name: str) -> NDArray[np.uint8] | None:
            return np.empty((self._places, *self._shapes[name]), np.uint8) if name in self._shapes else None

        hud = np.empty((self._places, len(Episodes.HUD)), np.float32)
        return Arrays(array("mask"), array("rgb"), hud, np.empty((self._places, len(Episodes.FIGURES)), np.float64))

    def observation(self, row: int | slice = slice(None)) -> Observation:
        """What is observed of a drive, or of all."""
        given: dict[str, Any] = {"mask": self.arrays.mask, "rgb": self.arrays.rgb, "hud": self.arrays.hud}
        return {name: given[name][row] for name in self._shapes}

    def reset(self, places: Sequence[int], seeds: Sequence[int], options: Mapping[str, Any] | None) -> None:
        """Starts drives."""
        setting = self._setting_of(options or {})
        self.episodes.reset(list(places), list(seeds), setting, self.arrays)
        for place, seed in zip(places, seeds, strict=True):
            self._seeds[place] = seed
            self._pictures[place] = None

    def step(self, places: Sequence[int], actions: NDArray[np.float32]) -> Told:
        """Steps drives by actions, a row for each of them."""
        if not np.isfinite(actions).all():
            raise InputError(f"action {actions.tolist()}; expected finite numbers")
        self.episodes.step(list(places), actions, self.arrays)
        facts = self._facts(places)
        terms = terms_of(self._reward, facts)
        rewards = sum(terms.values(), np.zeros(len(places)))
        over = facts["outcome"]
        terminated = ends(self._termination, "termination", facts) | (over == 0) | (over == 1)
        truncated = ends(self._truncation, "truncation", facts) | (over == 2)
        return Told(rewards, terms, terminated, truncated)

    def _facts(self, places: Sequence[int]) -> Facts:
        figures, hud = self.arrays.figures[places], self.arrays.hud[places]
        facts = dict(zip(Episodes.FIGURES, figures.T, strict=True))
        return facts | dict(zip(Episodes.HUD, hud.T, strict=True))

    def table(self) -> dict[str, Any]:
        """What is told of all drives beside their observations, an entry for each."""
        facts = dict(zip(Episodes.FIGURES, self.arrays.figures.T.copy(), strict=True))
        ticks, hashes = (facts.pop(name).astype(np.int64) for name in ("tick", "hash"))
        return {"tick": ticks, "hash": hashes, "seed": np.array(self._seeds), "facts": facts}

    def info(self, place: int, told: Told | None = None, row: int = 0) -> dict[str, Any]:
        """What is told of a drive; `row` is its own of what a step came to."""
        info = {name: _entry(column, place) for name, column in self.table().items()}
        return info if told is None else info | {"reward_terms": _entry(told.terms, row)}

    def finish(self, places: Sequence[int]) -> list[dict[str, Any]]:
        """Ends drives, and tells how they ended and where their recordings are."""
        if self.render_mode:
            for place in places:
                self._pictures[place] = self.draw(place)
        facts = self._facts(places)
        # A run that was taken over ends as such, sooner or later.
        outcomes = np.where(facts["taken_over"] > 0, 0, facts["outcome"]).astype(int).tolist()
        paths = self.episodes.finish(list(places))
        return [
            {"outcome": OUTCOMES[outcome]} | ({} if path is None else {"recording": str(path)})
            for outcome, path in zip(outcomes, paths, strict=True)
        ]

    def draw(self, place: int) -> NDArray[np.uint8]:
        """A picture of a drive, or the last one of a drive that is over."""
        picture = self._pictures[place]
        return self.episodes.draw(place) if picture is None else picture.copy()

    def close(self) -> None:
        """Ends all drives."""
        self.episodes.finish(list(range(self._places)))

    def _setting_of(self, options: Mapping[str, Any]) -> Setting:
        for name in options:
            if name not in _OPTIONS:
                raise InputError(f"option {name!r}; expected some of {', '.join(_OPTIONS)}")
        key = tuple(sorted((name, str(value)) for name, value in options.items()))
        if key not in self._settings:
            kept = dict(self._setting)
            if {"map", "scenario"} & options.keys():
                kept.update(map=None, scenario=None)
            self._settings[key] = Setting(**{**kept, **options})
        return self._settings[key]


def _entry(column: Any, row: int) -> Any:
    """That of a drive, of one column or of several."""
    if isinstance(column, dict):
        return {name: _entry(part, row) for name, part in column.items()}
    return column[row].item()


def _observed(seat: str | None, observe: str | None) -> tuple[str, ...]:
    if observe is None:
        return ("rgb",) if seat == "safety" else ("mask",)
    if observe not in ("mask", "rgb", "both"):
        raise InputError(f"observe={observe!r}; expected mask, rgb or both")
    return ("mask", "rgb") if observe == "both" else (observe,)


def _space(episodes: Episodes, observed: tuple[str, ...]) -> spaces.Dict:
    (mask_width, mask_height), (width, height) = episodes.mask_size, episodes.image_size
    low, high = np.array(Episodes.HUD_RANGES, np.float32).T
    every: dict[str, gymnasium.Space[Any]] = {
        "mask": spaces.Box(0, max(CLASSES), (mask_height, mask_width), np.uint8),
        "rgb": spaces.Box(0, 255, (height, width, 3), np.uint8),
    }
    return spaces.Dict({name: every[name] for name in observed} | {"hud": spaces.Box(low, high, dtype=np.float32)})


def actions() -> spaces.Box:
    """Steering (positive to the right), throttle, brake."""
    return spaces.Box(np.array([-1, 0, 0], np.float32), np.array([1, 1, 1], np.float32), dtype=np.float32)
