"""Reads dataset folders with the classes that training with PyTorch starts from, as their users do.

Usage: torch_readers.py DATASET...

torchvision's `Cityscapes` must find every picture of each split with its labels, instances and colours, and give what Pillow
reads from the files; a `DataLoader` with two workers must deliver them as tensors. mmsegmentation's `CityscapesDataset` must
find the same pictures and give them and their train ids. What is not installed is said to be left out; exit code 1 if anything
differs, or nothing is installed.
"""

import importlib.util
import json
import pathlib
import sys
import unittest.mock

import numpy as np
from PIL import Image

TARGETS = {"semantic": "gtFine_labelIds", "instance": "gtFine_instanceIds", "color": "gtFine_color"}


def is_there(*modules):
    return all(importlib.util.find_spec(module) for module in modules)


def splits(folder):
    """Names of the splits that a folder has, and how many frames dataset.json counts in each."""
    about = json.loads((folder / "dataset.json").read_text())
    counted = {split: about[f"{split}_frames"] for split in ("train", "val", "test")}
    return {split: frames for split, frames in counted.items() if frames}


def plane(folder, split, image, name):
    """What Pillow reads from a label file of a picture."""
    image = pathlib.Path(image)
    stem = image.name.removesuffix("_leftImg8bit.png")
    with Image.open(folder / "gtFine" / split / image.parent.name / f"{stem}_{name}.png") as picture:
        return np.array(picture)


def torchvision_reads(folder, split, frames):
    from torch.utils.data import DataLoader
    from torchvision.datasets import Cityscapes
    from torchvision.transforms.functional import pil_to_tensor

    read = Cityscapes(str(folder), split=split, mode="fine", target_type=list(TARGETS))
    if len(read) != frames:
        yield f"torchvision finds {len(read)} pictures, dataset.json counts {frames}"
    for image, (picture, targets) in zip(read.images, read):
        if not np.array_equal(np.array(picture), np.array(Image.open(image))):
            yield f"torchvision: {image} differs"
        for target, name in zip(targets, TARGETS.values()):
            if not np.array_equal(np.array(target), plane(folder, split, image, name)):
                yield f"torchvision: {name} of {image} differs"

    tensors = Cityscapes(
        str(folder), split=split, mode="fine", target_type="semantic", transform=pil_to_tensor, target_transform=pil_to_tensor
    )
    seen = 0
    for rgb, labels in DataLoader(tensors, batch_size=2, num_workers=2):
        if rgb.shape[1] != 3 or labels.shape[1] != 1 or rgb.shape[2:] != labels.shape[2:]:
            yield f"a batch of {tuple(rgb.shape)} with labels {tuple(labels.shape)}"
        seen += len(rgb)
    if seen != frames:
        yield f"a DataLoader gives {seen} of {frames} pictures"


def mmsegmentation_reads(folder, split, frames):
    # What it imports for its losses is not in mmcv-lite, and no reader calls it.
    sys.modules.setdefault("mmcv.ops", unittest.mock.MagicMock())
    from mmseg.datasets import CityscapesDataset

    classes = json.loads((folder / "dataset.json").read_text())["classes"]

    class OfFolder(CityscapesDataset):
        METAINFO = {"classes": classes, "palette": [[i, i, i] for i in range(len(classes))]}

    read = OfFolder(
        data_root=str(folder),
        data_prefix={"img_path": f"leftImg8bit/{split}", "seg_map_path": f"gtFine/{split}"},
        pipeline=[{"type": "LoadImageFromFile"}, {"type": "mmseg.LoadAnnotations"}],
    )
    if len(read) != frames:
        yield f"mmsegmentation finds {len(read)} pictures, dataset.json counts {frames}"
    for frame in read:
        image = frame["img_path"]
        # OpenCV's order of colours.
        if not np.array_equal(frame["img"][..., ::-1], np.array(Image.open(image))):
            yield f"mmsegmentation: {image} differs"
        if not np.array_equal(frame["gt_seg_map"], plane(folder, split, image, "gtFine_labelTrainIds")):
            yield f"mmsegmentation: train ids of {image} differ"


READERS = {"torchvision": (torchvision_reads, ("torch", "torchvision")), "mmsegmentation": (mmsegmentation_reads, ("mmseg",))}


def main():
    folders = [pathlib.Path(argument) for argument in sys.argv[1:]]
    if not folders:
        sys.exit(__doc__)
    wrong, ran = False, False
    for name, (reads, modules) in READERS.items():
        if not is_there(*modules):
            print(f"{name}: left out, since it is not installed")
            continue
        ran = True
        for folder in folders:
            for split, frames in splits(folder).items():
                problems = list(reads(folder, split, frames))
                for problem in problems[:20]:
                    print(problem, file=sys.stderr)
                print(f"{name}: {folder} {split}: {frames} frames, {len(problems)} problems")
                wrong = wrong or bool(problems)
    sys.exit(wrong or not ran)


if __name__ == "__main__":
    main()
