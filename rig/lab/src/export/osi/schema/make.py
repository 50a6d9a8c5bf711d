"""Writes `ground_truth.binpb`: the serialized FileDescriptorSet of osi3.GroundTruth with all that it imports, as
`protoc --include_imports --descriptor_set_out` gives it, from the bindings of ASAM (PyPI: osi-python).

    python -m venv venv && venv/bin/pip install osi-python==3.8.0 && venv/bin/python make.py
"""

import pathlib

from google.protobuf.descriptor_pb2 import FileDescriptorSet
from osi3.osi_groundtruth_pb2 import GroundTruth


def add(file, files, known):
    """Adds a file after those that it imports."""
    if file.name in known:
        return
    known.add(file.name)
    for imported in file.dependencies:
        add(imported, files, known)
    file.CopyToProto(files.file.add())


def main():
    files = FileDescriptorSet()
    add(GroundTruth.DESCRIPTOR.file, files, set())
    out = pathlib.Path(__file__).with_name("ground_truth.binpb")
    out.write_bytes(files.SerializeToString(deterministic=True))
    print(out, len(files.file), "files")


if __name__ == "__main__":
    main()
