"""The page of `cplan explain`, and explanations on the live page."""

import json
import math

import pytest
from conftest import ROOT
from live import Server, settled

WALL = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/no_path.toml"]
LIMITS = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/limits_closed.toml"]
SHELF = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"]


def explained(program, files, *words, code=3):
    """Explains a world; returns its page and the result."""
    page = program.folder / f"explained_{files[1].stem}{len(words)}.html"
    result = program.run("explain", *files, *words, "--time", "60", "--json", "--picture", page, code=code)
    return page, json.loads(result)


def cards(seen):
    return seen.page.locator(".explain .change")


def titles(seen):
    return seen.page.locator(".explain .change .title").all_inner_texts()


def middle(seen, index):
    """Returns the middle of the corners of an obstacle in the current world."""
    corners = seen.do("(index) => cplan.world.obstacles[index].outline.polygon", index)
    return [sum(corners[k::2]) / (len(corners) / 2) for k in range(2)]


def test_the_headline_and_the_cards_say_what_the_result_says(program, show_file):
    page, result = explained(program, WALL)
    seen = show_file(page)
    assert seen.page.locator("h1").inner_text() == "The front wall is in the way."
    status = seen.page.locator("p.status")
    assert status.get_attribute("data-ending") == "infeasible" and "infeasible" in status.inner_text()
    assert titles(seen) == ["Move it 614 mm right", "Remove it", "Show the narrowest place"]
    moved = result["sets"][0]["blockers"][0]["changes"][0]
    lines = seen.page.locator(".explain .change").first.locator(".line").all_inner_texts()
    opens, closed = (float(line.split()[0]) / 1000 for line in lines)
    assert lines[0].endswith("mm opens a path, certified") and lines[1].endswith("mm does not, proven")
    # Rounded to the safe side.
    assert moved["opens"] <= opens < moved["opens"] + 2e-4
    assert moved["closed"] - 2e-4 < closed <= moved["closed"]


def test_pointing_at_a_card_shows_the_change_and_the_path(program, show_file):
    page, result = explained(program, WALL)
    seen = show_file(page)
    change = result["sets"][0]["blockers"][0]["changes"][0]
    before = middle(seen, 0)
    assert seen.do("cplan.model.paths.length") == 0
    cards(seen).first.hover()
    after = middle(seen, 0)
    assert [b - a for a, b in zip(before, after)] == pytest.approx([x * change["opens"] for x in change["direction"]], abs=2e-5)
    # A path from the start to the goal, free in the changed world but not in the original one.
    points = seen.do("[...Geometry.pointsOf(cplan.model.paths[0].points)]")
    assert points[0] == pytest.approx(seen.do("cplan.model.start"), abs=1e-4)
    assert points[-1] == pytest.approx(seen.do("cplan.model.goals[0]"), abs=1e-4)
    depth = """() => {
      const points = [...Geometry.pointsOf(cplan.explain.explanation.cards[0].path.points)];
      let least = Infinity;
      for (let i = 1; i < points.length; i += 1) {
        for (let k = 0; k <= 200; k += 1) {
          const q = points[i].map((x, j) => points[i - 1][j] + ((x - points[i - 1][j]) * k) / 200);
          least = Math.min(least, Geometry.contacts(cplan.model.arm, cplan.world, q)[0]?.distance ?? Infinity);
        }
      }
      return least;
    }"""
    # The page rounds numbers to visible precision.
    assert seen.do(depth) > -1e-4
    # The arm moves along the path.
    assert seen.do("cplan.q") != points[-1]
    seen.until("Math.hypot(...cplan.q.map((x, k) => x - cplan.model.start[k])) > 0.2")
    # Leaving the card shows the original world.
    seen.page.mouse.move(5, 5)
    assert middle(seen, 0) == pytest.approx(before)
    assert seen.do("cplan.model.paths.length") == 0 and seen.do("cplan.q") == pytest.approx(seen.do("cplan.model.start"))
    assert seen.do(depth) < -0.01


def test_a_click_keeps_a_card_and_escape_releases_it(program, show_file):
    page, _ = explained(program, WALL)
    seen = show_file(page)
    first, second = cards(seen).nth(0), cards(seen).nth(1)
    first.click()
    seen.page.mouse.move(5, 5)
    assert first.get_attribute("aria-pressed") == "true" and seen.do("cplan.model.paths.length") == 1
    # Pointing at another card shows that one for a moment.
    second.hover()
    assert seen.do("cplan.explain.shown === cplan.explain.explanation.cards[1]")
    assert seen.do("cplan.world.obstacles[0].own") == 0, "nothing is left of the wall"
    seen.page.mouse.move(5, 5)
    assert seen.do("cplan.explain.shown === cplan.explain.explanation.cards[0]")
    seen.page.keyboard.press("Escape")
    assert first.get_attribute("aria-pressed") == "false" and seen.do("cplan.model.paths.length") == 0


def test_cards_work_with_the_keyboard_and_a_finger(program, show_file):
    page, _ = explained(program, WALL)
    seen = show_file(page, width=390, height=844, has_touch=True)
    cards(seen).first.tap()
    assert seen.do("cplan.explain.kept === cplan.explain.explanation.cards[0]") and seen.do("cplan.model.paths.length") == 1
    cards(seen).first.tap()
    assert seen.do("cplan.explain.shown") is None
    seen = show_file(page)
    seen.page.keyboard.press("Tab")
    assert seen.do("document.activeElement.classList.contains('change')")
    assert seen.do("cplan.explain.shown === cplan.explain.explanation.cards[0]")
    seen.page.keyboard.press("Tab")
    assert seen.do("cplan.explain.shown === cplan.explain.explanation.cards[1]")
    seen.page.keyboard.press("Enter")
    assert seen.do("cplan.explain.kept === cplan.explain.explanation.cards[1]")


def test_with_reduced_motion_the_arm_stays_in_the_middle_of_the_path(program, show_file):
    page, _ = explained(program, WALL)
    seen = show_file(page, reduced_motion="reduce")
    cards(seen).first.hover()
    first = seen.do("cplan.q")
    seen.page.wait_for_timeout(300)
    assert seen.do("cplan.q") == first


def test_the_narrowest_place_can_be_shown(program, show_file):
    page, result = explained(program, WALL)
    seen = show_file(page)
    cards(seen).last.hover()
    assert seen.do("cplan.probe.q") == pytest.approx(result["bottleneck"]["joints"], abs=2e-5)
    assert "touches" in seen.page.locator(".probe").inner_text()
    seen.page.mouse.move(5, 5)
    assert seen.do("cplan.probe") is None


def test_a_wider_limit_shows_more_of_the_configuration_space(program, show_file):
    page, result = explained(program, LIMITS)
    seen = show_file(page)
    assert seen.page.locator("h1").inner_text() == "The pole is in the way, and the elbow cannot turn far enough."
    assert titles(seen)[1] == "Widen the upper limit of the elbow to 87.2\u00b0"
    before = seen.do("cplan.panels.cspace.whole[1][1]")
    cards(seen).nth(1).hover()
    change = next(one for one in result["sets"][0]["blockers"] if one.get("side") == "upper")["changes"][0]
    assert seen.do("cplan.panels.cspace.whole[1][1]") == pytest.approx(before + change["opens"], abs=1e-9)
    seen.page.mouse.move(5, 5)
    assert seen.do("cplan.panels.cspace.whole[1][1]") == before


def test_a_found_path_has_cards_of_what_makes_it_longer(program, show_file):
    page, result = explained(program, SHELF, code=0)
    seen = show_file(page)
    assert seen.page.locator("h1").inner_text() == "The shelf makes the path longer."
    assert titles(seen) == ["Remove the shelf"]
    cards(seen).first.hover()
    first, second = seen.do("cplan.model.paths.map((path) => path.points)")
    length = lambda flat: sum(math.dist(flat[i : i + 2], flat[i + 2 : i + 4]) for i in range(0, len(flat) - 2, 2))
    assert length(first) == pytest.approx(result["shaped_by"][0]["length"], abs=1e-4)
    assert length(second) == pytest.approx(result["length"], abs=1e-4)


def test_a_blocked_goal_and_one_out_of_reach_have_sentences(program, show_file):
    page, result = explained(program, SHELF, "--goal", "0.14,0")
    seen = show_file(page)
    assert seen.page.locator("h1").inner_text() == "At the goal, the forearm hits the shelf."
    name = "Move the goal to the nearest free configuration"
    seen.page.get_by_role("button", name=name).hover()
    assert seen.do("cplan.probe.q") == pytest.approx(result["blocked_ends"][0]["nearest_free"]["joints"], abs=2e-5)
    page, _ = explained(program, SHELF, "--goal-tip", "5,0", "--quiet")
    seen = show_file(page)
    assert seen.page.locator("h1").inner_text() == "The goal is out of reach."
    assert titles(seen) == ["Move the goal 3.2 m nearer"]


# The live page.


def asked(seen):
    """Asks why, and waits for the explanation."""
    seen.page.get_by_role("button", name="Why?").click()
    seen.until("!cplan.view.explain.root.hidden")


def test_the_live_page_explains_and_applies_a_change(serve):
    seen = serve(*WALL)
    assert seen.do("cplan.answered.verdict") == "infeasible"
    asked(seen)
    assert seen.page.locator(".explain .headline").inner_text() == "The front wall is in the way."
    before = seen.do("cplan.scene.obstacles[0].shape.polygon")
    seen.page.get_by_role("button", name="Apply: Move it 614 mm right").click()
    assert settled(seen)["verdict"] == "found"
    by = [b - a for a, b in zip(before[0], seen.do("cplan.scene.obstacles[0].shape.polygon[0]"))]
    assert by == pytest.approx([0.6136, 0], abs=1e-3)
    assert seen.page.locator(".explain").is_hidden() and not seen.page.get_by_role("button", name="Why?").is_visible()
    # Like any other edit, it can be undone.
    seen.page.get_by_role("button", name="undo").click()
    assert settled(seen)["verdict"] == "infeasible"
    assert seen.do("cplan.scene.obstacles[0].shape.polygon") == before


def test_the_live_page_deletes_an_obstacle_of_which_nothing_is_left(serve):
    seen = serve(*WALL)
    asked(seen)
    seen.page.get_by_role("button", name="Apply: Remove it").click()
    assert settled(seen)["verdict"] == "found"
    assert seen.do("cplan.scene.obstacles.map(({ name }) => name)") == ["back wall"]


def test_the_live_page_widens_a_limit(serve):
    seen = serve(*LIMITS)
    asked(seen)
    seen.page.get_by_role("button", name="Apply: Widen the upper limit of the elbow").click()
    assert settled(seen)["verdict"] == "found"
    assert seen.do("cplan.view.model.arm.joints[1].domain[1]") == pytest.approx(math.radians(87.15), abs=2e-4)
    assert "limits" in seen.do("cplan.toml")
    seen.page.get_by_role("button", name="undo").click()
    assert settled(seen)["verdict"] == "infeasible"


def test_an_edit_removes_the_explanation(serve):
    seen = serve(*WALL)
    asked(seen)
    seen.page.locator(".explain .change").first.click()
    assert seen.do("cplan.view.model.paths.length") == 1
    seen.page.get_by_label("clearance in millimetres").fill("1")
    seen.page.keyboard.press("Tab")
    settled(seen)
    assert seen.page.locator(".explain").is_hidden()
    assert seen.do("cplan.view.model.paths.length") == 0
    assert seen.page.get_by_role("button", name="Why?").is_visible()


def test_a_blocked_goal_is_explained_on_the_live_page(serve):
    seen = serve(*SHELF)
    assert not seen.page.get_by_role("button", name="Why?").is_visible(), "there is nothing to ask"
    seen.do("cplan.editor.setConfiguration('goal', [0.14, 0])")
    settled(seen)
    asked(seen)
    assert seen.page.locator(".explain .headline").inner_text() == "At the goal, the forearm hits the shelf."
    seen.page.get_by_role("button", name="Apply: Move it 96 mm up").click()
    assert settled(seen)["verdict"] == "found"


def test_a_task_is_not_explained_on_the_live_page(show):
    server = Server([ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/tasks/elbow_choice.toml"])
    seen = show(server.address)
    settled(seen)
    assert not seen.page.get_by_role("button", name="Why?").is_visible()
    server.end()
