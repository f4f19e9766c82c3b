"""Programs that answer a problem: each is asked once at a time, in a process of its own."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from .problem import Problem, unwrapped
from .settings import NotRunError, Settings, called

GRACE = 20.0
"""Seconds beyond its own limit after which a process is given up."""


@dataclass(frozen=True)
class Answer:
    """One answer to one problem."""

    told: str
    """In the program's own words."""
    ms: float
    """Milliseconds from the loaded scene to the answer, by the program's own clock."""
    process_ms: float
    """Milliseconds from the start of the process to its end."""
    path: np.ndarray | None
    """Unwrapped."""
    bound: float | None = None
    """Proven lower bound on the length of all paths."""


class Contender(Protocol):
    """Something that answers problems."""

    @property
    def name(self) -> str:
        """In the tables."""
        ...

    @property
    def peer(self) -> str:
        """What `run` calls it where it cannot be had."""
        ...

    def ask(self, problem: Problem, seed: int, limit: float) -> Answer:
        """One answer. Raises `NotRunError`."""
        ...


@dataclass(frozen=True)
class Cplan:
    """cplan's command line, with some options."""

    name: str
    settings: Settings
    options: tuple[str, ...]
    peer: str = "cplan"

    def ask(self, problem: Problem, seed: int, limit: float) -> Answer:
        output = self.settings.work / "plan.json"
        output.unlink(missing_ok=True)
        command = [self.settings.cplan, *problem.files, "--quiet", "--timings", "--output", str(output), *self.options]
        start = time.perf_counter()
        try:
            run = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        except subprocess.TimeoutExpired as error:
            raise NotRunError("no answer within a minute") from error
        process_ms = (time.perf_counter() - start) * 1e3
        if run.returncode not in (0, 3, 4):
            raise NotRunError(run.stderr.strip())
        report = json.loads(output.read_text())
        stages = report["timings"]
        ms = sum(stages.get(stage, 0.0) for stage in ("build", "query", "certify", "prove", "bound"))
        path = np.array(report["path"]) if report["status"] == "found" else None
        return Answer(report["status"], ms, process_ms, path, report.get("optimum", {}).get("lower_bound"))


def _told(report: dict[str, Any], process_ms: float) -> Answer:
    path = unwrapped(np.array(report["path"])) if "path" in report else None
    return Answer(report["status"], report["ms"], process_ms, path)


def _timed(command: list[str], limit: float) -> Answer:
    start = time.perf_counter()
    report = called(command, limit + GRACE)
    process_ms = (time.perf_counter() - start) * 1e3
    return _told(report[0] if isinstance(report, list) else report, process_ms)


@dataclass(frozen=True)
class Ompl:
    """OMPL from C++."""

    name: str
    settings: Settings
    planner: str
    until: str = "first"
    peer: str = "OMPL, C++"

    def ask(self, problem: Problem, seed: int, limit: float) -> Answer:
        return _timed(self._command(problem, seed, limit, 1), limit)

    def warm(self, problem: Problem, seed: int, limit: float, runs: int) -> list[Answer]:
        """Several answers of one process: those after the first find its code and tables in the caches."""
        self.settings.demand(self.peer)
        reports = called(self._command(problem, seed, limit, runs), runs * limit + GRACE)
        return [_told(report, math.nan) for report in reports]

    def _command(self, problem: Problem, seed: int, limit: float, runs: int) -> list[str]:
        scene = self.settings.work / f"{problem.name}.scene"
        program = str(self.settings.work / "ompl_peer")
        return [program, str(scene), self.planner, str(seed), str(limit), self.until, str(runs)]


@dataclass(frozen=True)
class OmplPython:
    """OMPL from Python, with the C++ checker called from Python for each state."""

    name: str
    settings: Settings
    planner: str
    peer: str = "ompl"

    def ask(self, problem: Problem, seed: int, limit: float) -> Answer:
        scene, checker = self.settings.work / f"{problem.name}.scene", self.settings.work / "libchecker.so"
        worker = str(Path(__file__).parent / "ompl_worker.py")
        command = [sys.executable, worker, str(checker), str(scene), self.planner, str(seed), str(limit)]
        return _timed(command, limit)


@dataclass(frozen=True)
class Oxmpl:
    """oxmpl, a Rust crate."""

    name: str
    settings: Settings
    planner: str
    peer: str = "rust"

    def ask(self, problem: Problem, seed: int, limit: float) -> Answer:
        program = str(self.settings.work / "cplan-peers")
        return _timed([program, "oxmpl", *problem.files, self.planner, str(seed), str(limit)], limit)
