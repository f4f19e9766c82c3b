"""A grid that all field solvers get, with what cplan made of it and everybody's clocks."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .problem import ARM, PROBLEMS
from .settings import Settings


@dataclass
class Cells:
    """Free cells, one goal, milliseconds by name."""

    name: str
    free: np.ndarray
    goal: tuple[int, int]
    clock: dict[str, list[float]]
    report: dict[str, Any]
    folder: Path
    rounds: int

    def result(self, file: str, kind: str) -> np.ndarray:
        """What cplan computed, a value a cell."""
        return np.fromfile(self.folder / file, dtype=kind).reshape(self.free.shape)

    def reached(self) -> np.ndarray:
        """Cells from which a way leads to the goal."""
        return self.result("steps.u32", "<u4") != np.iinfo(np.uint32).max

    def both(self, first: str, second: str) -> list[float]:
        """Two stages of the same rounds together."""
        return [a + b for a, b in zip(self.clock[first], self.clock[second], strict=True)]

    def time(self, name: str, work: Callable[[], Any]) -> Any:  # noqa: ANN401
        """Runs `work`, and adds its milliseconds to the list of `name`."""
        start = time.perf_counter()
        result = work()
        self.clock[name].append((time.perf_counter() - start) * 1e3)
        return result


def solve(settings: Settings, scene: str, size: int, rounds: int) -> Cells:
    """cplan's fields of `boxes`, of a `maze`, or of the configuration space of a problem."""
    folder = settings.work / "field"
    folder.mkdir(parents=True, exist_ok=True)
    is_drawn = scene in ("boxes", "maze")
    world = scene if is_drawn else str(PROBLEMS / f"{scene.lower()}.toml")
    arm = [] if is_drawn else [str(ARM)]
    report = settings.rust("field", world, str(size), str(rounds), str(folder), *arm)
    free = np.fromfile(folder / "free.u8", dtype=np.uint8).reshape(size, size).astype(bool)
    goal = (report["goal"] // size, report["goal"] % size)
    clock = defaultdict(list, report["times"])
    return Cells(f"{scene}, {size} x {size}", free, goal, clock, report, folder, rounds)
