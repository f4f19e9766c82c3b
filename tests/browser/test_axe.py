"""Accessibility for users of a keyboard or a screen reader, or with weak eyes: axe finds nothing on any page, light or
dark, on a desktop or a phone.
"""

import pytest
from axe_playwright_python.sync_playwright import Axe
from conftest import ROOT

LOOKS = [("light", 1400, 1000), ("dark", 1400, 1000), ("light", 390, 844), ("dark", 390, 844)]


def faults(seen):
    """Returns the findings of axe: each violated rule, with place and reason."""
    found = Axe().run(seen.page).response
    assert found["passes"], "axe has looked at nothing"
    return [
        f"{violation['id']}: {node['target']}: {node['failureSummary']}"
        for violation in found["violations"]
        for node in violation["nodes"]
    ]


def is_in_place(seen):
    """Returns true if the page does not scroll sideways, not even on a phone."""
    return seen.do("document.documentElement.scrollWidth <= document.documentElement.clientWidth")


@pytest.fixture(scope="module")
def pages(program):
    """Returns pages of a plan, a proof, a task, comparisons, a study and a convergence."""
    robot, shelf, closed = (
        ROOT / f"{name}" for name in ("robots/planar_2r.urdf", "workspaces/shelf.toml", "workspaces/no_path.toml")
    )
    made = {
        "plan": program.plan("planar_2r", "shelf")[0],
        "proof": program.plan("planar_2r", "no_path", code=3)[0],
        "task": program.plan("scara", "tasks/kitting_cell")[0],
        "moving": program.plan("planar_2r", "moving/gate")[0],
    }
    for name, words, code in [
        ("report", ["compare", robot, shelf, "--quiet"], 0),
        ("infeasible", ["compare", robot, closed, "--planner", "shortest", "--planner", "first", "--quiet"], 3),
        ("queries", ["compare", robot, shelf, "--queries", "5", "--planner", "shortest", "--planner", "wavefront", "--quiet"], 0),
        ("study", ["study", ROOT / "workspaces/studies/base.toml", "--quiet"], 0),
    ]:
        made[name] = program.folder / f"axe_{name}.html"
        program.run(*words, "--output", made[name], code=code)
    made["reach"], made["inspection"] = (program.folder / f"axe_{name}.html" for name in ("reach", "inspection"))
    program.run("reach", robot, shelf, "--cell", "0.1", "--quiet", "--picture", made["reach"])
    program.run("inspect", ROOT / "robots/scara.urdf", ROOT / "workspaces/scara_cell.toml", "--picture", made["inspection"])
    (program.folder / "two.urdf").write_text('<robot name="two"><link name="a"/><link name="b"/></robot>')
    made["defects"] = program.folder / "axe_defects.html"
    program.run("inspect", program.folder / "two.urdf", "--picture", made["defects"], code=1)
    made["exploration"] = program.folder / "axe_exploration.html"
    program.run("explore", robot, shelf, "--quiet", "--timings", "--picture", made["exploration"])
    for name, words, code in [("explained", [robot, closed], 3), ("explained_limits", [robot, ROOT / "workspaces/limits_closed.toml"], 3)]:
        made[name] = program.folder / f"axe_{name}.html"
        program.run("explain", *words, "--quiet", "--picture", made[name], code=code)
    for name, code in [("crossing", 0), ("handover", 0), ("no_room", 3)]:
        made[name] = program.folder / f"axe_{name}.html"
        program.run("cell", ROOT / f"workspaces/cells/{name}.toml", "--quiet", "--picture", made[name], code=code)
    made["convergence"] = program.folder / "axe_convergence.html"
    program.run("converge", robot, shelf, "--cells", "24", "--quiet", "--picture", made["convergence"])
    return made


@pytest.mark.parametrize("name", ["plan", "proof", "task", "moving", "report", "infeasible", "queries", "study", "convergence", "reach", "inspection", "defects", "exploration", "explained", "explained_limits", "crossing", "handover", "no_room"])
def test_nothing_is_found_on_pages(pages, show_file, name):
    for scheme, width, height in LOOKS:
        seen = show_file(pages[name], width=width, height=height, color_scheme=scheme)
        seen.do("document.querySelectorAll('details').forEach((folded) => { folded.open = true; })")
        seen.do("document.querySelector('tr[data-path] button')?.focus()")
        assert faults(seen) == [], f"{name}, {scheme}, {width} pixels wide"
        assert is_in_place(seen), f"{name}, {width} pixels wide"
        seen.shoot(f"axe_{name}_{scheme}_{width}")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_is_found_in_any_state_of_a_result(pages, show_file, scheme):
    seen = show_file(pages["task"], width=1000, height=900, color_scheme=scheme)
    for state in (
        "cplan.tour.start()", "cplan.tour.end()", "cplan.sideView.choose('space')", "cplan.tabs.choose('plots')", "cplan.tabs.choose('margins')", "cplan.tabs.choose('details')",
        "cplan.dragTip([0.3, 0.2])", "cplan.switchTo('think')", "cplan.switchTo('learn')", "cplan.learn.open('carrying')",
        "cplan.learn.question.submit(new Event('submit'))", "cplan.learn.open('slice')", "cplan.learn.open('tests')", "document.documentElement.style.fontSize = '200%'",
    ):
        seen.do(state)
        assert faults(seen) == [], state


@pytest.mark.parametrize(("scheme", "width", "height"), LOOKS)
def test_nothing_is_found_on_the_live_page(serve, scheme, width, height):
    files = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"]
    seen = serve(*files, width=width, height=height, color_scheme=scheme)
    assert faults(seen) == []
    assert is_in_place(seen)


@pytest.mark.parametrize(("scheme", "width", "height"), LOOKS)
def test_nothing_is_found_on_the_live_page_with_a_notice_and_a_selection(serve, scheme, width, height):
    seen = serve(ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml", width=width, height=height, color_scheme=scheme)
    seen.page.get_by_label("selected", exact=True).select_option("start")
    # A start in the shelf.
    seen.page.get_by_label("shoulder in degrees").fill("11")
    seen.page.get_by_label("elbow in degrees").fill("0")
    seen.page.keyboard.press("Tab")
    seen.until("cplan.blocked?.length && cplan.isCurrent")
    seen.do("document.querySelectorAll('details').forEach((folded) => { folded.open = true; })")
    assert seen.page.locator(".notice.picture").is_visible()
    assert faults(seen) == []
    assert is_in_place(seen)


@pytest.mark.parametrize(("scheme", "width", "height"), LOOKS)
def test_nothing_is_found_on_explanations(pages, show_file, serve, scheme, width, height):
    seen = show_file(pages["explained"], width=width, height=height, color_scheme=scheme)
    seen.page.locator(".change").first.click()
    seen.do("document.documentElement.style.fontSize = '200%'")
    assert faults(seen) == [] and is_in_place(seen)
    live = serve(ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/no_path.toml", width=width, height=height, color_scheme=scheme)
    live.page.get_by_role("button", name="Why?").click()
    live.until("!cplan.view.explain.root.hidden")
    assert faults(live) == [] and is_in_place(live)
