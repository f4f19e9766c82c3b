"""Minkowski differences of convex polygons: cplan's exact order of sides beside a plain merge in doubles."""

from __future__ import annotations

from .figures import median, spread
from .settings import Settings, say
from .table import Lead, Table


def tables(settings: Settings) -> list[Table]:
    """One table, by number of corners."""
    table = Table(
        "Minkowski differences of convex polygons",
        "Both polygons are regular and have the same number of corners. Times are in nanoseconds per corner of the "
        "result: medians, with quartiles in brackets. The plain merge compares sides by a cross product in "
        "doubles, which is correct for these polygons. cplan uses exact predicates, which are also correct for "
        "nearly parallel sides.",
        ["corners", "cplan", "plain merge", "areas differ by"],
    )
    say("  differences")
    for corners in (4, 8, 64, 512):
        report = settings.rust("minkowski", str(corners), str(settings.choose(50, 10)))
        count = {who: report["batch"] * report["corners"][who] for who in ("cplan", "plain")}
        each = {who: [ms * 1e6 / count[who] for ms in report["times"][who]] for who in count}
        areas = report["areas"]
        difference = abs(areas["plain"] / areas["cplan"] - 1)
        table.rows.append(
            [
                str(corners),
                spread(each["cplan"]),
                spread(each["plain"]),
                "0" if difference == 0 else f"{difference:.0e}",
            ]
        )
        ratio = median(each["plain"]) / median(each["cplan"])
        table.leads.append(Lead(f"Minkowski difference, {corners} corners", "a plain merge", "cplan", ratio))
    return [table]
