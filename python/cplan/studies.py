"""Studies of many layouts, on this machine or on a Ray cluster."""

from __future__ import annotations

import importlib
import json
import os
from collections.abc import Callable, Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from cplan import _frames
from cplan._cplan import Arm, Found, Infeasible, Options, Problem, Rows, Unknown, World
from cplan._cplan import Journal as _Journal
from cplan._cplan import Study as _Study
from cplan._cplan import plan
from cplan.planning import words

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

# Number of layouts per Ray task, large enough that the work takes longer than the overhead of the cluster.
BATCH = 1000
# Number of layouts between reports of progress and checks for Ctrl-C.
_STEP = 256

Progress = Callable[[int, int], object]


class Study(_Study):
    """One task in many layouts: a study file (TOML), with the robot and the world that it names.

    `len(study)` is the number of layouts. Rows depend only on the number of the layout and the files.
    """

    @classmethod
    def from_text(cls, text: str, arm: Arm, world: World) -> Study:
        """Creates a study from a text (TOML, which need not name robot and world), a robot in URDF and a world."""
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
    ) -> Results:
        """Plans all layouts, then runs the search if the study has one.

        It runs on this machine with `jobs` threads (by default one for each core), or with `engine="ray"` on the
        cluster that Ray is connected to, in tasks of `batch` layouts. The search, in which each layout depends on the
        previous ones, always runs here. The rows are the same.

        The file `journal` keeps the rows. A later run continues an interrupted one, and removes the file at the end.
        `fresh` starts again. `progress` receives the number of finished layouts and the number of all.
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
    """Runs tasks in the order of their layouts. If a worker dies, another one does its task."""
    try:
        ray = importlib.import_module("ray")
    except ImportError as error:
        raise ImportError('engine="ray" needs Ray, which is not installed: `pip install "cplan[ray]"`') from error
    if batch < 1:
        raise ValueError("a batch has one layout or more")
    if not ray.is_initialized():
        ray.init()
    # Retried without limit: only machines fail, because a layout in which planning fails is a row.
    task = ray.remote(num_cpus=1, max_retries=-1)(_batch)
    shared = ray.put(study)
    starts = iter(range(first, len(study), batch))
    # Enough waiting tasks to keep all cores busy; more would only take memory.
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
    """Returns words of a command line, in which `others` replace the words for the same options."""
    names = {other.partition("=")[0] for other in others}
    kept, keeps = [], True
    for word in options:
        # A value may be a separate word.
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
        """Returns a summary of the rows as text."""
        return self.study.summary(self.rows)

    @cached_property
    def figures(self) -> dict[str, Any]:
        """Returns the members of the program's `--json`: outcomes, reasons, the best and the worst layout."""
        figures: dict[str, Any] = json.loads(self.study.summary_json(self.rows))
        return figures

    @property
    def best(self) -> dict[str, Any] | None:
        """The best layout: its number, its parameters, its measures. None if no layout fits."""
        best: dict[str, Any] | None = self.figures["best"]
        return best

    def to_columns(self) -> dict[str, NDArray[Any] | list[str | None]]:
        """Returns columns by name, as pandas and polars accept them; missing values are NaN or None."""
        return self.study.columns(self.rows)

    def to_pandas(self) -> Any:
        """Returns the table as a DataFrame; needs pandas."""
        return _frames.pandas(self.to_columns())

    def column(self, name: str) -> NDArray[np.float64]:
        """Returns a column of numbers."""
        import numpy as np

        return np.asarray(self.to_columns()[name], dtype=np.float64)

    def layout(self, row: int) -> tuple[Arm, World]:
        """Returns robot and world of a row."""
        return self.study.layout(self.rows.values(row))

    def plan(self, row: int, *, progress: Callable[[str], object] | None = None, **options: Any) -> Found | Infeasible | Unknown:
        """Plans in the layout of a row as the study did. Options given here, as in `plan`, replace those of the study."""
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
        # The file is written completely or not at all.
        part = path.with_name(path.name + ".new")
        try:
            part.write_bytes(content)
            part.replace(path)
        except OSError as error:
            # Report the requested file, not the temporary one.
            raise OSError(error.errno, error.strerror, str(path)) from error

    def _repr_html_(self) -> str:
        page = self.study.html(self.rows).replace("&", "&amp;").replace('"', "&quot;")
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 640px; border: 0"></iframe>'
