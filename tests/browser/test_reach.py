"""The page of `cplan reach`: pointing at a cell shows its IK solutions, and the certified motion from home to it."""

import json
import math

import pytest
from conftest import ROOT

FILES = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"]


@pytest.fixture(scope="module")
def made(program):
    """Returns a page of a reach, and its result."""
    page = program.folder / "reach_shelf.html"
    return page, json.loads(program.run("reach", *FILES, "--cell", "0.06", "--json", "--picture", page))


def solutions(result):
    """Returns all solutions in order, as in the page, each with the number of its cell."""
    return [(cell, solution) for cell, place in enumerate(result["reach"]["places"]) for solution in place]


def tip(joints):
    """Returns the tip of `planar_2r` in configurations (shoulder, elbow)."""
    a, b = joints
    return [math.cos(a) + 0.8 * math.cos(a + b), math.sin(a) + 0.8 * math.sin(a + b)]


def spot_of(seen, cell):
    """Returns the middle of a cell on the screen."""
    box = seen.page.locator("canvas[aria-label='Workspace']").bounding_box()
    x, y = seen.do("(cell) => cplan.panels.workspace.at(cplan.reachMap.center(cell))", cell)
    return box["x"] + x, box["y"] + y


def test_the_headline_and_the_key_figures_count_the_cells(made, show_file):
    page, result = made
    seen = show_file(page)
    cells = result["cells"]
    percent = 100 * cells["reachable"] / sum(cells.values())
    headline = seen.page.locator("h1").inner_text()
    assert headline.startswith("The tip reaches ") and float(headline.split()[3]) == pytest.approx(percent, abs=0.01)
    cards = dict(zip(seen.page.locator(".card dt").all_inner_texts(), seen.page.locator(".card dd").all_inner_texts()))
    assert float(cards["reachable area"].split()[0]) == pytest.approx(result["reachable_area"], rel=5e-3)
    assert int(cards["reached cells"].split("\n")[0].replace("\u202f", "")) == cells["reachable"]
    assert int(cards["not free"].split("\n")[0].replace("\u202f", "")) == cells["blocked"]


def test_pointing_at_a_cell_shows_all_its_solutions(made, show_file):
    page, result = made
    seen = show_file(page)
    both = [n for n, place in enumerate(result["reach"]["places"]) if {s["access"] for s in place} == {"reachable", "blocked"}]
    cell = both[len(both) // 2]
    seen.page.mouse.move(*spot_of(seen, cell))
    assert seen.do("cplan.reachMap.cell") == cell
    told = result["reach"]["places"][cell]
    items = seen.page.locator(".cell-report .solutions li")
    assert items.count() == len(told)
    for item, solution in zip(items.all(), told):
        text = item.inner_text()
        for name, value in zip(("shoulder", "elbow"), solution["joints"]):
            assert f"{name} {math.degrees(value):.1f}°".replace("-", "−") in text
        assert ("reached" if solution["access"] == "reachable" else "not free") in text
    # The chosen solution is a reached one, and the arm is there.
    chosen = seen.do("cplan.reachMap.chosen")
    assert told[chosen]["access"] == "reachable"
    assert seen.do("cplan.q") == pytest.approx(told[chosen]["joints"], abs=2e-5)
    assert "The tip can reach this cell" in seen.page.locator(".cell-report .verdict").inner_text()
    seen.shoot("reach_cell")


def test_motions_lead_from_home_and_are_certified(made, show_file, program):
    page, result = made
    seen = show_file(page)
    home = result["reach"]["home"]
    all_ = solutions(result)
    motions = seen.do("cplan.model.reach.origins.map((_, number) => cplan.reachMap.motionTo(number))")
    assert len(motions) == len(all_)
    bent = None
    for (_, solution), motion in zip(all_, motions):
        assert (motion is not None) == (solution["access"] == "reachable")
        if motion is None:
            continue
        assert motion[:2] == pytest.approx(home, abs=2e-5) and motion[-2:] == pytest.approx(solution["joints"], abs=1e-4)
        if bent is None or len(motion) > len(bent):
            bent = motion
    # The program accepts the motion with most waypoints.
    path = program.folder / "reach_path.csv"
    points = [bent[k : k + 2] for k in range(0, len(bent), 2)]
    path.write_text("shoulder,elbow\n" + "".join(f"{a},{b}\n" for a, b in points))
    # On the page, free space along it is never left by more than rounding.
    deepest = seen.do(
        """(flat) => {
          let least = Infinity;
          for (let i = 2; i < flat.length; i += 2) for (let k = 0; k <= 40; k += 1) {
            const q = [0, 1].map((j) => flat[i - 2 + j] + (flat[i + j] - flat[i - 2 + j]) * k / 40);
            least = Math.min(least, Geometry.contacts(cplan.model.arm, cplan.world, q)[0]?.distance ?? Infinity);
          }
          return least;
        }""",
        bent,
    )
    assert len(points) > 2 and deepest > -1e-4


def test_keys_choose_the_cell_and_play_the_motion(made, show_file):
    page, result = made
    seen = show_file(page, reduced_motion="reduce")
    seen.page.locator("canvas[aria-label='Workspace']").focus()
    before = seen.do("cplan.reachMap.cell")
    columns = result["reach"]["size"][0]
    seen.page.keyboard.press("ArrowLeft")
    assert seen.do("cplan.reachMap.cell") == before - 1 and seen.do("cplan.reachMap.isKept")
    seen.page.keyboard.press("ArrowDown")
    assert seen.do("cplan.reachMap.cell") == before - 1 - columns
    # Readers who prefer reduced motion see the end of the motion at once.
    seen.do("cplan.reachMap.show(0)")
    assert seen.do("cplan.q") == pytest.approx(result["reach"]["home"], abs=2e-5)
    seen.page.keyboard.press("Enter")
    assert seen.do("cplan.reachMap.part") == 1 and not seen.do("cplan.reachMap.isPlaying")
    # Another cell is not taken while one is kept.
    kept = seen.do("cplan.reachMap.cell")
    others = [n for n, place in enumerate(result["reach"]["places"]) if place and n != kept]
    seen.page.mouse.move(*spot_of(seen, others[len(others) // 3]))
    assert seen.do("cplan.reachMap.cell") == kept
    seen.page.keyboard.press("Escape")
    seen.page.mouse.move(*spot_of(seen, others[len(others) // 2]))
    assert seen.do("cplan.reachMap.cell") == others[len(others) // 2]


def test_a_click_plays_the_motion_to_the_cell(made, show_file):
    page, result = made
    seen = show_file(page)
    cells = [n for n, place in enumerate(result["reach"]["places"]) if place and place[0]["access"] == "reachable"]
    seen.page.mouse.click(*spot_of(seen, cells[len(cells) // 4]))
    assert seen.do("cplan.reachMap.isKept")
    seen.until("!cplan.reachMap.isPlaying")
    x, y = tip(seen.do("cplan.q"))
    assert [x, y] == pytest.approx(seen.do("cplan.reachMap.center(cplan.reachMap.cell)"), abs=1e-3)
    # The slider moves the arm along the motion.
    seen.page.get_by_role("slider", name="part of the motion").fill("0")
    assert seen.do("cplan.q") == pytest.approx(result["reach"]["home"], abs=2e-5)


def test_proofs_are_told_from_motions(program, show_file):
    page = program.folder / "reach_closed.html"
    files = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/singular_closed.toml"]
    result = json.loads(program.run("reach", *files, "--cell", "0.1", "--json", "--picture", page))
    seen = show_file(page)
    out = [n for n, place in enumerate(result["reach"]["places"]) if place and {s["access"] for s in place} == {"unreachable"}]
    seen.do("(cell) => cplan.reachMap.pointAt(cell)", out[0])
    report = seen.page.locator(".cell-report")
    assert "(proven)" in report.inner_text() and report.locator(".verdict").get_attribute("data-ending") == "infeasible"
    assert "No certified motion leads to this solution" in report.inner_text()
    # The arm stays at home.
    assert seen.do("cplan.q") == pytest.approx(result["reach"]["home"], abs=2e-5)


def test_the_configuration_space_has_no_gaps_at_a_straight_elbow(program, show_file):
    page = program.folder / "straight.html"
    program.run("reach", ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml", "--quiet", "--picture", page)
    seen = show_file(page)
    bare = seen.do(
        """() => { const panel = cplan.panels.cspace; const { data, width } = panel.back.getContext('2d').getImageData(0, 0, panel.back.width, panel.back.height);
             let [bare, count] = [0, 0];
             for (let x = -2.5; x < 2.5; x += 0.01) for (let y = -0.3; y < 0.3; y += 0.01) {
               const [i, j] = panel.at([x, y]).map((at) => Math.round(at * panel.ratio));
               count += 1; bare += data[4 * (j * width + i)] > 250 && data[4 * (j * width + i) + 2] > 250;
             } return bare / count; }"""
    )
    assert bare < 0.01, "but the halos of names and of the motion"
