"""Runs the examples of the book's pages and compares the output with the pages."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [(ROOT / f"docs/{page}.md").read_text() for page in ("python", "study", "grading")]
EXAMPLES = [example for page in PAGES for example in re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", page, re.DOTALL)]


def test_all_examples_are_run_but_for_those_that_say_why_not() -> None:
    blocks = sum(page.count("```python") - page.count("-->\n```python") for page in PAGES)
    assert len(EXAMPLES) == blocks >= 4


def test_the_readme_plans_the_shelf() -> None:
    codes = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert len(codes) == 1
    done = subprocess.run([sys.executable, "-c", codes[0]], capture_output=True, text=True, cwd=ROOT)
    assert (done.returncode, done.stdout) == (0, "found [ 1.55 -0.35]\n"), done.stderr


@pytest.mark.parametrize("code, said", EXAMPLES)
def test_an_example_prints_what_the_page_says(code: str, said: str) -> None:
    if "shapely" in code:
        pytest.importorskip("shapely")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert (done.returncode, done.stdout) == (0, said), done.stderr
