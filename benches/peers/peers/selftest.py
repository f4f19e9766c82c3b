"""Tests of the harness itself, at the start of each run: its judge rejects what collides, all checkers see one "
"scene."""

from __future__ import annotations

import ctypes
import math

import numpy as np

from .judge import STEP, Judge
from .problem import Problem
from .settings import NotRunError, Settings, say

SAMPLES = 20_000
"""Random configurations on which all checkers must agree."""

DOUBT = 1e-9
"""Gaps less than this, metres, are left to rounding."""


class BrokenError(Exception):
    """The harness is wrong; no figure of it would mean anything."""


def run(settings: Settings, problems: dict[str, Problem]) -> list[str]:
    """Raises `BrokenError`; returns what was tested, in words."""
    done = [_judge_rejects(problems["A"]), _judge_sees_thin_walls(problems["T"])]
    random = np.random.default_rng(1)
    for problem in problems.values():
        q = random.uniform(-math.pi, math.pi, size=(SAMPLES, 2))
        gaps = np.concatenate([Judge(problem).gaps(part) for part in np.array_split(q, 20)])
        sure = np.abs(gaps) > DOUBT
        for name, ask in (("C++", _by_cpp), ("Rust", _by_rust)):
            try:
                told = ask(settings, problem, q)
            except NotRunError as error:
                say(f"  {name} checker not tested: {error}")
                continue
            _demand((told == (gaps <= 0))[sure].all(), f"the {name} checker and the judge differ on {problem.name}")
    done.append(f"judge, C++ checker and Rust checker agree on {SAMPLES} random configurations of each problem")
    return done


def _demand(truth: bool, otherwise: str) -> None:
    if not truth:
        raise BrokenError(otherwise)


def _judge_rejects(problem: Problem) -> str:
    """Straight from start to goal goes through obstacles; and what goes nowhere is no path."""
    assert problem.start is not None and problem.goal is not None
    judge = Judge(problem)
    straight = np.stack([problem.start, problem.goal])
    _demand(not judge.judge(straight).valid, "the judge takes a path that collides for valid")
    nowhere = np.stack([problem.start, problem.start])
    _demand(not judge.judge(nowhere).valid, "the judge takes a path that ends elsewhere for valid")
    return "the judge rejects the straight motion of A, and one that does not reach the goal"


def _judge_sees_thin_walls(problem: Problem) -> str:
    """The walls of T are bands of the first joint, thinner than a hundredth of a radian: nothing passes the judge."""
    judge = Judge(problem)
    first = np.arange(-math.pi, math.pi, STEP)
    folded = np.stack([first, np.full_like(first, 2.6)], axis=1)
    gaps = judge.gaps(folded)
    blocked = int((gaps <= 0).sum())
    _demand(blocked > 0, "the judge sees no wall in T")
    middle = first[gaps <= 0].mean()
    across = np.array([[middle - 0.5, 2.6], [middle + 0.5, 2.6]])
    moved = Problem("across", problem.world, problem.links, problem.elbow, problem.obstacles, across[0], across[1])
    _demand(not Judge(moved).judge(across).valid, "the judge passes through a wall of T")
    return "the judge sees a wall of T that is thinner than the peers' steps"


def _by_cpp(settings: Settings, problem: Problem, q: np.ndarray) -> np.ndarray:
    library = settings.work / "libchecker.so"
    if not library.exists():
        raise NotRunError("it was not compiled")
    checker = ctypes.CDLL(str(library))
    checker.scene_read.restype = ctypes.c_void_p
    checker.scene_collides.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double]
    scene = ctypes.c_void_p(checker.scene_read(str(settings.work / f"{problem.name}.scene").encode()))
    return np.array([checker.scene_collides(scene, a, b) != 0 for a, b in q])


def _by_rust(settings: Settings, problem: Problem, q: np.ndarray) -> np.ndarray:
    text = "\n".join(f"{float(a)!r} {float(b)!r}" for a, b in q)
    return np.array(settings.rust("collides", *problem.files, given=text))
