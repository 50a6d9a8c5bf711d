"""An experiment's pieces, and what travels to machines that do them."""

import importlib.util
from pathlib import Path

import aeye
import pytest

needs_ray = pytest.mark.skipif(importlib.util.find_spec("ray") is None, reason="Ray is not installed; make cluster has it")

RECIPE = Path(__file__).parents[2] / "tests" / "cluster" / "recipe.toml"


def test_what_can_be_done_first_needs_nothing(tmp_path):
    pieces = aeye.pieces("smoke", tmp_path / "out")
    assert [(piece["piece"], piece["needs"]) for piece in pieces] == [("datasets/natural", []), ("datasets/pool", [])]
    assert aeye.pieces(RECIPE, tmp_path / "out") == pieces
    assert not (tmp_path / "out").exists()


def test_nonsense_is_refused(tmp_path):
    with pytest.raises(aeye.FileError, match="huge: no such file; .* presets smoke, small, desk, paper"):
        aeye.experiment("huge", tmp_path / "out")
    with pytest.raises(aeye.InputError, match="networks/natural-3: is no piece of this experiment"):
        aeye.experiment("smoke", tmp_path / "out", piece="networks/natural-3")
    (tmp_path / "wrong.toml").write_text(RECIPE.read_text().replace("seed = 5", "sead = 5"))
    with pytest.raises(aeye.InputError, match="wrong.toml.*unknown field"):
        aeye.pieces(tmp_path / "wrong.toml", tmp_path / "out")
    with pytest.raises(aeye.EngineError, match="driving.onnx: is not there; expected it before campaign-1/driving-0000"):
        aeye.experiment("smoke", tmp_path / "out", piece="campaign-1/driving-0000")


@needs_ray
def test_what_a_piece_needs_travels(tmp_path):
    from aeye import _pieces

    for place in ("datasets/natural/dataset.json", "datasets/natural/a/b.png", "campaign-1/.waiting/driving/c.mcap"):
        (tmp_path / "here" / place).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "here" / place).write_text(place)
    files = _pieces._read_below(tmp_path / "here", "datasets/natural")
    assert sorted(files) == ["datasets/natural/a/b.png", "datasets/natural/dataset.json"]
    everything = _pieces._read_below(tmp_path / "here", "")
    assert len(everything) == 3
    _pieces._write_below(everything, tmp_path / "there")
    assert _pieces._read_below(tmp_path / "there", "") == everything


@needs_ray
def test_maps_of_a_recipe_travel_or_are_refused(tmp_path, monkeypatch):
    from aeye import _pieces

    def packed(maps: str) -> tuple[str, dict[str, bytes]]:
        Path("mine.toml").write_text(RECIPE.read_text().replace('["city"]', maps))
        return _pieces._packed("mine.toml")

    monkeypatch.chdir(tmp_path)
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps" / "street.xodr").write_text("a street")
    assert _pieces._packed("smoke") == ("smoke", {})
    name, files = packed("[\"city\", 'maps/street.xodr']")
    assert name == "recipe.toml" and sorted(files) == ["maps/street.xodr", "recipe.toml"]
    with pytest.raises(aeye.InputError, match=r"\.\./street.xodr does not travel"):
        packed('["../street.xodr"]')
    with pytest.raises(aeye.FileError, match="gone.xodr: No such file"):
        packed('["gone.xodr"]')
