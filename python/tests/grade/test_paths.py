"""Paths past the shelf: a short one, and one with a payload. Hand-made paths fold the forearm, whose reach is then less than
the distance of the shelf."""

import cplan
import numpy as np
import pytest
from judged import is_graded
from oracle import gap, root

SHELF = [[1.15, 0.18], [1.6, 0.18], [1.6, 0.3], [1.15, 0.3]]
CRATE = [[0.5, -1.6], [0.8, -1.6], [0.8, -1.3], [0.5, -1.3]]
START, GOAL = (-0.9, 0.4), (1.55, -0.35)
TURN = 2 * np.pi
# The first stroke leads away from the shelf, which the forearm with its payload could hit.
FOLDED = [START, (-1.1, 0.6), (-1.1, 2.4), (1.55, 2.4), GOAL]
Q1 = np.radians(27.7)

SHORT = cplan.grading.exercise("roadmaps 2")
LOADED = cplan.grading.exercise("tasks 2")


def planned(exercise: cplan.grading.Exercise, planner: str) -> np.ndarray:
    found = cplan.plan(exercise.arm, exercise.world, planner=planner)
    assert isinstance(found, cplan.Found)
    return found.path


def length(path: np.ndarray) -> float:
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def split(path: np.ndarray) -> np.ndarray:
    middles = (path[1:] + path[:-1]) / 2
    return np.vstack([np.stack([path[:-1], middles], axis=1).reshape(-1, 2), path[-1:]])


def longer(path: np.ndarray, to: float) -> np.ndarray:
    """Returns the path with a stroke to and fro at its start, upwards from the shelf, of this total length."""
    stroke = (to - length(path)) / 2
    return np.vstack([path[:1], path[:1] + [0, stroke], path])


def dipping(to: float, lengths: tuple[float, float]) -> list[tuple[float, float]]:
    """Returns a folded path that dips towards the shelf until the gap is `to` metres."""
    [q2] = [root(lambda q2: gap((Q1, q2), [SHELF], lengths) - to, -0.8, 1.2)]
    assert abs(gap((Q1, q2), [SHELF], lengths) - to) < 1e-12
    return [*FOLDED[:3], (Q1, 2.4), (Q1, q2), *FOLDED[3:]]


BEST = planned(SHORT, "shortest")
BOUND = SHORT.bound
HANDS, LOAD = (1.0, 0.8), (1.0, 1.1)

RIGHT = {
    ("roadmaps 2", "shortest"): BEST,
    ("roadmaps 2", "visibility graph"): planned(SHORT, "visibility"),
    ("roadmaps 2", "as a list"): BEST.tolist(),
    ("roadmaps 2", "with more waypoints"): split(split(BEST)),
    ("roadmaps 2", "with a waypoint twice"): np.repeat(BEST, 2, axis=0),
    ("roadmaps 2", "0.9 % above the bound"): longer(BEST, 1.009 * BOUND),
    ("tasks 2", "folded by hand"): FOLDED,
    ("tasks 2", "shortest"): planned(LOADED, "shortest"),
    ("tasks 2", "triangles"): planned(LOADED, "triangles"),
    ("tasks 2", "with more waypoints"): split(np.array(FOLDED)),
    ("tasks 2", "a micrometre above the shelf"): dipping(1e-6, LOAD),
    ("tasks 2", "ends rounded to 1e-5"): [(-0.9 - 9e-6, 0.4), *FOLDED[1:-1], (1.55, -0.35 + 9e-6)],
}
COMMON = {
    "straight": ([START, GOAL], "collision"),
    "start off by 1.1e-5": ([(-0.9 - 1.1e-5, 0.4), *FOLDED[1:]], "ends"),
    "goal off by 1.1e-5": ([*FOLDED[:-1], (1.55, -0.35 + 1.1e-5)], "ends"),
    "from goal to start": (FOLDED[::-1], "ends"),
    "without the start": (FOLDED[1:], "ends"),
    "a full turn further": ([*FOLDED[:4], (1.55, -0.35 + TURN)], "ends"),
    "beyond a limit": ([*FOLDED[:2], (-1.1, 3.0), (1.55, 3.0), GOAL], "limits"),
    "degrees": (np.degrees(FOLDED), "ends"),
    "signs": ([(-a, -b) for a, b in FOLDED], "ends"),
    "one waypoint cut": ([*FOLDED[:3], GOAL], "collision"),
    "three columns": ([(*q, 0.0) for q in FOLDED], "shape"),
    "not finite": ([START, (np.inf, 0.0), GOAL], "shape"),
    "an empty list": ([], "shape"),
    "an empty cell": (None, "shape"),
    "text": ("straight on", "shape"),
}
WRONG = {(exercise, name): answer for exercise in ("roadmaps 2", "tasks 2") for name, answer in COMMON.items()} | {
    ("roadmaps 2", "1.1 % above the bound"): (longer(BEST, 1.011 * BOUND), "length"),
    ("roadmaps 2", "folded by hand, free but long"): (FOLDED, "length"),
    ("roadmaps 2", "a micrometre above the shelf, but long"): (dipping(1e-6, HANDS), "length"),
    ("roadmaps 2", "a micrometre in the shelf"): (dipping(-1e-6, HANDS), "collision"),
    ("roadmaps 2", "every second waypoint"): (np.vstack([BEST[:-1:2], BEST[-1:]]), "collision"),
    ("tasks 2", "a micrometre in the shelf"): (dipping(-1e-6, LOAD), "collision"),
    ("tasks 2", "the path of the empty hand"): (BEST, "collision"),
    ("tasks 2", "every second waypoint"): (planned(LOADED, "shortest")[::2], "collision"),
}


@pytest.mark.parametrize("case", RIGHT)
def test_a_right_path_is_right(case: tuple[str, str]) -> None:
    is_graded(case[0], RIGHT[case], "right")


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_path_is_wrong_for_its_reason(case: tuple[str, str]) -> None:
    is_graded(case[0], *WRONG[case])


@pytest.mark.parametrize("exercise, lengths", [("roadmaps 2", HANDS), ("tasks 2", LOAD)])
def test_touching_is_not_free(exercise: str, lengths: tuple[float, float]) -> None:
    grade = cplan.grade(exercise, dipping(0.0, lengths))
    assert grade.reason in ("collision", "undecided") and grade.figures["obstacle"] == "shelf"
    assert np.allclose(grade.figures["at"], dipping(0.0, lengths)[4], atol=1e-6)


def test_the_figures_name_the_place_of_the_collision() -> None:
    grade = cplan.grade("tasks 2", dipping(-1e-3, LOAD))
    assert (grade.figures["segment"], grade.figures["obstacle"]) == (3, "shelf")
    assert gap(grade.figures["at"], [SHELF], LOAD) <= 1e-9
    assert "the arm, not free" in grade.svg()
    too_long = cplan.grade("roadmaps 2", FOLDED)
    assert too_long.figures == {"length": pytest.approx(np.hypot(0.2, 0.2) + 1.8 + 2.65 + 2.75), "bound": BOUND}


def test_a_required_clearance_counts() -> None:
    exercise = cplan.grading.Path(LOADED.arm, LOADED.world, clearance=0.01)
    assert exercise.grade(FOLDED)
    assert exercise.grade(dipping(0.009, LOAD)).reason == "collision"


def test_full_turns_on_circles() -> None:
    wall = {"name": "wall", "polygon": [[0.4, -0.04], [2.0, -0.04], [2.0, 0.04], [0.4, 0.04]]}
    world = cplan.World(wall, start=[-0.8, 0.3], goal=[0.9, -0.3])
    around = cplan.grading.Path(cplan.Arm.rr([1.0, 0.8], width=0.06), world)
    # The goal is the same configuration after a full turn, and lies behind the start there.
    assert around.grade([(-0.8, 0.3), (-1.5, 0.3), (0.9 - TURN, -0.3)])
    # The turn is a motion, too: values that jump back by a turn sweep the arm through the wall.
    assert around.grade([(-0.8, 0.3), (-1.5, 0.3), (0.9, -0.3)]).reason == "collision"
    jump = around.grade([(-0.8, 0.3), (-1.5, 0.3), (0.9 - TURN, -0.3), (0.9, -0.3)])
    assert (jump.reason, jump.figures["segment"]) == ("collision", 2)
