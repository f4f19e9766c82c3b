"""Fingers: swipes scroll the page unless they begin on a handle."""

import pytest
from live import PLANAR, badge, drag, settled, spot

PHONE = {"width": 390, "height": 844, "has_touch": True, "is_mobile": True, "device_scale_factor": 2}


@pytest.fixture
def fingers():
    """Returns a function that moves a finger through Chromium's own touch input: gestures are recognised, and the page
    scrolls.
    """
    sessions = []

    def swipe(seen, from_, to, steps=12):
        session = seen.page.context.new_cdp_session(seen.page)
        sessions.append(session)

        def touch(kind, points):
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y} for x, y in points]})

        touch("touchStart", [from_])
        for i in range(1, steps + 1):
            touch("touchMove", [[a + (b - a) * i / steps for a, b in zip(from_, to)]])
            seen.page.wait_for_timeout(16)
        touch("touchEnd", [])
        seen.page.wait_for_timeout(300)

    yield swipe
    for session in sessions:
        session.detach()


def scrolled(seen):
    return seen.do("window.scrollY")


def test_swipes_scroll_the_page(serve, fingers):
    seen = serve(*PLANAR, **PHONE)
    for panel, empty in [("workspace", [-1.2, 1.2]), ("cspace", [-2.0, -1.5])]:
        x, y = spot(seen, panel, empty)
        before = scrolled(seen)
        assert seen.do("([p, v]) => cplan.editor.itemUnder(cplan.view.panels[p], v, { pointerType: 'touch', clientX: -999, clientY: -999 })", [panel, empty]) is None
        fingers(seen, [x, y], [x, y - 250])
        assert scrolled(seen) > before + 100, panel
        assert seen.do("cplan.view.probe") is None, "a swipe does not try the arm"
    seen.do("window.scrollTo(0, 0)")
    tab = seen.page.get_by_role("tab", name="Plots")
    if tab.count():
        tab.click()
    plot = seen.page.locator(".plots canvas").nth(1)
    plot.scroll_into_view_if_needed()
    before, box = scrolled(seen), plot.bounding_box()
    fingers(seen, [box["x"] + 150, box["y"] + 100], [box["x"] + 150, box["y"] - 150])
    assert scrolled(seen) > before + 100, "plots"


def test_what_begins_on_a_handle_moves_it_and_not_the_page(serve, fingers):
    seen = serve(*PLANAR, **PHONE)
    from_, to = spot(seen, "workspace", [0.65, -1.45]), spot(seen, "workspace", [0.65, -1.25])
    before = scrolled(seen)
    fingers(seen, from_, to)
    settled(seen)
    assert scrolled(seen) == before
    assert seen.do("cplan.scene.obstacles[1].shape.polygon[0]") == pytest.approx([0.5, -1.4], abs=0.03)
    # Start and goal in the configuration space.
    from_, to = spot(seen, "cspace", [1.55, -0.35]), spot(seen, "cspace", [1.9, 0.6])
    before = scrolled(seen)
    fingers(seen, from_, to)
    assert settled(seen)["certified"]
    assert scrolled(seen) == before
    assert seen.do("cplan.scene.goal.joints") == pytest.approx([1.9, 0.6], abs=0.05)


def test_a_tap_tries_the_arm_and_the_cross_can_be_taken(serve, fingers):
    seen = serve(*PLANAR, **PHONE)
    at = spot(seen, "cspace", [-2.0, -1.5])
    seen.page.touchscreen.tap(*at)
    assert seen.do("cplan.view.probe.q") == pytest.approx([-2.0, -1.5], abs=0.05)
    before = scrolled(seen)
    fingers(seen, at, [at[0] + 40, at[1] - 60])
    assert scrolled(seen) == before
    moved = seen.do("cplan.view.probe.q")
    assert moved[0] > -1.8 and moved[1] > -1.2
    seen.page.touchscreen.tap(*spot(seen, "cspace", moved))
    assert seen.do("cplan.view.probe") is None


def test_fingers_move_obstacles_by_their_body_and_corners_in_a_mode(serve, fingers):
    seen = serve(*PLANAR, **PHONE)
    seen.page.touchscreen.tap(*spot(seen, "workspace", [0.65, -1.45]))
    assert seen.do("cplan.editor.selection.index") == 1
    corners = seen.do("cplan.scene.obstacles[1].shape.polygon")
    # Near a corner, a finger takes the whole obstacle.
    near = [0.76, -1.34]
    fingers(seen, spot(seen, "workspace", near), spot(seen, "workspace", [0.86, -1.24]))
    settled(seen)
    moved = seen.do("cplan.scene.obstacles[1].shape.polygon")
    by = [moved[0][k] - corners[0][k] for k in (0, 1)]
    assert by == pytest.approx([0.1, 0.1], abs=0.03)
    assert moved == [pytest.approx([p[k] + by[k] for k in (0, 1)], abs=1e-3) for p in corners]
    toggle = seen.page.get_by_role("button", name="drag corners")
    toggle.click()
    assert toggle.get_attribute("aria-pressed") == "true"
    fingers(seen, spot(seen, "workspace", moved[2]), spot(seen, "workspace", [x + 0.1 for x in moved[2]]))
    settled(seen)
    assert seen.do("cplan.scene.obstacles[1].shape.polygon[2]") == pytest.approx([x + 0.1 for x in moved[2]], abs=0.03)
    assert seen.do("cplan.scene.obstacles[1].shape.polygon[0]") == moved[0]
    toggle.click()
    assert toggle.get_attribute("aria-pressed") == "false"


def test_pictures_outcome_and_tools_are_on_the_first_screen(serve):
    seen = serve(*PLANAR, **PHONE)
    assert scrolled(seen) == 0
    boxes = [seen.page.locator(where).bounding_box() for where in ("h1", "canvas[aria-label='Workspace']", "canvas[aria-label='Configuration space']", ".figures", ".toolbar")]
    bottoms = [box["y"] + box["height"] for box in boxes]
    assert bottoms == sorted(bottoms) and bottoms[-1] <= 844
    assert all(box["height"] > 250 for box in boxes[1:3]), "the pictures take most of it"
    seen.shoot("live-phone")
    # All fields of the inspector are within the width of the screen.
    seen.page.get_by_label("selected", exact=True).select_option("obstacle 1")
    fields = seen.do("[...document.querySelectorAll('.inspector input')].map((input) => input.getBoundingClientRect()).map(({ left, right }) => [left, right])")
    assert len(fields) == 8 and all(0 <= left and right <= 390 for left, right in fields)


def test_two_taps_on_a_side_add_a_corner(serve):
    seen = serve(*PLANAR, **PHONE)
    seen.page.get_by_role("button", name="drag corners").click()
    seen.page.touchscreen.tap(*spot(seen, "workspace", [0.65, -1.45]))
    assert seen.do("cplan.editor.selection.index") == 1
    seen.page.wait_for_timeout(500)
    side = spot(seen, "workspace", [0.65, -1.3])
    for _ in range(2):
        seen.page.touchscreen.tap(*side)
    settled(seen)
    assert len(seen.do("cplan.scene.obstacles[1].shape.polygon")) == 5


def test_pages_by_themselves_scroll_too(program, show_file, fingers):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page, **PHONE)
    box = seen.page.locator("canvas[aria-label='Workspace']").bounding_box()
    before = scrolled(seen)
    fingers(seen, [box["x"] + 200, box["y"] + 250], [box["x"] + 200, box["y"]])
    assert scrolled(seen) > before + 100


def test_nothing_moves_under_the_finger(serve):
    """Selections, errors and running plans change no place of the panels."""
    seen = serve(*PLANAR, **PHONE)
    places = "['Workspace', 'Configuration space'].map((name) => document.querySelector(`canvas[aria-label='${name}']`).getBoundingClientRect().top + window.scrollY)"
    before = seen.do(places)
    for selected in ("obstacle 0", "goal", ""):
        seen.page.get_by_label("selected", exact=True).select_option(selected)
        assert seen.do(places) == before
    seen.do("() => { window.tops = new Set(); const look = () => { tops.add(JSON.stringify(" + places + ")); requestAnimationFrame(look); }; look(); }")
    drag(seen, "workspace", [1.3, 0.24], [0.85, -0.95])
    settled(seen)
    assert "blocked" in badge(seen)
    drag(seen, "cspace", [1.55, -0.35], [2.0, 0.5])
    settled(seen)
    tops = seen.do("[...tops].map((top) => JSON.parse(top))")
    # While the page scrolls, places are rounded to fractions of a pixel.
    assert all(max(top) - min(top) < 1 for top in zip(*tops)), tops


def test_the_lesson_is_in_sight_when_the_course_opens(serve):
    seen = serve(*PLANAR, **PHONE)
    seen.page.get_by_role("button", name="Learn", exact=True).tap()
    in_sight = "(({ top, bottom }) => top >= 0 && bottom < innerHeight)(document.querySelector('.course-head h2').getBoundingClientRect())"
    seen.until(in_sight)
    seen.page.wait_for_timeout(600)
    assert seen.do(in_sight)
