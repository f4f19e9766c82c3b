"""Distances from one goal to all cells: cplan beside scikit-image and scikit-fmm."""

from __future__ import annotations

import numpy as np

from .cells import Cells
from .figures import median, spread, times
from .table import Lead, Table


def table() -> Table:
    """Empty."""
    return Table(
        "Distances on a grid",
        "Each program computes the distances from one goal to all free cells. Times are in milliseconds: medians, "
        'with quartiles in brackets. "Steps" counts moves to the four neighbours. With "eight neighbours", a '
        "diagonal move costs the square root of 2. cplan allows a diagonal move only if both cells beside it are "
        'free; scikit-image always allows it. "Any direction" is the distance around the walls for moves in all '
        "directions, to first order; cplan does not offer it.",
        ["grid", "quantity", "program", "time", "over cplan's", "same values"],
    )


def add(table: Table, cells: Cells) -> None:
    """The rows of one grid."""
    reached = cells.reached()
    steps = np.where(reached, cells.result("steps.u32", "<u4"), np.inf)
    ways = cells.result("dijkstra.f64", "<f8")
    for quantity, stage, ours in (("steps", "wave", steps), ("eight neighbours", "dijkstra", ways)):
        own = cells.both("pack", stage)
        table.rows.append([cells.name, quantity, "cplan", spread(own), "-", "-"])
        try:
            for _ in range(cells.rounds):
                costs = _scikit_image(cells, quantity)
        except ImportError as error:
            table.note(f"scikit-image was not run: {error}.")
            continue
        name = "scikit-image " + ("MCP" if quantity == "steps" else "MCP_Geometric")
        ratio = median(cells.clock[quantity]) / median(own)
        same = np.isclose(costs[reached], ours[reached], rtol=1e-9).mean()
        row = [cells.name, quantity, name, spread(cells.clock[quantity]), times(ratio), f"{100 * same:.4g} %"]
        table.rows.append(row)
        table.leads.append(Lead(f"distances by {quantity}, {cells.name}", name, "cplan", ratio))
    try:
        for _ in range(cells.rounds):
            _scikit_fmm(cells)
    except ImportError as error:
        table.note(f"scikit-fmm was not run: {error}.")
        return
    over = times(median(cells.clock["fmm"]) / median(cells.both("pack", "dijkstra")))
    row = [cells.name, "any direction", "scikit-fmm", spread(cells.clock["fmm"]), f"{over} (eight)", "cplan has none"]
    table.rows.append(row)


def _scikit_image(cells: Cells, quantity: str) -> np.ndarray:
    from skimage.graph import MCP, MCP_Geometric

    def search() -> np.ndarray:
        costs = np.where(cells.free, 1.0, -1.0)
        if quantity == "steps":
            # A path's cost counts the goal's cell, too.
            return MCP(costs, fully_connected=False).find_costs([cells.goal])[0] - 1.0
        return MCP_Geometric(costs).find_costs([cells.goal])[0]

    return cells.time(quantity, search)


def _scikit_fmm(cells: Cells) -> np.ndarray:
    import skfmm

    def march() -> np.ndarray:
        front = np.ones(cells.free.shape)
        front[cells.goal] = -1.0
        return skfmm.distance(np.ma.MaskedArray(front, ~cells.free))

    return cells.time("fmm", march)
