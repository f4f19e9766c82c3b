"""The page of `cplan cell`: both arms at a time that the reader chooses."""

import json

import pytest
from conftest import ROOT


@pytest.fixture(scope="module")
def made(program):
    """Returns the page of a cell, and its result."""
    page = program.folder / "cell.html"
    cell = ROOT / "workspaces/cells/crossing.toml"
    return page, json.loads(program.run("cell", cell, "--json", "--quiet", "--picture", page))


def transforms(seen):
    return seen.do("[...document.querySelectorAll('svg > g[transform]')].map((link) => link.getAttribute('transform'))")


def test_the_clock_moves_both_arms(made, show_file):
    page, result = made
    seen = show_file(page)
    assert "found, certified" in seen.page.locator(".status").inner_text()
    slider = seen.page.locator("input[type=range]")
    starts = transforms(seen)
    assert len(starts) == 4
    slider.fill(slider.get_attribute("max"))
    goals = transforms(seen)
    assert all(start != goal for start, goal in zip(starts, goals))
    assert seen.page.locator("output").inner_text() == f"{result['duration']:.3f} s"
    # An arm that waits at its start stands still.
    waits = [(arm, wait) for arm, own in enumerate(result["arms"]) for wait in own["waits"] if wait["from"] == 0]
    for arm, wait in waits:
        step = int(0.8 * wait["to"] / result["duration"] * int(slider.get_attribute("max")))
        slider.fill(str(step))
        assert transforms(seen)[2 * arm : 2 * arm + 2] == starts[2 * arm : 2 * arm + 2]
    seen.shoot("cell")


def test_the_arms_stand_where_the_result_says(made, show_file):
    page, result = made
    seen = show_file(page)
    # The second axis of the left SCARA is 0.3 m from the first.
    first, second = (list(map(float, text[7:-1].split(","))) for text in transforms(seen)[:2])
    scale = (first[0] ** 2 + first[1] ** 2) ** 0.5
    assert ((first[4] - second[4]) ** 2 + (first[5] - second[5]) ** 2) ** 0.5 == pytest.approx(0.3 * scale, rel=1e-3)


def test_the_diagram_follows_the_pointer(made, show_file):
    page, _ = made
    seen = show_file(page)
    picture = seen.page.locator("figure svg").bounding_box()
    dot = lambda: [float(seen.page.locator("svg > circle").get_attribute(name)) for name in ("cx", "cy")]
    before = dot()
    at = lambda x, y: (picture["x"] + x / 1400 * picture["width"], picture["y"] + y / 870 * picture["height"])
    seen.page.mouse.move(*at(1070, 370))
    seen.page.mouse.down()
    seen.page.mouse.up()
    assert dot() != before
    seen.page.get_by_role("button", name="Play").click()
    seen.until("document.querySelector('button').textContent === 'Play'")
    assert seen.page.locator("input").input_value() == seen.page.locator("input").get_attribute("max")


@pytest.mark.parametrize("width", [1400, 390])
def test_it_fits_the_window(made, show_file, width):
    page, _ = made
    seen = show_file(page, width=width)
    assert seen.do("document.documentElement.scrollWidth <= innerWidth")
    seen.shoot(f"cell_{width}")


def test_without_motions_there_is_no_clock(program, show_file):
    page = program.folder / "no_room.html"
    program.run("cell", ROOT / "workspaces/cells/no_room.toml", "--quiet", "--picture", page, code=3)
    seen = show_file(page)
    assert "infeasible" in seen.page.locator(".status").inner_text()
    assert seen.page.locator(".clock").count() == 0
