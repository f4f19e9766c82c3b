"""Toolbar and inspector of the live page."""

import math

import pytest
from conftest import ROOT
from live import PLANAR, drag, settled

TOOLS = ["undo", "redo", "add a polygon", "add a circle", "add a thin wall", "add a corner to the longest side", "delete the selection", "open a world file", "save as"]


def field(seen, label):
    return seen.page.get_by_label(label, exact=True)


def enter(seen, label, value):
    field(seen, label).fill(str(value))
    seen.page.keyboard.press("Enter")
    return settled(seen)


def tops(seen):
    return seen.do("[...document.querySelectorAll('.panels canvas')].map((canvas) => canvas.getBoundingClientRect().top + window.scrollY)")


def test_tools_are_icons_in_one_row_with_names_and_tooltips(serve):
    seen = serve(*PLANAR)
    boxes = []
    for name in TOOLS:
        tool = seen.page.get_by_role("button", name=name, exact=True)
        assert tool.locator("svg").count() == 1 and tool.get_attribute("title").startswith(name)
        boxes.append(tool.bounding_box())
    rows = {box["y"] for box in boxes}
    assert len(rows) == 2, "files in the first row, edits in the second"
    assert all(box["width"] >= 32 and box["height"] >= 32 for box in boxes), "large enough to hit"
    seen.shoot("live-tools")


def test_corners_are_shown_and_changed_as_numbers(serve):
    seen = serve(*PLANAR)
    before = tops(seen)
    seen.page.get_by_label("selected", exact=True).select_option("obstacle 1")
    corners = seen.do("cplan.scene.obstacles[1].shape.polygon")
    shown = [[float(field(seen, f"corner {i + 1} {axis} in metres").input_value()) for axis in "xy"] for i in range(len(corners))]
    assert shown == corners
    assert enter(seen, "corner 1 x in metres", 0.4321)["certified"]
    assert seen.do("cplan.scene.obstacles[1].shape.polygon[0]") == [0.4321, corners[0][1]]
    assert seen.do("cplan.editor.selection.corner") == 0, "the field's corner is the selected one"
    # The numbers follow a drag.
    drag(seen, "workspace", [0.7, -1.5], [0.8, -1.4])
    settled(seen)
    assert float(field(seen, "corner 1 x in metres").input_value()) == pytest.approx(0.5321, abs=0.01)
    # Text that is no number changes nothing.
    field(seen, "corner 1 x in metres").fill("")
    seen.page.keyboard.press("Tab")
    assert float(field(seen, "corner 1 x in metres").input_value()) == pytest.approx(0.5321, abs=0.01)
    assert tops(seen) == before, "the panels stay"
    for _ in range(2):
        seen.page.get_by_label("undo").click()
    settled(seen)
    assert seen.do("cplan.scene.obstacles[1].shape.polygon") == corners


def test_a_circle_has_a_centre_and_a_radius(serve):
    seen = serve(*PLANAR)
    seen.page.get_by_role("button", name="add a circle").click()
    settled(seen)
    enter(seen, "centre x in metres", -0.75)
    enter(seen, "radius in metres", 0.08)
    circle = seen.do("cplan.scene.obstacles[2].shape.circle")
    assert circle["center"][0] == -0.75 and circle["radius"] == 0.08
    outline = seen.do("cplan.view.world.obstacles[2].outline.circle")
    assert [outline[0], outline[2]] == pytest.approx([-0.75, 0.08])


def test_start_and_goal_are_set_by_tip_or_by_joint_values(serve):
    seen = serve(*PLANAR)
    select = seen.page.get_by_label("selected", exact=True)
    select.select_option("goal")
    assert enter(seen, "shoulder in degrees", 80)["certified"]
    assert seen.do("cplan.view.model.paths[0].points.at(-2)") == pytest.approx(math.radians(80), abs=1e-4)
    assert enter(seen, "tip x in metres", -0.4)["certified"]
    end = seen.do("Geometry.tipAt(cplan.view.model.arm, cplan.view.model.paths[0].points.slice(-2))")
    assert end[0] == pytest.approx(-0.4, abs=1e-3)
    select.select_option("start")
    assert enter(seen, "elbow in degrees", 30)["certified"]
    assert seen.do("cplan.view.model.paths[0].points[1]") == pytest.approx(math.radians(30), abs=1e-4)
    tip = seen.do("cplan.editor.tips.start")
    assert [float(field(seen, f"tip {axis} in metres").input_value()) for axis in "xy"] == pytest.approx(tip, abs=1e-4)
    seen.shoot("live-inspector")


def test_the_inspector_works_by_keyboard(serve):
    seen = serve(*PLANAR)
    seen.page.get_by_label("selected", exact=True).select_option("obstacle 1")
    field(seen, "corner 1 x in metres").focus()
    seen.page.keyboard.press("ArrowUp")
    settled(seen)
    assert seen.do("cplan.scene.obstacles[1].shape.polygon[0][0]") == pytest.approx(0.501)
    seen.page.keyboard.press("Tab")
    assert seen.do("document.activeElement.getAttribute('aria-label')") == "corner 1 y in metres"
    seen.page.keyboard.press("Delete")
    assert len(seen.do("cplan.scene.obstacles[1].shape.polygon")) == 4, "in a field, the key deletes text"


def test_tasks_have_no_tools_that_edit(serve):
    seen = serve(ROOT / "robots/scara.urdf", ROOT / "workspaces/tasks/kitting_cell.toml")
    assert seen.page.get_by_role("button", name="undo").count() == 0 and seen.page.locator(".inspector").is_hidden()
    assert seen.page.get_by_role("button", name="save as").is_visible()
    assert seen.page.locator(".hint").is_hidden(), "nothing can be dragged"


def test_large_text_is_followed(serve):
    seen = serve(*PLANAR)
    height = seen.page.get_by_label("undo").bounding_box()["height"]
    # Like a browser whose text size is set to twice the usual one.
    seen.do("document.documentElement.style.fontSize = '200%'")
    assert seen.page.get_by_label("undo").bounding_box()["height"] == pytest.approx(2 * height, abs=1)
    sizes = seen.do("[...document.querySelectorAll('.inspector label, .figures, .toolbar select, .status')].map((one) => parseFloat(getComputedStyle(one).fontSize))")
    assert min(sizes) >= 26, "all text grows"
    assert seen.do("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
