"""The examples run, each as a program of its own."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[1] / "examples"


def run(name: str, *arguments: str | Path) -> str:
    """What an example prints."""
    done = subprocess.run([sys.executable, EXAMPLES / name, *arguments], text=True, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_look_at_a_case(case, tmp_path):
    said = run("look_at_a_case.py", case, tmp_path / "worst.png")
    assert "another class" in said and (tmp_path / "worst.png").stat().st_size > 1000


def test_own_network(case):
    mine, early = (float(line.split()[-1]) for line in run("own_network.py", case.parent).splitlines())
    assert mine < early


def test_random_agent(tmp_path):
    said = run("random_agent.py", tmp_path)
    assert "verified" in said and "eight drives" in said


@pytest.mark.skipif(importlib.util.find_spec("torch") is None, reason="PyTorch is not installed")
def test_train_torch(case):
    losses = [float(line.split()[-1]) for line in run("train_torch.py", case.parent).splitlines()]
    assert len(losses) == 3 and losses[2] < losses[0]


def test_every_example_has_a_test():
    here = Path(__file__).read_text()
    assert all(f'"{example.name}"' in here for example in EXAMPLES.glob("*.py"))
