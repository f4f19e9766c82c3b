"""The course of the book: its live figures, and how they are loaded."""

import re
import shlex

import pytest
from conftest import ROOT
from test_page import pixels

LIVE = re.compile(r"^!\[.*\]\((.*)\)\n<!-- live: (\w+\.html)#(\w+)(?:/(\w+))? -->$", re.M)
CHAPTERS = {path.stem: path.read_text() for path in sorted(ROOT.glob("docs/*.md")) if LIVE.search(path.read_text())}


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_the_live_figure_shows_what_the_chapter_says(program, show, chapter):
    text = CHAPTERS[chapter]
    _, page, mode, lesson = LIVE.search(text).groups()
    mark, command = re.search(rf"(<!-- exit: 3 -->\n)?```sh\ncplan (.* --picture {page})\n```", text).groups()
    program.run(*[str(ROOT / word) if word.endswith((".urdf", ".toml")) else word for word in shlex.split(command)], code=3 if mark else 0)
    file = program.folder / page
    assert file.stat().st_size < 400_000
    seen = show(f"{file.as_uri()}#{mode}" + (f"/{lesson}" if lesson else ""))
    assert (seen.do("cplan.mode"), seen.do("cplan.learn.lesson")) == (mode, lesson or "slice")
    # It moves.
    at = []
    for part in (0.1, 0.5, 0.9):
        seen.do("(part) => cplan.seek(part * cplan.duration)", part)
        at.append((pixels(seen, "workspace"), pixels(seen, "cspace")))
    assert len(set(at)) == 3
    seen.shoot(f"course_{chapter}")


def test_a_live_figure_takes_the_place_of_the_picture(show, tmp_path):
    script = (ROOT / "docs/live.js").as_uri()
    figure = '<p><img src="a.svg" alt="a"> <!-- live: x.html#think --></p><p><img src="data:," alt="b"></p><!-- other -->'
    file = tmp_path / "chapter.html"
    file.write_text(f'<main>{figure.replace("a.svg", "data:,")}</main><script src="{script}"></script>')
    seen = show(file.as_uri())
    assert seen.do("[...document.querySelectorAll('main img')].map((image) => image.alt)") == ["b"]
    assert seen.do("[...document.querySelectorAll('iframe')].map((frame) => [frame.title, frame.getAttribute('src')])") == [["a", "live/x.html#think"]]
