"""Exercises with grids: numbers of a wavefront, and harmonic fields."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cplan._cplan import Arm, World, joint_ranges
from cplan.cspace import Grid
from cplan.grading._exercise import Array, Drawing, Exercise, Wrong, place
from cplan.planning import plan

Cell = tuple[int, int]


@dataclass(frozen=True)
class _OnGrid(Exercise[Array]):
    """An answer with one value per cell of a grid, shape `cells`."""

    arm: Arm
    world: World
    cells: tuple[int, int]

    @cached_property
    def grid(self) -> Grid:
        """The grid with its exact labels. A cell is blocked unless all its configurations are free."""
        [space] = plan(self.arm, self.world, planner="wavefront", cells=self.cells, levels=1, space="whole").cspaces()
        if space.grid is None or space.grid.values is None or space.grid.blocked.shape != self.cells:
            raise ValueError(f"the exercise has no wavefront on {self.cells[0]} x {self.cells[1]} cells")
        return space.grid

    @property
    def exact(self) -> Array:
        """The exact number of moves to the goal, NaN in cells without a number."""
        assert self.grid.values is not None
        return self.grid.values

    @property
    def blocked(self) -> NDArray[np.bool_]:
        """True for each cell that is not proven free as a whole."""
        return self.grid.blocked

    @property
    def goal(self) -> Cell:
        """The goal's cell."""
        [cell] = np.argwhere(self.exact == 0)
        return int(cell[0]), int(cell[1])

    def middle(self, cell: Cell) -> Array:
        """Returns the configuration in the middle of a cell."""
        middle: Array = self.grid.lower + (np.array(cell) + 0.5) * self.grid.size
        return middle

    def numbers(self, answer: Any) -> Array:
        """Converts one value per cell; values need not be finite."""
        try:
            values = np.array(answer, dtype=float)
        except (TypeError, ValueError, OverflowError):
            raise Wrong("shape", f"expected one number per cell, shape {self.cells}") from None
        if values.shape != self.cells:
            raise Wrong("shape", f"expected one number per cell, shape {self.cells}, not {values.shape}")
        return values

    def wrong(self, reason: str, why: str, cell: Cell, **figures: Any) -> Wrong:
        """Returns the fault of a cell."""
        middle = self.middle(cell)
        return Wrong(reason, f"cell {cell}, with its middle at {place(middle)}: {why}", at=middle, cell=cell, **figures)

    def drawing(self, answer: Array) -> Drawing:
        lower = self.grid.lower + np.argwhere(self.blocked) * self.grid.size
        return Drawing(boxes=([], np.stack([lower, lower + self.grid.size], axis=1).tolist(), []))

    def neighbors(self, values: Array, outside: float) -> Array:
        """Returns the values of the four neighbours of each cell; beyond a limit it is `outside`. Shape (4, n, m)."""
        found = []
        for axis, (_, _, is_circle) in enumerate(joint_ranges(self.arm, self.world)):
            for step, last in ((1, 0), (-1, -1)):
                moved = np.roll(values, step, axis)
                if not is_circle:
                    np.moveaxis(moved, axis, 0)[last] = outside
                found.append(moved)
        return np.stack(found)


class Wavefront(_OnGrid):
    """The numbers of a wavefront: 0 in the goal's cell, and in each other cell the least number of moves to it along the
    axes through free cells. Cells without a number have NaN, infinity, or a negative number.
    """

    def read(self, answer: Any) -> Array:
        values = self.numbers(answer)
        values[~np.isfinite(values) | (values < 0)] = np.nan
        return values

    def judge(self, answer: Array) -> str:
        exact = self.exact
        different = (answer != exact) & ~(np.isnan(answer) & np.isnan(exact))
        # The first fault is the one nearest to the goal, because later ones may follow from it.
        order = np.where(np.isnan(exact), np.inf, exact)
        for cell in sorted(((int(i), int(j)) for i, j in np.argwhere(different)), key=lambda cell: (order[cell], cell)):
            have, want = float(answer[cell]), float(exact[cell])
            if self.blocked[cell]:
                raise self.wrong("blocked", f"a number {have:g}, although the cell is blocked", cell, answer=have)
            if np.isnan(want):
                raise self.wrong("not reached", f"a number {have:g}, although no moves lead to the goal", cell, answer=have)
            if np.isnan(have):
                raise self.wrong("missing", f"no number; it is {want:g} moves to the goal", cell, exact=want)
            raise self.wrong("number", f"{have:g}, but it is {want:g} moves to the goal", cell, answer=have, exact=want)
        return f"all {int((~np.isnan(exact)).sum())} numbers are exact"


HARMONIC_TOLERANCE = 1e-6
"""Largest difference of a value from the mean of its neighbours, as a fraction of the value."""


class Harmonic(_OnGrid):
    """A harmonic field: -1 in the goal's cell, 0 in blocked cells and beyond limits. Each other value is the mean of its
    four neighbours, with a relative error of `HARMONIC_TOLERANCE` at most, and none is a local minimum.
    """

    def read(self, answer: Any) -> Array:
        values = self.numbers(answer)
        for cell in np.argwhere(~np.isfinite(values)):
            raise self.wrong("shape", "the value is not finite", (int(cell[0]), int(cell[1])))
        return values

    def judge(self, answer: Array) -> str:
        self._boundary(answer)
        around = self.neighbors(answer, 0.0)
        inner = ~self.blocked
        inner[self.goal] = False
        reached = inner & ~np.isnan(self.exact)
        minimum = reached & (around.min(axis=0) >= answer)
        if minimum.any():
            raise self.wrong("minimum", "a local minimum besides the goal", _cell(minimum.argmax(), answer.shape))
        residual = np.where(inner, np.abs(around.mean(axis=0) - answer), 0.0)
        excess = residual - HARMONIC_TOLERANCE * np.abs(answer)
        if excess.max() > 0:
            cell = _cell(excess.argmax(), answer.shape)
            why = f"{answer[cell]:.9g}, but the mean of its neighbours is {around.mean(axis=0)[cell]:.9g}"
            raise self.wrong("residual", why, cell, answer=float(answer[cell]), residual=float(residual[cell]))
        return f"harmonic in {int(inner.sum())} cells, without local minima"

    def _boundary(self, answer: Array) -> None:
        wanted = np.where(self.blocked, 0.0, np.nan)
        wanted[self.goal] = -1.0
        wrong = ~np.isnan(wanted) & (answer != wanted)
        # The goal comes first, because a wrong sign shows there.
        for cell in [self.goal, *((int(i), int(j)) for i, j in np.argwhere(wrong))]:
            if wrong[cell]:
                what = "goal" if cell == self.goal else "blocked cell"
                why = f"{answer[cell]:.9g}; the value of a {what} is {wanted[cell]:g}"
                raise self.wrong("boundary", why, cell, answer=float(answer[cell]))


def _cell(index: Any, shape: tuple[int, ...]) -> Cell:
    i, j = np.unravel_index(int(index), shape)
    return int(i), int(j)
