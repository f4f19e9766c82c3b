"""Exercises with C-obstacles: contact angles of a slice, and polygons. Both are compared with the exact ones."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cplan._cplan import Arm, World, joint_ranges, slices
from cplan.grading import _areas as areas
from cplan.grading._exercise import Array, Drawing, Exercise, Wrong, array, place
from cplan.planning import plan

Intervals = list[tuple[float, float]]


@dataclass(frozen=True)
class Slice(Exercise[Intervals]):
    """The blocked intervals of joint 2 at the value `q1` of joint 1: pairs of contact angles, shape (n, 2); [] if there are
    none.

    Ends may differ from the exact ones by `tolerance`, rad or m. On a circle, an interval may go across the seam.
    """

    arm: Arm
    world: World
    q1: float
    tolerance: float = 1e-9

    def read(self, answer: Any) -> Intervals:
        if isinstance(answer, (list, tuple)) and not answer:
            return []
        rows = array(answer, "intervals", None, 2)
        for lower, upper in rows:
            if lower >= upper:
                raise Wrong("shape", f"an interval leads from its least to its greatest value, not from {lower:g} to {upper:g}")
        lower, upper, is_circle = joint_ranges(self.arm, self.world)[1]
        if is_circle:
            return _merged([part for a, b in rows for part in _turned(float(a), float(b), lower, upper)])
        for value in rows.flat:
            if not lower - self.tolerance <= value <= upper + self.tolerance:
                raise Wrong("limits", f"{value:.6g} is not within the limits of joint 2", at=(self.q1, value))
        return _merged([(float(a), float(b)) for a, b in rows])

    def drawing(self, answer: Intervals) -> Drawing:
        return Drawing(paths=[[(self.q1, lower), (self.q1, upper)] for lower, upper in answer])

    @cached_property
    def exact(self) -> Intervals:
        """The exact intervals, ascending."""
        [rows] = slices(self.arm, self.world, [self.q1])
        return _merged([(float(lower), float(upper)) for lower, upper in rows])

    def judge(self, answer: Intervals) -> str:
        lower, upper, _ = joint_ranges(self.arm, self.world)[1]
        ends = sorted({lower, upper, *(end for interval in answer + self.exact for end in interval if lower < end < upper)})
        for a, b in zip(ends, ends[1:]):
            middle = (a + b) / 2
            blocked, answered = (any(u <= middle <= v for u, v in each) for each in (self.exact, answer))
            if b - a > self.tolerance and blocked != answered:
                state, claim = ("blocked", "free") if blocked else ("free", "blocked")
                why = f"at {place((self.q1, middle))} the arm is {state}, but the answer has it {claim} from {a:.9g} to {b:.9g}"
                raise Wrong("missing" if blocked else "extra", why, at=(self.q1, middle), interval=(a, b))
        return "the blocked intervals are exact, in both directions"


def _turned(a: float, b: float, lower: float, upper: float) -> Intervals:
    """Returns the parts of an interval on a circle in the domain from `lower` to `upper`."""
    turn = upper - lower
    if b - a >= turn:
        return [(lower, upper)]
    shift = np.floor((a - lower) / turn) * turn
    a, b = float(a - shift), float(b - shift)
    return [(a, b)] if b <= upper else [(a, upper), (lower, b - turn)]


def _merged(intervals: Intervals) -> Intervals:
    """Returns the union of intervals, ascending."""
    union: Intervals = []
    for lower, upper in sorted(intervals):
        if union and lower <= union[-1][1]:
            union[-1] = (union[-1][0], max(upper, union[-1][1]))
        else:
            union.append((lower, upper))
    return union


@dataclass(frozen=True)
class Region(Exercise[list[areas.Polygon]]):
    """The C-obstacles of a gantry: a polygon of shape (n, 2), or a list of polygons whose union counts.

    Areas are exact. The symmetric difference to the exact region, within the joints' limits, may be at most `tolerance`
    (metres) times its perimeter.
    """

    arm: Arm
    world: World
    tolerance: float = 1e-9

    def read(self, answer: Any) -> list[areas.Polygon]:
        try:
            rows = [array(answer, "corners", None, 2)]
        except Wrong:
            if not isinstance(answer, (list, tuple)) or not answer:
                raise
            rows = [array(each, "corners", None, 2) for each in answer]
        rings = [areas.ring(each) for each in rows]
        for number, ring in enumerate(rings):
            if not areas.is_simple(ring):
                raise Wrong("not simple", f"polygon {number} crosses or touches itself", polygon=number)
        return [[ring] for ring in rings]

    def drawing(self, answer: list[areas.Polygon]) -> Drawing:
        rings = [ring + ring[:1] for polygon in answer for ring in polygon]
        return Drawing(paths=[[(float(x), float(y)) for x, y in ring] for ring in rings])

    @cached_property
    def exact(self) -> list[areas.Polygon]:
        """The exact polygons."""
        [space] = plan(self.arm, self.world, planner="visibility", margin=0).cspaces()
        if space.proves.kind != "exact":
            raise ValueError("the C-obstacles of this arm are no polygons; use a `Slice`")
        polygons = [polygon for region in space.c_obstacles for polygon in region.polygons]
        return [[areas.ring(rows) for rows in (polygon.outer, *polygon.holes)] for polygon in polygons]

    def judge(self, answer: list[areas.Polygon]) -> str:
        (left, right, _), (bottom, top, _) = joint_ranges(self.arm, self.world)
        window = areas.ring([(left, bottom), (right, bottom), (right, top), (left, top)])
        extra, missing = areas.difference(answer, self.exact, window)
        allowed = self.tolerance * areas.perimeter(self.exact)
        for reason, part, state, claim in (("missing", missing, "blocked", "free"), ("extra", extra, "free", "blocked")):
            if part.area > allowed and part.place is not None:
                why = f"at {place(part.place)} the arm is {state}, but the answer has it {claim}; such places have an area of {float(part.area):.6g}"
                raise Wrong(reason, why, at=part.place, area=float(part.area))
        return "the region is exact in both directions"
