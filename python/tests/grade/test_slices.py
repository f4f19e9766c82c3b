"""Contact angles of a slice, against bisection of the distance to the shelf."""

import numpy as np
import pytest
from judged import is_graded
from oracle import gap, root

SHELF = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]]
Q1 = np.radians(27.7)
LOWER, UPPER = (root(lambda q2: gap((Q1, q2), [SHELF]), *about) for about in ((-1.5, -1.2), (-1.2, -0.5)))
TURN = 2 * np.pi

RIGHT = {
    "a list": [[LOWER, UPPER]],
    "an array": np.array([[LOWER, UPPER]]),
    "a tuple": ((LOWER, UPPER),),
    "two parts": [[-1.0, UPPER], [LOWER, -1.0]],
    "overlapping parts": [[LOWER, -0.9], [-1.1, UPPER]],
    "rounded": [[round(LOWER, 10), round(UPPER, 10)]],
}
WRONG = {
    "one end too late by 1e-6": ([[LOWER + 1e-6, UPPER]], "missing"),
    "one end too early by 1e-6": ([[LOWER - 1e-6, UPPER]], "extra"),
    "the other end too early by 1e-6": ([[LOWER, UPPER - 1e-6]], "missing"),
    "ends in degrees": ([np.degrees([LOWER, UPPER])], "limits"),
    "rounded to a tenth of a degree": ([np.radians([-79.2, -38.3])], "missing"),
    "the other sign": ([[-UPPER, -LOWER]], "missing"),
    "a full turn further": ([[LOWER + TURN, UPPER + TURN]], "limits"),
    "a second interval": ([[LOWER, UPPER], [0.5, 0.6]], "extra"),
    "a gap between parts": ([[LOWER, -1.0], [-0.999, UPPER]], "missing"),
    "the free part instead": ([[-2.9, LOWER], [UPPER, 2.9]], "extra"),
    "angles of the axis, without the width of the bar": (
        [[root(lambda q2: gap((Q1, q2), [SHELF]) + 0.03 - 1e-9, *about) for about in ((-1.4, -1.2), (-1.2, -0.7))]],
        "missing",
    ),
    "the greater end first": ([[UPPER, LOWER]], "shape"),
    "a flat list": ([LOWER, UPPER], "shape"),
    "not a number": ([[LOWER, np.nan]], "shape"),
    "an empty cell": (None, "shape"),
}


@pytest.mark.parametrize("answer", RIGHT.values(), ids=list(RIGHT))
def test_a_right_answer_is_right(answer: object) -> None:
    is_graded("c_obstacles 1", answer, "right")


@pytest.mark.parametrize("answer, reason", WRONG.values(), ids=list(WRONG))
def test_a_wrong_answer_is_wrong_for_its_reason(answer: object, reason: str) -> None:
    is_graded("c_obstacles 1", answer, reason)
