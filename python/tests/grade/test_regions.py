"""C-obstacles of a gantry, against corners that are computed by hand: a rectangle of 0.2 m x 0.1 m grows an obstacle by
0.1 m along x and 0.05 m along y."""

import cplan
import numpy as np
import pytest
from judged import is_graded

BLOCK = np.array([[0.4, 0.35], [0.9, 0.35], [0.9, 0.75], [0.4, 0.75]])
# The wedge's sloping side stays; the lowest side is beyond the joint's limit.
WEDGE = np.array([[1.1, -0.05], [1.7, -0.05], [1.7, 0.85], [1.5, 0.85], [1.1, 0.05]])
CLIPPED = np.array([[1.1, 0.0], [1.7, 0.0], [1.7, 0.85], [1.5, 0.85], [1.1, 0.05]])


RIGHT = {
    "both": [BLOCK, WEDGE],
    "within the limits": [BLOCK, CLIPPED],
    "in the other order, clockwise": (WEDGE[::-1], BLOCK[::-1]),
    "with the first corner repeated": [np.vstack([BLOCK, BLOCK[:1]]), WEDGE],
    "in pieces that overlap": [BLOCK[:, :], np.array([[0.4, 0.35], [0.7, 0.35], [0.7, 0.75], [0.4, 0.75]]), WEDGE],
    "with a corner on a side": [np.insert(BLOCK, 1, [0.65, 0.35], axis=0), WEDGE],
    "as lists": [BLOCK.tolist(), WEDGE.tolist()],
}
WRONG = {
    "a component is missing": ([BLOCK], "missing"),
    "only one polygon": (WEDGE, "missing"),
    "the obstacles themselves": ([[[0.5, 0.4], [0.8, 0.4], [0.8, 0.7], [0.5, 0.7]], [[1.2, 0], [1.6, 0], [1.6, 0.8]]], "missing"),
    "a side too far by 1e-6": ([BLOCK + np.array([[0, 0], [1e-6, 0], [1e-6, 0], [0, 0]]), WEDGE], "extra"),
    "a side too near by 1e-6": ([BLOCK + np.array([[0, 0], [-1e-6, 0], [-1e-6, 0], [0, 0]]), WEDGE], "missing"),
    "moved by 1e-6": ([BLOCK + [1e-6, 0], WEDGE], "missing"),
    "grown by the whole head": ([BLOCK + np.array([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]]), WEDGE], "extra"),
    "the bounding box of the wedge": ([BLOCK, [[1.1, 0], [1.7, 0], [1.7, 0.85], [1.1, 0.85]]], "extra"),
    "without one corner of the wedge": ([BLOCK, np.delete(WEDGE, 3, axis=0)], "missing"),
    "a sum instead of a difference": ([BLOCK, [[1.1, -0.05], [1.3, -0.05], [1.7, 0.75], [1.7, 0.85], [1.5, 0.85], [1.1, 0.05]]], "missing"),
    "signs of all values": ([-BLOCK, -WEDGE], "missing"),
    "joints exchanged": ([BLOCK[:, ::-1], WEDGE[:, ::-1]], "missing"),
    "an extra triangle": ([BLOCK, WEDGE, [[0.1, 0.1], [0.2, 0.1], [0.1, 0.2]]], "extra"),
    "corners out of order": ([BLOCK[[0, 2, 1, 3]], WEDGE], "not simple"),
    "touching itself at a corner": ([[[0, 0], [0.1, 0], [0.05, 0.05], [0.1, 0.1], [0, 0.1], [0.05, 0.05]], BLOCK], "not simple"),
    "two corners only": ([BLOCK[:2], WEDGE], "not simple"),
    "an empty list": ([], "shape"),
    "an empty cell": (None, "shape"),
}


@pytest.mark.parametrize("answer", RIGHT.values(), ids=list(RIGHT))
def test_a_right_answer_is_right(answer: object) -> None:
    is_graded("c_obstacles 2", answer, "right")


@pytest.mark.parametrize("answer, reason", WRONG.values(), ids=list(WRONG))
def test_a_wrong_answer_is_wrong_for_its_reason(answer: object, reason: str) -> None:
    is_graded("c_obstacles 2", answer, reason)


def test_the_figures_are_the_exact_area() -> None:
    missing = cplan.grade("c_obstacles 2", [BLOCK])
    # The wedge within the limits: 0.6 m x 0.85 m less a triangle of 0.4 m x 0.8 m.
    assert missing.figures["area"] == pytest.approx(0.6 * 0.85 - 0.4 * 0.8 / 2, rel=1e-12)
    assert 1.1 < missing.figures["at"][0] < 1.7 and 0 < missing.figures["at"][1] < 0.85
