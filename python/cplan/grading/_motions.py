"""Exercises with motions: paths and roadmaps. The judge certifies each motion as a whole."""

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cplan._cplan import Arm, Found, Problem, World
from cplan.findings import Verification, verify
from cplan.grading._exercise import Array, Drawing, Exercise, Wrong, array, place
from cplan.planning import plan

SAME_PLACE = 1e-9
"""Largest difference of equal configurations, rad or m."""


@dataclass(frozen=True)
class Path(Exercise[Array]):
    """A path from start to goal: waypoints of shape (n, 2) with straight motions between them.

    With `within`, its length may exceed the proven lower bound by this fraction at most. `clearance` (metres) replaces
    that of the world.
    """

    arm: Arm
    world: World
    within: float | None = None
    clearance: float | None = None

    def read(self, answer: Any) -> Array:
        return array(answer, "waypoints", None, 2)

    def drawing(self, answer: Array) -> Drawing:
        return Drawing(paths=[answer.tolist()])

    @cached_property
    def bound(self) -> float:
        """The proven lower bound on the length of all paths."""
        found = plan(self.arm, self.world, clearance=self.clearance)
        if not isinstance(found, Found) or found.lower_bound is None:
            raise ValueError("the exercise has no path with a proven bound on its length")
        return found.lower_bound

    def judge(self, answer: Array) -> str:
        found = verify(self.arm, self.world, answer, clearance=self.clearance)
        refuse(found)
        length = float(np.linalg.norm(np.diff(answer, axis=0), axis=1).sum())
        if self.within is not None and length > self.bound * (1 + self.within):
            over = length / self.bound - 1
            raise Wrong(
                "length",
                f"the path is free, but {100 * over:.3g} % longer than the proven bound {self.bound:.6g}; at most {100 * self.within:g} % are allowed",
                length=length,
                bound=self.bound,
            )
        return f"certified free from start to goal; length {length:.6g}"


def refuse(found: Verification, what: str = "the path", **figures: Any) -> None:
    """Raises the reason why a motion is not right, if it is not: wrong ends first, then limits, then contacts."""
    if found.free:
        return
    if found.faults:
        raise Wrong("ends", f"{what} does not lead from start to goal: {'; '.join(found.faults)}", **figures)
    if found.limits_broken:
        broken = found.limits_broken[0]
        why = f'joint "{broken.joint}" reaches {broken.value:.6g}; its limit is {broken.allowed:.6g}'
        raise Wrong("limits", f"{what} breaks a limit: {why}", at=broken.configuration, joint=broken.joint, **figures)
    moment = found.first_contact or found.undecided
    if moment is None:
        raise Wrong(found.verdict, f"{what} is not certified", **figures)
    fault = "collides" if found.verdict == "collision" else "is too near to decide"
    where = f'at {place(moment.configuration)}, in segment {moment.sample}, with link "{moment.link}" and "{moment.obstacle}"'
    raise Wrong(found.verdict, f"{what} {fault}: {where}", at=moment.configuration, **_about(moment), **figures)


def _about(moment: Any) -> dict[str, Any]:
    return {"segment": moment.sample, "link": moment.link, "obstacle": moment.obstacle, "depth": moment.depth}


Graph = tuple[Array, NDArray[np.int64]]


@dataclass(frozen=True, eq=False)
class Roadmap(Exercise[Graph]):
    """A roadmap: vertices of shape (n, 2), and pairs of their numbers. Every edge is certified, and the roadmap joins
    start and goal.

    With `samples`, the vertices are these configurations, in any order. Then the roadmap is complete: all pairs that
    are at most `radius` apart and have a free motion are edges, and there are no others.
    """

    arm: Arm
    world: World
    samples: Array | None = None
    radius: float = np.inf

    def read(self, answer: Any) -> Graph:
        try:
            vertices, edges = answer
        except (TypeError, ValueError):
            raise Wrong("shape", "expected a pair: vertices and edges") from None
        places, numbers = array(vertices, "vertices", None, 2), array(edges, "edges", None, 2)
        pairs = numbers.astype(np.int64)
        if (pairs != numbers).any() or pairs.min() < 0 or pairs.max() >= len(places):
            raise Wrong("shape", f"edges are pairs of numbers from 0 to {len(places) - 1}")
        return places, pairs

    def drawing(self, answer: Graph) -> Drawing:
        return Drawing(edges=answer[0][answer[1]].tolist())

    def judge(self, answer: Graph) -> str:
        vertices, edges = answer
        if self.samples is not None:
            self._compare_vertices(vertices, self.samples)
        problem = Problem(self.arm, self.world)
        ends = [(what, _number(vertices, q)) for what, q in (("start", problem.start), ("goal", problem.goals[0]))]
        for what, number in ends:
            if number is None:
                raise Wrong(what, f"the {what} is not a vertex")
        pairs = {(min(i, j), max(i, j)) for i, j in edges.tolist()}
        for i, j in sorted(pairs):
            if i == j:
                raise Wrong("edge", f"edge {i}-{j} joins a vertex with itself", at=vertices[i], edge=(i, j))
            refuse(self._verified(vertices, i, j), f"edge {i}-{j}", edge=(i, j))
        if self.samples is not None:
            self._compare_edges(vertices, pairs)
        groups = list(range(len(vertices)))
        for i, j in pairs:
            groups = [groups[i] if group == groups[j] else group for group in groups]
        if len({groups[number] for _, number in ends if number is not None}) > 1:
            raise Wrong("disconnected", "the roadmap does not join start and goal", at=problem.start)
        return f"{len(vertices)} vertices and {len(pairs)} edges, all certified"

    def _verified(self, vertices: Array, i: int, j: int) -> Verification:
        return verify(self.arm, self.world, vertices[[i, j]], anywhere=True)

    def _compare_vertices(self, vertices: Array, samples: Array) -> None:
        for number, q in enumerate(samples):
            if _number(vertices, q) is None:
                raise Wrong("missing vertex", f"sample {number} at {place(q)} is not a vertex", at=q, sample=number)
        for number, q in enumerate(vertices):
            if _number(samples, q) is None:
                raise Wrong("extra vertex", f"vertex {number} at {place(q)} is not a sample", at=q, vertex=number)
        if len(vertices) != len(samples):
            raise Wrong("extra vertex", f"{len(vertices)} vertices, but {len(samples)} samples")

    def _compare_edges(self, vertices: Array, pairs: set[tuple[int, int]]) -> None:
        for i, j in combinations(range(len(vertices)), 2):
            apart = float(np.linalg.norm(vertices[i] - vertices[j]))
            if (i, j) in pairs and apart > self.radius:
                why = f"edge {i}-{j} is {apart:.6g} long, more than {self.radius:g}"
                raise Wrong("extra edge", why, at=vertices[i], edge=(i, j), length=apart)
            if (i, j) not in pairs and apart <= self.radius and self._verified(vertices, i, j).free:
                raise Wrong("missing edge", f"the motion {i}-{j} is free, but not an edge", at=vertices[i], edge=(i, j))


def _number(vertices: Array, q: Any) -> int | None:
    """Returns the number of the vertex at a configuration, or None."""
    near = np.abs(vertices - np.asarray(q)).max(axis=1) <= SAME_PLACE
    return int(near.argmax()) if near.any() else None
