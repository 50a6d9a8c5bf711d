"""What `aeye eval` says of a checkpoint is what the evaluator of cityscapesscripts says.

The evaluator reads the labels and masks from the files that `aeye dataset` and `aeye eval` wrote. Only
its table of labels is replaced by ours; counting, ignoring and dividing are its own code. The names,
modes and values of the files are checked against what mmsegmentation's CityscapesDataset reads.
"""

import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
from cityscapesscripts.evaluation import evalPixelLevelSemanticLabeling as evaluator
from cityscapesscripts.helpers.labels import Label
from PIL import Image

SIZE = (256, 128)
SCENES, FRAMES = 6, 20
TOLERANCE = 1e-9

# The semantic tags of CARLA 0.9.10, in the order of their ids.
TAGS = (
    "Unlabeled Building Fence Other Pedestrian Pole RoadLine Road SideWalk Vegetation Vehicles Wall "
    "TrafficSign Sky Ground Bridge RailTrack GuardRail TrafficLight Static Dynamic Water Terrain"
).split()
UNTRAINED = {"Unlabeled", "Other", "Ground", "Bridge", "RailTrack", "Dynamic", "Water"}
WITH_INSTANCES = {"Pedestrian", "Vehicles"}


def table():
    """The tags as cityscapesscripts describes labels, each in a category of its own."""
    train_id, labels = 0, []
    for tag, name in enumerate(TAGS):
        ignored = name in UNTRAINED
        labels.append(Label(name, tag, 255 if ignored else train_id, name, tag, name in WITH_INSTANCES, ignored, (0, 0, 0)))
        train_id += not ignored
    return labels


def configure(labels, predictions):
    """Gives the evaluator our table, in the module-level names from which it reads its own."""
    evaluator.labels = labels
    evaluator.id2label = {label.id: label for label in labels}
    evaluator.category2labels = {label.category: [label] for label in labels}
    evaluator.args.avgClassSize = {name: 1.0 for name in WITH_INSTANCES}
    evaluator.args.predictionPath = str(predictions)
    evaluator.args.predictionWalk = None
    evaluator.args.JSONOutput = False
    evaluator.args.quiet = True


def aeye(program, *arguments):
    run = subprocess.run([program, "--json", *map(str, arguments)], check=True, stdout=subprocess.PIPE)
    return json.loads(run.stdout)


def same(what, ours, theirs):
    """The difference of two figures, of which ours is absent where theirs is no number."""
    if ours is None or math.isnan(theirs):
        assert ours is None and math.isnan(theirs), f"{what}: {ours} here, {theirs} there"
        return 0.0
    assert abs(ours - theirs) <= TOLERANCE, f"{what}: {ours} here, {theirs} there"
    return abs(ours - theirs)


def compare(program, dataset, masks, checkpoint, labels):
    measured = aeye(
        program, "eval", "--checkpoint", checkpoint, "--dataset", dataset, "--out", masks
    )
    truths = sorted(map(str, (dataset / "gtFine" / "val").glob("*/*_gtFine_labelIds.png")))
    assert len(truths) == measured["frames"] == SCENES * FRAMES >= 100, f"{len(truths)} frames"
    configure(labels, masks)
    predicted = [evaluator.getPrediction(evaluator.args, truth) for truth in truths]
    theirs = evaluator.evaluateImgLists(predicted, truths, evaluator.args)

    trained = [label for label in labels if not label.ignoreInEval]
    differences = [same(label.name, measured["iou"][label.name], theirs["classScores"][label.name]) for label in trained]
    differences.append(same("mean", measured["miou"], theirs["averageScoreClasses"]))
    matrix = np.array(theirs["confMatrix"])
    rows = [label.id for label in trained]
    elsewhere = [label.id for label in labels if label.ignoreInEval]
    counted = np.column_stack([matrix[np.ix_(rows, rows)], matrix[np.ix_(rows, elsewhere)].sum(axis=1)])
    assert measured["confusion"]["classes"] == [label.name for label in trained]
    assert (np.array(measured["confusion"]["pixels"]) == counted).all(), "the confusion matrices differ"

    # With every instance weighing the same, its instance-level IoU is the sum of the people's recalls
    # over the people and the false positives.
    people, row = measured["pedestrians"]["people"], TAGS.index("Pedestrian")
    false = sum(matrix[label.id, row] for label in trained if label.id != row)
    recall = people * measured["pedestrians"]["mean_recall"] / (people + false)
    differences.append(same("recall of pedestrians", recall, theirs["classInstScores"]["Pedestrian"]))
    print(
        f"{checkpoint}: {len(truths)} frames, mean IoU {measured['miou']:.6f}, "
        f"pedestrian IoU {measured['pedestrian_iou']:.6f}, {people} pedestrians; "
        f"greatest difference {max(differences):.1e}"
    )


def check_layout(dataset, labels):
    """mmsegmentation: all `*_leftImg8bit.png` below the split's folder; the map of classes has the same
    path below `gtFine`, another suffix, one channel, and train ids or 255."""
    trained = [label.id for label in labels if not label.ignoreInEval]
    train_id = np.full(256, 255)
    train_id[trained] = range(len(trained))
    pictures = sorted((dataset / "leftImg8bit" / "val").rglob("*_leftImg8bit.png"))
    assert len(pictures) == SCENES * FRAMES
    for picture in pictures:
        inner = str(picture.relative_to(dataset / "leftImg8bit" / "val"))
        other = lambda ending: dataset / "gtFine" / "val" / inner.replace("_leftImg8bit.png", f"_gtFine_{ending}.png")
        files = [picture, other("labelTrainIds"), other("labelIds"), other("instanceIds")]
        image, classes, tags, instances = map(Image.open, files)
        assert [file.mode for file in (image, classes, tags)] == ["RGB", "L", "L"], picture
        assert instances.mode.startswith("I"), f"{picture}: instances of mode {instances.mode}"
        assert {file.size for file in (image, classes, tags, instances)} == {SIZE}, picture
        classes, tags, instances = map(np.asarray, (classes, tags, instances))
        assert (classes == train_id[tags]).all(), f"{picture}: train ids and tags differ"
        assert (np.where(instances < 1000, instances, instances // 1000) == tags).all(), picture
    print(f"{len(pictures)} frames as CityscapesDataset of mmsegmentation reads them")


def main(program, folder):
    dataset, labels = folder / "dataset", table()
    sizes = ["--scenes", 0, "--val-scenes", SCENES, "--test-scenes", 0, "--frames", FRAMES, "--size", "x".join(map(str, SIZE))]
    aeye(program, "dataset", "natural", *sizes, "--pedestrians", 200, "--seed", 7, "--out", dataset)
    check_layout(dataset, labels)
    for checkpoint in ["early", "full"]:
        compare(program, dataset, folder / checkpoint, checkpoint, labels)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
