"""Shards of a campaign, and what they come to; what travels to machines that drive them."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

import aeye
import pytest
from aeye import _shipped
from aeye._shipped import Shipped

DRIVES = {"maps": "city", "runs": 3, "seed": 5, "max_time": 10}
NOTHING = {"checkpoint": "early", "maps": None, "scenario": None}

needs_ray = pytest.mark.skipif(importlib.util.find_spec("ray") is None, reason="Ray is not installed; make cluster has it")


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_shards_come_to_what_one_process_gives(tmp_path):
    expected = aeye.campaign("truth", tmp_path / "alone", **DRIVES)
    second = aeye.campaign("truth", tmp_path / "shards" / "2", shard=(2, 2), **DRIVES)
    assert (second["shard"], second["of"], second["runs"]) == (2, 2, 1)
    with pytest.raises(aeye.MissingRunsError, match="truth 0, 2; expected all of --shard 1/2"):
        aeye.collect(tmp_path / "shards", tmp_path / "early")
    aeye.campaign("truth", tmp_path / "shards" / "1", shard=(1, 2), **DRIVES)
    found = aeye.collect(tmp_path / "shards", tmp_path / "together")
    assert found == expected and isinstance(found["runs"], aeye.Table)
    assert contents(tmp_path / "together") == contents(tmp_path / "alone")

    travelled = _shipped.folder_as_bytes(tmp_path / "shards" / "2")
    _shipped.write_folder(travelled, tmp_path / "elsewhere")
    assert _shipped.is_whole(tmp_path / "elsewhere")
    assert aeye.collect([tmp_path / "shards" / "1", tmp_path / "elsewhere"], tmp_path / "moved") == expected


@pytest.mark.parametrize(
    ("command", "more"),
    [("compare", {"checkpoints": ["early", "truth"]}), ("redrive", {"without_intervention": True, "after": 1})],
)
def test_shards_of_files_are_finished_by_the_same_call(command, more, case, tmp_path):
    call = getattr(aeye, command)
    for i, done in ((2, 0), (1, 1)):
        share = call(case, out=tmp_path / "together", shard=(i, 2), **more)
        assert (share["shard"], share["of"], share["done"]) == (i, 2, done)
    together = call(case, out=tmp_path / "together", **more)
    alone = call(case, out=tmp_path / "alone", **more)
    assert together.keys() == alone.keys()
    assert {key for key in alone if together[key] != alone[key]} <= {"speed", "out"}
    with pytest.raises(aeye.InputError, match="expected \\(i, n\\)"):
        call(case, out=tmp_path / "none", shard=(3, 2), **more)


@pytest.mark.parametrize("shard", [(0, 2), (3, 2), (1, 0)])
def test_no_such_shard(shard, tmp_path):
    with pytest.raises(aeye.InputError, match="expected \\(i, n\\)"):
        aeye.campaign("truth", tmp_path / "out", shard=shard, **DRIVES)


def test_shards_need_an_end(tmp_path):
    with pytest.raises(aeye.InputError, match="a shard without runs or vary"):
        aeye.campaign("truth", tmp_path / "out", shard=(1, 2), km=1.0)


def test_files_travel_and_names_stay(tmp_path):
    (tmp_path / "maps").mkdir()
    for name in ("a.onnx", "maps/street.xodr", "here.xodr"):
        (tmp_path / name).write_text(name)
    (tmp_path / "run.toml").write_text('seed = 1\nmap = "maps/street.xodr"\n')
    asked = {"checkpoint": ["early", tmp_path / "a.onnx"], "maps": tmp_path / "here.xodr", "scenario": tmp_path / "run.toml"}
    packed = Shipped.pack({**asked, "runs": 3})
    shutil.rmtree(tmp_path / "maps")
    (tmp_path / "a.onnx").unlink()
    with packed.unpack() as (here, out):
        assert here["checkpoint"][0] == "early" and here["runs"] == 3
        assert here["checkpoint"][1].name == "a.onnx" and here["checkpoint"][1].read_text() == "a.onnx"
        assert here["maps"][0].read_text() == "here.xodr"
        assert (here["scenario"].parent / "maps" / "street.xodr").read_text() == "maps/street.xodr"
        assert not out.exists()
    assert not out.parent.exists()


def test_a_story_travels_with_its_map_and_catalogs_and_a_bundled_one_is_a_name(tmp_path):
    (tmp_path / "catalogs").mkdir()
    for name in ("catalogs/cars.xosc", "street.xodr", "other.xodr"):
        (tmp_path / name).write_text(name)
    story = '<Directory path="catalogs"/><LogicFile filepath="street.xodr"/><LogicFile filepath="../street.xodr"/>'
    (tmp_path / "cut.xosc").write_text(story)
    packed = Shipped.pack({**NOTHING, "scenario": tmp_path / "cut.xosc"})
    assert set(packed.files) == {"scenario/cut.xosc", "scenario/catalogs/cars.xosc", "scenario/street.xodr"}
    assert Shipped.pack({**NOTHING, "scenario": "cut_out"}).arguments["scenario"] == "cut_out"


def test_what_a_call_is_follows_from_the_content_of_files(tmp_path):
    def identity(text: str) -> dict[str, object]:
        (tmp_path / "a.onnx").write_text(text)
        return Shipped.pack({**NOTHING, "checkpoint": tmp_path / "a.onnx"}).identity()

    assert identity("one") == identity("one") != identity("another")


def test_a_file_that_is_not_there_does_not_travel(tmp_path):
    with pytest.raises(aeye.FileError, match="gone.onnx: No such file"):
        Shipped.pack({**NOTHING, "checkpoint": tmp_path / "gone.onnx"})


def test_a_folder_that_was_left_half_written_is_not_whole(tmp_path):
    (tmp_path / "1").mkdir()
    (tmp_path / "1" / "early-0000.mcap").write_bytes(b"")
    assert not _shipped.is_whole(tmp_path / "1")
    with pytest.raises(aeye.EngineError, match="without shard.json"):
        _shipped.write_folder({"early-0000.mcap": b"1"}, tmp_path / "1")


def test_without_ray_one_sentence_says_so(tmp_path):
    """Also where it is installed: a module that is not to be had stands in its way."""
    code = "import sys; sys.modules['ray'] = None; import aeye; import aeye.ray"
    done = subprocess.run([sys.executable, "-c", code], text=True, capture_output=True, check=False, cwd=tmp_path)
    last = done.stderr.splitlines()[-1]
    assert done.returncode == 1 and last.startswith("ImportError: Ray is not installed; ") and "aeye[ray]" in last


@needs_ray
def test_a_folder_of_another_call_is_refused(tmp_path):
    import aeye.ray as on_ray

    folder = tmp_path / "out.shards"
    on_ray._keep_request({"shards": 2, "seed": 1}, folder)
    on_ray._keep_request({"shards": 2, "seed": 1}, folder)
    with pytest.raises(aeye.InputError, match="seed is 1 there, 2 here"):
        on_ray._keep_request({"shards": 2, "seed": 2}, folder)
