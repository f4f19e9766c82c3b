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


@pytest.mark.parametrize("width", [1280, 390])
def test_the_index_shows_what_each_chapter_is_about(course, show, width):
    seen = show((course / "index.html").as_uri(), width=width)
    assert seen.page.locator(".chapters li").count() == len(CHAPTERS)
    seen.until("[...document.querySelectorAll('.chapters img')].every((img) => img.complete)")
    assert seen.do("[...document.querySelectorAll('.chapters img')].map((img) => img.naturalWidth > 0 && img.clientWidth > 60)") == [True] * len(CHAPTERS)
    assert all(len(text) > 30 for text in seen.page.locator(".chapters p").all_inner_texts())
    assert seen.do("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
    seen.shoot(f"course-index-{width}")


def test_the_printed_sheet_has_room_for_the_name_and_answers(course, show):
    seen = show((course / "exercises.html").as_uri())
    seen.page.emulate_media(media="print")
    assert seen.do("getComputedStyle(document.querySelector('.person'), '::after').borderBottomStyle") == "solid"
    rooms = seen.do("[...document.querySelectorAll('.sheet li')].map((li) => parseFloat(getComputedStyle(li, '::after').height))")
    assert len(rooms) >= 21 and min(rooms) >= 100
    headings = seen.page.locator(".sheet h2 a")
    assert [headings.nth(k).get_attribute("href") for k in range(headings.count())] == [f"{chapter}.html" for chapter in CHAPTERS]
    seen.shoot("course-sheet")


def test_answers_are_apart(course, show):
    seen = show((course / "exercises.html").as_uri())
    questions = seen.page.locator("section > ol > li").count()
    assert questions >= 21 and seen.page.locator("section").count() == len(CHAPTERS)
    seen = show((course / "answers/index.html").as_uri())
    assert seen.page.locator("details[open]").count() == questions
    seen.shoot("course-answers")
