"""Narrow passages are less than a pixel wide, so both panels can be magnified."""

import pytest
from live import PLANAR, settled
from test_page import pixels


def place(seen, panel, value, view="cplan"):
    """Returns the place on the screen for a value in a panel."""
    box = seen.page.locator("canvas[aria-label='%s']" % {"workspace": "Workspace", "cspace": "Configuration space"}[panel]).bounding_box()
    x, y = seen.do(f"([panel, value]) => {view}.panels[panel].at(value)", [panel, value])
    return box["x"] + x, box["y"] + y


def shown(seen, panel, view="cplan"):
    return seen.do(f"(panel) => {view}.panels[panel].shown", panel)


def width(ranges):
    return ranges[0][1] - ranges[0][0]


@pytest.fixture
def slot(program, show_file):
    page, _ = program.plan("planar_2r", "narrow_slot")
    return show_file(page)


@pytest.mark.parametrize("panel", ["workspace", "cspace"])
def test_the_wheel_magnifies_what_is_under_the_pointer(slot, panel):
    whole, before = shown(slot, panel), pixels(slot, panel)
    # Wheels report whole pixels.
    box = slot.page.locator("canvas").nth(["workspace", "cspace"].index(panel)).bounding_box()
    at = [round(box["x"] + box["width"] * 0.6), round(box["y"] + box["height"] * 0.4)]
    value = slot.do("([panel, spot]) => cplan.panels[panel].value(spot)", [panel, [at[0] - box["x"], at[1] - box["y"]]])
    slot.page.mouse.move(*at)
    for _ in range(6):
        slot.page.mouse.wheel(0, -300)
    slot.until(f"cplan.panels.{panel}.times > 20")
    now = shown(slot, panel)
    assert width(now) < width(whole) / 20
    assert all(a <= c and d <= b for (a, b), (c, d) in zip(whole, now)), "within what there is"
    assert place(slot, panel, value) == pytest.approx(at, abs=1)
    slot.until(f"!cplan.panels.{panel}.dirty")
    assert pixels(slot, panel) != before
    slot.shoot(f"zoom-{panel}")
    # The dragged content follows the pointer.
    slot.page.mouse.down()
    slot.page.mouse.move(at[0] + 60, at[1] - 30, steps=4)
    slot.page.mouse.up()
    assert place(slot, panel, value) == pytest.approx((at[0] + 60, at[1] - 30), abs=1)
    slot.page.mouse.dblclick(*at)
    assert shown(slot, panel) == whole


def test_ticks_become_finer_and_no_two_are_alike(slot):
    slot.do("cplan.panels.cspace.magnify(1000, [300, 200])")
    texts = slot.do(
        """() => { const { shown, rect, degrees, digits } = cplan.panels.cspace;
             return [0, 1].map((k) => ticks(...shown[k], degrees[k], [rect.width, rect.height][k], [56 + 1.4 * digits, 34][k]).map((t) => t.text)); }"""
    )
    for axis in texts:
        assert 2 <= len(axis) == len(set(axis))
        assert all(text.endswith("\u00b0") and "." in text for text in axis), axis


def test_a_wheel_turned_down_scrolls_the_page_where_nothing_is_magnified(slot):
    slot.page.mouse.move(*place(slot, "cspace", [0.3, 0.4]))
    slot.page.mouse.wheel(0, 200)
    slot.until("window.scrollY > 0")
    assert slot.do("cplan.panels.cspace.times") == 1
    # Scrolling continues, also upwards.
    slot.page.mouse.wheel(0, -100)
    assert slot.do("cplan.panels.cspace.times") == 1


def test_keys_and_buttons_magnify(slot):
    keyboard = slot.page.keyboard
    canvas = slot.page.locator("canvas[aria-label='Workspace']")
    canvas.focus()
    whole = shown(slot, "workspace")
    keyboard.press("+")
    keyboard.press("+")
    assert width(shown(slot, "workspace")) == pytest.approx(width(whole) / 2.25)
    assert slot.do("cplan.speed") == 1, "elsewhere it plays faster"
    before = shown(slot, "workspace")
    keyboard.press("Shift+ArrowRight")
    assert shown(slot, "workspace")[0][0] > before[0][0] and slot.do("cplan.time") == 0
    keyboard.press("-")
    assert width(shown(slot, "workspace")) == pytest.approx(width(whole) / 1.5)
    keyboard.press("0")
    assert shown(slot, "workspace") == whole
    for name, times in [("zoom in", 1.5), ("zoom in", 2.25), ("zoom out", 1.5), ("show all", 1)]:
        slot.page.get_by_role("button", name=f"{name}: Configuration space").click()
        assert slot.do("cplan.panels.cspace.times") == pytest.approx(times)


def test_what_is_magnified_follows_the_cross(slot):
    slot.page.locator("canvas[aria-label='Configuration space']").focus()
    for _ in range(12):
        slot.page.keyboard.press("+")
    times = slot.do("cplan.panels.cspace.times")
    before = slot.do("cplan.q")
    slot.page.keyboard.press("ArrowRight")
    q = slot.do("cplan.probe.q")
    assert q[0] - before[0] == pytest.approx(3.14159265 / 180 / times, rel=1e-6), "finer steps"
    (a, b), (c, d) = shown(slot, "cspace")
    assert a <= q[0] <= b and c <= q[1] <= d


def test_two_fingers_magnify_and_one_moves(program, show_file):
    page, _ = program.plan("planar_2r", "narrow_slot")
    seen = show_file(page, width=390, height=844, has_touch=True, is_mobile=True, device_scale_factor=2)
    x, y = place(seen, "cspace", [0.3, 0.4])
    session = seen.page.context.new_cdp_session(seen.page)

    def touch(kind, *points):
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": a, "y": b, "id": i} for i, (a, b) in enumerate(points)]})

    touch("touchStart", (x - 20, y))
    touch("touchStart", (x - 20, y), (x + 20, y))
    for k in range(1, 7):
        touch("touchMove", (x - 20 - 10 * k, y), (x + 20 + 10 * k, y))
    touch("touchEnd")
    assert seen.do("cplan.panels.cspace.times") == pytest.approx(4, rel=0.05)
    assert place(seen, "cspace", [0.3, 0.4]) == pytest.approx((x, y), abs=2)
    assert seen.do("cplan.probe") is None and seen.do("visualViewport.scale") == 1
    touch("touchStart", (x, y))
    for k in range(1, 7):
        touch("touchMove", (x + 8 * k, y + 5 * k))
    touch("touchEnd")
    assert place(seen, "cspace", [0.3, 0.4]) == pytest.approx((x + 48, y + 30), abs=9)
    assert seen.do("window.scrollY") == 0
    session.detach()


def test_the_live_page_is_dragged_in_what_is_magnified(serve):
    seen = serve(*PLANAR)
    seen.page.mouse.move(*place(seen, "workspace", [0.65, -1.45], "cplan.view"))
    seen.page.mouse.wheel(0, -300)
    seen.until("cplan.view.panels.workspace.times > 1.5")
    before = seen.do("cplan.scene.obstacles[1].shape.polygon[0]")
    seen.page.mouse.move(*place(seen, "workspace", [0.65, -1.45], "cplan.view"))
    seen.page.mouse.down()
    seen.page.mouse.move(*place(seen, "workspace", [0.65, -1.4], "cplan.view"), steps=5)
    seen.page.mouse.up()
    settled(seen)
    after = seen.do("cplan.scene.obstacles[1].shape.polygon[0]")
    assert after == pytest.approx([before[0], before[1] + 0.05], abs=0.01)
    assert seen.do("cplan.view.panels.workspace.times") > 1.5, "a new plan keeps what is seen"


def test_drawing_what_is_magnified_is_quick(program, show_file):
    page, _ = program.plan("planar_2r", "crowd", "--planner", "trapezoid")
    seen = show_file(page)
    taken = seen.do(
        """() => { const { cspace } = cplan.panels; cspace.magnify(30, [300, 200]);
             const from = performance.now();
             for (let k = 0; k < 20; k += 1) { cspace.dirty = true; cspace.draw(); }
             return (performance.now() - from) / 20; }"""
    )
    assert taken < 60, f"{taken} ms a picture"
