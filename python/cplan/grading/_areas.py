"""Exact differences of polygons, in rational arithmetic."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import hypot

Point = tuple[Fraction, Fraction]
Ring = list[Point]
Polygon = list[Ring]
"""Rings of a polygon; a place is inside if it is within an odd number of rings."""


@dataclass
class Part:
    """A part of the plane: its area, and a place in its widest piece."""

    area: Fraction = Fraction(0)
    place: tuple[float, float] | None = None
    _widest: Fraction = Fraction(0)

    def add(self, area: Fraction, place: Point) -> None:
        """Adds a piece."""
        self.area += area
        if area > self._widest:
            self._widest, self.place = area, (float(place[0]), float(place[1]))


def ring(corners: Iterable[Sequence[float]]) -> Ring:
    """Converts corners without rounding, without repeated ones."""
    points = [(Fraction(float(x)), Fraction(float(y))) for x, y in corners]
    return [point for point, before in zip(points, points[-1:] + points[:-1]) if point != before]


def is_simple(corners: Ring) -> bool:
    """Returns true if the sides of a ring meet only at common corners."""
    sides = list(zip(corners, corners[1:] + corners[:1]))
    if len(sides) < 3:
        return False
    for (i, (a, b)), (j, (c, d)) in combinations(enumerate(sides), 2):
        if j == i + 1 or (i == 0 and j == len(sides) - 1):
            shared, before, after = (b, a, d) if j == i + 1 else (a, b, c)
            # Neighbouring sides overlap if one turns back onto the other.
            if _turn(before, shared, after) == 0 and _along(shared, before, after) > 0:
                return False
        elif _meet(a, b, c, d):
            return False
    return True


def difference(a: Sequence[Polygon], b: Sequence[Polygon], within: Ring) -> tuple[Part, Part]:
    """Returns the parts of the union of `a` that are not in the union of `b`, and the reverse, in a convex window."""
    unions = [list(a), list(b), [[within]]]
    sides = [
        (min(p, q), max(p, q), (union, polygon))
        for union, polygons in enumerate(unions)
        for polygon, rings in enumerate(polygons)
        for corners in rings
        for p, q in zip(corners, corners[1:] + corners[:1])
        if p[0] != q[0]
    ]
    ends = {x for p, q, _ in sides for x in (p[0], q[0])}
    ends.update(x for (p, q, _), (r, s, _) in combinations(sides, 2) for x in _crossing(p, q, r, s))
    only_a, only_b = Part(), Part()
    ordered = sorted(ends)
    for left, right in zip(ordered, ordered[1:]):
        middle = (left + right) / 2
        levels = sorted((_height(p, q, middle), key) for p, q, key in sides if p[0] <= left and right <= q[0])
        inside: set[tuple[int, int]] = set()
        for (low, key), (high, _) in zip(levels, levels[1:]):
            inside ^= {key}
            in_a, in_b, in_window = (any(union == k for union, _ in inside) for k in range(3))
            if in_window and in_a != in_b:
                (only_a if in_a else only_b).add((right - left) * (high - low), (middle, (low + high) / 2))
    return only_a, only_b


def perimeter(polygons: Iterable[Polygon]) -> float:
    """Returns the length of all sides, rounded."""
    rings = [corners for polygon in polygons for corners in polygon]
    return sum(hypot(p[0] - q[0], p[1] - q[1]) for r in rings for p, q in zip(r, r[1:] + r[:1]))


def _turn(a: Point, b: Point, c: Point) -> Fraction:
    """Returns twice the signed area of a triangle."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _along(origin: Point, a: Point, b: Point) -> Fraction:
    return (a[0] - origin[0]) * (b[0] - origin[0]) + (a[1] - origin[1]) * (b[1] - origin[1])


def _meet(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Returns true if two segments have a common point."""
    turns = [_turn(a, b, c), _turn(a, b, d), _turn(c, d, a), _turn(c, d, b)]
    if turns[0] * turns[1] < 0 and turns[2] * turns[3] < 0:
        return True
    ends = zip(turns, (c, d, a, b), ((a, b), (a, b), (c, d), (c, d)))
    return any(turn == 0 and _along(point, *segment) <= 0 for turn, point, segment in ends)


def _height(p: Point, q: Point, x: Fraction) -> Fraction:
    return p[1] + (q[1] - p[1]) * (x - p[0]) / (q[0] - p[0])


def _crossing(p: Point, q: Point, r: Point, s: Point) -> list[Fraction]:
    """Returns the abscissa at which two segments cross, if they do."""
    left, right = max(p[0], r[0]), min(q[0], s[0])
    if left >= right:
        return []
    begin, end = (_height(p, q, x) - _height(r, s, x) for x in (left, right))
    return [left + (right - left) * begin / (begin - end)] if begin * end < 0 else []
