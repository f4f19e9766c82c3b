"""Building configuration spaces: cplan's rows beside parry2d's collision tests."""

from __future__ import annotations

from .figures import median, spread, times
from .problem import ARM, PROBLEMS
from .settings import Settings, say
from .table import Lead, Table


def tables(settings: Settings) -> list[Table]:
    """One table: problems A and W20, two sizes."""
    table = Table(
        "Building a configuration space",
        "Times are in milliseconds, on one core in one process: medians, with quartiles in brackets. With parry2d, "
        "we test the centre of each cell for collision. If the first link collides, one test decides a whole row "
        "of cells. Bounding discs are tested before exact shapes, and a test ends at the first hit. cplan's bitmap "
        "and rows contain the same result, computed from exact contact angles, as a bit or a byte per cell. In "
        "cplan's outer grid, a cell counts as free only if all of it is free. cplan's polygons describe the free "
        "space with a margin of 1 mm; they have no cells.",
        [
            "problem",
            "cells",
            "parry2d",
            "cplan bitmap",
            "cplan rows",
            "cplan outer",
            "cplan polygons",
            "parry2d over bitmap",
        ],
    )
    for name in ("A", "W20"):
        for cells, rounds in ((360, settings.choose(20, 4)), (2048, settings.choose(3, 1))):
            say(f"  configuration space of {name}, {cells} x {cells}")
            world = str(PROBLEMS / f"{name.lower()}.toml")
            report = settings.rust("cspace", str(ARM), world, str(cells), str(rounds))
            clock = report["times"]
            ratio = median(clock["parry2d"]) / median(clock["bitmap"])
            kinds = ("parry2d", "bitmap", "rows", "outer", "regions")
            row = [name, f"{cells} x {cells}", *(spread(clock[kind]) for kind in kinds), times(ratio)]
            table.rows.append(row)
            what = f"configuration space of {name}, {cells} x {cells}"
            table.leads.append(Lead(what, "parry2d", "cplan bitmap", ratio))
            table.note(
                f"{name}, {cells} x {cells}: {report['blocked']} of {report['cells']} cells are blocked. In single "
                f"precision, parry2d differs from cplan in {report['differ']} cells; in double precision, it differs "
                f"in {report['differ_double']} of these cells."
            )
    return [table]
