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
    """Who is faster at what."""
    lines = ["### Where another program is faster", ""]
    lines += _grouped([lead for lead in leads if lead.ratio < 1]) or ["Nowhere in this run."]
    lines += ["", "### Where cplan is faster", "", "<details><summary>All comparisons</summary>", ""]
    lines += _grouped([lead for lead in leads if lead.ratio >= 1]) or ["Nowhere in this run."]
    lines += ["", "</details>"]
    return "\n".join(lines) + "\n"


def _grouped(leads: list[Lead]) -> list[str]:
    """A table with a row for each thing that was compared, with all peers, the fastest first."""
    groups: dict[tuple[str, str], list[Lead]] = {}
    for lead in sorted(leads, key=lambda lead: lead.ratio):
        groups.setdefault((lead.what, lead.cplan), []).append(lead)
    ranked = sorted(groups.items(), key=lambda group: group[1][0].ratio)
    rows = [
        f"| {what} | {cplan} | " + ", ".join(f"{lead.peer}: {times(lead.ratio)}" for lead in group) + " |"
        for (what, cplan), group in ranked
    ]
    head = ["| compared | cplan's program | time of the other program, divided by cplan's |", "|---|---|---|"]
    return head + rows if rows else []


def write(results: str) -> None:
    """Puts the results between the marks."""
    text = DOCUMENT.read_text()
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    DOCUMENT.write_text(f"{before}{BEGIN}\n\n{results}\n{END}{after}")
