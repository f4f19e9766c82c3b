"""Studies of many layouts: on this machine, or on a cluster of Ray."""

import importlib
import json
import os
from collections.abc import Callable, Iterator
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from cplan import _frames
from cplan._cplan import Arm, Found, Infeasible, Options, Problem, Rows, Unknown, World
from cplan._cplan import Journal as _Journal
from cplan._cplan import Study as _Study
from cplan._cplan import plan
from cplan.planning import words

# Layouts of a task for Ray: it takes longer than what a cluster costs.
BATCH = 1000
# Layouts after which there is progress, and Ctrl-C is seen at the latest.
_STEP = 256

Progress = Callable[[int, int], object]


class Study(_Study):
    """One task in many layouts: a study file (TOML), with the robot and the world that it names.

    `len(study)` is the number of layouts. Rows follow from a layout's number and the files alone.
    """

    @classmethod
    def from_text(cls, text: str, arm: Arm, world: World) -> "Study":
        """The study of a text (TOML, which need not name robot and world) for a robot in URDF and a world."""
        return cls("", cls.sources(text, arm, world))

    def run(
        self,
        *,
        engine: Literal["local", "ray"] = "local",
        jobs: int | None = None,
        journal: str | os.PathLike[str] | None = None,
        fresh: bool = False,
        batch: int = BATCH,
        progress: Progress | None = None,
    ) -> "Results":
        """Plans in all layouts, then searches on if the study says so.

        On this machine with so many threads as `jobs` (by default one for each core), or with `engine="ray"` on the cluster that Ray is
        connected to, in tasks of `batch` layouts; the search, whose layouts follow from each other, runs here. The same rows either way.

        Rows are kept in `journal`, a file: a run that was stopped goes on there, and the file is removed at the end. `fresh` begins anew.
        `progress` hears how many layouts are done, and of how many.
        """
        jobs = jobs or os.cpu_count() or 1
        kept, known = _Journal.open(Path(journal), self, fresh) if journal is not None else (None, Rows())
        known, tried = known.split(len(self))
        total = len(self) + self.searched
        parts = [known]
        done = len(known)
        batches = _locally(self, done, jobs) if engine == "local" else _by_ray(self, done, batch)
        for rows in batches:
            parts.append(rows)
            done += len(rows)
            if kept is not None:
                kept.add(rows)
            if progress is not None:
                progress(done, total)
        designed = Rows(*parts)
        found = self.search(designed, tried, jobs) if self.searched else Rows()
        if kept is not None:
            kept.add(found.split(len(tried))[1])
        if progress is not None and self.searched:
            progress(done + len(found), total)
        results = Results(self, Rows(designed, found))
        if kept is not None:
            kept.remove()
        return results


def _locally(study: Study, first: int, jobs: int) -> Iterator[Rows]:
    step = _STEP * jobs
    for at in range(first, len(study), step):
        yield study.rows(at, at + step, jobs)


def _by_ray(study: Study, first: int, batch: int) -> Iterator[Rows]:
    """Tasks in the order of their layouts. A worker that dies has its task done by another one."""
    try:
        ray = importlib.import_module("ray")
    except ImportError as error:
        raise ImportError('engine="ray" needs Ray, which is not installed: `pip install "cplan[ray]"`') from error
    if batch < 1:
        raise ValueError("a batch has one layout or more")
    if not ray.is_initialized():
        ray.init()
    # Tried again as often as it takes: what fails are machines, since a layout that cannot be planned in is a row.
    task = ray.remote(num_cpus=1, max_retries=-1)(_batch)
    shared = ray.put(study)
    starts = iter(range(first, len(study), batch))
    # As many tasks wait as keep all cores busy; more would only hold memory.
    most = 4 * max(1, int(ray.cluster_resources().get("CPU", 1)))
    waiting: list[Any] = []
    for start in starts:
        waiting.append(task.remote(shared, start, start + batch))
        if len(waiting) >= most:
            yield ray.get(waiting.pop(0))
    while waiting:
        yield ray.get(waiting.pop(0))


def _batch(study: Study, first: int, last: int) -> Rows:
    return study.rows(first, last, 1)


def _replaced(options: list[str], others: list[str]) -> list[str]:
    """Words of a command line with others in place of those that say the same."""
    names = {other.partition("=")[0] for other in others}
    kept, keeps = [], True
    for word in options:
        # A value may be a word of its own.
        if word.startswith("--"):
            keeps = word.partition("=")[0] not in names
        if keeps:
            kept.append(word)
    return kept + others


class Results:
    """The rows of a study."""

    def __init__(self, study: Study, rows: Rows) -> None:
        self.study = study
        self.rows = rows

    def __len__(self) -> int:
        return len(self.rows)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Results) and self.rows == other.rows

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<cplan.Results of {self.study!r}: {len(self)} rows>"

    def summary(self) -> str:
        """What the rows show, in some lines for people."""
        return self.study.summary(self.rows)

    @cached_property
    def figures(self) -> dict[str, Any]:
        """The same as the program's `--json` has it: outcomes, reasons, the best and the worst layout."""
        figures: dict[str, Any] = json.loads(self.study.summary_json(self.rows))
        return figures

    @property
    def best(self) -> dict[str, Any] | None:
        """The best layout: its number, its parameters, what was measured. None where none fits."""
        best: dict[str, Any] | None = self.figures["best"]
        return best

    def to_columns(self) -> dict[str, NDArray[Any] | list[str | None]]:
        """Columns by name, as pandas and polars take them; what there is none of is NaN or None."""
        return self.study.columns(self.rows)

    def to_pandas(self) -> Any:
        """A DataFrame, where pandas is installed."""
        return _frames.pandas(self.to_columns())

    def column(self, name: str) -> NDArray[np.float64]:
        """A column of numbers."""
        return np.asarray(self.to_columns()[name], dtype=np.float64)

    def layout(self, row: int) -> tuple[Arm, World]:
        """Robot and world of a row."""
        return self.study.layout(self.rows.values(row))

    def plan(self, row: int, *, progress: Callable[[str], object] | None = None, **options: Any) -> Found | Infeasible | Unknown:
        """Plans in the layout of a row as the study did: with its options, but for those that are given here as to `plan`."""
        arm, world = self.layout(row)
        asked = Options(_replaced(self.study.options, words(**options)))
        return plan(Problem(arm, world, asked), asked, progress)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the table (.csv, .parquet), the page (.html) or the summary (.json)."""
        path = Path(path)
        match path.suffix:
            case ".csv":
                content = self.study.csv(self.rows).encode()
            case ".parquet":
                content = self.study.parquet(self.rows)
            case ".html":
                content = self.study.html(self.rows).encode()
            case ".json":
                content = (json.dumps(self.figures, indent=2) + "\n").encode()
            case other:
                raise ValueError(f"{path}: results are saved as .csv, .parquet, .html or .json, not {other or 'without an ending'}")
        # Whole or not at all.
        part = path.with_name(path.name + ".new")
        try:
            part.write_bytes(content)
            part.replace(path)
        except OSError as error:
            # The file that was asked for, not the one beside it.
            raise OSError(error.errno, error.strerror, str(path)) from error

    def _repr_html_(self) -> str:
        page = self.study.html(self.rows).replace("&", "&amp;").replace('"', "&quot;")
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 640px; border: 0"></iframe>'
