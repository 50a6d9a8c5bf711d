"""The stubs are those of the native module, name by name, and examples in the documentation run."""

import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import aeye

PAGE = Path(__file__).parents[2] / "docs" / "python.md"


def test_stubs_are_one_to_one():
    check = [sys.executable, "-m", "mypy.stubtest", "aeye", "--ignore-disjoint-bases"]
    found = subprocess.run(check, text=True, capture_output=True, check=False)
    assert found.returncode == 0, found.stdout + found.stderr


def test_everything_public_says_what_it_is():
    for name in aeye.__all__:
        thing = getattr(aeye, name)
        if isinstance(thing, type) or callable(thing):
            assert thing.__doc__, name
        if isinstance(thing, type):
            assert all(getattr(thing, member).__doc__ for member in vars(thing) if not member.startswith("_")), name


def test_the_page_runs(drive, case, program, tmp_path, monkeypatch):
    """Every block of Python of the page, and what it makes of cases by the command, one after the other.

    What takes minutes there, a drive and a campaign, is in the folder already.
    """
    (tmp_path / "drive.mcap").symlink_to(drive)
    shutil.copytree(case.parent, tmp_path / "cases")
    monkeypatch.chdir(tmp_path)
    blocks = PAGE.read_text().split("```")[1::2]
    assert sum(block.startswith("python\n") for block in blocks) > 3
    names: dict[str, object] = {}
    for block in blocks:
        if block.startswith("python\n"):
            exec(compile(block.removeprefix("python"), str(PAGE), "exec"), names)
        for line in block.splitlines():
            if line.startswith("aeye dataset "):
                program(*shlex.split(line)[1:])
