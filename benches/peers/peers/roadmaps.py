"""Shortest paths among polygons: cplan beside pyvisgraph and polyanya, the same polygons and queries."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from .figures import median, short, spread
from .settings import NotRunError, Settings, say
from .table import Lead, Table

POLYANYA = ("polyanya", "polyanya merged")
"""A mesh of triangles, and one whose triangles are merged to polygons."""


def tables(settings: Settings) -> list[Table]:
    """One table, by number of corners."""
    table = Table(
        "Shortest paths among polygons",
        "The polygons are random and disjoint, have ten corners each, are mostly not convex, and fill a fifth of "
        "the area. Build times are in milliseconds and query times in microseconds: medians, with quartiles in "
        "brackets. A query time is the mean of 32 queries in each round. cplan builds a triangulation, and its "
        "queries need no visibility graph: they search cones of sight in the triangulation. pyvisgraph builds the "
        "graph.",
        ["corners", "program", "build ms", "whole visibility graph ms", "query us", "greatest difference in length"],
    )
    sizes = [(100, settings.choose(20, 5), True), (1000, settings.choose(10, 3), not settings.quick)]
    sizes.append((20_000, settings.choose(5, 1), False))
    for corners, rounds, slow in sizes:
        say(f"  roadmaps: {corners} corners")
        _size(settings, table, corners, rounds, slow)
    return [table]


def _size(settings: Settings, table: Table, corners: int, rounds: int, slow: bool) -> None:
    file = settings.work / "polygons.json"
    report = settings.rust("roadmap", str(corners), str(rounds), str(file))
    clock, count = report["times"], report["queries"]
    query = {who: [ms * 1e3 / count for ms in clock[f"{who} queries"]] for who in ("cplan", *POLYANYA)}
    whole = [a + b for a, b in zip(clock["cplan build"], clock["cplan all arcs"], strict=True)]
    name = f"{corners:,}".replace(",", " ")
    rows = [[name, "cplan", spread(clock["cplan build"]), spread(whole), spread(query["cplan"]), "-"]]
    for who in POLYANYA:
        difference = _difference(report["cplan"], report[who])
        rows.append([name, who, spread(clock[f"{who} build"]), "-", spread(query[who]), difference])
        for what, stage in (("building a mesh", "build"), ("a query", "queries")):
            ratio = median(clock[f"{who} {stage}"]) / median(clock[f"cplan {stage}"])
            table.leads.append(Lead(f"{what} among {name} corners", who, "cplan", ratio))
    if slow:
        try:
            build, each, lengths = _pyvisgraph(json.loads(file.read_text()))
            difference = _difference(report["cplan"], lengths)
            rows.append([name, "pyvisgraph", "-", f"{short(build)} (once)", short(each), difference])
            ratio = build / median(whole)
            table.leads.append(Lead(f"visibility graph of {name} corners", "pyvisgraph", "cplan", ratio))
            times_as_long = f"{short(ratio)} times as long as cplan"
            table.note(f"{name} corners: pyvisgraph takes {times_as_long} for the visibility graph.")
        except NotRunError as error:
            table.note(f"pyvisgraph was not run: {error}.")
    table.rows += rows


def _pyvisgraph(scene: dict[str, Any]) -> tuple[float, float, list[float]]:
    """Milliseconds for the graph, microseconds a query, lengths."""
    try:
        import pyvisgraph
    except ImportError as error:
        raise NotRunError(str(error)) from error
    polygons = [[pyvisgraph.Point(x, y) for x, y in polygon] for polygon in scene["polygons"]]
    graph = pyvisgraph.VisGraph()
    start = time.perf_counter()
    graph.build(polygons, workers=1, status=False)
    build = (time.perf_counter() - start) * 1e3
    lengths = []
    start = time.perf_counter()
    for a, b in scene["queries"]:
        path = np.array([[p.x, p.y] for p in graph.shortest_path(pyvisgraph.Point(*a), pyvisgraph.Point(*b))])
        lengths.append(float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum()))
    return build, (time.perf_counter() - start) * 1e6 / len(lengths), lengths


def _difference(ours: Sequence[float | None], theirs: Sequence[float | None]) -> str:
    pairs = list(zip(ours, theirs, strict=True))
    missing = sum(a is not None and b is None for a, b in pairs)
    extra = sum(a is None and b is not None for a, b in pairs)
    differences = [abs(b / a - 1) for a, b in pairs if a is not None and b is not None]
    words = f"{max(differences):.1e}" if differences else "-"
    return words + (f"; {missing} not found" if missing else "") + (f"; {extra} that cplan lacks" if extra else "")
