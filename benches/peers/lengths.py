"""cplan and Polyanya on the queries of docs/published_lengths.md: lengths that agree, and the median time of a query.

usage: python lengths.py PUBLISHED_LENGTHS POLYANYA FOLDER [ROUNDS]

The programs are cplan's example `published_lengths`, and `cpp/polyanya.cpp`, which runs the code of Polyanya's authors.
FOLDER is that of the example; its folder `meshes` also has the meshes for Polyanya. The programs take turns.
"""

import csv
import pathlib
import re
import statistics
import subprocess
import sys

TOLERANCE = 1e-6
"""Greatest relative difference of lengths that agree, as in cplan's example."""


def output(*command: str | pathlib.Path) -> str:
    """Runs a program and returns what it prints."""
    return subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout


def cplan(program: str, folder: pathlib.Path) -> tuple[int, int, float]:
    """Returns cplan's number of lengths that agree, the number of queries, and the median time in microseconds."""
    line = output(program, folder).splitlines()[-1]
    agreeing, queries, time = re.search(r"(\d+) of (\d+) lengths agree.*?([\d.]+) us per query", line).groups()
    return int(agreeing), int(queries), float(time)


def polyanya(program: str, folder: pathlib.Path) -> tuple[int, int, float]:
    """Returns the same for Polyanya."""
    agreeing, times = 0, []
    for published in sorted((folder / "results").glob("*.csv")):
        name = published.stem
        lines = output(program, folder / f"meshes/{name}-merged.mesh", folder / f"scenarios/{name}.map.scen")
        with published.open() as file:
            for line, known in zip(lines.splitlines(), csv.DictReader(file), strict=True):
                time, length = map(float, line.split())
                expected = float(known["Distance"])
                agreeing += abs(length - expected) <= TOLERANCE * expected
                times.append(time)
    return agreeing, len(times), statistics.median(times)


def main() -> None:
    """Prints a table in Markdown."""
    ours, theirs, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    contenders = {"cplan": (cplan, ours), "Polyanya": (polyanya, theirs)}
    results = {name: [] for name in contenders}
    for _ in range(int((sys.argv[4:] or ["3"])[0])):
        for name, (run, program) in contenders.items():
            results[name].append(run(program, folder))
    print("| program | lengths that agree | time of a query, median | by round |")
    print("|---|---|---|---|")
    for name, rounds in results.items():
        agreeing, queries, _ = rounds[0]
        times = [time for *_, time in rounds]
        by_round = ", ".join(f"{time:.0f}" for time in times)
        print(f"| {name} | {agreeing} of {queries} | {statistics.median(times):.0f} us | {by_round} |")
    ratios = [a[2] / b[2] for a, b in zip(results["cplan"], results["Polyanya"], strict=True)]
    print(f"\nratio of the medians, cplan to Polyanya: {statistics.median(ratios):.2f}")


if __name__ == "__main__":
    main()
