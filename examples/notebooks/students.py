"""Writes the notebooks for students: `python examples/notebooks/students.py`.

The notebooks in `solutions` have model answers between two marks, those of nbgrader. The notebooks in `exercises` are
the same without these lines.
"""

import json
import re
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent
SOLUTIONS = sorted((FOLDER / "solutions").glob("*.ipynb"))
ANSWER = re.compile(r"### BEGIN SOLUTION\n.*?### END SOLUTION", re.DOTALL)


def student(notebook: Path) -> dict[str, Any]:
    """Returns a notebook without its model answers."""
    cells: dict[str, Any] = json.loads(notebook.read_text())
    for cell in cells["cells"]:
        cell["source"] = ANSWER.sub("# Your answer", cell["source"])
    return cells


def text(notebook: dict[str, Any]) -> str:
    """Returns a notebook as the text of its file."""
    return json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"


def main() -> None:
    for notebook in SOLUTIONS:
        (FOLDER / "exercises" / notebook.name).write_text(text(student(notebook)))


if __name__ == "__main__":
    main()
