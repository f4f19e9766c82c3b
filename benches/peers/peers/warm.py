"""Answers in a process that has planned before: what a program that plans more than once sees."""

from __future__ import annotations

import numpy as np

from .contenders import Answer, Ompl
from .figures import median, spread
from .judge import Verdicts
from .problem import Problem, length
from .settings import NotRunError, Settings, say
from .table import Lead, Table

LIMIT = 2.0
"""Seconds for one answer."""

BATCHES = 3
"""All take turns, so many times."""

FEASIBLE = ("A", "B")

CPLAN = {"decide": "cplan decide", "shortest": "cplan shortest", "proven": "cplan shortest, bound"}


def table(settings: Settings, problems: dict[str, Problem], verdicts: Verdicts, bounds: dict[str, float]) -> Table:
    """cplan's library calls beside OMPL's planners."""
    table = Table(
        "Answers from a warm process",
        "Here one process calls the library repeatedly, without files. `decide` returns a certified path or a "
        "checked proof. `shortest` is the default planner, without and with the lower bound on the optimum. OMPL "
        "returns its first solutions, for different seeds. Times are in milliseconds: medians, with quartiles in "
        "brackets. Length is relative to the proven lower bound.",
        ["problem", "program", "ms", "answer", "length", "valid"],
    )
    for name, problem in problems.items():
        say(f"  warm: {name}")
        answers = _answers(settings, table, problem)
        for who, given in answers.items():
            table.rows.append(_row(name, who, given, verdicts, bounds.get(name)))
        if name in FEASIBLE and CPLAN["decide"] in answers:
            own = median([a.ms for a in answers[CPLAN["decide"]]])
            for who, given in answers.items():
                if who not in CPLAN.values():
                    ratio = median([a.ms for a in given]) / own
                    table.leads.append(Lead(f"problem {name}, first answer, warm", who, CPLAN["decide"], ratio))
    return table


def _answers(settings: Settings, table: Table, problem: Problem) -> dict[str, list[Answer]]:
    runs = settings.choose(30, 6)
    # Another table shows their answers if there is no path.
    names = ["RRTConnect", "RRT*", "BIT*"] if problem.name in FEASIBLE else []
    peers = [Ompl(f"OMPL {name}", settings, name) for name in names]
    answers: dict[str, list[Answer]] = {}
    for batch in range(BATCHES):
        try:
            for who, own in _library(settings, problem, 5 * runs).items():
                answers.setdefault(who, []).extend(own)
            for peer in peers:
                given = peer.warm(problem, batch + 1, LIMIT, 1 + runs // BATCHES)
                answers.setdefault(peer.name, []).extend(given[1:])
        except NotRunError as error:
            table.note(f"{problem.name}: not all were run: {error}.")
            break
    return answers


def _library(settings: Settings, problem: Problem, rounds: int) -> dict[str, list[Answer]]:
    report = settings.rust("answers", *problem.files, str(rounds))
    answers = {}
    for call, name in CPLAN.items():
        path = np.array(report[call]["path"]) if "path" in report[call] else None
        gap = report[call].get("gap")
        told = report[call]["status"] if gap is None else f"found, proven within {gap:.0e}"
        answers[name] = [Answer(told, ms, float("nan"), path) for ms in report["times"][call]]
    return answers


def _row(problem: str, who: str, answers: list[Answer], verdicts: Verdicts, bound: float | None) -> list[str]:
    told = sorted({answer.told for answer in answers})
    paths = [answer.path for answer in answers if answer.path is not None]
    valid = [path for path in paths if verdicts.valid(problem, path)]
    ratio = f"{median([length(path) for path in valid]) / bound:.4f}" if valid and bound else "-"
    return [
        problem,
        who,
        spread([a.ms for a in answers]),
        ", ".join(told),
        ratio,
        f"{len(valid)} of {len(paths)} paths",
    ]
