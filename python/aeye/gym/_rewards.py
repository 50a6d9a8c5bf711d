"""What a step is worth, and when an episode ends."""

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from aeye._errors import InputError

Facts: TypeAlias = dict[str, NDArray[Any]]
"""What a step came to: an array of shape (n,) for each name, an entry for each drive (one where there is one drive).

`tick` (60 a second), `hash` (low 32 bits of the world's state), `outcome` (-1 while the run goes on, 0 it ended after a
takeover, 1 by a collision that nobody prevented, 2 because its time or the road was over), `taken_over` (0 or 1); of the step alone:
`progress_m` (along the route, negative against it), `jerk_mps2` (integral of the jerk along the car, without sign),
`sideways_mps` (integral of the acceleration to the side, without sign), `red_lights` and `collisions` (how many),
`off_road_s`, `wrong_way_s` and `speeding_s` (for how long), `takeovers` (0 or 1); and the columns of the HUD by their names.
"""

Reward: TypeAlias = Callable[[Facts], "NDArray[Any] | Mapping[str, NDArray[Any]]"]
End: TypeAlias = Callable[[Facts], "NDArray[np.bool_]"]

# The fact that each term of the reward is proportional to.
_FACTS = {
    "progress": "progress_m",
    "jerk": "jerk_mps2",
    "sideways": "sideways_mps",
    "red_light": "red_lights",
    "off_road": "off_road_s",
    "wrong_way": "wrong_way_s",
    "speeding": "speeding_s",
    "collision": "collisions",
    "takeover": "takeovers",
}

_SEMANTIC = {
    "progress": 0.1,
    "jerk": -0.01,
    "sideways": -0.02,
    "red_light": -5.0,
    "off_road": -1.0,
    "wrong_way": -1.0,
    "speeding": -0.5,
    "collision": -20.0,
    "takeover": -10.0,
}

WEIGHTS: dict[str, dict[str, float]] = {"semantic": _SEMANTIC, "safety": {**_SEMANTIC, "takeover": -1.0}}
"""Weights of the reward's terms for an agent in either seat.

The reward is the sum of the terms: 0.1 for each metre along the route, less so much for discomfort (each m/s² by which the
acceleration along the car changes, each m/s² to the side for a second), for what is against the rules (each red light, each
second beside the road, against the direction of the lane or too fast), for each collision, and for a takeover, which costs the
semantic driver much and the safety driver little.
"""


def weighted(seat: str, weights: Mapping[str, float] | None) -> Callable[[Facts], dict[str, NDArray[Any]]]:
    """The reward of a seat with its weights, some of them replaced."""
    for name in weights or {}:
        if name not in _FACTS:
            raise InputError(f"weight {name!r}; expected some of {', '.join(_FACTS)}")
    used = {**WEIGHTS[seat], **(weights or {})}
    # Nothing times a negative weight is no negative nothing.
    return lambda facts: {name: used[name] * facts[fact] + 0.0 for name, fact in _FACTS.items()}


def terms_of(reward: Reward, facts: Facts) -> dict[str, NDArray[np.float64]]:
    """What a reward gives, term by term; what is no sum of terms is one, `reward`."""
    given = reward(facts)
    terms = given if isinstance(given, Mapping) else {"reward": given}
    return {name: _column(name, term, facts, np.float64) for name, term in terms.items()}


def ends(end: End, name: str, facts: Facts) -> NDArray[np.bool_]:
    """Where an episode is to end."""
    return _column(name, end(facts), facts, np.bool_)


def _column(name: str, given: Any, facts: Facts, dtype: Any) -> NDArray[Any]:
    column = np.asarray(given, dtype=dtype)
    if column.shape != facts["tick"].shape:
        raise InputError(f"{name} has the shape {column.shape}; expected {facts['tick'].shape}, as facts have")
    return column


def never(facts: Facts) -> NDArray[np.bool_]:
    """Nowhere."""
    return np.zeros(facts["tick"].shape, dtype=np.bool_)


def taken_over(facts: Facts) -> NDArray[np.bool_]:
    """Where the safety driver has taken over."""
    return facts["taken_over"] > 0
