"""The course of the book: its live figures, and how they are loaded."""

import math
import re
import shlex

import pytest
from conftest import ROOT

LIVE = re.compile(r"^!\[.*\]\((.*)\)\n<!-- live: (\w+\.html)#learn=(\w+) -->$", re.M)
CHAPTERS = {path.stem: path.read_text() for path in sorted(ROOT.glob("docs/*.md")) if LIVE.search(path.read_text())}


# Lessons whose figure has nothing to play.
STILL = {"tests"}


def written(program, chapter):
    """Writes the page of a chapter by the chapter's own command."""
    text = CHAPTERS[chapter]
    _, page, _ = LIVE.search(text).groups()
    mark, command = re.search(rf"(<!-- exit: 3 -->\n)?```sh\ncplan (.* --picture {page})\n```", text).groups()
    program.run(*[str(ROOT / word) if word.endswith((".urdf", ".toml")) else word for word in shlex.split(command)], code=3 if mark else 0)
    return program.folder / page


def lessons_of(seen, chapter):
    return seen.do("(name) => cplan.learn.chapters.find((one) => one.name === name).lessons.map((lesson) => lesson.name)", chapter)


def click(seen, q):
    """Clicks on a configuration."""
    seen.do("cplan.examine(null)")
    canvas = seen.page.locator("canvas[aria-label='Configuration space']")
    canvas.scroll_into_view_if_needed()
    x, y = seen.do("(q) => cplan.panels.cspace.at(q)", q)
    canvas.click(position={"x": x, "y": y})


def answer(seen, value):
    """Enters a number or chooses an option, and checks it. Returns whether it is right, and the feedback."""
    form = seen.page.locator(".question")
    if form.locator("input[type=radio]").count():
        form.locator("input[type=radio]").nth(value).check()
    elif form.locator("input").count():
        form.locator("input").fill(str(value))
    return check(seen)


def check(seen):
    form = seen.page.locator(".question")
    form.get_by_role("button", name="Check").click()
    feedback = form.locator(".feedback")
    return feedback.get_attribute("data-right") == "true", feedback.inner_text()


def refused(outcome):
    is_right, text = outcome
    assert text.startswith("Not yet. ") and len(text) > len("Not yet. ") + 10, text
    return not is_right


def accepted(outcome):
    is_right, text = outcome
    assert text.startswith("Right. ") or not is_right, text
    return is_right


def test_the_chapters_of_the_book_are_those_of_the_page():
    assert sorted(CHAPTERS) == sorted(["c_obstacles", "roadmaps", "cells", "waves", "fields", "proofs", "tasks"])


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_a_chapter_opens_in_the_course_of_its_page(program, show, chapter):
    file = written(program, chapter)
    assert file.stat().st_size < 620_000
    seen = show(f"{file.as_uri()}#learn={chapter}")
    lessons = lessons_of(seen, chapter)
    assert (seen.do("cplan.mode"), seen.do("cplan.learn.lesson")) == ("learn", lessons[0]) and len(lessons) > 1
    assert seen.page.get_by_label("chapter", exact=True).input_value() == chapter
    for number, lesson in enumerate(lessons, 1):
        assert seen.do("cplan.learn.lesson") == lesson
        assert seen.page.locator(".progress [aria-current]").get_attribute("aria-label").startswith(f"{number}: ")
        assert 20 < len(seen.page.locator(".course-head .text").inner_text().split()) <= 60, lesson
        assert seen.page.locator(".prompt").inner_text().endswith(("?", ".")), lesson
        # Its figure moves.
        figure = "cplan.learn.figure === 'pair' ? [cplan.learn.pair.panels.left, cplan.learn.pair.panels.right] : Object.values(cplan.panels)"
        at = set()
        for part in (0.1, 0.5, 0.9):
            seen.do("(part) => cplan.seek(part * cplan.duration)", part)
            at.add(seen.do(f"({figure}).map((panel) => panel.canvas.toDataURL()).join()"))
        # The proof is complete before its last phase ends.
        assert len(at) == (1 if lesson in STILL or not seen.do("cplan.duration") else 3), lesson
        seen.shoot(f"course_{chapter}_{lesson}")
        # Without an answer, the next lesson is open.
        button = seen.page.get_by_role("button", name=re.compile("^Next"))
        if number < len(lessons):
            button.click()


def answers(seen, lesson):
    """Tries a wrong answer and the right one. The right one is computed here, from the data of the page."""
    do = seen.do
    model = "cplan.model"
    if lesson == "point":
        assert refused(check(seen)), "nothing was chosen"
        click(seen, do(f"{model}.start"))
        assert refused(check(seen)), "the start is free"
        wanted = do(f"{model}.worlds[0].c_obstacles[0].obstacle")
        touching = """(wanted) => { for (let x = -1.5; x < 1.5; x += 0.1) for (let y = -1.5; y < 1.5; y += 0.1) {
            const hits = Geometry.contacts(cplan.model.arm, cplan.world, [x, y]).filter((one) => one.distance < -0.01);
            if (hits.some((one) => one.obstacle === wanted)) return [x, y]; } }"""
        click(seen, do(touching, wanted))
        return accepted(check(seen))
    if lesson == "slice":
        assert refused(answer(seen, "no")) and refused(answer(seen, -1))
        ends = do("cplan.learn.slices.slice.rows[0].intervals[0].map((end) => end.value)")
        return accepted(answer(seen, f"{math.degrees(ends[1] - ends[0]):.1f}".replace(".", ",")))
    if lesson == "tests":
        test = do("cplan.learn.pair.test()")
        corners = sum(one["inside"] for one in test["mine"] + test["others"])
        right = 2 if corners and test["crossings"] else 0 if corners else 1 if test["crossings"] else 3
        assert refused(answer(seen, (right + 1) % 4))
        return accepted(answer(seen, right))
    if lesson == "sweep":
        directions = set()
        for name, sign in (("a", -1), ("b", 1)):
            corners = do(f"cplan.learn.pair.pieces.{name}")
            for p, q in zip(corners, corners[1:] + corners[:1]):
                directions.add(round(math.atan2(sign * (q[1] - p[1]), sign * (q[0] - p[0])) % (2 * math.pi), 4))
        assert refused(answer(seen, len(directions) - 1))
        return accepted(answer(seen, len(directions)))
    if lesson == "stack":
        count = 0
        for k in range(12):
            do("(k) => cplan.seek(k / 12 * cplan.duration)", k)
            count += do("cplan.learn.pair.test().meet")
        assert 0 < count < 12 and refused(answer(seen, count + 1))
        return accepted(answer(seen, count))
    if lesson == "graph":
        start = do(f"{model}.paths[0].points.slice(0, 2)")
        click(seen, [start[0] - 0.6, start[1] - 0.4])
        assert refused(check(seen))
        points = do(f"{model}.paths[0].points")
        places = list(zip(points[::2], points[1::2]))
        # The least value of joint 2 on this path is at a bend.
        click(seen, min(places[5:-5], key=lambda q: q[1]))
        return accepted(check(seen))
    if lesson == "detour":
        points = do(f"{model}.paths[0].points")
        places = list(zip(points[::2], points[1::2]))
        more = 100 * (sum(math.dist(p, q) for p, q in zip(places, places[1:])) / math.dist(places[0], places[-1]) - 1)
        assert refused(answer(seen, round(more / 2)))
        return accepted(answer(seen, f"{more:.1f} %"))
    if lesson == "convex":
        cells, channel = do("[cplan.world.trace.cells, cplan.world.trace.channel]")
        middle = lambda cell: [sum(cell[k::2]) / (len(cell) // 2) for k in (0, 1)]
        area = lambda cell: abs(sum(cell[i] * cell[(i + 3) % len(cell)] - cell[(i + 2) % len(cell)] * cell[i + 1] for i in range(0, len(cell), 2)))
        other = max((cell for k, cell in enumerate(cells) if k not in channel), key=area)
        click(seen, middle(other))
        assert refused(check(seen))
        click(seen, middle(max((cells[k] for k in channel), key=area)))
        return accepted(check(seen))
    if lesson == "portals":
        count = len(do("cplan.world.trace.channel"))
        assert refused(answer(seen, count))
        return accepted(answer(seen, count - 1))
    if lesson == "labels":
        points = do(f"{model}.paths[0].points")
        click(seen, points[-2:])
        assert refused(check(seen)), "the goal has the label 0"
        low = do(f"{model}.arm.joints.map((joint) => joint.domain[0] + 0.02)")
        high = do(f"{model}.arm.joints.map((joint) => joint.domain[1] - 0.02)")
        click(seen, [low[0], high[1]])
        return accepted(check(seen))
    if lesson == "moves":
        start = [int(n) for n in re.findall(r"column (\d+), row (\d+)", seen.page.locator(".prompt").inner_text())[0]]
        goal = [int(n) for n in re.findall(r"column (\d+), row (\d+)", seen.page.locator(".prompt").inner_text())[1]]
        moves = sum(abs(a - b) for a, b in zip(start, goal))
        assert refused(answer(seen, moves + 1))
        return accepted(answer(seen, moves))
    if lesson == "minimum":
        points = do(f"{model}.paths[0].points")
        click(seen, points[:2])
        assert refused(check(seen))
        click(seen, points[-2:])
        return accepted(check(seen))
    if lesson == "slope":
        assert refused(answer(seen, 0)) and refused(answer(seen, 1))
        return accepted(answer(seen, 2))
    if lesson == "certified":
        gap, moved = re.findall(r"([\d.]+) (m|mm)\b", seen.page.locator(".prompt").inner_text())
        metres = lambda text: float(text[0]) * (0.001 if text[1] == "mm" else 1)
        right = 0 if metres(moved) < metres(gap) else 2
        assert refused(answer(seen, 1)) and refused(answer(seen, 2 - right))
        return accepted(answer(seen, right))
    if lesson == "clearance":
        do("cplan.seek(0)")
        assert refused(check(seen))
        nearest = """(() => { let [best, least] = [0, Infinity];
            for (let k = 0; k <= 300; k += 1) { cplan.seek(k / 300 * cplan.duration); const d = Geometry.contacts(cplan.model.arm, cplan.world, cplan.q)[0].distance;
              if (d < least) [best, least] = [cplan.time, d]; }
            cplan.seek(best); })()"""
        do(nearest)
        return accepted(check(seen))
    if lesson == "collision_boxes":
        proof = do("cplan.world.proof")
        click(seen, do(f"{model}.start"))
        assert refused(check(seen))
        click(seen, [(proof[0] + proof[2]) / 2, (proof[1] + proof[3]) / 2 + 0.3])
        return accepted(check(seen))
    if lesson == "walls":
        assert refused(answer(seen, 1))
        return accepted(answer(seen, 2))
    if lesson == "spaces":
        do("cplan.seek(0)")
        assert refused(check(seen))
        do("cplan.seek(cplan.model.motions.find(({ world }) => cplan.model.worlds[world].payload).from + 1e-3)")
        return accepted(check(seen))
    if lesson == "carrying":
        assert refused(answer(seen, 5))
        return accepted(answer(seen, 2))
    raise AssertionError(f"no answer to {lesson} is known")


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_questions_accept_the_right_answer_and_refuse_a_wrong_one_with_a_hint(program, show, chapter):
    seen = show(f"{written(program, chapter).as_uri()}#learn={chapter}")
    lessons = lessons_of(seen, chapter)
    for lesson in lessons:
        seen.do("([chapter, lesson]) => cplan.learn.open(chapter, lesson)", [chapter, lesson])
        assert answers(seen, lesson), (lesson, seen.page.locator(".feedback").inner_text())
    assert seen.page.locator(".progress .solved").count() == len(lessons)
    seen.shoot(f"course_{chapter}_solved")
    # Another visit knows that.
    seen.page.reload()
    assert seen.page.locator(".progress .solved").count() == len(lessons)
    label = seen.page.locator(".progress button").first.get_attribute("aria-label")
    assert label.startswith("1: ") and label.endswith(", solved")


@pytest.mark.parametrize(("planner", "chapter", "lessons"), [
    ("shortest", "roadmaps", ["graph", "detour"]), ("prm", "roadmaps", ["graph", "detour"]), ("voronoi", "roadmaps", ["graph", "detour"]),
    ("triangles", "cells", ["convex", "portals"]), ("subdivision", "cells", ["boxes", "splits"]), ("harmonic", "fields", ["minimum", "slope"]),
])
def test_each_planner_has_the_chapter_about_its_method(program, show, planner, chapter, lessons):
    page, _ = program.plan("planar_2r", "workbench", "--planner", planner)
    seen = show(f"{page.as_uri()}#learn={chapter}")
    assert seen.do("cplan.learn.chapters.map((one) => one.name)") == ["c_obstacles", chapter, "proofs"]
    assert lessons_of(seen, chapter) == lessons
    if planner == "voronoi":
        edges = seen.do("cplan.world.trace.edges")
        click(seen, [edges[0], edges[1]])
        assert accepted(check(seen))
    if planner == "subdivision":
        free, mixed = seen.do("[cplan.world.trace.free, cplan.world.trace.mixed]")
        largest = lambda flat: max((flat[k : k + 4] for k in range(0, len(flat), 4)), key=lambda box: (box[2] - box[0]) * (box[3] - box[1]))
        for boxes, right in ((mixed, False), (free, True)):
            x0, y0, x1, y1 = largest(boxes)
            click(seen, [(x0 + x1) / 2, (y0 + y1) / 2])
            assert check(seen)[0] == right
        seen.page.get_by_role("button", name="Next", exact=True).click()
        share = int(re.search(r"the (\d+)th part", seen.page.locator(".course-head .text").inner_text()).group(1))
        assert refused(answer(seen, 3)) and accepted(answer(seen, share.bit_length() - 1))


def test_answers_never_block_and_the_course_works_without_a_memory(program, show):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show("about:blank")
    seen.page.add_init_script("Object.defineProperty(window, 'localStorage', { get() { throw new Error('no memory'); } });")
    seen.page.goto(f"{page.as_uri()}#learn")
    assert refused(check(seen))
    names = []
    while True:
        names.append(seen.do("cplan.learn.lesson"))
        button = seen.page.get_by_role("button", name=re.compile("^Next"))
        if button.is_disabled():
            break
        button.click()
    assert names == ["point", "slice", "tests", "sweep", "stack", "graph", "detour", "certified", "clearance"]
    seen.page.get_by_role("button", name="Back", exact=True).click()
    assert seen.do("cplan.learn.lesson") == "certified"
    # The keyboard alone is enough: arrow keys place the arm, and Enter checks a number.
    seen.do("cplan.learn.open('sweep')")
    seen.page.locator(".question input").fill(str(len(seen.do("cplan.learn.pair.steps"))))
    seen.page.keyboard.press("Enter")
    assert seen.page.locator(".feedback").inner_text().startswith("Right. ")
    # The answer is no shortcut of the page.
    assert seen.do("cplan.mode") == "learn"


def test_a_live_figure_takes_the_place_of_the_picture(show, tmp_path):
    script = (ROOT / "docs/live.js").as_uri()
    figure = '<p><img src="a.svg" alt="a"> <!-- live: x.html#think --></p><p><img src="data:," alt="b"></p><!-- other -->'
    file = tmp_path / "chapter.html"
    file.write_text(f'<main>{figure.replace("a.svg", "data:,")}</main><script src="{script}"></script>')
    seen = show(file.as_uri())
    assert seen.do("[...document.querySelectorAll('main img')].map((image) => image.alt)") == ["b"]
    assert seen.do("[...document.querySelectorAll('iframe')].map((frame) => [frame.title, frame.getAttribute('src')])") == [["a", "live/x.html#think"]]


@pytest.mark.parametrize(("width", "room", "beside"), [(1280, 1000, True), (700, 668, True), (390, 358, False)])
def test_a_live_figure_fits_its_frame(program, show, tmp_path, width, room, beside):
    page, _ = program.plan("planar_2r", "shelf")
    (tmp_path / "live").mkdir()
    (tmp_path / "live/x.html").write_text(page.read_text())
    script = (ROOT / "docs/live.js").as_uri()
    figure = '<p><img src="data:," alt="a"> <!-- live: x.html#learn=c_obstacles --></p>'
    file = tmp_path / "chapter.html"
    file.write_text(
        f'<meta name="viewport" content="width=device-width"><body style="margin:0"><div id="content"><main style="max-width:750px;margin:0 auto">{figure}</main></div><script src="{script}"></script>'
    )
    seen = show(file.as_uri(), width=width, height=800)
    element = seen.page.locator("iframe")
    frame = element.element_handle().content_frame()
    frame.wait_for_selector(".embedded .course-head")
    for lesson in ("point", "slice", "sweep"):
        frame.evaluate("(lesson) => cplan.learn.open(lesson)", lesson)
        seen.page.wait_for_timeout(300)
        box, content = element.bounding_box(), frame.evaluate("document.querySelector('main').getBoundingClientRect().height")
        assert box["width"] == pytest.approx(room, abs=2)
        assert content <= box["height"] <= content + 8, "as high as its content"
        assert frame.evaluate("document.documentElement.scrollWidth") <= box["width"] + 1
        # Nothing of the page around the lesson, but both spaces in sight.
        for left_out in ("h1", ".status", ".side", ".modes", ".cards"):
            assert frame.locator(left_out).first.is_hidden(), left_out
        if lesson != "sweep":
            boxes = [frame.locator(f"canvas[aria-label='{name}']").bounding_box() for name in ("Workspace", "Configuration space")]
            assert (boxes[1]["x"] > boxes[0]["x"] + boxes[0]["width"]) == beside
            assert boxes[1]["y"] + boxes[1]["height"] <= box["y"] + box["height"]
    seen.shoot(f"embedded-{width}")


def test_the_address_names_the_lesson(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    seen.do("cplan.switchTo('learn')")
    seen.do("cplan.learn.open('c_obstacles', 'tests')")
    assert seen.do("location.hash") == "#learn=c_obstacles/tests"
    seen.page.reload()
    assert seen.do("[cplan.mode, cplan.learn.lesson]") == ["learn", "tests"], "the address opens it again"
    seen.do("cplan.switchTo('move')")
    assert seen.do("location.hash") == "#move"
