"""Something to read: a short drive, a corner case, a folder of labelled pictures, and the program that made them."""

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Program = Callable[..., subprocess.CompletedProcess[str]]

# Many people on foot, so that a takeover is not long in coming.
CAMPAIGN = "campaign --checkpoint early --maps city --pedestrians 300 --seed 1 --cases 1 --max-time 40s"


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
    """A corner case."""
    folder = tmp_path_factory.mktemp("campaign") / "drives"
    program(*CAMPAIGN.split(), "--out", folder)
    return next(folder.glob("*.case.mcap"))


@pytest.fixture(scope="session")
def dataset(program: Program, case: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The case as labelled pictures."""
    folder = tmp_path_factory.mktemp("dataset") / "cases"
    program("dataset", "cases", case, "--out", folder)
    return folder
