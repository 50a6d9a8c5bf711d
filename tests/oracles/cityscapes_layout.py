"""Checks that a dataset folder is laid out as Cityscapes is, with Pillow instead of our own PNG code.

Usage: cityscapes_layout.py DATASET...

Names and folders are those of mmsegmentation's CityscapesDataset (img_suffix `_leftImg8bit.png`,
seg_map_suffix `_gtFine_labelTrainIds.png`) and of cityscapesscripts (`CITY_SEQ_FRAME_TYPE.png`); modes and
values of every file are checked, and `frames.jsonl` is compared with what the pictures hold. Exit code 1
if anything differs.
"""

import json
import pathlib
import re
import sys

from PIL import Image

# Tags of CARLA 0.9.10 at the index of their train id; the others are ignored.
TRAINED = [1, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 17, 18, 19, 22]
TAGS, IGNORE = 23, 255
MODES = {
    "gtFine_labelIds": "L",
    "gtFine_labelTrainIds": "L",
    "gtFine_instanceIds": "I;16",
    "gtFine_color": "P",
}


def train_id(tag):
    return TRAINED.index(tag) if tag in TRAINED else IGNORE


def check_labels(size, planes):
    """Problems of a frame's label files, by what they hold."""
    for name, plane in planes.items():
        if plane.size != size:
            yield f"{name}: {plane.size}, its picture has {size}"
        if plane.mode != MODES[name]:
            yield f"{name}: mode {plane.mode}, expected {MODES[name]}"
            return
    tags, trained = (planes[f"gtFine_{name}"].tobytes() for name in ("labelIds", "labelTrainIds"))
    instances = memoryview(planes["gtFine_instanceIds"].tobytes()).cast("H")
    if max(tags) >= TAGS:
        yield f"label id {max(tags)}, expected 0 to {TAGS - 1}"
    if trained != bytes(map(train_id, tags)):
        yield "train ids do not follow from label ids"
    if any(i != tag and i // 1000 != tag for i, tag in zip(instances, tags)):
        yield "instance ids are neither LABEL nor LABEL * 1000 + N"
    if planes["gtFine_color"].tobytes() != tags:
        yield "palette indices are not the label ids"


def check_frame(dataset, image):
    """Problems of a frame; gives its path and pixels of each train id last."""
    split, city = image.parts[-3], image.parts[-2]
    stem = image.name.removesuffix("_leftImg8bit.png")
    if not re.fullmatch(rf"{re.escape(city)}_\d{{6}}_\d{{6}}", stem) or "_" in city:
        yield f"{image}: expected CITY_SEQ_FRAME_leftImg8bit.png with six digits each"
    with Image.open(image) as picture:
        size, mode = picture.size, picture.mode
        picture.load()
    if mode != "RGB":
        yield f"{image}: mode {mode}, expected RGB"
    planes = {}
    for name in MODES:
        path = dataset / "gtFine" / split / city / f"{stem}_{name}.png"
        if not path.is_file():
            yield f"{path}: is missing"
            return
        with Image.open(path) as plane:
            plane.load()
            planes[name] = plane.copy()
    yield from (f"{image}: {problem}" for problem in check_labels(size, planes))
    yield planes["gtFine_labelTrainIds"].histogram()


def check(dataset):
    about = json.loads((dataset / "dataset.json").read_text())
    lines = {}
    for line in (dataset / "frames.jsonl").read_text().splitlines():
        line = json.loads(line)
        lines[line["image"]] = line
    images = sorted((dataset / "leftImg8bit").glob("*/*/*_leftImg8bit.png"))
    problems = []
    for image in images:
        *found, pixels = check_frame(dataset, image)
        line = lines.pop(str(image.relative_to(dataset)), None)
        if line is None:
            found.append(f"{image}: has no line in frames.jsonl")
        elif isinstance(pixels, list):
            counted = {name: n for name, n in zip(about["classes"], pixels) if n}
            if counted != line["class_pixels"]:
                found.append(f"{image}: {counted}, frames.jsonl says {line['class_pixels']}")
        else:
            found.append(pixels)
        problems += found
    problems += [f"{dataset / image}: is missing" for image in lines]
    if len(images) != sum(about[f"{split}_frames"] for split in ("train", "val", "test")):
        problems.append(f"{dataset}: {len(images)} pictures, dataset.json counts others")
    return len(images), problems


def main():
    folders = [pathlib.Path(argument) for argument in sys.argv[1:]]
    if not folders:
        sys.exit(__doc__)
    wrong = False
    for folder in folders:
        frames, problems = check(folder)
        for problem in problems[:20]:
            print(problem, file=sys.stderr)
        print(f"{folder}: {frames} frames, {len(problems)} problems")
        wrong = wrong or bool(problems) or frames == 0
    sys.exit(wrong)


if __name__ == "__main__":
    main()
