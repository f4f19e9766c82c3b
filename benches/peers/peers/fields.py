"""Fields on grids: every grid goes to all solvers of harmonic fields and of distances."""

from __future__ import annotations

from . import cells, distances, harmonic
from .settings import Settings, say
from .table import Table


def tables(settings: Settings) -> list[Table]:
    """Harmonic fields, then distances."""
    grids = [
        ("boxes", 256, settings.choose(7, 3)),
        ("maze", 255, settings.choose(7, 2)),
        ("A", 512, settings.choose(5, 1)),
        ("boxes", 1024, settings.choose(3, 1)),
    ]
    tables = [harmonic.table(), distances.table()]
    for scene, size, rounds in grids:
        say(f"  fields: {scene}, {size} x {size}")
        grid = cells.solve(settings, scene, size, rounds)
        harmonic.add(tables[0], grid)
        distances.add(tables[1], grid)
    return tables
