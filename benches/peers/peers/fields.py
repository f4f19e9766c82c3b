"""Fields on grids: cplan beside scipy and pyamg (harmonic), scikit-image and scikit-fmm (distances), the same cells."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .figures import median, spread, times
from .problem import ARM, PROBLEMS
from .settings import NotRunError, Settings, say
from .table import Lead, Table

ERROR = 1e-6
"""Greatest error of a harmonic value that the iterative solvers are held to."""

DIRECT = 512
"""The largest grid that the direct solver is asked for."""


@dataclass
class Cells:
    """A grid, what cplan made of it, and the clocks."""

    name: str
    free: np.ndarray
    goal: tuple[int, int]
    clock: dict[str, list[float]]
    report: dict[str, Any]
    folder: Path

    def result(self, file: str, kind: str) -> np.ndarray:
        """What cplan computed, a value a cell."""
        return np.fromfile(self.folder / file, dtype=kind).reshape(self.free.shape)

    def time(self, name: str, work: Callable[[], Any]) -> Any:  # noqa: ANN401
        """Runs `work`, and adds its milliseconds to the list of `name`."""
        start = time.perf_counter()
        result = work()
        self.clock[name].append((time.perf_counter() - start) * 1e3)
        return result


def _cells(settings: Settings, scene: str, cells: int, rounds: int) -> Cells:
    folder = settings.work / "field"
    folder.mkdir(parents=True, exist_ok=True)
    arm = [] if scene == "boxes" else [str(ARM)]
    world = scene if scene == "boxes" else str(PROBLEMS / f"{scene.lower()}.toml")
    report = settings.rust("field", world, str(cells), str(rounds), str(folder), *arm)
    free = np.fromfile(folder / "free.u8", dtype=np.uint8).reshape(cells, cells).astype(bool)
    goal = (report["goal"] // cells, report["goal"] % cells)
    clock = defaultdict(list, report["times"])
    return Cells(f"{scene}, {cells} x {cells}", free, goal, clock, report, folder)


def tables(settings: Settings) -> list[Table]:
    """Harmonic fields, then distances."""
    harmonic = Table(
        "Harmonic fields",
        "Laplace's equation on the free cells: 1 at the goal, 0 on walls and beyond the edge. Milliseconds, median "
        "(quartiles). Setup: all that depends on the walls alone; a goal: with the setup done, also by the peers "
        "(their matrix is given to them, the time to assemble it not counted). Error: against scipy's direct solver, "
        "where it is asked; the iterative ones are stopped at 1e-6. Dead ends: reachable free cells without a "
        "greater neighbour, where a robot that climbs the field gets stuck.",
        ["grid", "solver", "setup", "a goal", "setup and goal", "greatest error", "dead ends"],
    )
    distance = Table(
        "Distances on a grid",
        "From one goal to all free cells, milliseconds, median (quartiles). Steps: moves to four neighbours; eight "
        "neighbours: a diagonal move costs the square root of 2. scikit-fmm's is another quantity, the distance "
        "around the walls in any direction, to first order, which cplan has not.",
        ["grid", "quantity", "program", "time", "over cplan's", "same values"],
    )
    grids = [
        ("boxes", 256, settings.choose(7, 3)),
        ("A", 512, settings.choose(5, 1)),
        ("boxes", 1024, settings.choose(3, 1)),
    ]
    for scene, size, rounds in grids:
        say(f"  fields: {scene}, {size} x {size}")
        cells = _cells(settings, scene, size, rounds)
        _harmonic(harmonic, cells, rounds)
        _distances(distance, cells, rounds)
    harmonic.notes.append(
        "cplan harmonic is precise in relative terms however far from the goal, where values underflow or drown in the "
        "absolute error of the other solvers; that is what its time buys."
    )
    return [harmonic, distance]


def _harmonic(table: Table, cells: Cells, rounds: int) -> None:
    clock, reached = cells.clock, cells.result("steps.u32", "<u4") != np.iinfo(np.uint32).max
    ours = cells.result("multigrid.f64", "<f8")
    found: list[tuple[str, str, np.ndarray]] = []
    exact: np.ndarray | None = None
    for name, solver in (
        ("scipy splu", _direct),
        ("pyamg ruge_stuben", _classical),
        ("pyamg aggregation", _aggregation),
    ):
        if solver is _direct and len(cells.free) > DIRECT:
            table.notes.append(f"{cells.name}: scipy's direct solver was not asked: minutes, and gigabytes.")
            continue
        try:
            for _ in range(1 if solver is _direct else rounds):
                values = solver(cells, exact)
        except (ImportError, NotRunError) as error:
            table.notes.append(f"{name} was not run: {error}.")
            continue
        exact = values if solver is _direct else exact
        found.append((name, _kind(solver), values))
    total = [a + b for a, b in zip(clock["multigrid setup"], clock["multigrid solve"], strict=True)]

    def row(name: str, setup: str, goal: str, both: list[float], error: str, dead: str) -> None:
        table.rows.append([cells.name, name, setup, goal, spread(both), error, dead])

    row("cplan multigrid", spread(clock["multigrid setup"]), spread(clock["multigrid again"]), total,
        _error(ours, exact), str(_dead_ends(ours, reached, cells.goal)))  # fmt: skip
    proven = "0" if cells.report["harmonic navigates"] else "some"
    row("cplan harmonic", "-", "-", clock["harmonic"], "relative", proven)
    for name, kind, values in found:
        both = [a + b for a, b in zip(clock[f"{kind} setup"], clock[f"{kind} solve"], strict=True)]
        row(name, spread(clock[f"{kind} setup"]), spread(clock[f"{kind} solve"]), both,
            "is the measure" if values is exact else _error(values, exact),
            str(_dead_ends(values, reached, cells.goal)))  # fmt: skip
        table.leads.append(Lead(f"harmonic field, {cells.name}", name, "cplan multigrid", median(both) / median(total)))
        again = median(clock[f"{kind} solve"]) / median(clock["multigrid again"])
        table.leads.append(Lead(f"another goal, {cells.name}", name, "cplan multigrid", again))


def _kind(solver: Callable[..., np.ndarray]) -> str:
    return solver.__name__.strip("_")


def _matrix(cells: Cells) -> tuple[Any, np.ndarray, int]:
    """The five-point matrix of the free cells, the index of each cell in it, and the goal's."""
    import scipy.sparse as sparse

    index = np.full(cells.free.shape, -1)
    index[cells.free] = np.arange(cells.free.sum())
    pairs = [(index[:-1], index[1:]), (index[:, :-1], index[:, 1:])]
    rows, columns = (np.concatenate(side) for side in zip(*[_both(a, b) for a, b in pairs], strict=True))
    count = int(cells.free.sum())
    matrix = sparse.csr_matrix((np.full(len(rows), -1.0), (rows, columns)), shape=(count, count))
    return matrix + sparse.diags(np.full(count, 4.0)).tocsr(), index, int(index[cells.goal])


def _both(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    inside = (a >= 0) & (b >= 0)
    return np.concatenate([a[inside], b[inside]]), np.concatenate([b[inside], a[inside]])


def _field(cells: Cells, solution: np.ndarray, goal: int) -> np.ndarray:
    """1 at the goal: the solution for a source there, divided by its value there."""
    values = np.zeros(cells.free.shape)
    values[cells.free] = solution / solution[goal]
    return values


def _source(count: int, goal: int) -> np.ndarray:
    source = np.zeros(count)
    source[goal] = 1.0
    return source


def _direct(cells: Cells, _: np.ndarray | None) -> np.ndarray:
    from scipy.sparse.linalg import splu

    matrix, _, goal = _matrix(cells)
    columns = matrix.tocsc()
    factors = cells.time(
        "direct setup", lambda: splu(columns, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    )
    source = _source(matrix.shape[0], goal)
    return _field(cells, cells.time("direct solve", lambda: factors.solve(source)), goal)


def _classical(cells: Cells, exact: np.ndarray | None) -> np.ndarray:
    import pyamg

    return _multilevel(cells, exact, "classical", pyamg.ruge_stuben_solver)


def _aggregation(cells: Cells, exact: np.ndarray | None) -> np.ndarray:
    import pyamg

    return _multilevel(cells, exact, "aggregation", pyamg.smoothed_aggregation_solver)


def _multilevel(cells: Cells, exact: np.ndarray | None, kind: str, make: Callable[[Any], Any]) -> np.ndarray:
    matrix, _, goal = _matrix(cells)
    solver = cells.time(f"{kind} setup", lambda: make(matrix))
    source = _source(matrix.shape[0], goal)

    def solve(tolerance: float) -> np.ndarray:
        return solver.solve(source, tol=tolerance, accel="cg", maxiter=200)

    tolerance = _tolerance(cells, exact, goal, solve)
    return _field(cells, cells.time(f"{kind} solve", lambda: solve(tolerance)), goal)


def _tolerance(cells: Cells, exact: np.ndarray | None, goal: int, solve: Callable[[float], np.ndarray]) -> float:
    """The greatest residual, of powers of ten, whose error is no more than asked for; without a measure, against itself
    at 1e-12."""
    measure = _field(cells, solve(1e-12), goal) if exact is None else exact
    for power in range(2, 12):
        if np.abs(_field(cells, solve(10.0**-power), goal) - measure).max() <= ERROR:
            return 10.0**-power
    return 1e-12


def _error(values: np.ndarray, exact: np.ndarray | None) -> str:
    return "-" if exact is None else f"{np.abs(values - exact).max():.1e}"


def _dead_ends(values: np.ndarray, reached: np.ndarray, goal: tuple[int, int]) -> int:
    """Reachable cells but the goal without a strictly greater neighbour."""
    framed = np.pad(np.where(reached, values, -np.inf), 1, constant_values=-np.inf)
    around = [framed[:-2, 1:-1], framed[2:, 1:-1], framed[1:-1, :-2], framed[1:-1, 2:]]
    stuck = reached & (np.maximum.reduce(around) <= values)
    stuck[goal] = False
    return int(stuck.sum())


def _distances(table: Table, cells: Cells, rounds: int) -> None:
    clock = cells.clock
    steps = cells.result("steps.u32", "<u4")
    reached = steps != np.iinfo(np.uint32).max
    ours = {
        "steps": np.where(reached, steps, np.inf).astype(float),
        "eight neighbours": cells.result("dijkstra.f64", "<f8"),
    }
    wave = [a + b for a, b in zip(clock["pack"], clock["wave"], strict=True)]
    ways = [a + b for a, b in zip(clock["pack"], clock["dijkstra"], strict=True)]
    own = {"steps": wave, "eight neighbours": ways}
    for quantity, clocks in own.items():
        table.rows.append([cells.name, quantity, "cplan", spread(clocks), "-", "-"])
        try:
            for _ in range(rounds):
                costs = _geometric(cells, quantity)
            name = "scikit-image " + ("MCP" if quantity == "steps" else "MCP_Geometric")
            theirs = clock[f"skimage {quantity}"]
            ratio = median(theirs) / median(clocks)
            same = np.isclose(costs[reached], ours[quantity][reached], rtol=1e-9).mean()
            row = [cells.name, quantity, name, spread(theirs), times(ratio), f"{100 * same:.4g} %"]
            table.rows.append(row)
            table.leads.append(Lead(f"{quantity}, {cells.name}", name, "cplan", ratio))
        except (ImportError, NotRunError) as error:
            table.notes.append(f"scikit-image was not run: {error}.")
    try:
        for _ in range(rounds):
            _marching(cells)
        theirs = clock["skfmm"]
        ratio = median(theirs) / median(ways)
        quantity = "any direction"
        table.rows.append(
            [cells.name, quantity, "scikit-fmm", spread(theirs), f"{times(ratio)} (eight)", "no such in cplan"]
        )
    except (ImportError, NotRunError) as error:
        table.notes.append(f"scikit-fmm was not run: {error}.")


def _geometric(cells: Cells, quantity: str) -> np.ndarray:
    from skimage.graph import MCP, MCP_Geometric

    def search() -> np.ndarray:
        costs = np.where(cells.free, 1.0, -1.0)
        if quantity == "steps":
            # A path's cost counts the goal's cell, too.
            return MCP(costs, fully_connected=False).find_costs([cells.goal])[0] - 1.0
        return MCP_Geometric(costs).find_costs([cells.goal])[0]

    return cells.time(f"skimage {quantity}", search)


def _marching(cells: Cells) -> np.ndarray:
    import skfmm

    def march() -> np.ndarray:
        front = np.ones(cells.free.shape)
        front[cells.goal] = -1.0
        return skfmm.distance(np.ma.MaskedArray(front, ~cells.free))

    return cells.time("skfmm", march)
