"""The page of `cplan study`: the answer first, and a layout that is marked in all maps, charts and tables."""

import csv
import json

import pytest
from conftest import ROOT

STUDY = """robot = "{root}/robots/planar_2r.urdf"
world = "{root}/workspaces/shelf.toml"
measure = ["duration", "length"]
objective = "least duration"

[[parameter]]
name = "base x"
unit = "m"
sets = "world.robot.at[0]"
from = -0.2
to = 0.2
steps = 5

[[parameter]]
name = "base y"
unit = "m"
sets = "world.robot.at[1]"
from = -0.2
to = 0.2
steps = 5
"""


@pytest.fixture(scope="module")
def made(program):
    """Returns the page of a study with 25 layouts, its rows and its summary."""
    study = program.folder / "small.toml"
    study.write_text(STUDY.format(root=ROOT))
    files = [program.folder / f"small.{end}" for end in ("html", "csv", "json")]
    program.run("study", "small.toml", "--quiet", *(word for file in files for word in ("--output", file)))
    return files[0], list(csv.DictReader(files[1].open())), json.loads(files[2].read_text())


def cell(seen, layout):
    return seen.page.locator(f".maps rect[data-layout='{layout}']")


def panel(seen):
    return seen.page.locator(".pointed").inner_text()


def test_the_answer_comes_first(made, show_file):
    page, rows, summary = made
    seen = show_file(page)
    best = summary["best"]
    x, y = (1000 * best["parameters"][f"base {axis}"] for axis in "xy")
    signed = lambda value: f"{value:g}".replace("-", "−")
    assert seen.page.locator(".answer h2").inner_text() == f"Put the base at x = {signed(x)} mm, y = {signed(y)} mm"
    fitting = sorted(float(row["duration"]) for row in rows if row["outcome"] == "found")
    title = f"{len(fitting)} of {len(rows)} layouts have a motion; the best, base x {signed(x)} mm, base y {signed(y)} mm, has duration {fitting[0]:.2f} s"
    assert seen.page.locator("h1").inner_text() == seen.page.title() == title
    better = 1 - best["measured"]["duration"] / fitting[len(fitting) // 2]
    assert f"{best['measured']['duration']:.2f} s duration: {100 * better:.0f} % better" in seen.page.locator(".figure").inner_text()
    counts = seen.page.locator(".counts").inner_text()
    assert f"{summary['outcomes']['found']} found" in counts and f"{summary['outcomes']['infeasible']} infeasible" in counts
    assert seen.page.locator(".answer .command").inner_text() == f"cplan study small.toml --layout {best['layout']} --output layout_{best['layout']}.toml"
    # The picture of the best layout belongs to the answer.
    assert seen.page.locator(".answer .picture svg").get_attribute("aria-label").startswith(f"best: layout {best['layout']} ")
    seen.shoot("study")


def test_pointing_at_a_cell_draws_its_layout(made, show_file):
    page, rows, summary = made
    seen = show_file(page)
    best = summary["best"]["layout"]
    assert f"Layout {best}, the best" in panel(seen)
    infeasible = next(int(row["layout"]) for row in rows if row["outcome"] == "infeasible")
    cell(seen, infeasible).hover()
    assert f"Layout {infeasible}" in panel(seen) and "infeasible" in panel(seen)
    # In the drawing, the arm stands where the layout puts it.
    drawn = seen.do("(n) => study.data.drawings.layouts[n]", infeasible)
    bases = {n: seen.do("(n) => study.data.drawings.layouts[n]", n) for n in (0, 1)}
    assert bases[0] != bases[1] and drawn not in bases.values()
    assert seen.page.locator(".drawing path.arm").count() > 0
    # The pointer leaves, and the best layout is back.
    seen.page.mouse.move(2, 2)
    assert f"Layout {best}, the best" in panel(seen)


def test_arms_are_drawn_where_the_layouts_put_them(made, show_file):
    page, rows, _ = made
    seen = show_file(page)
    shift = lambda n, axis: float(rows[n][f"base {axis}"]) - float(rows[0][f"base {axis}"])
    corner = """(n) => {
      const all = study.data.drawings.layouts[n];
      for (let i = 0; i < all.length; i += 4) if (all[i] === -1) return all.slice(i + 2, i + 4);
    }"""
    first = seen.do(corner, 0)
    # One unit of the drawings is 2e-4 of the reach of 1.8 m and more.
    unit = None
    for n in range(1, 25):
        at = seen.do(corner, n)
        for k, axis in enumerate("xy"):
            moved = shift(n, axis)
            if abs(moved) < 1e-9:
                assert abs(at[k] - first[k]) <= 1
            else:
                ratio = (at[k] - first[k]) / moved
                unit = unit or ratio
                assert ratio == pytest.approx(unit, rel=0.01)


def test_a_layout_is_marked_everywhere(made, show_file):
    page, rows, summary = made
    seen = show_file(page)
    listed = [int(text) for text in seen.page.locator("tbody tr .name").all_inner_texts()]
    other = next(n for n in listed if n != summary["best"]["layout"])
    seen.page.get_by_role("button", name=f"layout {other}", exact=True).click()
    assert f"Layout {other}" in panel(seen)
    assert seen.page.locator("tr.marked").count() == 1 and seen.page.locator("tr.marked th").inner_text() == str(other)
    # A cell of the map, and a dot in each chart in which it appears; each with a halo.
    spots = seen.page.locator(f"svg.chart [data-layout='{other}']").count()
    assert spots >= 2 and seen.page.locator(".mark").count() == 2 * spots


def test_arrow_keys_move_from_cell_to_cell(made, show_file):
    page, _, summary = made
    seen = show_file(page)
    best = summary["best"]["layout"]
    place = lambda: [int(x) for x in seen.do("document.querySelector(`.maps rect[data-layout='${study.shown}']`).dataset.cell").split(",")]
    seen.page.locator(".maps svg.chart").first.focus()
    begin = place()
    step = "ArrowRight" if begin[0] < 4 else "ArrowLeft"
    seen.page.keyboard.press(step)
    assert place() == [begin[0] + (1 if step == "ArrowRight" else -1), begin[1]]
    assert seen.do("study.kept") == seen.do("study.shown") != best
