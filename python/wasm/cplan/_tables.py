"""Studies of many layouts by the planner in WebAssembly, and their rows."""

import json
from typing import Any, final

from cplan._problems import Arm, Held, World, absolute, answered
from cplan._wasm import Handle, ask


class Study(Held):
    """One task in many layouts: a robot, a world, varied numbers in both, and measures."""

    __slots__ = ()

    def __new__(cls, path: Any, sources: str | None = None) -> Any:
        """Reads a study file (TOML), and the robot and world that it names. `sources` are the texts of a pickled study,
        which replace the files.
        """
        if sources is None:
            return cls._of({"do": "read_study", "path": absolute(path)})
        return cls._of({"do": "study_of_sources", "sources": sources})

    @staticmethod
    def sources(text: str, arm: Arm, world: World) -> str:
        """Returns `sources` for a study with this text, a robot that was read from a URDF, and a world."""
        sources: bytes = ask({"do": "study_sources", "text": text, "arm": arm, "world": world})
        return sources.decode()

    name = answered("name", "The title of the study.")
    parameters = answered("parameters", "Names of the parameters.")
    searched = answered("searched", "Number of layouts that the search may try, in addition to the listed and drawn ones.")
    options = answered("options", "Options of the main job, as the study states them.")

    def __len__(self) -> int:
        count: int = self._handle.answer["count"]
        return count

    def values(self, layout: int) -> dict[str, float]:
        """Returns the values of a layout, by the names of the parameters."""
        values = ask({"do": "values", "study": self._handle, "layout": layout})
        return dict(zip(self._handle.answer["parameters"], values))

    def layout(self, values: Any) -> tuple[Arm, World]:
        """Returns robot and world with the values of a row."""
        arm, world = ask({"do": "layout", "study": self._handle, "values": list(values)})
        return Arm(arm), World._of(world)

    def rows(self, first: int, last: int, jobs: int = 1) -> "Rows":
        """Plans in the layouts from `first` to before `last`, and returns their rows. There is one thread, whatever
        `jobs` is.
        """
        return Rows._of(ask({"do": "rows", "study": self._handle, "first": first, "last": last}))

    def search(self, known: "Rows", done: "Rows", jobs: int) -> "Rows":
        """Continues with a search after the rows `known`, and returns its rows. `done` are rows of a search that was
        interrupted.
        """
        return Rows._of(ask({"do": "search", "study": self._handle, "known": known, "done": done}))

    def _table(self, rows: "Rows", content: str) -> Any:
        return ask({"do": "table", "study": self._handle, "rows": rows, "content": content})

    def summary(self, rows: "Rows") -> str:
        """Summarises rows in some lines for people."""
        text: str = self._table(rows, "summary").decode()
        return text

    def summary_json(self, rows: "Rows") -> str:
        """Summarises rows as a JSON object."""
        text: str = self._table(rows, "json").decode()
        return text

    def csv(self, rows: "Rows") -> str:
        """Returns the table of rows as CSV."""
        text: str = self._table(rows, "csv").decode()
        return text

    def parquet(self, rows: "Rows") -> bytes:
        """Returns the table of rows as a Parquet file."""
        table: bytes = self._table(rows, "parquet")
        return table

    def html(self, rows: "Rows") -> str:
        """Returns the page of rows, with pictures of the best and the worst layout, and of one without a motion."""
        page: str = self._table(rows, "html").decode()
        return page

    def columns(self, rows: "Rows") -> dict[str, Any]:
        """Returns the columns of rows by name: numbers and flags as arrays, words as lists with None."""
        import numpy as np

        columns = {}
        for name, column in self._table(rows, "columns"):
            kind, values = next(iter(column.items()))
            types = {"counts": np.int64, "numbers": np.float64, "flags": np.bool_}
            columns[name] = np.array(values, dtype=types[kind]) if kind in types else values
        return columns

    def __repr__(self) -> str:
        description: str = self._handle.answer["description"]
        return description

    def __reduce__(self) -> Any:
        sources = ask({"do": "study_stored", "study": self._handle})
        return type(self), ("", json.dumps(sources, ensure_ascii=False, separators=(",", ":")))


@final
class Rows:
    """Rows of a study."""

    __slots__ = ("_rows",)
    _rows: list[Any]

    def __new__(cls, *parts: "Rows") -> "Rows":
        """Creates rows by joining parts."""
        return cls._of([row for part in parts for row in part._rows])

    @classmethod
    def _of(cls, rows: list[Any]) -> "Rows":
        joined = object.__new__(cls)
        joined._rows = rows
        return joined

    def _content(self) -> list[Any]:
        return self._rows

    def __len__(self) -> int:
        return len(self._rows)

    def __eq__(self, other: object, /) -> bool:
        return type(other) is Rows and other._rows == self._rows

    __hash__ = None  # type: ignore[assignment]

    def split(self, count: int) -> "tuple[Rows, Rows]":
        """Splits into the first `count` rows and the others."""
        return Rows._of(self._rows[:count]), Rows._of(self._rows[count:])

    def values(self, row: int) -> list[float]:
        """Returns the values of a row, in the order of the parameters."""
        if not 0 <= row < len(self._rows):
            raise ValueError("there is no such row")
        values: list[float] = self._rows[row]["values"]
        return values

    def __reduce__(self) -> Any:
        return rows_restored, (json.dumps(self._rows, ensure_ascii=False, separators=(",", ":")).encode(),)


def rows_restored(data: bytes) -> Rows:
    """Restores pickled rows."""
    return Rows._of(json.loads(data))


@final
class Journal:
    """The rows of a running study on disk."""

    __slots__ = ("_handle",)
    _handle: Handle

    @staticmethod
    def open(path: Any, study: Study, fresh: bool) -> "tuple[Journal, Rows]":
        """Opens the journal of a study, and returns it with the rows of an earlier run; `fresh` drops these."""
        request = {"do": "open_journal", "study": study._handle, "path": absolute(path), "fresh": fresh}
        journal = object.__new__(Journal)
        journal._handle = Handle(request)
        # When it is opened again, it keeps the rows since.
        journal._handle.request = {**request, "fresh": False}
        return journal, Rows._of(journal._handle.answer["rows"])

    def add(self, rows: Rows) -> None:
        """Adds the next rows, and writes them to disk."""
        ask({"do": "add_rows", "journal": self._handle, "rows": rows})

    def remove(self) -> None:
        """Removes the journal."""
        ask({"do": "remove_journal", "journal": self._handle})
