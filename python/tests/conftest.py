"""Something to read: a short drive, a corner case, a folder of labelled pictures, and the program that made them."""

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Program = Callable[..., subprocess.CompletedProcess[str]]

# Many people, who often step onto the road, and mistakes of others, so that a takeover is not long in coming.
HASTY = """map = "city"

[traffic]
pedestrians = 300
jaywalks_per_min = 60.0

[hazards]
level = "raised"
"""
CAMPAIGN = "campaign --checkpoint early --seed 2 --cases 1 --max-time 60s"


@pytest.fixture(scope="session")
def program() -> Program:
    """The command `aeye` with arguments, some of them paths."""

    def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
        command = [os.environ["AEYE"], *map(str, arguments)]
        return subprocess.run(command, check=True, text=True, capture_output=True)

    return run


@pytest.fixture(scope="session")
def said(program: Program) -> Callable[..., dict[str, Any]]:
    """What the command prints with `--json`."""
    return lambda *arguments: json.loads(program("--json", *arguments).stdout)


@pytest.fixture(scope="session")
def drive(program: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Thirteen seconds, with a keyframe in between."""
    path = tmp_path_factory.mktemp("drive") / "drive.mcap"
    program("drive", "--headless", "--map", "city", "--max-time", "13s", "--record", path)
    return path


@pytest.fixture(scope="session")
def case(program: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A corner case with a takeover."""
    folder = tmp_path_factory.mktemp("campaign")
    scenario, drives = folder / "hasty.toml", folder / "drives"
    scenario.write_text(HASTY)
    program(*CAMPAIGN.split(), "--scenario", scenario, "--out", drives)
    return next(drives.glob("*.case.mcap"))


@pytest.fixture(scope="session")
def dataset(program: Program, case: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The case as labelled pictures."""
    folder = tmp_path_factory.mktemp("dataset") / "cases"
    program("dataset", "cases", case, "--out", folder)
    return folder
