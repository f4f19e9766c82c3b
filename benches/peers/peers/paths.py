"""Paths and their absence: cplan beside OMPL and oxmpl on the problems A, B, INF and T."""

from __future__ import annotations

import math
import statistics
from collections import Counter, defaultdict
from dataclasses import dataclass, field

from . import warm
from .contenders import Answer, Contender, Cplan, Ompl, OmplPython, Oxmpl
from .figures import median, spread, times
from .judge import Verdicts
from .problem import Problem, length
from .settings import NotRunError, Settings, say
from .table import Lead, Table

SOLVABLE = ("A", "B")
IMPOSSIBLE = ("INF", "T")
REFERENCE = "cplan subdivision"
"""Whose time the others' are compared with: the first certified answer."""

DEFAULT = "cplan shortest (default)"


@dataclass
class Entry:
    """A contender, and what it takes part in."""

    contender: Contender
    problems: tuple[str, ...]
    rounds: dict[str, int]
    limits: dict[str, float]
    """Seconds."""
    answers: dict[str, list[Answer]] = field(default_factory=lambda: defaultdict(list))
    failure: str | None = None


def entries(settings: Settings) -> list[Entry]:
    """All contenders, cplan first."""
    rounds, few = settings.choose(20, 5), settings.choose(10, 3)
    everything = (*SOLVABLE, *IMPOSSIBLE)
    often = dict.fromkeys(everything, rounds)
    # A run on INF takes all its time: fewer say as much.
    peers = often | {"INF": settings.choose(10, 2)}
    limits = {"A": 2.0, "B": 2.0, "INF": 1.0, "T": 2.0}
    improving = 1.0

    def cplan(name: str, *options: str) -> Entry:
        return Entry(Cplan(f"cplan {name}", settings, options), everything, often, limits)

    listed = [
        cplan(REFERENCE.removeprefix("cplan "), "--planner", "subdivision"),
        cplan(DEFAULT.removeprefix("cplan ")),
        cplan("first", "--planner", "first"),
        cplan("visibility", "--planner", "visibility"),
        cplan("trapezoid", "--planner", "trapezoid"),
        cplan("wavefront", "--planner", "wavefront"),
        cplan("harmonic", "--planner", "harmonic"),
    ]
    for planner in ("RRTConnect", "BiEST", "PRM", "RRT*", "BIT*"):
        listed.append(Entry(Ompl(f"OMPL {planner}", settings, planner), everything, peers, limits))
    for planner in ("RRT*", "BIT*"):
        name = f"OMPL {planner}, {improving:g} s"
        listed.append(Entry(Ompl(name, settings, planner, "anytime"), ("A",), {"A": rounds}, {"A": improving}))
    for planner in ("RRTConnect", "PRM", "RRT*"):
        contender = OmplPython(f"OMPL in Python, {planner}", settings, planner)
        listed.append(Entry(contender, ("A", "B", "T"), {"A": few, "B": few, "T": few}, limits))
    # On T, whose runs mostly take all their time, fewer.
    peers = peers | {"T": few}
    for planner in ("RRT", "RRTConnect", "RRT*"):
        listed.append(Entry(Oxmpl(f"oxmpl {planner}", settings, planner), everything, peers, limits))
    return listed


def measure(settings: Settings, problems: dict[str, Problem]) -> list[Entry]:
    """Asks everybody, round after round, one at a time."""
    listed = entries(settings)
    for entry in listed:
        entry.failure = settings.missing(entry.contender.peer)
    for index in range(max(max(entry.rounds.values()) for entry in listed)):
        say(f"  paths: round {index + 1}")
        for problem in problems.values():
            for entry in listed:
                if entry.failure is None and problem.name in entry.problems and index < entry.rounds[problem.name]:
                    try:
                        answer = entry.contender.ask(problem, index + 1, entry.limits[problem.name])
                        entry.answers[problem.name].append(answer)
                    except NotRunError as error:
                        entry.failure = str(error)
                        say(f"  without {entry.contender.name}: {error}")
    return listed


def paths_table(listed: list[Entry], verdicts: Verdicts) -> Table:
    """Problems that have a path."""
    bounds = _bounds(listed)
    table = Table(
        "Paths: problems A and B",
        "Times are in milliseconds, from the scene in memory to the answer, by each program's own clock: medians, "
        "with quartiles in brackets. Length is the median over the valid paths, divided by the proven lower bound "
        f"(A {bounds['A']:.4f} rad, B {bounds['B']:.4f} rad, by `cplan --gap 1e-4`). Valid counts the paths that "
        "the judge finds free of collision at steps of 1e-4 rad. Process is the time of the whole process on A. In "
        "this time cplan also reads URDF and TOML files and writes the timed trajectory; the others print "
        "waypoints.",
        [
            "planner",
            "A ms",
            "A length",
            "A valid",
            "B ms",
            "B length",
            "B valid",
            "A process ms",
            "A time over subdivision's",
        ],
    )
    reference = _time(listed, REFERENCE, "A")
    for entry in listed:
        row = [entry.contender.name]
        for name in SOLVABLE:
            row += _path_cells(entry, name, bounds[name], verdicts)
        answers = entry.answers["A"]
        row += [spread([a.process_ms for a in answers]), times(median([a.ms for a in answers]) / reference)]
        table.rows.append(row)
        if entry.failure is not None:
            table.note(f"{entry.contender.name} was not run, or not to the end: {entry.failure}.")
    _add_leads(table, listed)
    table.note(
        'The other programs stop at their first solution, except those marked "1 s", which improve it for one '
        'second. The time limit is 2 s, and 1 s on INF. cplan\'s times include the certificate, and for "shortest" '
        'and "visibility" also the lower bound on the optimum.'
    )
    return table


def _bounds(listed: list[Entry]) -> dict[str, float]:
    """Proven lower bounds on the lengths of all paths."""
    proven = {name: [a.bound for e in listed for a in e.answers[name] if a.bound] for name in SOLVABLE}
    return {name: max(bounds, default=math.nan) for name, bounds in proven.items()}


def _time(listed: list[Entry], name: str, problem: str) -> float:
    return next(median([a.ms for a in e.answers[problem]]) for e in listed if e.contender.name == name)


def _path_cells(entry: Entry, problem: str, bound: float, verdicts: Verdicts) -> list[str]:
    answers = entry.answers[problem]
    if not answers:
        return ["-", "-", "-"]
    valid = [a for a in answers if verdicts.valid(problem, a.path)]
    lengths = [length(a.path) / bound for a in valid if a.path is not None]
    ratio = f"{statistics.median(lengths):.4f}" if lengths else "-"
    return [spread([a.ms for a in answers]), ratio, f"{len(valid)} of {len(answers)}"]


def _add_leads(table: Table, listed: list[Entry]) -> None:
    """First answers beside cplan's first answer, and beside that of the planner that it runs if nothing else is "
    "asked."""
    for name in SOLVABLE:
        for own in (REFERENCE, DEFAULT):
            reference = _time(listed, own, name)
            for entry in listed:
                answers = entry.answers[name]
                is_first = not isinstance(entry.contender, Cplan) and not entry.contender.name.endswith(" s")
                if answers and is_first:
                    ratio = median([a.ms for a in answers]) / reference
                    table.leads.append(Lead(f"problem {name}, first answer", entry.contender.name, own, ratio))


def impossible_table(listed: list[Entry], verdicts: Verdicts) -> Table:
    """Problems that have none."""
    table = Table(
        "No path: problems INF and T",
        "The table quotes the answers of each program and says how often each was given. Times are in "
        "milliseconds: medians, with quartiles in brackets. Every returned path is wrong, and the judge rejects "
        "them all.",
        ["planner", "INF: answer", "INF ms", "T: answer", "T ms", "paths returned", "of these valid"],
    )
    for entry in listed:
        if not any(entry.answers[name] for name in IMPOSSIBLE):
            continue
        row = [entry.contender.name]
        for name in IMPOSSIBLE:
            answers = entry.answers[name]
            told = Counter(answer.told for answer in answers)
            row.append(", ".join(f'"{words}" {count}' for words, count in told.most_common()) or "-")
            row.append(spread([answer.ms for answer in answers]))
        claimed = [(name, a) for name in IMPOSSIBLE for a in entry.answers[name] if a.path is not None]
        row += [str(len(claimed)), str(sum(verdicts.valid(name, answer.path) for name, answer in claimed))]
        table.rows.append(row)
    peers = [e for e in listed if not isinstance(e.contender, Cplan)]
    runs = sum(len(e.answers["T"]) for e in peers)
    wrong = sum(a.path is not None and not verdicts.valid("T", a.path) for e in peers for a in e.answers["T"])
    table.note(f"On T the sampling planners return {wrong} colliding paths in {runs} runs.")
    return table


def tables(settings: Settings, problems: dict[str, Problem]) -> list[Table]:
    """The three."""
    listed = measure(settings, problems)
    say("  paths: judging")
    verdicts = Verdicts(problems)
    found = [paths_table(listed, verdicts), impossible_table(listed, verdicts)]
    found.append(warm.table(settings, problems, verdicts, _bounds(listed)))
    own = [
        (name, a.path) for e in listed if isinstance(e.contender, Cplan) for name in problems for a in e.answers[name]
    ]
    paths = [(name, path) for name, path in own if path is not None]
    wrong = sum(not verdicts.valid(name, path) for name, path in paths)
    found[0].note(f"The judge rejects {wrong} of cplan's {len(paths)} paths.")
    return found
