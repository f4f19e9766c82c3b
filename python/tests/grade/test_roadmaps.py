"""Complete roadmaps of a gantry, against segments and grown polygons that are computed by hand."""

from itertools import combinations

import cplan
import numpy as np
import pytest
from judged import is_graded
from oracle import bar_to_polygon

EXERCISE = cplan.grading.exercise("roadmaps 1")
SAMPLES = np.array(
    [[0.1, 0.1], [0.4, 0.2], [0.4, 0.9], [0.6, 1.2], [1.0, 0.2], [1.0, 0.7], [1.1, 1.2], [1.5, 1.1], [1.9, 1.4], [1.9, 0.3]]
)
# Block, wedge and pillar, grown by 0.1 m along x and 0.05 m along y. Block and pillar touch at x = 0.4.
GROWN = [
    [[0.4, 0.35], [0.9, 0.35], [0.9, 0.75], [0.4, 0.75]],
    [[1.1, -0.05], [1.7, -0.05], [1.7, 0.85], [1.5, 0.85], [1.1, 0.05]],
    [[-0.1, 0.45], [0.4, 0.45], [0.4, 0.65], [-0.1, 0.65]],
]


def is_free(a: np.ndarray, b: np.ndarray) -> bool:
    return min(bar_to_polygon(a, b, polygon) for polygon in GROWN) > 1e-9


EDGES = [
    (i, j)
    for i, j in combinations(range(len(SAMPLES)), 2)
    if np.hypot(*(SAMPLES[i] - SAMPLES[j])) <= 0.9 and is_free(SAMPLES[i], SAMPLES[j])
]
ORDER = np.array([3, 1, 4, 0, 5, 9, 2, 6, 8, 7])
TREE = [(0, 1), (1, 4), (4, 5), (5, 3), (3, 2), (3, 6), (6, 7), (7, 8)]

RIGHT = {
    "lists": (SAMPLES.tolist(), EDGES),
    "arrays": (SAMPLES, np.array(EDGES)),
    "edges the other way round": (SAMPLES, [(j, i) for i, j in EDGES]),
    "edges in both directions": (SAMPLES, EDGES + [(j, i) for i, j in EDGES]),
    "vertices in another order": (SAMPLES[ORDER], [(int(np.argmax(ORDER == i)), int(np.argmax(ORDER == j))) for i, j in EDGES]),
    "whole numbers as floats": [SAMPLES, np.array(EDGES, float)],
}
WRONG = {
    "through the block": ((SAMPLES, [*EDGES, (0, 2)]), "collision"),
    "through the passage of no width": ((SAMPLES, [*EDGES, (1, 2)]), "collision"),
    "longer than the radius by 0.006": ((SAMPLES, [*EDGES, (0, 4)]), "extra edge"),
    "an edge is missing": ((SAMPLES, EDGES[:-1]), "missing edge"),
    "another edge is missing": ((SAMPLES, EDGES[1:]), "missing edge"),
    "a tree only": ((SAMPLES, TREE), "missing edge"),
    "a sample is missing": ((SAMPLES[:-1], [e for e in EDGES if 9 not in e]), "missing vertex"),
    "a sample moved by 1e-6": ((SAMPLES + [[1e-6, 0]] * 10, EDGES), "missing vertex"),
    "an extra vertex": ((np.vstack([SAMPLES, [[0.2, 0.2]]]), EDGES), "extra vertex"),
    "a vertex twice": ((np.vstack([SAMPLES, SAMPLES[:1]]), EDGES), "extra vertex"),
    "a loop": ((SAMPLES, [*EDGES, (3, 3)]), "edge"),
    "numbers from 1": ((SAMPLES, [(i + 1, j + 1) for i, j in EDGES]), "collision"),
    "a number too large": ((SAMPLES, [*EDGES, (0, 10)]), "shape"),
    "a negative number": ((SAMPLES, [*EDGES, (0, -1)]), "shape"),
    "half numbers": ((SAMPLES, np.array(EDGES) + 0.5), "shape"),
    "edges as places": ((SAMPLES, SAMPLES[np.array(EDGES)]), "shape"),
    "no edges": ((SAMPLES, []), "shape"),
    "vertices only": (SAMPLES, "shape"),
    "an empty cell": (None, "shape"),
}


def test_the_exercise_is_not_trivial() -> None:
    assert np.array_equal(EXERCISE.samples, SAMPLES) and EXERCISE.radius == 0.9
    assert len(EDGES) == 12 and (1, 2) not in EDGES
    assert bar_to_polygon(SAMPLES[1], SAMPLES[2], GROWN[0]) == bar_to_polygon(SAMPLES[1], SAMPLES[2], GROWN[2]) == 0


@pytest.mark.parametrize("answer", RIGHT.values(), ids=list(RIGHT))
def test_a_right_roadmap_is_right(answer: object) -> None:
    is_graded("roadmaps 1", answer, "right")


@pytest.mark.parametrize("answer, reason", WRONG.values(), ids=list(WRONG))
def test_a_wrong_roadmap_is_wrong_for_its_reason(answer: object, reason: str) -> None:
    is_graded("roadmaps 1", answer, reason)


def test_a_roadmap_of_any_vertices() -> None:
    free = cplan.grading.Roadmap(EXERCISE.arm, EXERCISE.world)
    ways = [[0.1, 0.1], [1.0, 0.2], [1.0, 1.2], [1.9, 1.4]]
    assert free.grade((ways, [(0, 1), (1, 2), (2, 3)]))
    assert free.grade((ways, [(0, 1), (2, 3)])).reason == "disconnected"
    assert free.grade((ways[1:], [(0, 1), (1, 2)])).reason == "start"
    assert free.grade((ways[:-1], [(0, 1), (1, 2)])).reason == "goal"
    # This edge only touches a corner of the grown block, (0.9, 0.75).
    corner = free.grade(([*ways, [0.8, 0.85], [1.0, 0.65]], [(0, 1), (1, 2), (2, 3), (4, 5)]))
    assert corner.reason in ("collision", "undecided") and corner.figures["edge"] == (4, 5)
    assert np.allclose(corner.figures["at"], [0.9, 0.75], atol=1e-6)
    beside = free.grade(([*ways, [0.8 + 1e-6, 0.85], [1.0 + 1e-6, 0.65]], [(0, 1), (1, 2), (2, 3), (4, 5)]))
    assert beside, beside
