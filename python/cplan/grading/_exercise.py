"""Exercises and grades: an exercise reads an answer, judges it, and draws it."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from cplan._cplan import Arm, InputError, Problem, World, joint_ranges
from cplan._cplan import drawn as _drawn

Array = NDArray[np.float64]

MAX_VALUE = 1e6
"""Largest value of a joint that cplan reads, rad or m."""


class Wrong(Exception):
    """The reason why an answer is wrong: a word for programs, a sentence, and figures. `at` is a configuration."""

    def __init__(self, reason: str, message: str, *, at: Sequence[float] | Array | None = None, **figures: Any) -> None:
        super().__init__(message)
        self.reason = reason
        self.figures = figures
        if at is not None:
            self.figures = {"at": (float(at[0]), float(at[1])), **figures}


@dataclass(frozen=True)
class Drawing:
    """The parts of an answer in configuration space: paths, edges, and boxes (free, in collision, wrong)."""

    paths: list[Any] = field(default_factory=list)
    edges: list[Any] = field(default_factory=list)
    boxes: tuple[list[Any], list[Any], list[Any]] = ([], [], [])

    def marked(self, number: int | None) -> "Drawing":
        """Returns the same drawing with one of its boxes marked as wrong."""
        free, stuck, _ = self.boxes
        if number is None:
            return self
        wrong = (free + stuck)[number]
        return replace(self, boxes=([b for b in free if b != wrong], [b for b in stuck if b != wrong], [wrong]))


@dataclass(frozen=True, eq=False)
class Grade:
    """The grade of an answer. It is true if the answer is right, so `assert grade, grade` fails with the message.

    `reason` is a word, "right" if the answer is right. `figures` has the place of the fault: `at` is a configuration,
    other members depend on the exercise.
    """

    right: bool
    reason: str
    message: str
    figures: dict[str, Any]
    _arm: Arm = field(repr=False)
    _world: World = field(repr=False)
    _drawing: Drawing = field(repr=False)

    def __bool__(self) -> bool:
        return self.right

    def __str__(self) -> str:
        return self.message

    def svg(self) -> str:
        """Returns a picture: the answer among the C-obstacles, and the arm at the fault."""
        shown = self._drawing.marked(self.figures.get("box"))
        places = [*(path[0] for path in shown.paths), *(edge[0] for edge in shown.edges)]
        at = self.figures.get("at") or (places[0] if places else self._start())
        title = ["right" if self.right else f"wrong: {self.reason}", self.message]
        return _drawn(self._arm, self._world, title, at, shown.paths, shown.edges, shown.boxes)

    def _start(self) -> Sequence[float]:
        """Returns the start, or the middle of the joints' ranges in a world without one."""
        try:
            return Problem(self._arm, self._world).start
        except InputError:
            return [(lower + upper) / 2 for lower, upper, _ in joint_ranges(self._arm, self._world)]

    def _repr_html_(self) -> str:
        return self.svg()


Answer = TypeVar("Answer")


class Exercise(ABC, Generic[Answer]):
    """A question about an arm in a world, with a judge of answers."""

    arm: Arm
    world: World

    @abstractmethod
    def read(self, answer: Any) -> Answer:
        """Converts an answer; raises `Wrong` if it has another shape."""

    @abstractmethod
    def judge(self, answer: Answer) -> str:
        """Returns a sentence about a right answer; raises `Wrong` otherwise."""

    def drawing(self, answer: Answer) -> Drawing:
        """Returns the parts of an answer that pictures show."""
        return Drawing()

    def grade(self, answer: Any) -> Grade:
        """Grades an answer. Any object may be an answer."""
        drawing = Drawing()
        try:
            known = self.read(answer)
            drawing = self.drawing(known)
            message = self.judge(known)
        except Wrong as wrong:
            return Grade(False, wrong.reason, str(wrong), wrong.figures, self.arm, self.world, drawing)
        return Grade(True, "right", message, {}, self.arm, self.world, drawing)


def array(answer: Any, name: str, *shape: int | None) -> Array:
    """Converts an answer to finite numbers of this shape; None stands for any number of rows, one or more."""
    wanted = ", ".join("n" if size is None else str(size) for size in shape)
    try:
        rows = np.asarray(answer, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise Wrong("shape", f"expected {name} as numbers of shape ({wanted})") from None
    if rows.ndim != len(shape) or not all(size == want or want is None and size for size, want in zip(rows.shape, shape)):
        raise Wrong("shape", f"expected {name} of shape ({wanted}), not {rows.shape}")
    if not (np.abs(rows) <= MAX_VALUE).all():
        raise Wrong("shape", f"{name}: all numbers must be finite, and at most {MAX_VALUE:g} in magnitude")
    return rows


def place(q: Sequence[float] | Array) -> str:
    """Formats a configuration."""
    return f"({q[0]:.6g}, {q[1]:.6g})"
