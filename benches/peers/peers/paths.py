"""Paths and their absence: cplan beside OMPL and oxmpl on the problems A, B, INF and T."""

from __future__ import annotations

import statistics
from collections import Counter, defaultdict
from dataclasses import dataclass, field

from .contenders import Answer, Contender, Cplan, Ompl, OmplPython, Oxmpl
from .figures import median, spread, times
from .judge import Judge
from .problem import Problem, length, load
from .settings import NotRunError, Settings, say
from .table import Lead, Table

SOLVABLE = ("A", "B")
IMPOSSIBLE = ("INF", "T")
REFERENCE = "cplan subdivision"
"""Whose time the others' are compared with: the first certified answer."""


@dataclass
class Entry:
    """A contender, and what it takes part in."""

    contender: Contender
    problems: tuple[str, ...]
    rounds: dict[str, int]
    limit: float
    answers: dict[str, list[Answer]] = field(default_factory=lambda: defaultdict(list))
    failure: str | None = None


def entries(settings: Settings) -> list[Entry]:
    """All contenders, cplan first."""
    rounds, few = settings.choose(20, 5), settings.choose(10, 3)
    everything = (*SOLVABLE, *IMPOSSIBLE)
    often = dict.fromkeys(everything, rounds)
    # A run on INF takes all its time: fewer say as much.
    peers = often | {"INF": few}
    limit = 1.0

    def cplan(name: str, *options: str) -> Entry:
        return Entry(Cplan(f"cplan {name}", settings, options), everything, often, limit)

    listed = [
        cplan("subdivision", "--planner", "subdivision"),
        cplan("visibility (default)"),
        cplan("visibility --gap 1e-4", "--gap", "1e-4"),
        cplan("trapezoid", "--planner", "trapezoid"),
        cplan("wavefront", "--planner", "wavefront"),
        cplan("harmonic", "--planner", "harmonic"),
    ]
    for planner in ("RRTConnect", "BiEST", "PRM", "RRT*", "BIT*"):
        listed.append(Entry(Ompl(f"OMPL {planner}", settings, planner), everything, peers, limit))
    for planner in ("RRT*", "BIT*"):
        name = f"OMPL {planner}, {limit:g} s"
        listed.append(Entry(Ompl(name, settings, planner, "anytime"), ("A",), {"A": rounds}, limit))
    for planner in ("RRTConnect", "PRM", "RRT*"):
        contender = OmplPython(f"OMPL in Python, {planner}", settings, planner)
        listed.append(Entry(contender, ("A", "B", "T"), {"A": few, "B": few, "T": few}, limit))
    for planner in ("RRT", "RRTConnect", "RRT*"):
        listed.append(Entry(Oxmpl(f"oxmpl {planner}", settings, planner), everything, peers, limit))
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
                        answer = entry.contender.ask(problem, index + 1, entry.limit)
                        entry.answers[problem.name].append(answer)
                    except NotRunError as error:
                        entry.failure = str(error)
                        say(f"  without {entry.contender.name}: {error}")
    return listed


class Verdicts:
    """Judgements, each path judged once."""

    def __init__(self, problems: dict[str, Problem]) -> None:
        self._judges = {name: Judge(problem) for name, problem in problems.items()}
        self._known: dict[tuple[str, bytes], bool] = {}

    def valid(self, problem: str, answer: Answer) -> bool:
        """Whether there is a path and it is one."""
        if answer.path is None:
            return False
        key = (problem, answer.path.tobytes())
        if key not in self._known:
            self._known[key] = self._judges[problem].judge(answer.path).valid
        return self._known[key]


def paths_table(listed: list[Entry], verdicts: Verdicts) -> Table:
    """Problems that have a path."""
    bounds = {name: max(a.bound or 0.0 for e in listed for a in e.answers[name]) for name in SOLVABLE}
    table = Table(
        "Paths: problems A and B",
        "Time from the scene in memory to the answer, by each program's own clock, in milliseconds: median, and in "
        "brackets the quartiles. Length: median of the valid paths over the proven lower bound "
        f"(A {bounds['A']:.4f}, B {bounds['B']:.4f} rad, by `cplan --gap 1e-4`). Valid: free of collision at every "
        "1e-4 rad, by the harness's own judge, of the runs made. Process: from its start to its end on A; cplan "
        "reads URDF and TOML and writes the timed trajectory in it, the others print waypoints.",
        [
            "planner",
            "A ms",
            "A length",
            "A valid",
            "B ms",
            "B length",
            "B valid",
            "A process ms",
            "A time over cplan's",
        ],
    )
    reference = _reference(listed, "A")
    for entry in listed:
        row = [entry.contender.name]
        for name in SOLVABLE:
            row += _path_cells(entry, name, bounds[name], verdicts)
        answers = entry.answers["A"]
        row += [spread([a.process_ms for a in answers]), times(median([a.ms for a in answers]) / reference)]
        table.rows.append(row)
        if entry.failure is not None:
            table.notes.append(f"{entry.contender.name} was not run: {entry.failure}.")
    _add_leads(table, listed, SOLVABLE)
    table.notes.append(
        "All but cplan's five planners stop at the first solution, or after 1 s where the table says so; time limit "
        "1 s. "
        'cplan\'s times hold the certificate, and for "visibility" the lower bound on the optimum too.'
    )
    return table


def _reference(listed: list[Entry], problem: str) -> float:
    return next(median([a.ms for a in e.answers[problem]]) for e in listed if e.contender.name == REFERENCE)


def _path_cells(entry: Entry, problem: str, bound: float, verdicts: Verdicts) -> list[str]:
    answers = entry.answers[problem]
    if not answers:
        return ["-", "-", "-"]
    valid = [a for a in answers if verdicts.valid(problem, a)]
    lengths = [length(a.path) / bound for a in valid if a.path is not None]
    ratio = f"{statistics.median(lengths):.4f}" if lengths else "-"
    return [spread([a.ms for a in answers]), ratio, f"{len(valid)} of {len(answers)}"]


def _add_leads(table: Table, listed: list[Entry], problems: tuple[str, ...]) -> None:
    for name in problems:
        reference = _reference(listed, name)
        for entry in listed:
            answers = entry.answers[name]
            if answers and not isinstance(entry.contender, Cplan) and not entry.contender.name.endswith(" s"):
                ratio = median([a.ms for a in answers]) / reference
                table.leads.append(Lead(f"{name}, first answer", entry.contender.name, REFERENCE, ratio))


def impossible_table(listed: list[Entry], verdicts: Verdicts) -> Table:
    """Problems that have none."""
    table = Table(
        "No path: problems INF and T",
        "What each program says, in its own words, how often, and after how long (ms, median and quartiles). Any "
        "path here is wrong: the judge says so of every one.",
        ["planner", "INF: answer", "INF ms", "T: answer", "T ms", "T: paths, valid"],
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
        claimed = [answer for answer in entry.answers["T"] if answer.path is not None]
        row.append(f"{len(claimed)}, {sum(verdicts.valid('T', answer) for answer in claimed)}")
        table.rows.append(row)
    peers = [e for e in listed if not isinstance(e.contender, Cplan)]
    runs = sum(len(e.answers["T"]) for e in peers)
    wrong = sum(a.path is not None and not verdicts.valid("T", a) for e in peers for a in e.answers["T"])
    table.notes.append(f"On T the sampling planners return {wrong} colliding paths in {runs} runs.")
    return table


def library_table(settings: Settings, rounds: int) -> Table:
    """cplan's library, warm."""
    table = Table(
        "cplan as a library",
        "The same problems by library calls in one process, which is what a program that plans more than once sees: "
        "`decide` (a certified path, or a proof that has passed its check), `shorten` (the same, shortened to within "
        "1e-4). Milliseconds.",
        ["problem", "decide", "shorten", "answer"],
    )
    for name in (*SOLVABLE, *IMPOSSIBLE):
        report = settings.rust("answers", *load(name).files, str(rounds))
        clock = report["times"]
        table.rows.append([name, spread(clock["decide"]), spread(clock["shorten"]), report["decide"]["status"]])
    return table


def tables(settings: Settings, problems: dict[str, Problem]) -> list[Table]:
    """The three."""
    listed = measure(settings, problems)
    say("  paths: judging")
    verdicts = Verdicts(problems)
    found = [paths_table(listed, verdicts), impossible_table(listed, verdicts)]
    try:
        found.append(library_table(settings, settings.choose(200, 50)))
    except NotRunError as error:
        found[0].notes.append(f"The library was not run: {error}.")
    for name, problem in problems.items():
        cplan = [a for e in listed if isinstance(e.contender, Cplan) for a in e.answers[name]]
        wrong = sum(a.path is not None and not verdicts.valid(problem.name, a) for a in cplan)
        found[0].notes.append(
            f"{name}: of cplan's {sum(a.path is not None for a in cplan)} paths {wrong} fail the judge."
        )
    return found
