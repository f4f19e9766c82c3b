"""The live page shows "certified" only for certified answers, and errors at their places."""

import re

import pytest
from live import PLANAR, badge, drag, notices, path, settled, spot

# A place of the shelf at which it covers the arm's start.
ON_THE_ARM = [[1.3, 0.24], [0.85, -0.95]]


def reds(seen, panel):
    """Returns the number of pixels of a panel that are as red as blocked parts."""
    return seen.do(
        """(panel) => { const { canvas } = cplan.view.panels[panel];
             const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
             let count = 0;
             for (let i = 0; i < data.length; i += 4) count += data[i] > 170 && data[i + 1] < 90 && data[i + 2] < 90;
             return count; }""",
        panel,
    )


def test_a_blocked_start_is_shown_where_it_is(serve):
    seen = serve(*PLANAR)
    before = [reds(seen, panel) for panel in ("workspace", "cspace")]
    drag(seen, "workspace", *ON_THE_ARM)
    answer = settled(seen)
    assert answer["verdict"] is None and not answer["certified"]
    # Place: the configuration, the links in contact, and the obstacles that they hit.
    [blocked] = seen.do("cplan.blocked")
    assert blocked["at"] == pytest.approx([-0.9, 0.4])
    assert {(hit["link"], seen.do("cplan.view.world.obstacles.map((o) => o.name)")[hit["obstacle"]]) for hit in blocked["hits"]} <= {(0, "shelf"), (1, "shelf")}
    deepest = -min(hit["distance"] for hit in blocked["hits"])
    shown = seen.do("(q) => Geometry.contacts(cplan.view.model.arm, cplan.view.world, q)", blocked["at"])
    assert deepest == pytest.approx(-shown[0]["distance"], abs=3e-5), "the page's own contact test finds the same depth"
    after = [reds(seen, panel) for panel in ("workspace", "cspace")]
    assert after[0] > before[0] + 200 and after[1] > before[1] + 30
    # The message does not refer to files.
    [text] = notices(seen).values()
    assert text.startswith("The start is blocked: link") and '"shelf"' in text and f"{1e3 * deepest:.3g}"[:3] in text
    assert "line" not in text and ".toml" not in text and "^" not in text and "joints =" not in text
    assert badge(seen) == "\u2715 start blocked"
    # Above the panels, where it covers nothing, and the only message.
    notice, canvas = (seen.page.locator(where).bounding_box() for where in (".notice.picture", "canvas[aria-label='Workspace']"))
    assert 0 <= notice["y"] and notice["y"] + notice["height"] <= canvas["y"]
    assert seen.page.locator("[role=alert]:visible").count() == 1
    seen.shoot("live-blocked")
    seen.page.get_by_label("undo").click()
    assert settled(seen)["certified"]
    assert notices(seen) == {} and seen.do("cplan.blocked") == [] and "certified" in badge(seen)


def test_a_blocked_goal_and_one_out_of_reach_are_told_apart(serve):
    seen = serve(*PLANAR)
    # In all configurations with the tip in the crate, the arm hits it.
    drag(seen, "workspace", seen.do("cplan.editor.tips.goal"), [0.65, -1.45])
    settled(seen)
    assert badge(seen) == "\u2715 goal blocked" and '"crate"' in notices(seen)["picture"]
    assert len(seen.do("cplan.blocked")) == 2
    drag(seen, "workspace", [0.65, -1.45], [1.95, 1.6])
    settled(seen)
    assert badge(seen) == "\u2715 goal not possible" and "out of reach" in notices(seen)["picture"]
    assert "line" not in notices(seen)["picture"]


def test_a_polygon_that_crosses_itself_is_explained_and_what_was_there_is_not_certified(serve):
    seen = serve(*PLANAR)
    seen.page.get_by_label("selected", exact=True).select_option("obstacle 1")
    corners = seen.do("cplan.scene.obstacles[1].shape.polygon")
    drag(seen, "workspace", corners[0], [corners[1][0] + 0.1, corners[2][1] - 0.1])
    answer = settled(seen)
    assert "not a simple polygon" in answer["error"]
    assert "crate" in notices(seen)["picture"] and "line" not in notices(seen)["picture"]
    assert badge(seen) == "\u2715 not planned"
    seen.page.get_by_label("undo").click()
    assert settled(seen)["certified"] and notices(seen) == {}


def test_wrong_options_are_told_beside_them(serve):
    seen = serve(*PLANAR)
    more = seen.page.get_by_label("other options")
    more.fill("--gap nothing")
    more.press("Enter")
    settled(seen)
    assert list(notices(seen)) == ["options"] and "--gap" in notices(seen)["options"]
    assert more.get_attribute("aria-invalid") == "true" and "certified" not in badge(seen)
    field, notice = more.bounding_box(), seen.page.locator(".notice.options").bounding_box()
    assert 0 <= notice["y"] - field["y"] < 80
    # The picture is about the last plan, and says so.
    seen.page.locator("main.behind").wait_for()
    assert "not up to date" in seen.do("getComputedStyle(document.querySelector('.panels figcaption'), '::after').content")
    more.fill("")
    more.press("Enter")
    assert settled(seen)["certified"]
    assert notices(seen) == {} and more.get_attribute("aria-invalid") is None
    seen.page.locator("main.behind").wait_for(state="detached")


def test_a_laptop_shows_the_tools_the_key_figures_and_the_controls_of_time_at_once(serve):
    seen = serve(*PLANAR, width=1280, height=720)
    seen.page.wait_for_timeout(300)
    parts = [".toolbar", ".outcome .cards", ".panels:visible", ".transport .play"]
    boxes = [seen.page.locator(part).bounding_box() for part in parts]
    bottoms = [box["y"] + box["height"] for box in boxes]
    assert seen.page.locator(".toolbar").count() == 1 and boxes[0]["height"] < 60, "one row of tools and options"
    assert bottoms == sorted(bottoms) and bottoms[-1] <= 720
    assert seen.page.locator(".outcome .card").count() == 3
    assert "length 4.4920 rad" in seen.page.locator(".figures").inner_text()
    heights = [seen.page.locator(f"canvas[aria-label='{name}']").bounding_box()["height"] for name in ("Workspace", "Configuration space")]
    assert min(heights) >= 380, "the pictures take most of it"
    before = [seen.page.locator(part).bounding_box()["y"] for part in parts[2:]]
    # A goal within an obstacle is one red message, in the place of the key figures.
    drag(seen, "cspace", seen.do("cplan.view.goals()[0][0]"), [0.14, 0.0])
    settled(seen)
    assert badge(seen) == "\u2715 goal blocked" and seen.page.locator("[role=alert]:visible").count() == 1
    assert path(seen) is None, "no path of before"
    assert seen.page.locator(".panels:visible").bounding_box()["y"] == before[0], "nothing moves"
    seen.shoot("live-laptop")


def test_wrong_text_is_told_beside_it_until_it_is_changed(serve):
    seen = serve(*PLANAR)
    seen.page.locator(".world summary").click()
    text = seen.page.get_by_label("world as TOML")
    text.fill("[start]\njoints = [0.1]\n")
    seen.page.get_by_role("button", name="Plan in this world").click()
    seen.until("cplan.answered.error")
    assert list(notices(seen)) == ["text"] and "line 2" in notices(seen)["text"], "here there are lines"
    box = seen.page.locator(".notice.text").bounding_box()
    assert 0 <= box["y"] and box["y"] + box["height"] <= 1000, "in sight"
    # The world is unchanged, and certified.
    assert "certified" in badge(seen)
    text.press_sequentially("#")
    assert notices(seen) == {}


def test_an_error_during_a_drag_on_a_phone_is_in_sight(serve):
    seen = serve(*PLANAR, width=390, height=844)
    # In the configuration space, which is far below the workspace on this screen.
    drag(seen, "cspace", [-0.9, 0.4], [0.2, 0.0])
    settled(seen)
    box = seen.page.locator(".notice.picture").bounding_box()
    assert "blocked" in notices(seen)["picture"]
    assert 0 <= box["y"] and box["y"] + box["height"] <= 844
    seen.shoot("live-blocked-phone")


WATCH = """() => {
  window.lies = [];
  const state = () => { const { scene } = cplan; return JSON.stringify([scene.obstacles, scene.start, scene.goal, scene.clearance, cplan.words]); };
  const told = new Map();
  const send = cplan.link.send.bind(cplan.link);
  cplan.link.send = (kind, request, about) => { if (kind === 'plan') told.set(request.id, state()); send(kind, request, about); };
  let certified = state();
  const receive = cplan.receive.bind(cplan);
  cplan.receive = (message, about) => {
    if (message.kind === 'answer' && message.done) certified = message.certified && message.final && !message.error ? told.get(message.id) : null;
    receive(message, about);
  };
  const look = () => {
    const text = document.querySelector('p.status').textContent;
    if (/certified/.test(text) && state() !== certified) lies.push(text);
  };
  new MutationObserver(look).observe(document.querySelector('main'), { subtree: true, childList: true, characterData: true, attributes: true });
  const frame = () => { look(); requestAnimationFrame(frame); };
  frame();
}"""


def test_the_badge_never_says_certified_of_what_is_not(serve):
    """Compares the badge with the page's world and the last answer, after every change of the page and for every
    picture.
    """
    seen = serve(*PLANAR)
    seen.do(WATCH)
    drag(seen, "workspace", [0.7, -1.5], [1.15, -0.75], steps=30)
    seen.page.get_by_label("planner", exact=True).select_option("wavefront")
    settled(seen)
    drag(seen, "workspace", *ON_THE_ARM, steps=30)
    settled(seen)
    seen.page.get_by_label("undo").click()
    seen.page.get_by_label("undo").click()
    seen.page.get_by_label("redo").click()
    seen.page.get_by_label("clearance in millimetres").fill("40")
    seen.page.keyboard.press("Enter")
    seen.page.get_by_label("other options").fill("--gap x")
    seen.page.keyboard.press("Enter")
    settled(seen)
    seen.page.get_by_label("other options").fill("")
    seen.page.keyboard.press("Enter")
    settled(seen)
    assert seen.do("lies") == []


def test_what_is_proven_is_rounded_to_the_safe_side(serve):
    seen = serve(*PLANAR)
    settled(seen)
    text, figures = seen.do("cplan.cards.textContent"), seen.do("cplan.answered.figures")
    clearance = float(re.search(r"clearance([\d.e+-]+) mmproven", text)[1]) / 1e3
    longer = float(re.search(r"at most ([\d.e+-]+) %longer", text)[1]) / 100
    # Lengths have at least three decimals of a millimetre.
    assert figures["clearance"] - 1e-6 <= clearance <= figures["clearance"], text
    gap = figures["length"] / figures["lower_bound"] - 1
    assert gap <= longer <= 1.1 * gap + 1e-12, text
    shown = seen.do("[[0.1201, 2, Math.ceil], [99.01, 2, Math.ceil], [1239, 3, Math.floor], [0, 2, Math.ceil]].map((v) => roundedSafely(...v))")
    assert shown == ["0.13", "100", "1230", "0"]


def test_what_is_awaited_is_not_certified(serve):
    seen = serve(*PLANAR)
    assert "certified" in badge(seen)
    seen.server.pause()
    try:
        drag(seen, "workspace", [0.7, -1.5], [0.8, -1.4])
        assert badge(seen) == "\u2026 planning\u2026"
        # The last verdict and its figures stay visible, with a label.
        assert seen.page.locator(".last").inner_text() == "last: found, certified"
        assert seen.do("getComputedStyle(document.querySelector('.figures'), '::before').content") == '"last plan: "'
        assert seen.page.locator(".figures").inner_text().startswith("found and certified") and seen.page.locator(".figures").is_visible()
        seen.page.wait_for_timeout(600)
        assert badge(seen) == "\u2026 planning\u2026" and "not up to date" in seen.do("getComputedStyle(document.querySelector('.panels figcaption'), '::after').content")
        # Facts of the previous plan are not facts of this world.
        assert not seen.page.locator(".facts").is_visible() and not seen.page.locator(".lines").is_visible()
    finally:
        seen.server.go_on()
    assert settled(seen)["certified"] and "certified" in badge(seen)
    assert seen.page.locator(".last").inner_text() == ""


def test_a_blocked_start_or_goal_is_moved_to_the_nearest_free_place(serve):
    seen = serve(*PLANAR)
    drag(seen, "workspace", *ON_THE_ARM)
    settled(seen)
    [blocked] = seen.do("cplan.blocked")
    seen.page.get_by_role("button", name="Move start to nearest free").click()
    assert settled(seen)["certified"] and notices(seen) == {}
    start = seen.do("cplan.scene.start.joints")
    assert 0 < max(abs(a - b) for a, b in zip(start, blocked["at"])) < 0.5, "near"
    assert seen.do("Geometry.contacts(cplan.view.model.arm, cplan.view.world, cplan.scene.start.joints)[0].distance") < 0.05, "not farther than necessary"
    assert seen.do("cplan.editor.selection.kind") == "start"
    seen.page.get_by_label("undo").click()
    settled(seen)
    assert "start blocked" in badge(seen)
    seen.page.get_by_label("undo").click()
    # A goal given by its tip, at which all IK solutions are blocked.
    drag(seen, "workspace", seen.do("cplan.editor.tips.goal"), [0.65, -1.45])
    settled(seen)
    assert badge(seen) == "\u2715 goal blocked"
    seen.page.get_by_role("button", name="Move goal to nearest free").click()
    assert settled(seen)["certified"]
    # With a clearance, the place keeps it.
    seen.page.get_by_label("clearance in millimetres").fill("40")
    seen.page.keyboard.press("Enter")
    settled(seen)
    assert badge(seen) == "\u2715 goal blocked"
    seen.page.get_by_role("button", name="Move goal to nearest free").click()
    assert settled(seen)["certified"]
    assert seen.do("Geometry.contacts(cplan.view.model.arm, cplan.view.world, cplan.scene.goal.joints)[0].distance") > 0.04


def test_delete_works_after_something_was_added(serve):
    seen = serve(*PLANAR)
    names = "cplan.scene.obstacles.map(({ name }) => name)"
    for button, name in [("add a thin wall", "wall 1"), ("add a polygon", "block 1"), ("add a circle", "disc 1")]:
        seen.page.get_by_role("button", name=button).click()
        assert seen.do(names) == ["shelf", "crate", name]
        seen.page.keyboard.press("Delete")
        assert settled(seen)["certified"] and seen.do(names) == ["shelf", "crate"]
    # Without any focus, too.
    seen.page.get_by_role("button", name="add a thin wall").click()
    seen.do("document.activeElement.blur()")
    seen.page.keyboard.press("Delete")
    assert seen.do(names) == ["shelf", "crate"]
    # Elsewhere the key belongs to the control with the focus.
    seen.page.get_by_role("button", name="add a thin wall").click()
    for label in ("speed", "clearance in millimetres"):
        seen.page.get_by_label(label).focus()
        seen.page.keyboard.press("Delete")
        assert seen.do(names) == ["shelf", "crate", "wall 1"], label
    settled(seen)


def test_shortcuts_of_a_single_key_can_be_switched_off(serve):
    seen = serve(*PLANAR)
    seen.page.get_by_label("selected", exact=True).select_option("obstacle 1")
    seen.do("localStorage.setItem('cplan.shortcuts', 'off')")
    for key in ("c", "Delete", "Backspace"):
        seen.page.keyboard.press(key)
    assert seen.do("cplan.editor.selection") == {"kind": "obstacle", "index": 1, "corner": None}
    seen.do("document.activeElement.blur()")
    seen.page.keyboard.press("Delete")
    assert seen.do("cplan.scene.obstacles.length") == 2
    seen.do("localStorage.removeItem('cplan.shortcuts')")
    seen.page.keyboard.press("Delete")
    assert seen.do("cplan.scene.obstacles.length") == 1
