"""Exercises about reasons and solutions: blocking obstacles, and configurations that reach a place."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from cplan._cplan import Arm, Found, Infeasible, Problem, World, joint_ranges
from cplan.findings import check
from cplan.grading._exercise import Array, Drawing, Exercise, Wrong, array, place
from cplan.planning import plan


@dataclass(frozen=True)
class Blockers(Exercise[frozenset[str]]):
    """The names of obstacles that together leave no path, none of which can be left out.

    cplan proves that no path exists among these obstacles alone, and certifies a path whenever one of them is missing.
    `keys` are those of the world file, such as start and goal.
    """

    arm: Arm
    obstacles: tuple[Mapping[str, Any], ...]
    keys: Mapping[str, Any] = field(default_factory=dict)

    @cached_property
    def world(self) -> World:  # type: ignore[override]
        """The world with all obstacles."""
        return self._among(self._names)

    @property
    def _names(self) -> frozenset[str]:
        return frozenset(obstacle["name"] for obstacle in self.obstacles)

    def _among(self, names: frozenset[str]) -> World:
        return World(*(obstacle for obstacle in self.obstacles if obstacle["name"] in names), **self.keys)

    def read(self, answer: Any) -> frozenset[str]:
        if isinstance(answer, str) or not hasattr(answer, "__iter__"):
            raise Wrong("shape", "expected a collection of names")
        names = list(answer)
        if not names or not all(isinstance(name, str) for name in names):
            raise Wrong("shape", "expected one or more names of obstacles")
        unknown = sorted(set(names) - self._names)
        if unknown:
            raise Wrong("unknown name", f'no obstacle is called "{unknown[0]}"; there are {", ".join(sorted(self._names))}')
        return frozenset(names)

    def judge(self, answer: frozenset[str]) -> str:
        alone = plan(self.arm, self._among(answer))
        if isinstance(alone, Found):
            why = f"among {_listed(answer)} alone a path of length {alone.length or 0:.4g} is certified"
            raise Wrong("path exists", why, at=alone.path[len(alone.path) // 2], path=alone.path.tolist())
        if not isinstance(alone, Infeasible):
            raise Wrong("undecided", f"whether a path exists among {_listed(answer)} alone is not decided")
        for name in sorted(answer):
            if len(answer) > 1 and not isinstance(plan(self.arm, self._among(answer - {name})), Found):
                raise Wrong("not needed", f'the others block the arm without "{name}"', obstacle=name)
        return f"{_listed(answer)} block the arm (proven), and none of them can be left out"


def _listed(names: frozenset[str]) -> str:
    return ", ".join(f'"{name}"' for name in sorted(names))


@dataclass(frozen=True)
class Solutions(Exercise[Array]):
    """All free configurations that put the tip at the goal of the world, which is a place of the tip: shape (n, 2).

    The tip may be off by `tolerance`, metres.
    """

    arm: Arm
    world: World
    tolerance: float = 1e-9

    def read(self, answer: Any) -> Array:
        return array(answer, "configurations", None, 2)

    def drawing(self, answer: Array) -> Drawing:
        return Drawing(paths=[[q] for q in answer.tolist()])

    @cached_property
    def exact(self) -> Array:
        """All free solutions."""
        return Problem(self.arm, self.world).goals

    @cached_property
    def tip(self) -> tuple[float, float]:
        """The place of the tip, metres."""
        return check(self.arm, self.world, self.exact[0].tolist()).tip

    def judge(self, answer: Array) -> str:
        for number, q in enumerate(answer):
            found = check(self.arm, self.world, q.tolist())
            off = float(np.hypot(*np.subtract(found.tip, self.tip)))
            if off > self.tolerance:
                raise Wrong("tip", f"solution {number}: the tip is {off:.6g} m away from {place(self.tip)}", at=q, off=off)
            if not all(found.within_limits):
                raise Wrong("limits", f"solution {number} at {place(q)} is not within the limits", at=q, solution=number)
            if not found.free:
                hit = found.contacts[0]
                why = f'link "{hit.link}" meets "{hit.obstacle}", {hit.depth:.6g} m deep'
                raise Wrong("collision", f"solution {number} at {place(q)}: {why}", at=q, obstacle=hit.obstacle, depth=hit.depth)
            if any(self._same(q, other) for other in answer[:number]):
                raise Wrong("repeated", f"solution {number} at {place(q)} is listed twice", at=q, solution=number)
        for q in self.exact:
            if not any(self._same(q, other) for other in answer):
                raise Wrong("missing", f"there is another free solution: joint 1 at {q[0]:.4g}", at=q)
        return f"{len(answer)} solutions, and there are no others"

    def _same(self, a: Array, b: Array) -> bool:
        apart = np.abs(np.subtract(a, b))
        for joint, (_, _, is_circle) in enumerate(joint_ranges(self.arm, self.world)):
            if is_circle:
                apart[joint] = abs((apart[joint] + np.pi) % (2 * np.pi) - np.pi)
        # Where the arm is nearly stretched, the joints may move much while the tip hardly moves.
        return bool(apart.max() <= 1e-4)
