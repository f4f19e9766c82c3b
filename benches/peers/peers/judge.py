"""The independent judge of paths: separating axes in numpy, at most 1e-4 rad apart; no code of cplan or of any peer."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .problem import Problem

STEP = 1e-4
"""Greatest distance between two tested configurations, radians (Euclidean in joint space)."""

LEVELS = (1e-2, 1e-3, STEP)
"""Lengths of pieces: one that is proven free as a whole is not divided further."""


@dataclass(frozen=True)
class Judgement:
    """What became of a path: why it is none, or the least gap found along it."""

    valid: bool
    reason: str
    gap: float


def _projections(corners: np.ndarray, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest of the corners along each axis: (n, k, 2) and (n, m, 2) give (n, m) twice."""
    values = np.einsum("nkd,nmd->nmk", corners, axes)
    return values.min(axis=2), values.max(axis=2)


def _normals(corners: np.ndarray) -> np.ndarray:
    sides = np.roll(corners, -1, axis=-2) - corners
    normals = np.stack([sides[..., 1], -sides[..., 0]], axis=-1)
    return normals / np.linalg.norm(normals, axis=-1, keepdims=True)


class Judge:
    """Judges paths of one problem."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        far = [float(np.linalg.norm(link, axis=1).max()) for link in problem.links]
        self._lever = (far[0], problem.elbow + far[1], far[1])

    def gaps(self, q: np.ndarray) -> np.ndarray:
        """Of each configuration a lower bound on the distance of arm and obstacles, metres; contact is 0 or less."""
        least = np.full(len(q), math.inf)
        for corners in self._links(q):
            link_normals = _normals(corners)
            for obstacle in self.problem.obstacles:
                polygon = np.broadcast_to(obstacle, (len(q), *obstacle.shape))
                normals = np.broadcast_to(_normals(obstacle), polygon.shape)
                axes = np.concatenate([link_normals, normals], axis=1)
                low, high = _projections(corners, axes)
                low_fixed, high_fixed = _projections(polygon, axes)
                gap = np.maximum(low - high_fixed, low_fixed - high).max(axis=1)
                least = np.minimum(least, gap)
        return least

    def _links(self, q: np.ndarray) -> list[np.ndarray]:
        first, both = q[:, 0], q[:, 0] + q[:, 1]
        elbow = self.problem.elbow * np.stack([np.cos(first), np.sin(first)], axis=1)
        places = []
        for angle, corners, at in zip((first, both), self.problem.links, (np.zeros_like(elbow), elbow), strict=True):
            x, y = corners.T
            c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
            places.append(at[:, None, :] + np.stack([c * x - s * y, s * x + c * y], axis=2))
        return places

    def judge(self, path: np.ndarray) -> Judgement:
        """Whether an unwrapped path leads from start to goal and no tested configuration of it collides."""
        problem = self.problem
        assert problem.start is not None and problem.goal is not None
        turns = (path[-1] - problem.goal) / (2 * math.pi)
        if np.abs(path[0] - problem.start).max() > 1e-9 or np.abs(turns - turns.round()).max() > 1e-9:
            return Judgement(False, "does not lead from start to goal", math.nan)
        pieces = np.stack([path[:-1], path[1:]], axis=1)
        least = math.inf
        for size in LEVELS:
            pieces = _divided(pieces, size)
            middle = self.gaps(pieces.mean(axis=1))
            least = min(least, float(middle.min()))
            if least <= 0:
                return Judgement(False, f"collides ({-least * 1e3:.3g} mm deep)", least)
            # No point of the arm is farther from where it is in the middle of the piece than that.
            step = np.abs(pieces[:, 1] - pieces[:, 0]) / 2
            upper, fore, second = self._lever
            moves = np.maximum(step[:, 0] * upper, step[:, 0] * fore + step[:, 1] * second)
            pieces = pieces[moves >= middle]
            if not len(pieces):
                break
        return Judgement(True, "free", least)


def _divided(pieces: np.ndarray, size: float) -> np.ndarray:
    """The pieces in equal parts no longer than `size`."""
    lengths = np.linalg.norm(pieces[:, 1] - pieces[:, 0], axis=1)
    counts = np.maximum(np.ceil(lengths / size).astype(int), 1)
    index = np.repeat(np.arange(len(pieces)), counts)
    at = np.concatenate([np.arange(count) for count in counts]) / counts[index]
    width = 1 / counts[index]
    start, way = pieces[index, 0], pieces[index, 1] - pieces[index, 0]
    return np.stack([start + at[:, None] * way, start + (at + width)[:, None] * way], axis=1)


class Verdicts:
    """Judgements, each path judged once."""

    def __init__(self, problems: dict[str, Problem]) -> None:
        self._judges = {name: Judge(problem) for name, problem in problems.items()}
        self._known: dict[tuple[str, bytes], bool] = {}

    def valid(self, problem: str, path: np.ndarray | None) -> bool:
        """Whether there is a path and it is one."""
        if path is None:
            return False
        key = (problem, path.tobytes())
        if key not in self._known:
            self._known[key] = self._judges[problem].judge(path).valid
        return self._known[key]
