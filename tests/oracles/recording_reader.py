"""Reads recordings and cases by docs/recording.md alone, with PyPI's mcap, zstandard, blake3 and xxhash, and
compares what they hold with what `aeye inspect` tells of them.

    python recording_reader.py PATH/TO/aeye FILE...
"""

import json
import pathlib
import struct
import subprocess
import sys

import blake3
import mcap.records
import mcap.stream_reader
import xxhash
import zstandard

VERSION = 3
EVENTS = ["CollisionActor", "CollisionScenery", "RedLight", "Speeding", "OffRoad", "WrongWay", "Armed", "Intervention"]
EVENTS += ["Seen", "Ended", "Stuck", "Dissolved"]
EVENTS += ["HazardRedLight", "HazardRollingStop", "HazardBraking", "HazardCutIn", "HazardPullOut", "HazardCollision"]
EVENTS += ["HazardDoor"]
NOTES = ["unit bound", "unit armed", "unit lost", "unit returned"]


class Bincode:
    """Bincode 2's standard configuration: little-endian, integers of variable length."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def raw(self, n):
        self.at += n
        assert self.at <= len(self.data), "the payload ends early"
        return self.data[self.at - n : self.at]

    def u8(self):
        return self.raw(1)[0]

    def uint(self):
        first = self.u8()
        return first if first < 251 else int.from_bytes(self.raw({251: 2, 252: 4, 253: 8}[first]), "little")

    def int(self):
        n = self.uint()
        return n >> 1 if n % 2 == 0 else -(n >> 1) - 1

    def bytes(self):
        return self.raw(self.uint())

    def text(self):
        return self.bytes().decode()

    def list(self, item):
        return [item() for _ in range(self.uint())]

    def option(self, item):
        return item() if self.u8() else None

    def end(self):
        assert self.at == len(self.data), "bytes are left over"


class State:
    """State bytes: numbers of fixed width, little-endian."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, form):
        values = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return values if len(values) > 1 else values[0]

    def list(self, item):
        return [item() for _ in range(self.take("I"))]

    def left(self):
        return len(self.data) - self.at

    def option(self, item):
        return item() if self.take("B") else None

    def end(self):
        assert self.at == len(self.data), "state bytes are left over"


def unzigzag(column):
    """Differences of 16 bits, low bytes first, as values."""
    half, values, value = len(column) // 2, [], 0
    for low, high in zip(column[:half], column[half:]):
        n = low | high << 8
        value = (value + ((n >> 1) ^ -(n & 1))) & 0xFFFF
        values.append(value)
    return values


def sums(differences):
    total = 0
    for difference in differences:
        total += difference
        yield total


def signed(n):
    return n - 0x10000 if n > 0x7FFF else n


def controls(payload):
    steer, throttle, brake, flags = [unzigzag(payload.bytes()) for _ in range(4)]
    return list(zip(map(signed, steer), throttle, brake, flags))


def intervention(state):
    tick, steer, throttle, brake, flags, by_brake, by_steering, speed_mps = state.take("QhHHB??f")
    found = {"tick": tick, "controls": (steer, throttle, brake, flags), "by_brake": by_brake, "by_steering": by_steering}
    return found | {"speed_mps": speed_mps}


def scene(data):
    state = State(data)
    tick = state.take("Q")
    state.take("3f4f2fB")
    actors = state.list(lambda: state.take("IBI3f4f2fB"))
    lights = state.list(lambda: state.take("B"))
    state.take("4f")
    if state.left():
        state.take("5f")
    state.end()
    return {"tick": tick, "actors": len(actors), "lights": len(lights)}


def rows(lengths, stacked):
    """The snapshots of a case: transposed differences where all are equally long."""
    if len(set(lengths)) > 1:
        ends = list(sums(lengths))
        return [stacked[end - n : end] for n, end in zip(lengths, ends)]
    count = len(lengths)
    columns = [bytes(n & 0xFF for n in sums(stacked[at : at + count])) for at in range(0, len(stacked), count)]
    return [bytes(column[row] for column in columns) for row in range(count)]


class Reader:
    """What a file holds, record by record."""

    def __init__(self, path):
        self.digest = blake3.blake3()
        self.state, self.keyframes, self.hashes, self.semantic, self.safety = b"", [], [], [], []
        self.events, self.masks, self.notes, self.scenes = [], 0, [], []
        self.map_text, self.count, self.seals, self.marks = None, 0, 0, {}
        with open(path, "rb") as file:
            for record in mcap.stream_reader.StreamReader(file, emit_chunks=True).records:
                if isinstance(record, mcap.records.Header):
                    assert record.profile == ""
                    self.feed(1, text(record.profile) + text(record.library))
                if isinstance(record, mcap.records.Chunk):
                    self.chunk(zstandard.decompress(record.data, max_output_size=record.uncompressed_size))

    def feed(self, op, body):
        self.digest.update(bytes([op]) + struct.pack("<Q", len(body)) + body)

    def chunk(self, records):
        at, last = 0, None
        while at < len(records):
            op, length = records[at], struct.unpack_from("<Q", records, at + 1)[0]
            body = records[at + 9 : at + 9 + length]
            if op == 3:
                name = body[6 : 6 + struct.unpack_from("<I", body, 2)[0]].decode()
                assert name.rsplit(".", 1)[1] == str(VERSION), name
            if op == 5:
                last = self.message(body)
            self.feed(op, body)
            at += 9 + length
        assert last == 10, "the last message of a chunk is its seal"

    def message(self, body):
        channel, sequence, logged, published = struct.unpack_from("<HIQQ", body)
        assert sequence == self.count and logged == published
        self.count += 1
        handlers = [self.manifest, self.keyframe, self.block, self.happenings, self.mask_columns, self.end]
        handlers += [self.scene_rows, self.note_columns, self.map, self.seal]
        tick = handlers[channel - 1](body[22:])
        assert tick is None or logged == tick * 1_000_000_000 // 60, "the time of a message is that of its tick"
        return channel

    def manifest(self, data):
        payload = Bincode(data)
        assert payload.uint() == VERSION
        self.kernel, self.engines, self.scenario = payload.text(), payload.text(), payload.text()
        self.map_digest, self.foreign_map = payload.raw(16)[::-1].hex(), payload.option(lambda: payload.raw(32))
        entries = payload.list(lambda: (payload.text(), payload.text()))
        self.provenance = dict(entries)
        self.case = payload.option(lambda: (payload.raw(32).hex(), payload.uint(), payload.uint()))
        payload.end()

    def map(self, data):
        assert blake3.blake3(data).digest() == self.foreign_map
        self.map_text = data.decode()

    def keyframe(self, data):
        payload = Bincode(data)
        tick, length, packed, digest = payload.uint(), payload.uint(), payload.bytes(), payload.raw(16)
        payload.end()
        before = zstandard.ZstdCompressionDict(self.state, dict_type=zstandard.DICT_TYPE_RAWCONTENT)
        unpacker = zstandard.ZstdDecompressor(dict_data=before) if self.state else zstandard.ZstdDecompressor()
        self.state = unpacker.decompress(packed, max_output_size=length)
        assert len(self.state) == length
        assert xxhash.xxh3_128(self.state).intdigest() == int.from_bytes(digest, "little")
        self.keyframes.append(tick)
        return tick

    def block(self, data):
        payload = Bincode(data)
        first, semantic, safety = payload.uint(), controls(payload), controls(payload)
        assert first == self.keyframes[0] + len(self.semantic) + 1
        self.semantic += semantic
        self.safety += safety
        hashes = payload.bytes()
        assert len(hashes) == 4 * len(semantic) == 4 * len(safety)
        self.last = first + len(semantic) - 1
        whole = payload.raw(16)
        assert whole[:4] == hashes[-4:], "the low bytes of the hash are those of the last tick"
        self.marks[self.last] = whole, [payload.raw(8) for _ in range(7)]
        self.odometer_mm = payload.uint()
        payload.end()
        return self.last

    def happenings(self, data):
        payload = Bincode(data)
        ticks = list(sums(payload.list(payload.int)))
        state = State(payload.bytes())
        events = state.list(lambda: state.take("BIf"))
        state.end()
        assert len(events) == len(ticks)
        self.events += [(tick, EVENTS[kind], actor) for tick, (kind, actor, _) in zip(ticks, events)]
        found = payload.option(payload.bytes)
        payload.end()
        if found is not None:
            at = intervention(State(found))
            given = self.safety[at["tick"] - self.keyframes[0] - 1]
            assert given == at["controls"], "the controls of the intervention are those of its tick"
        return self.last

    def mask_columns(self, data):
        payload = Bincode(data)
        shown, age = payload.list(payload.int), payload.list(payload.int)
        camera, digests = payload.bytes(), payload.list(lambda: payload.raw(8))
        times = payload.list(lambda: payload.option(lambda: [payload.int() for _ in range(3)]))
        payload.end()
        assert len(shown) == len(age) == len(camera) == len(digests) == len(times)
        self.masks += len(shown)
        return self.last

    def note_columns(self, data):
        payload = Bincode(data)
        ticks, kinds, seats = list(sums(payload.list(payload.int))), payload.bytes(), payload.bytes()
        payload.end()
        self.notes += [(tick, NOTES[kind], seat) for tick, kind, seat in zip(ticks, kinds, seats, strict=True)]
        return self.last

    def scene_rows(self, data):
        payload = Bincode(data)
        lengths, stacked = payload.list(payload.uint), payload.bytes()
        payload.end()
        self.scenes = [scene(row) for row in rows(lengths, stacked)]
        return self.last

    def end(self, data):
        payload = Bincode(data)
        self.annotation = payload.option(lambda: (payload.u8(), payload.text(), payload.option(payload.u8)))
        self.summary = payload.option(lambda: (payload.uint(), payload.uint(), payload.bytes(), payload.bytes()))
        payload.end()
        return self.last

    def seal(self, data):
        assert data == self.digest.digest()[:16], "the seal fits what stands before it"
        self.seals += 1


def text(value):
    return struct.pack("<I", len(value.encode())) + value.encode()


def compare(aeye, path):
    done = subprocess.run([aeye, "--json", "inspect", str(path)], check=True, capture_output=True, text=True)
    told = json.loads(done.stdout.splitlines()[0])
    read = Reader(path)
    same = {
        "kernel": read.kernel,
        "first_tick": read.keyframes[0],
        "last_tick": read.last,
        "keyframes": len(read.keyframes),
        "masks": read.masks,
        "map_digest": read.map_digest,
        "embedded_map": read.map_text is not None,
        "scenario": read.scenario,
        "provenance": read.provenance,
    }
    for key, value in same.items():
        assert told[key] == value, f"{path}: {key}: read {value}, told {told[key]}"
    assert [(e["tick"], e["kind"], e["actor"]) for e in told["events"]] == read.events, f"{path}: events"
    assert [(n["tick"], n["kind"]) for n in told["notes"]] == [note[:2] for note in read.notes], f"{path}: notes"
    if read.case:
        source, first, last = read.case
        window = told["window"]
        assert (window["source"], window["from"], window["to"]) == (source, first, last), f"{path}: window"
        assert [scene["tick"] for scene in read.scenes] == list(range(first, last + 1, 6)), f"{path}: scenes"
    ticks, odometer_mm, _, _ = read.summary
    assert (ticks, odometer_mm) == (read.last, read.odometer_mm), f"{path}: summary"
    print(f"{path}: {read.count} messages, {read.seals} seals, {len(read.semantic)} ticks, {len(read.scenes)} scenes")


if __name__ == "__main__":
    for file in sys.argv[2:]:
        compare(sys.argv[1], pathlib.Path(file))
