"""The stubs are those of the native module, name by name, and examples in the documentation run."""

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


def test_the_page_runs(drive, case, dataset, tmp_path, monkeypatch):
    """Every block of Python of the page, one after the other, in a folder where its files are."""
    for name, path in (("drive.mcap", drive), ("cases/a.case.mcap", case), ("dataset", dataset)):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).symlink_to(path)
    monkeypatch.chdir(tmp_path)
    blocks = [block.split("```")[0] for block in PAGE.read_text().split("```python\n")[1:]]
    assert len(blocks) > 3
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), names)
