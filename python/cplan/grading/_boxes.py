"""Exercises with boxes of configurations: channels of free boxes, and walls of collision boxes."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from cplan._cplan import Arm, Problem, World, joint_ranges, judge_boxes, separate
from cplan.findings import check
from cplan.grading._exercise import Array, Drawing, Exercise, Wrong, array, place


def _refuse_empty(boxes: Array) -> None:
    """Raises `Wrong` if a box has no area."""
    for number, (lower, upper) in enumerate(boxes):
        if (lower >= upper).any():
            raise Wrong("empty", f"box {number} from {place(lower)} to {place(upper)} is empty", at=lower, box=number)


@dataclass(frozen=True)
class Channel(Exercise[Array]):
    """A channel of free boxes, from the box of the start to the box of the goal: shape (n, 2, 2), with the least and the
    greatest values of each box. Boxes that follow each other share a portal.
    """

    arm: Arm
    world: World

    def read(self, answer: Any) -> Array:
        return array(answer, "boxes", None, 2, 2)

    def drawing(self, answer: Array) -> Drawing:
        return Drawing(boxes=(answer.tolist(), [], []))

    def judge(self, answer: Array) -> str:
        _refuse_empty(answer)
        problem = Problem(self.arm, self.world)
        for what, which, q, box in (("start", "first", problem.start, answer[0]), ("goal", "last", problem.goals[0], answer[-1])):
            if not self._contains(box, np.asarray(q)):
                raise Wrong(what, f"the {what} {place(q)} is not in the {which} box", at=q)
        for number, (verdict, at) in enumerate(judge_boxes(self.arm, self.world, answer.tolist())):
            if at is None:
                continue
            figures: dict[str, Any] = {"at": at, "box": number}
            match verdict:
                case "collision":
                    contact = check(self.arm, self.world, at).contacts[0]
                    why = f'link "{contact.link}" meets "{contact.obstacle}" at {place(at)}'
                    raise Wrong(verdict, f"box {number} is not free: {why}", obstacle=contact.obstacle, **figures)
                case "limits":
                    raise Wrong(verdict, f"box {number} extends beyond the limits, to {place(at)}", **figures)
            raise Wrong(verdict, f"box {number} is too near a C-obstacle to decide, about {place(at)}", **figures)
        for number, (a, b) in enumerate(zip(answer, answer[1:])):
            common = np.minimum(a[1], b[1]) - np.maximum(a[0], b[0])
            if common.min() < 0 or common.max() <= 0:
                why = f"boxes {number} and {number + 1} share no portal, that is a piece of a side"
                raise Wrong("portal", why, at=a.mean(axis=0), box=number)
        return f"all boxes are certified free, and lead from start to goal: {len(answer)}"

    def _contains(self, box: Array, q: Array) -> bool:
        """Returns true if a box contains a configuration, or a copy of it on circles."""
        is_circle = [is_circle for _, _, is_circle in joint_ranges(self.arm, self.world)]
        turns = np.where(is_circle, np.round((box.mean(axis=0) - q) / (2 * np.pi)), 0.0)
        copy = q + 2 * np.pi * turns
        return bool((box[0] <= copy).all() and (copy <= box[1]).all())


@dataclass(frozen=True)
class Proof(Exercise[Array]):
    """A proof that no path exists: collision boxes that separate the start from all goals, shape (n, 2, 2), with the
    least and the greatest values of each. On a circle, a box may go across the seam.
    """

    arm: Arm
    world: World

    def read(self, answer: Any) -> Array:
        return array(answer, "boxes", None, 2, 2)

    def drawing(self, answer: Array) -> Drawing:
        return Drawing(boxes=([], answer.tolist(), []))

    def judge(self, answer: Array) -> str:
        _refuse_empty(answer)
        boxes = answer.tolist()
        for number, (verdict, at) in enumerate(judge_boxes(self.arm, self.world, boxes, colliding=True)):
            if at is not None:
                fault = "is free" if verdict == "free" else "cannot be decided"
                raise Wrong(verdict, f"box {number} is not in collision: {place(at)} {fault}", at=at, box=number)
        if not separate(self.arm, self.world, boxes):
            start = Problem(self.arm, self.world).start
            raise Wrong("not separated", "all boxes are in collision, but they do not separate start and goal", at=start)
        return f"the boxes are in collision, and separate start and goal: {len(boxes)}"
