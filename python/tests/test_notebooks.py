"""The notebooks run, and show the results of the book's pages."""

import json
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "examples/notebooks"))

pytest.importorskip("nbclient")
pytest.importorskip("matplotlib")
pages = pytest.importorskip("pages")


def test_there_are_notebooks() -> None:
    assert len(pages.NOTEBOOKS) == 3


@pytest.mark.parametrize("notebook", pages.NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_shows_what_its_page_says(notebook: Path) -> None:
    cells = json.loads(notebook.read_text())["cells"]
    assert not any(cell.get("outputs") or cell.get("execution_count") for cell in cells), "stored without outputs"
    text, pictures = pages.page(notebook.stem, pages.executed(notebook))
    assert text == (ROOT / f"docs/{notebook.stem}.md").read_text(), "write the pages again: examples/notebooks/pages.py"
    assert sorted(pictures) == re.findall(r"\(pictures/notebooks/(\w+\.png)\)", text)
    for name, picture in pictures.items():
        assert picture.startswith(b"\x89PNG") and len(picture) > 5_000, name
        assert (ROOT / "docs/pictures/notebooks" / name).exists()
