"""Answers of any kind are graded: none raises an exception, and none of these is right."""

import cplan
import numpy as np
import pytest

HUGE = 1e308
MALFORMED = {
    "nothing": None,
    "an ellipsis": ...,
    "text": "no path",
    "bytes": b"\x00",
    "a number": 3,
    "a truth value": True,
    "a huge integer": 10**400,
    "an object": object(),
    "a function": len,
    "a dictionary": {"path": [[0, 0]]},
    "an empty list": [],
    "an empty row": [[]],
    "rows of different lengths": [[0, 1], [2]],
    "missing values": [[None, None], [0, 0]],
    "words": [["a", "b"]],
    "complex numbers": [[1j, 2j]],
    "no rows": np.zeros((0, 2)),
    "infinite": np.full((3, 2), np.inf),
    "not a number": np.full((20, 15), np.nan),
    "huge values": [[HUGE, -HUGE], [-HUGE, HUGE], [HUGE, HUGE]],
    "a huge box": [[[-HUGE, -HUGE], [HUGE, HUGE]]],
    "a tiny box": [[[0.5, 0.5], [np.nextafter(0.5, 1), np.nextafter(0.5, 1)]]],
    "a point many times": [[0.1, 0.1]] * 50,
    "a pair of texts": ("vertices", "edges"),
    "a huge number of a vertex": ([[0.0, 0.0]], [[1e300, 0]]),
    "huge cells": np.full((20, 15), HUGE),
    "text in cells": np.full((20, 15), "x"),
}


@pytest.mark.parametrize("exercise", cplan.grading.NAMES)
@pytest.mark.parametrize("answer", MALFORMED.values(), ids=list(MALFORMED))
def test_malformed_answers_are_wrong(exercise: str, answer: object) -> None:
    grade = cplan.grade(exercise, answer)
    assert not grade and grade.reason != "right" and grade.svg().startswith("<svg")
