"""Times networks from picture to mask against onnxruntime, one thread each, turn by turn.

Usage: engines.py PROGRAM WIDTH HEIGHT ROUNDS FILE.onnx...

PROGRAM is `picture_to_mask` of `benches`. onnxruntime runs the same file, with what is in it of upsampling and argmax;
what it needs before (normalised planes) and after (upsampling where the file has none, argmax) is done with numpy and
not counted, so that its time is less than an application's. Both times are CPU time, the least of all rounds: a busy
machine does not count. Last stand the ratio and the share of pixels that agree.
"""

import json
import pathlib
import struct
import subprocess
import sys
import time
import tomllib

import numpy
import onnxruntime


def session(path):
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    return onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])


def meaning(path, run):
    """Mean and deviation of the input, 0 to 255; nothing for byte input."""
    sidecar = path.with_suffix(".toml")
    if sidecar.exists():
        told = tomllib.loads(sidecar.read_text())
    else:
        held = run.get_modelmeta().custom_metadata_map
        told = {key: json.loads(held[f"aeye.{key}"]) for key in ("mean", "std") if f"aeye.{key}" in held}
    return "mean" in told and [numpy.float32(told[key]) * 255 for key in ("mean", "std")]


def upsampled(scores, width, height):
    """Bilinear, half-pixel centres, by two products."""

    def weights(source, target):
        place = numpy.clip((numpy.arange(target) + 0.5) * source / target - 0.5, 0, source - 1)
        left = numpy.minimum(place.astype(int), max(source - 2, 0))
        table = numpy.zeros((target, source), numpy.float32)
        rows = numpy.arange(target)
        table[rows, left] += 1 - (place - left)
        table[rows, numpy.minimum(left + 1, source - 1)] += place - left
        return table

    rows, cols = weights(scores.shape[1], height), weights(scores.shape[2], width)
    return numpy.matmul(numpy.matmul(rows, scores), cols.T)


class Theirs:
    def __init__(self, path, width, height):
        self.run, self.size = session(path), (width, height)
        self.norm = meaning(path, self.run)
        self.name = self.run.get_inputs()[0].name

    def classes(self, picture):
        """The class of every pixel by its index, and the milliseconds that the network took."""
        if self.norm:
            image = ((picture - self.norm[0]) / self.norm[1]).transpose(2, 0, 1)[None]
        else:
            image = picture[None]
        image = numpy.ascontiguousarray(image)
        start = time.thread_time()
        out = self.run.run(None, {self.name: image})[0][0]
        taken = (time.thread_time() - start) * 1e3
        if out.ndim == 2:
            return out, taken
        if not self.norm:
            return out.argmax(-1), taken
        if out.shape[1:] != self.size[::-1]:
            out = upsampled(out, *self.size)
        return out.argmax(0), taken


class Ours:
    def __init__(self, program, path, width, height):
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        self.process = subprocess.Popen([program, str(path), str(width), str(height)], **pipes)
        self.shape = (height, width)
        self.tags = numpy.frombuffer(self.read(self.read(1)[0]), numpy.uint8)

    def read(self, count):
        data = self.process.stdout.read(count)
        if len(data) < count:
            sys.exit("the program ended")
        return data

    def mask(self, picture):
        """The tag of every pixel, and the milliseconds from the picture to it."""
        self.process.stdin.write(picture.tobytes())
        self.process.stdin.flush()
        (taken,) = struct.unpack("<d", self.read(8))
        return numpy.frombuffer(self.read(picture.size // 3), numpy.uint8).reshape(self.shape), taken

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def pictures(width, height, count):
    """Pictures with areas and soft borders."""
    random = numpy.random.default_rng(5)
    for _ in range(count):
        parts = [random.random((3, 2**k, 2 ** (k + 1)), numpy.float32) for k in range(1, 6)]
        whole = sum(upsampled(part, width, height) for part in parts) / len(parts)
        values = numpy.clip((whole - 0.5) * 2 + 0.5, 0, 1) * 255
        yield numpy.ascontiguousarray(values.astype(numpy.uint8).transpose(1, 2, 0))


def compare(program, path, width, height, rounds):
    theirs, ours = Theirs(path, width, height), Ours(program, path, width, height)
    best, same, count, seen = [float("inf")] * 2, 0, 0, set()
    views = list(pictures(width, height, 3))
    for number in range(rounds):
        picture = views[number % len(views)]
        mask, own = ours.mask(picture)
        classes, other = theirs.classes(picture)
        best = [min(best[0], own), min(best[1], other)]
        same, count = same + int((ours.tags[classes] == mask).sum()), count + mask.size
        seen.update(numpy.unique(mask).tolist())
    ours.close()
    ratio = best[0] / best[1]
    print(f"{path.stem:20} {best[0]:8.2f} ms, onnxruntime {best[1]:8.2f} ms: {ratio:5.2f}; "
          f"same {100 * same / count:7.3f} % of {len(seen)} classes", flush=True)
    return ratio


def main():
    program = sys.argv[1]
    width, height, rounds = map(int, sys.argv[2:5])
    ratios = [compare(program, pathlib.Path(name), width, height, rounds) for name in sys.argv[5:]]
    print(f"mean ratio {sum(ratios) / len(ratios):.2f}, highest {max(ratios):.2f}")


if __name__ == "__main__":
    main()
