"""Geometry of the course's arms without cplan: distances of bars to polygons, contact angles by bisection, IK by the law of
cosines, and waves and fields by plain loops."""

from collections import deque
from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

RADIUS = 0.03
"""Half of the width of a bar with round ends."""


def point_to_segment(p: NDArray[np.float64], a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    along = np.clip(np.dot(p - a, b - a) / np.dot(b - a, b - a), 0.0, 1.0)
    return float(np.linalg.norm(p - a - along * (b - a)))


def cross(a: ArrayLike, b: ArrayLike) -> float:
    (ax, ay), (bx, by) = np.asarray(a), np.asarray(b)
    return float(ax * by - ay * bx)


def segments(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike) -> float:
    """Returns the distance of two segments."""
    a, b, c, d = (np.asarray(p, float) for p in (a, b, c, d))
    if cross(b - a, c - a) * cross(b - a, d - a) < 0 and cross(d - c, a - c) * cross(d - c, b - c) < 0:
        return 0.0
    return min(point_to_segment(a, c, d), point_to_segment(b, c, d), point_to_segment(c, a, b), point_to_segment(d, a, b))


def bar_to_polygon(a: NDArray[np.float64], b: NDArray[np.float64], corners: ArrayLike) -> float:
    """Returns the distance of a bar's axis to a polygon (or polyline of two points); 0 if they meet."""
    ring = np.asarray(corners, float)
    inside = False
    for p, q in zip(ring, np.roll(ring, -1, axis=0)):
        if (p[1] > a[1]) != (q[1] > a[1]) and a[0] < p[0] + (a[1] - p[1]) / (q[1] - p[1]) * (q[0] - p[0]):
            inside = not inside
    return 0.0 if inside else min(segments(a, b, p, q) for p, q in zip(ring, np.roll(ring, -1, axis=0)))


def tip(q: ArrayLike, lengths: tuple[float, float] = (1.0, 0.8)) -> NDArray[np.float64]:
    first, second = np.cumsum(np.asarray(q, float))
    elbow = lengths[0] * np.array([np.cos(first), np.sin(first)])
    return elbow + lengths[1] * np.array([np.cos(second), np.sin(second)])


def gap(q: ArrayLike, polygons: Iterable[ArrayLike], lengths: tuple[float, float] = (1.0, 0.8)) -> float:
    """Returns the distance of the arm to polygons, less the half width of the bars; negative in collision."""
    first = float(np.asarray(q, float)[0])
    elbow = lengths[0] * np.array([np.cos(first), np.sin(first)])
    bars = [(np.zeros(2), elbow), (elbow, tip(q, lengths))]
    return min(bar_to_polygon(a, b, polygon) for a, b in bars for polygon in polygons) - RADIUS


def root(function: Callable[[float], float], lower: float, upper: float) -> float:
    """Returns a place at which a function changes its sign, by bisection."""
    positive = function(upper) > 0
    assert (function(lower) > 0) != positive
    for _ in range(200):
        middle = (lower + upper) / 2
        if (function(middle) > 0) == positive:
            upper = middle
        else:
            lower = middle
    return (lower + upper) / 2


def solutions(at: ArrayLike, lengths: tuple[float, float] = (1.0, 0.8)) -> list[tuple[float, float]]:
    """Returns both IK solutions of a place."""
    (x, y), (a, b) = np.asarray(at, float), lengths
    elbow = float(np.arccos((x * x + y * y - a * a - b * b) / (2 * a * b)))
    return [(float(np.arctan2(y, x) - np.arctan2(b * np.sin(e), a + b * np.cos(e))), e) for e in (elbow, -elbow)]


def around(cell: tuple[int, int], shape: tuple[int, ...]) -> list[tuple[int, int]]:
    i, j = cell
    near = [(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)]
    return [(a, b) for a, b in near if 0 <= a < shape[0] and 0 <= b < shape[1]]


def wave(blocked: NDArray[np.bool_], goal: tuple[int, int]) -> NDArray[np.float64]:
    """Returns the number of moves to the goal, NaN in cells without one."""
    steps = np.full(blocked.shape, np.nan)
    steps[goal] = 0
    queue = deque([goal])
    while queue:
        cell = queue.popleft()
        for near in around(cell, blocked.shape):
            if not blocked[near] and np.isnan(steps[near]):
                steps[near] = steps[cell] + 1
                queue.append(near)
    return steps


def harmonic(blocked: NDArray[np.bool_], goal: tuple[int, int]) -> NDArray[np.float64]:
    """Returns the harmonic field by a direct solution: -1 at the goal, 0 in blocked cells and outside."""
    free = [(int(i), int(j)) for i, j in np.argwhere(~blocked) if (i, j) != goal]
    number = {cell: k for k, cell in enumerate(free)}
    matrix, right = 4 * np.eye(len(free)), np.zeros(len(free))
    for cell, row in number.items():
        for near in around(cell, blocked.shape):
            if near == goal:
                right[row] = -1
            elif near in number:
                matrix[row, number[near]] = -1
    field = np.zeros(blocked.shape)
    field[goal] = -1
    for cell, value in zip(free, np.linalg.solve(matrix, right)):
        field[cell] = value
    return field
