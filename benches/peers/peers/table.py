"""Tables of results, as Markdown and for JSON."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any


@dataclass
class Lead:
    """A peer's time over cplan's at the same thing: below 1 the peer is faster."""

    what: str
    peer: str
    cplan: str
    ratio: float


@dataclass
class Table:
    """A table with what the reader should know of it."""

    title: str
    intro: str
    columns: list[str]
    rows: list[list[str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    leads: list[Lead] = field(default_factory=list)
    data: dict[str, Any] = field(default_factory=dict)

    def note(self, text: str) -> None:
        """Adds a note, once."""
        if text not in self.notes:
            self.notes.append(text)

    def markdown(self) -> str:
        """With aligned columns, so that it can be read as text too."""
        lines = [f"### {self.title}", "", self.intro, ""]
        if self.rows:
            cells = [self.columns, *self.rows]
            widths = [max(len(row[k]) for row in cells) for k in range(len(self.columns))]
            padded = ["| " + " | ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)) + " |" for row in cells]
            rule = "|" + "|".join("-" * (width + 2) for width in widths) + "|"
            lines += [padded[0], rule, *padded[1:], ""]
        lines += [f"- {note}" for note in self.notes]
        return "\n".join(lines).rstrip() + "\n"

    def as_json(self) -> dict[str, Any]:
        """Everything."""
        return asdict(self)
