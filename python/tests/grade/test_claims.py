"""Blocking obstacles, and configurations that reach a place, against the law of cosines."""

import pickle

import cplan
import numpy as np
import pytest
from judged import is_graded
from oracle import solutions, tip

FRONT, BACK = "front wall", "back wall"

BLOCKERS = {
    "a list": [FRONT, BACK],
    "a set": {FRONT, BACK},
    "a tuple in the other order": (BACK, FRONT),
    "one of them twice": [FRONT, BACK, FRONT],
    "keys of a dictionary": {FRONT: 1, BACK: 2},
}
NO_BLOCKERS = {
    "the front wall only": ([FRONT], "path exists"),
    "the back wall only": ([BACK], "path exists"),
    "the post": (["post"], "path exists"),
    "a wall and the shelf": ([FRONT, "shelf"], "path exists"),
    "the two others": (["post", "shelf"], "path exists"),
    "with the post": ([FRONT, BACK, "post"], "not needed"),
    "with the shelf": ([FRONT, BACK, "shelf"], "not needed"),
    "everything": ([FRONT, BACK, "post", "shelf"], "not needed"),
    "a misspelt name": (["front", "back"], "unknown name"),
    "a capital letter": (["Front wall", BACK], "unknown name"),
    "a single text": ("front wall", "shape"),
    "numbers of obstacles": ([0, 1], "shape"),
    "no obstacle": ([], "shape"),
    "an empty cell": (None, "shape"),
}

TIP = (0.35, 1.2)
LEFT, RIGHT_SIDE = solutions(TIP)
TURNED = (RIGHT_SIDE[0] - 2 * np.pi, RIGHT_SIDE[1])
SOLUTIONS = {
    "both": [RIGHT_SIDE, TURNED],
    "in the other order": [TURNED, RIGHT_SIDE],
    "an array": np.array([RIGHT_SIDE, TURNED]),
    "rounded to 1e-10": np.round([RIGHT_SIDE, TURNED], 10),
    "a nanometre off": [(RIGHT_SIDE[0] + 5e-10, RIGHT_SIDE[1]), TURNED],
}
NO_SOLUTIONS = {
    "one of them": ([RIGHT_SIDE], "missing"),
    "the other one": ([TURNED], "missing"),
    "with the solution that meets the post": ([LEFT, RIGHT_SIDE, TURNED], "collision"),
    "only the solution that meets the post": ([LEFT], "collision"),
    "a full turn of joint 2": ([RIGHT_SIDE, TURNED, (RIGHT_SIDE[0], RIGHT_SIDE[1] + 2 * np.pi)], "limits"),
    "a full turn of joint 1 beyond the limit": ([RIGHT_SIDE, TURNED, (RIGHT_SIDE[0] + 2 * np.pi, RIGHT_SIDE[1])], "limits"),
    "one of them twice": ([RIGHT_SIDE, RIGHT_SIDE], "repeated"),
    "a micrometre off": ([(RIGHT_SIDE[0], RIGHT_SIDE[1] + 2e-6), TURNED], "tip"),
    "the sign of joint 2": ([(RIGHT_SIDE[0], -RIGHT_SIDE[1])], "tip"),
    "the sign of joint 1": ([(-RIGHT_SIDE[0], RIGHT_SIDE[1])], "tip"),
    "joints exchanged": ([RIGHT_SIDE[::-1]], "tip"),
    "absolute angles": ([(RIGHT_SIDE[0], sum(RIGHT_SIDE))], "tip"),
    "degrees": (np.degrees([RIGHT_SIDE, TURNED]), "tip"),
    "the place itself": ([TIP], "tip"),
    "a flat list": (RIGHT_SIDE, "shape"),
    "an empty cell": (None, "shape"),
}


@pytest.mark.parametrize("answer", BLOCKERS.values(), ids=list(BLOCKERS))
def test_right_blockers_are_right(answer: object) -> None:
    is_graded("proofs 2", answer, "right")


@pytest.mark.parametrize("answer, reason", NO_BLOCKERS.values(), ids=list(NO_BLOCKERS))
def test_wrong_blockers_are_wrong_for_their_reason(answer: object, reason: str) -> None:
    is_graded("proofs 2", answer, reason)


def test_solutions_by_hand_reach_the_place() -> None:
    assert np.allclose([tip(q) for q in (LEFT, RIGHT_SIDE, TURNED)], [TIP] * 3, atol=1e-12)


@pytest.mark.parametrize("answer", SOLUTIONS.values(), ids=list(SOLUTIONS))
def test_right_solutions_are_right(answer: object) -> None:
    is_graded("tasks 1", answer, "right")


@pytest.mark.parametrize("answer, reason", NO_SOLUTIONS.values(), ids=list(NO_SOLUTIONS))
def test_wrong_solutions_are_wrong_for_their_reason(answer: object, reason: str) -> None:
    is_graded("tasks 1", answer, reason)


def test_there_are_seven_chapters() -> None:
    chapters = {name.split()[0] for name in cplan.grading.NAMES}
    assert chapters == {"c_obstacles", "roadmaps", "cells", "waves", "fields", "proofs", "tasks"}
    with pytest.raises(ValueError, match="there is no exercise"):
        cplan.grade("roadmaps 9", None)


def test_grades_and_exercises_can_be_pickled() -> None:
    grade = cplan.grade("proofs 2", [FRONT])
    again = pickle.loads(pickle.dumps(grade))
    assert (again.reason, again.message, again.figures, again.svg()) == (grade.reason, grade.message, grade.figures, grade.svg())
    exercise = cplan.grading.exercise("tasks 1")
    assert pickle.loads(pickle.dumps(exercise)).grade([RIGHT_SIDE, TURNED])
