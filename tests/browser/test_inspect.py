"""The page of `cplan inspect`: defects first, joints and links in tables beside a large drawing."""

import math

import pytest
from conftest import ROOT
from test_page import pixels

BAD = """<robot name="loose"><link name="a"/><link name="b"/><link name="c"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
<joint name="k" type="revolute"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/></joint></robot>
"""


@pytest.fixture(scope="module")
def scara(program):
    page = program.folder / "inspect_scara.html"
    text = program.run("inspect", ROOT / "robots/scara.urdf", ROOT / "workspaces/scara_cell.toml", "--picture", page)
    return page, text


def row(seen, name):
    return seen.page.locator("tbody tr", has=seen.page.get_by_role("button", name=name, exact=True)).first


def test_each_joint_has_a_row_with_its_role_and_limits(scara, show_file):
    page, text = scara
    seen = show_file(page)
    assert seen.page.locator(".status").inner_text() == "✓ ready for planning" and not seen.page.locator(".defects").count()
    assert seen.page.locator(".status").get_attribute("data-ending") == "found"
    first, quill = row(seen, "axis_1").inner_text(), row(seen, "axis_3").inner_text()
    assert "first joint" in first and "−140° to 140°" in first and "415°/s" in first and "default" in first
    assert "held" in quill and "−150 mm" in quill and "−180 mm to 0 mm" in quill
    # The report as the terminal shows it is on the page, too.
    seen.page.get_by_text("The report as text").click()
    assert seen.page.locator(".inspection pre").last.inner_text().strip() == text.strip()
    seen.shoot("inspect")


def test_values_follow_the_arm(scara, show_file):
    seen = show_file(scara[0])
    value = row(seen, "axis_1").locator("td").nth(1)
    assert value.inner_text() == "0.0°"
    seen.do("cplan.place([Math.PI / 6, -0.5])")
    assert value.inner_text() == "30.0°"
    second = row(seen, "axis_2").locator("td").nth(1)
    assert second.inner_text() == f"−{math.degrees(0.5):.1f}°"


def test_pointing_at_a_row_shows_its_link(scara, show_file):
    seen = show_file(scara[0])
    before = pixels(seen, "workspace")
    row(seen, "axis_2").hover()
    assert seen.do("inspection.lit") == "outer_arm"
    shown = pixels(seen, "workspace")
    assert shown != before
    # The row of the link is marked, too; the focus of the keyboard has the same effect.
    assert seen.page.locator("tr.lit").count() == 2
    seen.page.mouse.move(0, 0)
    assert seen.do("inspection.lit") is None and pixels(seen, "workspace") == before
    seen.page.get_by_role("button", name="inner_arm", exact=True).focus()
    assert seen.do("inspection.lit") == "inner_arm" and pixels(seen, "workspace") != before


def test_a_robot_without_a_planar_arm_has_a_page(program, show_file):
    (program.folder / "loose.urdf").write_text(BAD)
    page = program.folder / "loose.html"
    program.run("inspect", program.folder / "loose.urdf", "--picture", page, code=1)
    seen = show_file(page)
    defects = seen.page.locator(".defects li")
    assert defects.count() == 3 and seen.page.locator(".status").inner_text() == "✕ 3 defects"
    first = defects.first.inner_text()
    assert "loose.urdf:3:" in first and "axes are not parallel" in first and "Hint:" in first
    tree = seen.page.locator("section[aria-label='Tree of links']").inner_text()
    assert all(f"{joint} (revolute)" in tree for joint in "jk")
    assert seen.page.locator("canvas").count() == 0
    seen.shoot("inspect_defects")


def test_a_contact_at_zero_is_grey_and_one_of_the_moved_arm_is_red(program, show_file):
    page = program.folder / "inspect_touching.html"
    program.run("inspect", ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/no_path.toml", "--picture", page)
    seen = show_file(page)
    probe = seen.page.locator(".probe")
    color = lambda: probe.evaluate("(text) => getComputedStyle(text).color")
    ink = seen.do("getComputedStyle(document.body).color")
    assert "touches the front wall" in probe.inner_text() and "does not prevent planning" in probe.inner_text()
    assert color() == ink
    seen.do("cplan.place([0, 0])")
    assert "touches" in probe.inner_text() and color() != ink
