"""The notebooks with exercises: model answers grade right, and students' notebooks have empty answers."""

import json
import re
import sys
from pathlib import Path
from typing import Any

import cplan
import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "examples/notebooks"))

pytest.importorskip("nbclient")
pages = pytest.importorskip("pages")
students = pytest.importorskip("students")


def sources(notebook: Path) -> list[str]:
    return [cell["source"] for cell in json.loads(notebook.read_text())["cells"] if cell["cell_type"] == "code"]


def names(notebook: Path) -> list[str]:
    return re.findall(r'assert \(grade := cplan.grade\("(\w+ \d)", answer_\d\)\), grade', "\n".join(sources(notebook)))


def outputs(notebook: Any) -> list[str]:
    return [output["data"]["text/plain"] for cell in notebook.cells for output in cell.get("outputs", []) if "data" in output]


def test_all_exercises_have_a_notebook() -> None:
    assert len(students.SOLUTIONS) == 7
    assert sorted(name for notebook in students.SOLUTIONS for name in names(notebook)) == sorted(cplan.grading.NAMES)


@pytest.mark.parametrize("notebook", students.SOLUTIONS, ids=lambda path: path.stem)
def test_model_answers_are_right(notebook: Path) -> None:
    # A wrong answer fails an assertion, and the run.
    grades = outputs(pages.executed(notebook))
    assert len(grades) == len(names(notebook)) and all("Grade(right=True" in grade for grade in grades)


@pytest.mark.parametrize("notebook", students.SOLUTIONS, ids=lambda path: path.stem)
def test_students_get_empty_answers(notebook: Path) -> None:
    handed_out = ROOT / "examples/notebooks/exercises" / notebook.name
    assert handed_out.read_text() == students.text(students.student(notebook)), "run examples/notebooks/students.py"
    cells = sources(handed_out)
    assert sum("# Your answer" in cell for cell in cells) == len(names(handed_out)) == len(names(notebook))
    assert not any("SOLUTION" in cell for cell in cells)
    assert not any(cell.get("outputs") for path in (notebook, handed_out) for cell in json.loads(path.read_text())["cells"])
    # The grader refuses each empty answer.
    space: dict[str, Any] = {}
    for cell in cells:
        if cell.startswith("assert"):
            with pytest.raises(AssertionError, match="expected"):
                exec(cell, space)
        else:
            exec(cell, space)
