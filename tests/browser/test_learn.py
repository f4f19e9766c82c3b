"""Lessons in geometry: the page computes the same values as the program."""

import json
import math
import random
import re

import pytest
from conftest import ROOT
from test_page import CASES, pixels


def learn(seen, lesson="slice"):
    seen.page.get_by_role("button", name="Learn", exact=True).click()
    assert seen.do("(lesson) => cplan.learn.open('c_obstacles', lesson)", lesson)
    assert (seen.do("cplan.mode"), seen.do("cplan.learn.lesson")) == ("learn", lesson)


def rows_of(seen):
    return seen.page.locator(".lesson tbody tr")


def slice_at(seen, part):
    """Returns the slice at this part of joint 1's domain: its value, the obstacles that block all of it, and intervals
    by obstacle.
    """
    seen.do("(part) => cplan.seek(part * cplan.duration)", part)
    return seen.do(
        """() => { const { q1, bands, rows } = cplan.learn.slices.slice; const name = (k) => cplan.world.obstacles[k].name;
             return [q1, bands.map(name), rows.map(({ obstacle, intervals }) => [name(obstacle), intervals.map((ends) => ends.map((end) => [end.value, Boolean(end.features)]))])]; }"""
    )


@pytest.mark.parametrize(("robot", "world"), CASES)
def test_slices_are_those_of_the_program(program, show_file, robot, world):
    page, _ = program.plan(robot, world)
    seen = show_file(page)
    learn(seen)
    low, high = seen.do("cplan.model.arm.joints[1].domain")
    files = [ROOT / f"robots/{robot}.urdf", ROOT / f"workspaces/{world}.toml"]
    contacts = 0

    def touched(q1, q2):
        found = json.loads(program.run("check", *files, f"--at={q1!r},{q2!r}", "--json"))
        return {contact["obstacle"] for contact in found["contacts"]}, found.get("clearance")

    source = random.Random(3)
    for _ in range(4):
        q1, bands, rows = slice_at(seen, source.random())
        places = [low, high]
        for name, intervals in rows:
            for begin, end in intervals:
                for value, is_contact in (begin, end):
                    places.append(value)
                    # At a contact, the distance to the obstacle is zero.
                    by = (high - low) * 1e-3
                    near = touched(q1, value)[1]
                    assert not is_contact or near <= by and name in touched(q1, value - by)[0] | touched(q1, value + by)[0]
                    contacts += is_contact
        places.sort()
        for a, b in zip(places, places[1:]):
            if b - a < 2e-4:
                continue
            middle = (a + b) / 2
            names = {name for name, intervals in rows if any(begin[0] < middle < end[0] for begin, end in intervals)}
            assert touched(q1, middle)[0] == names | set(bands), (q1, middle)
    assert contacts > 0


@pytest.mark.parametrize(("robot", "world"), [("planar_2r", "shelf"), ("l_forearm", "l_hook"), ("slide_arm", "slide_table")])
def test_slices_are_the_exact_ones_of_the_planner(program, show_file, robot, world):
    page, _ = program.plan(robot, world, "--output", "exact.cspace.json")
    exact = json.loads((program.folder / "exact.cspace.json").read_text())["spaces"][0]["rows"]
    seen = show_file(page)
    learn(seen)
    domains = seen.do("cplan.model.arm.joints.map((joint) => joint.domain)")
    values = sorted({row[0][0] for row in exact})
    compared = 0
    for q1 in values[:: len(values) // 12]:
        _, bands, rows = slice_at(seen, (q1 - domains[0][0]) / (domains[0][1] - domains[0][0]))
        assert not bands
        ends = [value for _, intervals in rows for pair in intervals for value, _ in pair] + domains[1]
        for row in exact:
            if row[0][0] == q1:
                # The planner's obstacles are slightly larger.
                assert all(min(abs(end - q[1]) for end in ends) < 2e-3 for q in row), (q1, row, ends)
                compared += 1
    assert compared > 8


def test_a_slice_is_chosen_by_slider_click_and_key_and_says_what_touches(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    before = [pixels(seen, "workspace"), pixels(seen, "cspace")]
    learn(seen)
    assert rows_of(seen).count() == 2, "begins where there is something to see"
    seen.page.get_by_label("time", exact=True).fill("7")
    assert "shoulder 27.7°" in seen.page.locator(".clock").inner_text()
    assert seen.page.locator(".step").inner_text() == "Contacts of elbow here: 2"
    rows = rows_of(seen)
    assert [re.sub(r"\s+", " ", text) for text in rows.all_inner_texts()] == [
        "−82.2° side 3 of forearm on corner 1 of shelf",
        "−36.8° side 1 of forearm on corner 3 of shelf",
    ]
    assert seen.do("cplan.q[1]") == pytest.approx(-1.4346, abs=1e-3)
    chosen = pixels(seen, "workspace")
    rows.nth(1).get_by_role("button").click()
    assert seen.do("cplan.q[1]") == pytest.approx(-0.6417, abs=1e-3) and pixels(seen, "workspace") != chosen
    seen.shoot("learn_slice")
    box = seen.page.locator("canvas[aria-label='Configuration space']").bounding_box()
    spot = seen.do("cplan.panels.cspace.at([-1.2, 0.6])")
    seen.page.mouse.click(box["x"] + spot[0], box["y"] + spot[1])
    assert seen.do("cplan.q[0]") == pytest.approx(-1.2, abs=0.02) and "crate" in rows.first.inner_text()
    # Obstacle by obstacle.
    seen.page.locator("[data-obstacle='crate']").uncheck()
    assert rows.count() == 0
    seen.page.locator("[data-obstacle='crate']").check()
    assert rows.count() == 2
    seen.page.keyboard.press("l")
    assert seen.do("cplan.mode") == "move" and [pixels(seen, "workspace"), pixels(seen, "cspace")] == before


def test_a_link_that_touches_bars_the_whole_slice(program, show_file):
    page, _ = program.plan("planar_2r_continuous", "torus_open")
    seen = show_file(page)
    learn(seen)
    said = set()
    for k in range(60):
        _, bands, _ = slice_at(seen, k / 59)
        text = seen.page.locator(".step").inner_text()
        assert ("Link 1 touches" in text) == bool(bands) and all(name in text for name in bands)
        said.add(bool(bands))
    assert said == {True, False}


# A tool whose corners have few binary digits, so that all implementations agree on touching.
GANTRY = (ROOT / "robots/gantry.urdf").read_text().replace('size="0.1 0.1 0.4"', 'size="0.25 0.125 0.4"')
BARE = re.sub(r'<collision>\s*<origin xyz="0 0.75 0.5"/>.*?</collision>', "", GANTRY, flags=re.S)
WORLD = """name = "tests"
[start]
joints = [0.0625, 0.0625]
[goal]
joints = [0.0625, 0.125]
[[obstacle]]
name = "block"
polygon = {}
"""
BLOCKS = [[[0.75, 0.5], [1.25, 0.5], [1.25, 0.875], [0.75, 0.875]], [[0.5, 0.5], [1.25, 0.75], [0.75, 1.0]]]


@pytest.fixture
def block(program, show_file):
    """Opens the page of a gantry and a block."""
    (program.folder / "bare.urdf").write_text(BARE)

    def open_(corners):
        (program.folder / "block.toml").write_text(WORLD.format(corners))
        program.run("bare.urdf", "block.toml", "--quiet", "--picture", "block.html", "--output", "block.cspace.json")
        return show_file(program.folder / "block.html")

    return open_


@pytest.mark.parametrize("corners", BLOCKS, ids=["square", "triangle"])
def test_both_tests_of_penetration_are_the_programs(program, block, corners):
    seen = block(corners)
    learn(seen, "tests")
    source = random.Random(7)
    kinds = set()
    for _ in range(40):
        # Sixteenths, so that corners sometimes lie on sides and on other corners.
        at = [source.randint(5, 22) / 16, source.randint(5, 18) / 16]
        seen.do("(at) => { cplan.learn.pair.pieces.at = at; cplan.learn.changed(); }", at)
        test = seen.do("cplan.learn.pair.test()")
        moved, rests = seen.do("[cplan.learn.pair.moved, cplan.learn.pair.pieces.b]")
        said = json.loads(program.run("check", "bare.urdf", "block.toml", f"--at={at[0]},{at[1]}", "--json"))["contacts"]
        assert test["meet"] == bool(said)
        found = said[0] if said else {"link_corners_inside": [], "obstacle_corners_inside": [], "crossing_sides": []}

        def inside(points, tests):
            return sorted((*p, t["depth"]) for p, t in zip(points, tests) if t["inside"])

        for points, tests, key in ((moved, test["mine"], "link_corners_inside"), (rests, test["others"], "obstacle_corners_inside")):
            expected = sorted((*corner["at"], corner["depth"]) for corner in found[key])
            assert [pytest.approx(e, abs=1e-9) for e in expected] == inside(points, tests), at
        sides = [[[p[i], p[(i + 1) % len(p)]] for p, i in ((moved, i), (rests, k))] for i, k in test["crossings"]]
        assert sorted(sides) == sorted(found["crossing_sides"])
        kinds.add((bool(test["crossings"]), bool(said)))
    assert kinds == {(True, True), (False, True), (False, False)}
    seen.shoot("learn_tests")


@pytest.mark.parametrize("corners", BLOCKS, ids=["square", "triangle"])
def test_the_difference_is_swept_to_the_c_obstacle(program, block, corners):
    seen = block(corners)
    learn(seen, "sweep")
    steps = seen.do("cplan.learn.pair.steps")
    # Parallel sides of the block and of the tool are merged.
    assert len(steps) == (4 if len(corners) == 4 else 7)
    assert {step["of"] for step in steps} == ({"both"} if len(corners) == 4 else {"a", "b"})
    swept = seen.do("cplan.learn.pair.steps.map((step) => cplan.learn.pair.placeOf(step.at))")
    exact = json.loads((program.folder / "block.cspace.json").read_text())["spaces"][0]["c_obstacles"]
    ring = exact[0]["polygons"][0][0]
    assert len(ring) - 1 == len(swept) and all(min(math.dist(p, q) for q in ring) < 1e-3 for p in swept)
    shown = []
    for step in range(len(steps)):
        seen.do("([k, n]) => cplan.seek((k + 0.5) / n * cplan.duration)", [step, len(steps)])
        i, k = steps[step]["i"] + 1, steps[step]["k"] + 1
        assert seen.page.locator(".step").inner_text().startswith(f"Step {step + 1}: corner b{k} − a{i}; next by its angle: ")
        shown.append(seen.do("cplan.learn.pair.panels.right.canvas.toDataURL()"))
    assert len(set(shown)) == len(steps)
    seen.shoot("learn_sweep")


def test_polygons_are_dragged_by_pointer_and_keys_and_stay_convex(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    learn(seen, "tests")
    canvas = seen.page.get_by_label("Two polygons: drag them and their corners")
    box = canvas.bounding_box()

    def drag(place, by):
        x, y = seen.do("(p) => cplan.learn.pair.panels.left.at(p)", place)
        seen.page.mouse.move(box["x"] + x, box["y"] + y)
        seen.page.mouse.down()
        seen.page.mouse.move(box["x"] + x + by[0], box["y"] + y + by[1], steps=4)
        seen.page.mouse.up()

    assert seen.page.locator(".step").inner_text() == "They meet. Corners within the other one: 1; crossings of sides: 2"
    corner = seen.do("cplan.learn.pair.pieces.b[2]")
    drag(corner, (30, -25))
    after = seen.do("cplan.learn.pair.pieces.b")
    assert after[2][0] > corner[0] and after[2][1] > corner[1]
    # Beyond the opposite corner, the polygon would not be convex.
    drag(after[2], (-600, 400))
    turns = seen.do(
        """cplan.learn.pair.pieces.b.map((p, i, all) => { const [q, r] = [1, 2].map((k) => all[(i + k) % all.length]);
             return Contact.cross(Contact.minus(q, p), Contact.minus(r, q)); })"""
    )
    assert min(turns) > 0
    canvas.focus()
    for _ in range(12):
        seen.page.keyboard.press("Shift+ArrowDown")
    assert seen.page.locator(".step").inner_text() == "They do not meet." and "deep" not in seen.page.locator(".lesson").inner_text()


def test_a_link_that_turns_has_a_difference_for_each_angle(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    learn(seen, "stack")
    shown = set()
    for part in (0, 0.3, 0.6):
        seen.do("(part) => cplan.seek(part * cplan.duration)", part)
        # The origin of the link is in the difference exactly if the polygons meet.
        for dx in (-0.4, -0.1, 0, 0.2, 0.7):
            seen.do("(dx) => { const [x, y] = cplan.learn.pair.pieces.b[0]; cplan.learn.pair.pieces.at = [x + dx, y + 0.04]; }", dx)
            inside = "Contact.pointTest(cplan.learn.pair.pieces.at, cplan.learn.pair.steps.map((step) => step.at)).inside"
            assert seen.do(inside) == seen.do("cplan.learn.pair.test().meet")
        seen.do("cplan.learn.changed()")
        shown.add(seen.do("cplan.learn.pair.panels.right.canvas.toDataURL()"))
    assert len(shown) == 3
    seen.shoot("learn_stack")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_lessons_fit_a_phone_and_all_controls_have_names(program, show_file, scheme):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page, width=360, height=740, color_scheme=scheme)
    for lesson in ("slice", "tests", "sweep", "stack"):
        learn(seen, lesson)
        assert seen.do("document.documentElement.scrollWidth <= innerWidth"), lesson
        nameless = seen.do(
            """[...document.querySelectorAll('button, input, select, canvas')].filter((e) =>
                 !(e.getAttribute('aria-label') || e.closest('label, button')?.textContent.trim())).length"""
        )
        assert nameless == 0
        seen.shoot(f"learn_phone_{lesson}_{scheme}")


HEADING_IS_IN_SIGHT = "(({ top, bottom }) => top >= 0 && bottom < innerHeight / 2)(document.querySelector('.course-head h2').getBoundingClientRect())"


@pytest.mark.parametrize("motion", ["reduce", "no-preference"])
@pytest.mark.parametrize("scrolled", [90, 270])
def test_a_phone_scrolls_to_the_lesson_when_the_course_opens(program, show_file, scrolled, motion):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page, width=390, height=844, has_touch=True, is_mobile=True, reduced_motion=motion)
    seen.do("(y) => scrollTo(0, y)", scrolled)
    seen.page.get_by_role("button", name="Learn", exact=True).tap()
    seen.until(HEADING_IS_IN_SIGHT)
    # The browser's own scrolling, which keeps old content in place, is over as well.
    seen.page.wait_for_timeout(600)
    assert seen.do(HEADING_IS_IN_SIGHT)


def test_there_are_lessons_only_where_there_is_something_to_learn_from(program, show_file):
    program.run("inspect", ROOT / "robots/planar_2r.urdf", "--picture", "inspect.html")
    assert show_file(program.folder / "inspect.html").page.get_by_role("button", name="Learn").is_hidden()
    page, _ = program.plan("gantry", "gantry_maze")
    seen = show_file(page)
    learn(seen)
    lessons = seen.do("cplan.learn.chapters[0].lessons.map((lesson) => lesson.name)")
    assert lessons == ["point", "slice", "tests", "sweep"], "a gantry does not turn"


def test_an_address_says_what_is_looked_at_first(program, show):
    page, _ = program.plan("planar_2r", "shelf")
    for address, mode, lesson in (
        ("", "move", "point"), ("#think", "think", "point"), ("#learn", "learn", "point"), ("#learn/sweep", "learn", "sweep"), ("#learn=c_obstacles", "learn", "point"),
        ("#learn=c_obstacles/stack", "learn", "stack"), ("#learn=proofs", "learn", "certified"), ("#learn=proofs/clearance", "learn", "clearance"), ("#learn/x", "learn", "point"),
    ):
        seen = show(page.as_uri() + address)
        assert (seen.do("cplan.mode"), seen.do("cplan.learn.lesson")) == (mode, lesson), address
    seen.do("location.hash = '#learn=roadmaps'")
    seen.until("cplan.learn.lesson === 'graph'")


def test_the_heading_is_that_of_the_course_until_it_is_left(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    heading, result = seen.page.locator("h1"), seen.page.locator("h1").inner_text()
    learn(seen, "sweep")
    assert heading.inner_text() == "Learn: C-obstacles" and not seen.page.locator(".status").is_visible()
    assert "short lessons with questions" in seen.page.locator(".lines").inner_text()
    # The button that checks the answer is the prominent one.
    next_ = seen.page.get_by_role("button", name="Next", exact=True)
    assert "primary" not in next_.get_attribute("class")
    seen.do("cplan.learn.solve()")
    assert "primary" in next_.get_attribute("class") and "1 solved" in seen.page.locator(".lines").inner_text()
    seen.page.get_by_role("button", name="Motion", exact=True).click()
    assert heading.inner_text() == result and seen.page.locator(".status").is_visible()


def test_the_legend_names_what_lessons_draw(program, show_file):
    page, _ = program.plan("planar_2r", "workbench", "--planner", "visibility")
    seen = show_file(page)
    legend = lambda: seen.page.locator(".legend li:visible").all_inner_texts()
    moves = legend()
    assert {"path, and trace of the tip", "start", "goal"} <= set(moves)
    learn(seen)
    assert set(moves) - set(legend()) == {"path, and trace of the tip", "poses along the path"}
    seen.page.get_by_role("button", name="How it was found", exact=True).click()
    assert set(legend()) - set(moves) == {"reduced visibility graph"}
    seen.page.get_by_role("button", name="Motion", exact=True).click()
    assert legend() == moves


def test_the_text_is_beside_the_figure_and_next_is_at_it(program, show):
    page, _ = program.plan("planar_2r", "shelf")
    for width, height in [(1400, 900), (1100, 800)]:
        seen = show(f"{page.as_uri()}#learn=c_obstacles/sweep", width=width, height=height)
        text, question, following, figure = (seen.page.locator(name).bounding_box() for name in (".course-head", ".course-foot", ".course-steps", ".pictures > .panels:not([hidden])"))
        for box in (text, question, following):
            assert box["x"] + box["width"] <= figure["x"], "a column of its own"
            assert box["y"] + box["height"] <= height, "without scrolling"
        assert abs(text["y"] - figure["y"]) < 24
        seen.shoot(f"learn-{width}")
    phone = show(f"{page.as_uri()}#learn=c_obstacles/sweep", width=390, height=844, has_touch=True, is_mobile=True)
    following, figure = (phone.page.locator(name).bounding_box() for name in (".course-steps", ".pictures > .panels:not([hidden])"))
    assert 0 <= figure["y"] - (following["y"] + following["height"]) < 24
    phone.page.get_by_role("button", name="Next", exact=True).click()
    assert phone.do("location.hash") == "#learn=c_obstacles/stack"
