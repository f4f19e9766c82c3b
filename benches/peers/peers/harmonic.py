"""Harmonic fields: cplan beside scipy's direct solver and pyamg's multigrids, the same equations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .cells import Cells
from .figures import median, spread
from .table import Lead, Table

ERROR = 1e-6
"""Greatest error of a value that the iterative solvers are held to; cplan's too."""

DIRECT = 512
"""The largest grid that the direct solver is asked for."""


@dataclass(frozen=True)
class Equations:
    """The five-point problem of the free cells.

    The solution for a source at the goal, divided by its value there, is the field: so one matrix, factored or
    coarsened once, serves all goals, as it does with cplan.
    """

    cells: Cells
    matrix: Any
    source: np.ndarray
    goal: int

    def field(self, solution: np.ndarray) -> np.ndarray:
        """1 at the goal, 0 on walls."""
        values = np.zeros(self.cells.free.shape)
        values[self.cells.free] = solution / solution[self.goal]
        return values


def table() -> Table:
    """Empty."""
    return Table(
        "Harmonic fields",
        "The problem is Laplace's equation on the free cells: 1 at the goal, 0 on walls and beyond the edge. Times "
        'are in milliseconds: medians, with quartiles in brackets. "Setup" is all work that depends only on the '
        'walls; "a goal" is the remaining work for one goal. The times of the other programs do not include the '
        "assembly of their matrix. Errors are relative to scipy's direct solver, if it ran; the iterative solvers "
        "stop at 1e-6. Dead ends are cells from which the goal can be reached, but which have no neighbour with a "
        "greater value: a robot that climbs the field gets stuck there.",
        ["grid", "solver", "setup", "a goal", "setup and goal", "greatest error", "dead ends"],
        notes=[
            "cplan multigrid is the library's solver for one equation, accurate to 1e-6 of the goal's value. cplan "
            "harmonic is the planner's solver: each value satisfies the equation to a relative error of 1.5e-14. "
            "Some values are so small that only their logarithms can be compared. This solver takes more time, and "
            "has no dead ends.",
        ],
    )


def add(table: Table, cells: Cells) -> None:
    """The rows of one grid."""
    try:
        equations = _equations(cells)
    except ImportError as error:
        table.note(f"scipy and pyamg were not run: {error}.")
        return
    exact: np.ndarray | None = None
    rows: list[list[str]] = []
    if len(cells.free) <= DIRECT:
        exact = _direct(equations)
        rows.append(_peer(table, cells, "scipy splu", exact, "is the measure"))
    else:
        table.note(f"{cells.name}: scipy's direct solver was not run; it takes gigabytes.")
    for name, maker in (
        ("pyamg ruge_stuben", "ruge_stuben_solver"),
        ("pyamg aggregation", "smoothed_aggregation_solver"),
    ):
        try:
            values = _multilevel(equations, exact, name, maker)
        except ImportError as error:
            table.note(f"{name} was not run: {error}.")
            continue
        rows.append(_peer(table, cells, name, values, _error(values, exact)))
    table.rows += _own(cells, exact) + rows


def _own(cells: Cells, exact: np.ndarray | None) -> list[list[str]]:
    values = cells.result("multigrid.f64", "<f8")
    stages = [
        cells.clock["multigrid setup"],
        cells.clock["multigrid again"],
        cells.both("multigrid setup", "multigrid solve"),
    ]
    multigrid = [cells.name, "cplan multigrid", *map(spread, stages), _error(values, exact), _dead_ends(cells, values)]
    logarithms = cells.result("harmonic.f64", "<f8")
    field = np.exp(logarithms)
    whole = spread(cells.clock["harmonic"])
    planner = [cells.name, "cplan harmonic", "-", "-", whole, _error(field, exact), _dead_ends(cells, logarithms)]
    return [multigrid, planner]


def _peer(table: Table, cells: Cells, name: str, values: np.ndarray, error: str) -> list[str]:
    setup, solve, both = (
        cells.clock[f"{name} setup"],
        cells.clock[f"{name} solve"],
        cells.both(f"{name} setup", f"{name} solve"),
    )
    own = cells.both("multigrid setup", "multigrid solve")
    table.leads.append(Lead(f"harmonic field, {cells.name}", name, "cplan multigrid", median(both) / median(own)))
    again = median(solve) / median(cells.clock["multigrid again"])
    table.leads.append(Lead(f"another goal, {cells.name}", name, "cplan multigrid", again))
    whole = median(both) / median(cells.clock["harmonic"])
    table.leads.append(Lead(f"harmonic field, {cells.name}", name, "cplan harmonic", whole))
    return [cells.name, name, spread(setup), spread(solve), spread(both), error, _dead_ends(cells, values)]


def _equations(cells: Cells) -> Equations:
    from scipy import sparse

    count = int(cells.free.sum())
    index = np.full(cells.free.shape, -1)
    index[cells.free] = np.arange(count)
    beside = [(index[:-1], index[1:]), (index[:, :-1], index[:, 1:])]
    pairs = np.concatenate([np.stack([a[(a >= 0) & (b >= 0)], b[(a >= 0) & (b >= 0)]]) for a, b in beside], axis=1)
    rows, columns = np.concatenate([pairs, pairs[::-1]], axis=1)
    neighbours = sparse.csr_matrix((np.full(len(rows), -1.0), (rows, columns)), shape=(count, count))
    matrix = (neighbours + sparse.diags_array(np.full(count, 4.0))).tocsr()
    goal = int(index[cells.goal])
    source = np.zeros(count)
    source[goal] = 1.0
    return Equations(cells, matrix, source, goal)


def _direct(equations: Equations) -> np.ndarray:
    from scipy.sparse.linalg import splu

    columns = equations.matrix.tocsc()
    time = equations.cells.time
    # The ordering and mode for symmetric matrices: the default takes several times as long.
    options = {"permc_spec": "MMD_AT_PLUS_A", "options": {"SymmetricMode": True}}
    for _ in range(min(equations.cells.rounds, 3)):
        factors = time("scipy splu setup", lambda: splu(columns, **options))
        solution = time("scipy splu solve", lambda: factors.solve(equations.source))  # noqa: B023 (called at once)
    return equations.field(solution)


def _multilevel(equations: Equations, exact: np.ndarray | None, name: str, maker: str) -> np.ndarray:
    import pyamg

    make: Callable[[Any], Any] = getattr(pyamg, maker)
    time = equations.cells.time
    tolerance: float | None = None
    for _ in range(equations.cells.rounds):
        solver = time(f"{name} setup", lambda: make(equations.matrix))

        def solve(tolerance: float) -> np.ndarray:
            return solver.solve(equations.source, tol=tolerance, accel="cg", maxiter=300)  # noqa: B023 (called at once)

        if tolerance is None:
            tolerance = _tolerance(equations, exact, solve)
        solution = time(f"{name} solve", lambda: solve(tolerance))  # noqa: B023
    return equations.field(solution)


def _tolerance(equations: Equations, exact: np.ndarray | None, solve: Callable[[float], np.ndarray]) -> float:
    """The greatest residual, of powers of ten, whose error is no more than asked for.

    Measured against the direct solver, or where that is not asked against the same solver at 1e-12.
    """
    measure = equations.field(solve(1e-12)) if exact is None else exact
    for power in range(2, 12):
        if np.abs(equations.field(solve(10.0**-power)) - measure).max() <= ERROR:
            return 10.0**-power
    return 1e-12


def _error(values: np.ndarray, exact: np.ndarray | None) -> str:
    return "-" if exact is None else f"{np.abs(values - exact).max():.1e}"


def _dead_ends(cells: Cells, values: np.ndarray) -> str:
    """Number of cells that can reach the goal, without a strictly greater neighbour."""
    reached = cells.reached()
    framed = np.pad(np.where(reached, values, -np.inf), 1, constant_values=-np.inf)
    around = [framed[:-2, 1:-1], framed[2:, 1:-1], framed[1:-1, :-2], framed[1:-1, 2:]]
    stuck = reached & (np.maximum.reduce(around) <= values)
    stuck[cells.goal] = False
    return f"{stuck.sum()} of {reached.sum()}"
