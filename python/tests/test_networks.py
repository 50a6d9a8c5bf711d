"""Networks, and how good they are."""

import os
import signal
import threading
import time

import aeye
import numpy as np
import pytest


def test_a_network_says_what_it_is():
    early, full = aeye.Segmenter("early"), aeye.Segmenter("full")
    assert (early.name, len(early.digest)) == ("early", 64)
    assert early.digest != full.digest
    assert early.classes.items() <= aeye.CLASSES.items() and early.classes[4] == "Pedestrian"


def test_masks_have_the_size_of_their_pictures_however_these_lie_in_memory():
    network = aeye.Segmenter("early")
    noise = np.random.default_rng(1).integers(0, 256, (256, 512, 3), dtype=np.uint8)
    whole = network.predict(noise[::2, ::2].copy())
    assert (whole.shape, whole.dtype) == ((128, 256), np.uint8)
    assert np.array_equal(network.predict(noise[::2, ::2]), whole), "a part with gaps"
    assert np.array_equal(network.predict(np.asfortranarray(noise[::2, ::2])), whole), "column by column"
    assert network.predict(noise[:96, :192]).shape == (96, 192)
    assert np.array_equal(network.predict(noise[::2, ::2]), whole), "as before the other size"
    assert set(np.unique(whole).tolist()) <= network.classes.keys()


def test_what_is_no_picture_or_no_network_is_refused(tmp_path):
    network = aeye.Segmenter("early")
    for wrong in (np.zeros((8, 8, 3), np.float32), np.zeros((8, 8), np.uint8), np.zeros((8, 8, 4), np.uint8), "x"):
        with pytest.raises(aeye.InputError, match="expected an array of uint8 of shape"):
            network.predict(wrong)
    with pytest.raises(aeye.InputError):
        network.predict(np.zeros((0, 0, 3), np.uint8))
    with pytest.raises(aeye.InputError, match="truth is no network"):
        aeye.Segmenter("truth")
    with pytest.raises(TypeError, match="^checkpoint: expected a string or a path, got int$"):
        aeye.Segmenter(3)
    with pytest.raises(aeye.FileError, match="no such checkpoint"):
        aeye.Segmenter(tmp_path / "gone.onnx")
    (tmp_path / "text.onnx").write_text("not a network")
    with pytest.raises(aeye.InputError, match="text.onnx"):
        aeye.Segmenter(tmp_path / "text.onnx")


@pytest.mark.parametrize("checkpoint", ["early", "truth"])
def test_evaluate_says_what_eval_says(checkpoint, dataset, said):
    told = said("eval", "--checkpoint", checkpoint, "--dataset", dataset, "--split", "train")
    assert aeye.evaluate(checkpoint, dataset, split="train") == told
    assert aeye.evaluate(checkpoint, dataset, split="train", jobs=1) == told


def test_what_cannot_be_evaluated_is_told(dataset, tmp_path):
    with pytest.raises(aeye.Error, match="has no split test"):
        aeye.evaluate("early", dataset, split="test")
    with pytest.raises(aeye.FileError, match="gone: no such file or folder"):
        aeye.evaluate("early", tmp_path / "gone")
    with pytest.raises(TypeError, match="^checkpoint: expected a name, a file or an aeye.External, got Segmenter$"):
        aeye.evaluate(aeye.Segmenter("early"), dataset)


def test_ctrl_c_ends_long_work_and_the_next_goes_on(dataset):
    threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):
            aeye.evaluate("full", dataset, split="train", jobs=1)
    assert aeye.evaluate("truth", dataset, split="train")["miou"] == 1.0


def test_other_threads_go_on_meanwhile(dataset):
    beats = []
    over = threading.Event()

    def beat():
        while not over.wait(0.01):
            beats.append(time.monotonic())

    thread = threading.Thread(target=beat)
    thread.start()
    aeye.evaluate("early", dataset, split="train", jobs=1)
    over.set()
    thread.join()
    assert len(beats) > 5
