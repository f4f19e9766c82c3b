"""Runs everything. Called by `benches/peers/run`, which builds what this needs."""

from __future__ import annotations

import argparse
import json
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path

from . import cspaces, document, fields, machine, minkowski, paths, problem, roadmaps, selftest
from .settings import NotRunError, Settings, say
from .table import Table

PATH_PROBLEMS = ("A", "B", "INF", "T")


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="benches/peers/run", description="cplan beside its peers, in one run")
    parser.add_argument("--quick", action="store_true", help="fewer repetitions: a few minutes at the most")
    parser.add_argument(
        "--only",
        choices=["paths", "cspaces", "roadmaps", "fields", "minkowski"],
        action="append",
        help="these parts only",
    )
    parser.add_argument("--write", action="store_true", help="put the tables into docs/peers.md")
    parser.add_argument("--cplan", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--work", required=True, type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.write and (arguments.quick or arguments.only):
        parser.error("--write takes a full run: without --quick and --only")
    return arguments


def main() -> int:
    """The exit code: 1 if the harness is broken."""
    arguments = _arguments()
    settings = Settings(arguments.cplan, arguments.work, arguments.quick)
    start = time.monotonic()
    where = machine.machine()
    problems = {name: problem.load(name) for name in PATH_PROBLEMS}
    for each in problems.values():
        problem.write_scene(each, settings.work / f"{each.name}.scene")
    say("self-test")
    try:
        tested = selftest.run(settings, problems)
    except selftest.BrokenError as error:
        say(f"the harness is broken: {error}")
        return 1
    parts: dict[str, Callable[[], list[Table]]] = {
        "paths": lambda: paths.tables(settings, problems),
        "cspaces": lambda: cspaces.tables(settings),
        "roadmaps": lambda: roadmaps.tables(settings),
        "fields": lambda: fields.tables(settings),
        "minkowski": lambda: minkowski.tables(settings),
    }
    tables: list[Table] = []
    for name, part in parts.items():
        if arguments.only and name not in arguments.only:
            continue
        say(name)
        try:
            tables += part()
        except NotRunError as error:
            tables.append(Table(name, f"Not run: {error}.", []))
        except Exception as error:  # What goes wrong with one peer must not lose the others.
            traceback.print_exc()
            tables.append(Table(name, f"Not run to the end: {type(error).__name__}, {error}.", []))
    seconds = time.monotonic() - start
    versions = machine.versions(settings.cplan, settings.work)
    results = document.markdown(where, versions, tested, tables, seconds)
    print(results)
    record = {"machine": where, "versions": versions, "tables": [table.as_json() for table in tables]}
    (settings.work / "results.json").write_text(json.dumps(record, indent=1))
    say(f"results.json in {settings.work}")
    if arguments.write:
        document.write(results)
        say(f"tables written into {document.DOCUMENT}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
