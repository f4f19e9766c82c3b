"""The results as a document: the whole of it goes to standard output, and between two marks of docs/peers.md."""

from __future__ import annotations

from pathlib import Path

from .figures import times
from .table import Lead, Table

DOCUMENT = Path(__file__).parents[3] / "docs" / "peers.md"
BEGIN, END = "<!-- results: begin, written by benches/peers/run --write -->", "<!-- results: end -->"


def markdown(machine: list[str], versions: list[str], tested: list[str], tables: list[Table], seconds: float) -> str:
    """Everything measured."""
    lines = ["### Machine and versions", ""]
    lines += [f"- {line}" for line in (*machine, *versions)]
    lines += [f"- Self-test: {line}." for line in tested]
    lines += [f"- The run took {seconds / 60:.1f} minutes.", ""]
    leads = [lead for table in tables for lead in table.leads]
    parts = ["\n".join(lines), *(table.markdown() for table in tables), _summary(leads)]
    return "\n".join(parts)


def _summary(leads: list[Lead]) -> str:
    """Who is faster at what, worst first."""
    behind = sorted((lead for lead in leads if lead.ratio < 1), key=lambda lead: lead.ratio)
    ahead = sorted((lead for lead in leads if lead.ratio >= 1), key=lambda lead: lead.ratio)
    lines = ["### Where a peer is faster", "", "By medians of this run; a ratio is the peer's time over cplan's.", ""]
    lines += [f"- {lead.what}: {lead.peer} takes {times(lead.ratio)} the time of {lead.cplan}." for lead in behind]
    lines += [] if behind else ["- Nowhere in this run."]
    lines += ["", "### Where cplan is faster", ""]
    lines += [f"- {lead.what}: {lead.peer} takes {times(lead.ratio)} the time of {lead.cplan}." for lead in ahead]
    return "\n".join(lines) + "\n"


def write(results: str) -> None:
    """Puts the results between the marks."""
    text = DOCUMENT.read_text()
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    DOCUMENT.write_text(f"{before}{BEGIN}\n\n{results}\n{END}{after}")
