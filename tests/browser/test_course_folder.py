"""The course as pages in a folder, opened without a server."""

import pytest

CHAPTERS = ["c_obstacles", "roadmaps", "cells", "waves", "fields", "proofs", "tasks"]


@pytest.fixture(scope="module")
def course(program):
    folder = program.folder / "course"
    program.run("course", str(folder))
    return folder


@pytest.mark.parametrize("width, height", [(1280, 720), (390, 844)])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_every_chapter_has_its_figure(course, show, width, height, scheme):
    seen = show((course / "index.html").as_uri(), width=width, height=height, color_scheme=scheme)
    for k, chapter in enumerate(CHAPTERS):
        seen.page.locator(".chapters a").nth(k).click()
        assert seen.page.url.endswith(f"/{chapter}.html")
        frame = seen.page.frame_locator("iframe")
        frame.locator(".question").first.wait_for()
        # Once it is seen, the frame is as high as its content, and nothing scrolls sideways.
        figure = next(frame for frame in seen.page.frames if f"/live/{chapter}.html" in frame.url)
        seen.page.locator("iframe").scroll_into_view_if_needed()
        seen.page.wait_for_timeout(400)
        inner, outer = figure.evaluate("cplan.root.getBoundingClientRect().height"), seen.page.locator("iframe").bounding_box()
        assert abs(outer["height"] - inner) < 8, (chapter, inner, outer)
        assert seen.do("document.documentElement.scrollWidth <= document.documentElement.clientWidth"), chapter
        assert seen.page.get_by_role("heading", name="Exercises").count() == 1
        assert "Answer" not in seen.page.locator("main").inner_text()
        seen.shoot(f"course-{chapter}-{width}-{scheme}")
        seen.page.get_by_role("link", name="All chapters").first.click()


def test_answers_are_apart(course, show):
    seen = show((course / "exercises.html").as_uri())
    questions = seen.page.locator("section > ol > li").count()
    assert questions >= 21 and seen.page.locator("section").count() == len(CHAPTERS)
    seen = show((course / "answers/index.html").as_uri())
    assert seen.page.locator("details[open]").count() == questions
    seen.shoot("course-answers")
