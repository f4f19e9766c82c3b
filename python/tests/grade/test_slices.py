"""Contact angles of a slice, against bisection of the distance to the shelf."""

import cplan
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
    "no interval": ([], "missing"),
    "an empty cell": (None, "shape"),
}


@pytest.mark.parametrize("answer", RIGHT.values(), ids=list(RIGHT))
def test_a_right_answer_is_right(answer: object) -> None:
    is_graded("c_obstacles 1", answer, "right")


@pytest.mark.parametrize("answer, reason", WRONG.values(), ids=list(WRONG))
def test_a_wrong_answer_is_wrong_for_its_reason(answer: object, reason: str) -> None:
    is_graded("c_obstacles 1", answer, reason)


def test_a_free_slice_has_no_intervals() -> None:
    arm, world = cplan.Arm.rr([1.0, 0.8], width=0.06), cplan.World({"name": "shelf", "polygon": SHELF})
    free = cplan.grading.Slice(arm, world, q1=np.pi)
    assert free.grade([]) and free.grade([[0.0, 1.0]]).reason == "extra"
    assert free.grade(None).svg().startswith("<svg")


@pytest.mark.parametrize("turns", [-1, 0, 2])
def test_intervals_on_a_circle_go_across_the_seam(turns: int) -> None:
    # The forearm is longer than link 1. Folded back, its end hits the post behind the base, from both sides of the seam.
    post, lengths = [[-0.4, -0.24], [-0.3, -0.24], [-0.3, -0.14], [-0.4, -0.14]], (1.0, 1.6)
    world = cplan.World({"name": "post", "polygon": post})
    folded = cplan.grading.Slice(cplan.Arm.rr(lengths, width=0.06), world, q1=0.5)
    first = root(lambda q2: gap((0.5, q2), [post], lengths), 2.0, np.pi)
    last = root(lambda q2: gap((0.5, q2), [post], lengths), np.pi, 5.0)
    assert first < np.pi < last
    assert folded.grade([[first + turns * TURN, last + turns * TURN]])
    assert folded.grade([[first, np.pi], [-np.pi, last - TURN]])
    assert folded.grade([[first, np.pi]]).reason == "missing"
    assert folded.grade([[first, last + 1e-6]]).reason == "extra"
