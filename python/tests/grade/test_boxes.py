"""Channels of free boxes and walls of collision boxes. Their limits follow from trigonometry: the reach of the folded arm, and
the angles at which link 1 touches a wall."""

import cplan
import numpy as np
import pytest
from cplan import _cplan
from judged import is_graded
from oracle import RADIUS, bar_to_polygon, gap, root

# Folded at least that far, no point of the arm is farther from the base than the nearest corner of the shelf.
NEAREST = np.hypot(1.15, 0.18)
FOLD = float(np.arccos(((NEAREST - RADIUS) ** 2 - 1.64) / 1.6))
AT_START, AT_GOAL = [[-0.95, 0.35], [-0.85, 2.1]], [[1.5, -0.4], [1.6, 2.1]]
ALL_ROUND = [[-2.9, 2.0], [2.9, 2.85]]
HANDMADE = [AT_START, ALL_ROUND, AT_GOAL]

CHANNELS = {
    "three boxes": HANDMADE,
    "an array": np.array(HANDMADE),
    "a narrower box": [AT_START, [[-0.95, 2.0], [1.6, 2.2]], AT_GOAL],
    "boxes that only share sides": [[[-0.95, 0.35], [-0.85, 2.0]], [[-0.95, 2.0], [1.6, 2.2]], [[1.5, -0.4], [1.6, 2.0]]],
    "five boxes": [AT_START, [[-0.95, 2.0], [0.0, 2.5]], [[0.0, 2.2], [0.5, 2.8]], [[0.5, 2.1], [1.6, 2.7]], AT_GOAL],
    "up to a micrometre from contact": [AT_START, [[-2.9, FOLD + 2e-6], [2.9, 2.85]], AT_GOAL],
    "start and goal on sides": [[[-0.9, 0.4], [-0.85, 2.1]], ALL_ROUND, [[1.5, -0.35], [1.55, 2.1]]],
}
NO_CHANNELS = {
    "a micrometre in contact": ([AT_START, [[-2.9, FOLD - 2e-6], [2.9, 2.85]], AT_GOAL], "collision"),
    "far into the C-obstacle": ([AT_START, [[-2.9, 1.2], [2.9, 2.85]], AT_GOAL], "collision"),
    "straight across": ([[[-0.95, -0.4], [1.6, 0.45]]], "collision"),
    "beyond the limits": ([AT_START, [[-2.9, 2.0], [2.9, 2.91]], AT_GOAL], "limits"),
    "without the start": ([[[-0.95, 0.41], [-0.85, 2.1]], ALL_ROUND, AT_GOAL], "start"),
    "without the goal": ([AT_START, ALL_ROUND, [[1.5, -0.34], [1.6, 2.1]]], "goal"),
    "in the other order": (HANDMADE[::-1], "start"),
    "a gap of 1e-6": ([AT_START, [[-2.9, 2.1 + 1e-6], [2.9, 2.85]], AT_GOAL], "portal"),
    "only a common corner": ([AT_START, [[-0.85, 2.1], [1.6, 2.5]], AT_GOAL], "portal"),
    "a box is missing": ([AT_START, AT_GOAL], "portal"),
    "a box of no height": ([AT_START, [[-0.95, 2.05], [1.6, 2.05]], AT_GOAL], "empty"),
    "least and greatest values exchanged": (np.array(HANDMADE)[:, ::-1], "empty"),
    "intervals of each joint instead": (np.array(HANDMADE).transpose(0, 2, 1), "empty"),
    "a full turn further": (np.array(HANDMADE) + [2 * np.pi, 0], "start"),
    "a single box, not in a list": (ALL_ROUND, "shape"),
    "an empty cell": (None, "shape"),
}

FRONT = [[0.4, -0.04], [2.0, -0.04], [2.0, 0.04], [0.4, 0.04]]
BACK = [[-0.4, 0.0], [-2.0, 0.0]]
PI, TURN = np.pi, 2 * np.pi


def gap_of_link_1(q1: float, wall: list[list[float]]) -> float:
    return bar_to_polygon(np.zeros(2), np.array([np.cos(q1), np.sin(q1)]), wall) - RADIUS


A = root(lambda q1: gap_of_link_1(q1, FRONT), 0.05, 0.5)
B = root(lambda q1: gap_of_link_1(PI - q1, BACK), 0.01, 0.5)
FRONT_WALL, BACK_WALL = [[-0.03, -PI], [0.03, PI]], [[PI - 0.03, -PI], [PI + 0.03, PI]]

PROOFS = {
    "two boxes": [FRONT_WALL, BACK_WALL],
    "an array": np.array([BACK_WALL, FRONT_WALL]),
    "joint 2 from 0": [[[-0.03, 0], [0.03, TURN]], [[PI - 0.02, 0], [PI - 0.01, TURN]]],
    "as wide as contact allows, less 1e-6": [[[-A + 1e-6, -PI], [A - 1e-6, PI]], [[-PI - B + 1e-6, -PI], [-PI + B - 1e-6, PI]]],
    "pieces": [[[-0.03, -PI], [0.03, 0.5]], [[-0.02, 0.5], [0.05, PI]], BACK_WALL],
    "with a box too many": [FRONT_WALL, [[0.05, 0.0], [0.06, 1.0]], BACK_WALL],
    "some turns further": np.array([FRONT_WALL, BACK_WALL]) + [4 * TURN, -TURN],
}
NO_PROOFS = {
    "the front wall only": ([FRONT_WALL], "not separated"),
    "the back wall only": ([BACK_WALL], "not separated"),
    "the front wall twice": ([FRONT_WALL, [[0.04, -PI], [0.08, PI]]], "not separated"),
    "too wide by 1e-6": ([[[-0.03, -PI], [A + 1e-6, PI]], BACK_WALL], "free"),
    "the back wall too wide by 1e-6": ([FRONT_WALL, [[PI - B - 1e-6, -PI], [PI, PI]]], "free"),
    "as wide as contact": ([[[-0.03, -PI], [A, PI]], BACK_WALL], "undecided"),
    "a gap of 1e-6": ([[[-0.03, -PI], [0.03, 0.5]], [[-0.03, 0.5 + 1e-6], [0.03, PI]], BACK_WALL], "not separated"),
    "pieces that meet in a corner only": ([[[-0.03, -PI], [0.0, 0.5]], [[0.0, 0.5 + 1e-9], [0.03, PI]], BACK_WALL], "not separated"),
    "half a turn of joint 2": ([[[-0.03, 0], [0.03, PI]], BACK_WALL], "not separated"),
    "a wall of no width": ([[[0.0, -PI], [0.0, PI]], BACK_WALL], "empty"),
    "a free box": ([FRONT_WALL, BACK_WALL, [[0.8, -0.4], [1.0, -0.2]]], "free"),
    "a wall at the sides": ([[[PI / 2 - 0.03, -PI], [PI / 2 + 0.03, PI]], BACK_WALL], "free"),
    "joints exchanged": ([[[-PI, -0.03], [PI, 0.03]], [[-PI, 3.1], [PI, 3.2]]], "free"),
    "all of the space": ([[[-PI, -PI], [PI, PI]]], "free"),
    "intervals of each joint instead": ([[[-0.03, 0.03], [-PI, PI]]], "empty"),
    "a single box, not in a list": (FRONT_WALL, "shape"),
    "an empty cell": (None, "shape"),
}


@pytest.mark.parametrize("answer", CHANNELS.values(), ids=list(CHANNELS))
def test_a_right_channel_is_right(answer: object) -> None:
    is_graded("cells 1", answer, "right")


@pytest.mark.parametrize("answer, reason", NO_CHANNELS.values(), ids=list(NO_CHANNELS))
def test_a_wrong_channel_is_wrong_for_its_reason(answer: object, reason: str) -> None:
    is_graded("cells 1", answer, reason)


@pytest.mark.parametrize("answer", PROOFS.values(), ids=list(PROOFS))
def test_a_right_proof_is_right(answer: object) -> None:
    is_graded("proofs 1", answer, "right")


@pytest.mark.parametrize("answer, reason", NO_PROOFS.values(), ids=list(NO_PROOFS))
def test_a_wrong_proof_is_wrong_for_its_reason(answer: object, reason: str) -> None:
    is_graded("proofs 1", answer, reason)


def test_figures_are_places_of_the_fault() -> None:
    touching = cplan.grade("cells 1", NO_CHANNELS["a micrometre in contact"][0])
    assert (touching.figures["box"], touching.figures["obstacle"]) == (1, "shelf")
    assert touching.figures["at"][1] == pytest.approx(FOLD, abs=3e-6)
    free = cplan.grade("proofs 1", NO_PROOFS["too wide by 1e-6"][0])
    assert free.figures["box"] == 0 and A <= free.figures["at"][0] <= A + 1e-6


def test_limits_close_the_ends_of_a_wall() -> None:
    arm = cplan.Arm.rr([1.0, 0.8], width=0.06, limits=[(-2.9, 2.9), (-2.9, 2.9)])
    exercise = cplan.grading.Proof(arm, cplan.World({"name": "front", "polygon": FRONT}, start=[-0.8, 0.3], goal=[0.9, -0.3]))
    assert exercise.grade([FRONT_WALL])
    assert exercise.grade([[[-0.03, -2.9], [0.03, 2.9]]])
    assert exercise.grade([[[-0.03, -2.8], [0.03, 2.9]]]).reason == "not separated"


def test_channels_on_circles_go_across_the_seam() -> None:
    world = cplan.World({"name": "front", "polygon": FRONT}, start=[-0.8, 0.3], goal=[0.9, -0.3])
    exercise = cplan.grading.Channel(cplan.Arm.rr([1.0, 0.8], width=0.06), world)
    around = [[[-2.0, 0.2], [-0.8, 0.4]], [[-4.5, -0.4], [-1.9, 0.4]], [[0.9 - TURN, -0.4], [-4.4, -0.2]]]
    assert exercise.grade(around), exercise.grade(around)
    assert exercise.grade([*around[:2], [[0.9, -0.4], [1.0, -0.2]]]).reason == "portal"


def test_verdicts_on_random_boxes_agree_with_samples() -> None:
    channel = cplan.grading.exercise("cells 1")
    shelf, crate = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]], [[0.5, -1.6], [0.8, -1.6], [0.8, -1.3], [0.5, -1.3]]
    random = np.random.default_rng(7)
    lower = random.uniform(-2.9, 2.3, size=(300, 2))
    boxes = np.stack([lower, lower + random.uniform(0.01, 0.6, size=(300, 2))], axis=1)
    count = {"free": 0, "collision": 0, "undecided": 0}
    for colliding in (False, True):
        for (low, high), (verdict, at) in zip(boxes, _cplan.judge_boxes(channel.arm, channel.world, boxes.tolist(), colliding)):
            count[verdict] += 1
            inside = random.uniform(low, high, size=(20, 2))
            if at is None:
                # The verdict holds in the whole box.
                assert all((gap(q, [shelf, crate]) <= 0) == colliding for q in inside)
            elif verdict != "undecided":
                assert (low <= at).all() and (at <= high).all()
                assert (gap(at, [shelf, crate]) <= 0) != colliding
    assert count["free"] > 300 and count["collision"] > 50 and count["undecided"] < 5, count
