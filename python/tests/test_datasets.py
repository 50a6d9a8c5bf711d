"""Datasets give the frames of the files, also in other processes."""

import multiprocessing
import pickle
import shutil
from multiprocessing.connection import Connection
from pathlib import Path

import aeye
import numpy as np
import pytest
from aeye.datasets import CornerCases, Natural


@pytest.fixture(scope="module")
def files(drive: Path, case: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a drive and, below it, two cases."""
    folder = tmp_path_factory.mktemp("files")
    (folder / "below").mkdir()
    shutil.copy(drive, folder / "drive.mcap")
    for name in ("a.case.mcap", "b.case.mcap"):
        shutil.copy(case, folder / "below" / name)
    return folder


def test_samples_are_the_frames_of_the_files(files):
    cases = CornerCases(files, size=(64, 32), last=2.0, fps=20)
    window = aeye.open(files / "below" / "a.case.mcap").frames(last=2.0, fps=20, size=(64, 32))
    assert len(window) > 32, "more than one piece"
    assert [path.name for path in cases.paths] == ["a.case.mcap", "b.case.mcap"]
    assert len(cases) == 2 * len(window)
    for index in (0, 33, len(window) - 1, len(window), -1):
        rgb, class_ids = cases[index]
        frame = window[index % len(window)]
        assert np.array_equal(rgb, frame.rgb) and np.array_equal(class_ids, frame.class_ids)
        assert cases.path_of(index).name == ("a" if 0 <= index < len(window) else "b") + ".case.mcap"
    with pytest.raises(IndexError):
        cases[len(cases)]


def test_samples_have_the_quality_and_the_sensor_that_are_asked_for(files):
    made = {"quality": "standard", "sensor": "noise=6"}
    case = files / "below" / "a.case.mcap"
    frames = aeye.open(case).frames(last=0.5, size=(64, 32), **made)
    samples = CornerCases(case, size=(64, 32), last=0.5, **made)
    assert np.array_equal(samples[3][0], frames[3].rgb)
    assert not np.array_equal(samples[3][0], CornerCases(case, size=(64, 32), last=0.5)[3][0])
    drive = aeye.open(files / "drive.mcap").frames(last=None, fps=1, size=(64, 32), **made)
    assert np.array_equal(Natural(files, size=(64, 32), **made)[2][0], drive[2].rgb)


def test_a_drive_is_taken_from_its_start_to_its_end(files):
    natural = Natural(files, size=(64, 32), fps=2, transform=lambda frame: frame.tick)
    assert [path.name for path in natural.paths] == ["drive.mcap"]
    assert [natural[i] for i in range(len(natural))] == list(range(0, 781, 30))


def test_what_was_asked_for_last_is_kept(files):
    drawn = []
    cases = CornerCases(files, size=(32, 16), last=1.0, transform=lambda frame: drawn.append(frame.tick), keep=1)
    half = len(cases) // 2
    for index in (half + 1, 0, 1, half, 0):
        cases[index]
    assert len(drawn) == 2 * (half + 1), "the first case is drawn as a whole, twice, since who goes back wants any order"


def test_who_goes_on_draws_what_is_asked_for_alone(files):
    drawn = []
    cases = CornerCases(files, size=(32, 16), last=1.0, transform=lambda frame: drawn.append(frame.tick) or frame.tick)
    every_other = [cases[index] for index in range(0, len(cases), 2)]
    assert drawn == every_other, "the ones between are another worker's"
    assert [cases[index] for index in range(0, len(cases), 2)] == every_other
    in_between = {cases[index] for index in range(1, len(cases), 2)}
    assert len(drawn) == len(cases) and in_between.isdisjoint(every_other), "none twice"


def test_a_file_stands_for_itself_and_other_files_are_told(files):
    assert [path.name for path in CornerCases(files / "below" / "a.case.mcap").paths] == ["a.case.mcap"]
    with pytest.raises(aeye.InputError, match="drive.mcap: a recording; expected a case"):
        CornerCases(files / "drive.mcap")
    with pytest.raises(aeye.InputError, match="has no recording among its files"):
        Natural(files / "below")
    with pytest.raises(aeye.InputError, match="size 3x3; expected sides of 8 to 8192"):
        CornerCases(files, size=(3, 3))


@pytest.mark.parametrize(("folder", "error"), [("gone", aeye.FileError), (".", aeye.InputError)])
def test_a_folder_without_cases_is_refused(folder, error, tmp_path):
    with pytest.raises(error, match="no "):
        CornerCases(tmp_path / folder)


def last_sample(dataset: CornerCases, answer: Connection) -> None:
    """What a worker does; the sum of the picture, or the sentence of what is wrong."""
    try:
        answer.send(int(dataset[-1][0].sum()))
    except aeye.Error as error:
        answer.send(str(error))


def asked(method: str, dataset: CornerCases) -> int | str:
    mine, its = multiprocessing.Pipe()
    process = multiprocessing.get_context(method).Process(target=last_sample, args=(dataset, its))
    process.start()
    answered = mine.poll(60)
    process.kill()
    process.join()
    assert answered
    return mine.recv()


def test_workers_open_their_own_device(files):
    # The parent has drawn the first case and the workers draw the second one.
    dataset = CornerCases(files, size=(64, 32))
    assert len(dataset[0]) == 2
    expected = int(CornerCases(files, size=(64, 32))[-1][0].sum())
    assert asked("spawn", dataset) == expected
    assert int(pickle.loads(pickle.dumps(dataset))[-1][0].sum()) == expected
    said = asked("fork", dataset)
    assert "forked" in str(said) and "spawn" in str(said)
