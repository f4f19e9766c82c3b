"""The planner's replay on the page."""

import json

import pytest
from test_page import pixels

PLANNERS = ["shortest", "first", "visibility", "trapezoid", "triangles", "voronoi", "prm", "wavefront", "harmonic", "subdivision"]


def think(seen):
    seen.page.get_by_role("button", name="How it was found", exact=True).click()
    assert seen.do("cplan.mode") == "think"


@pytest.mark.parametrize("planner", PLANNERS)
def test_each_planner_tells_its_run_phase_by_phase(program, show_file, planner):
    page, _ = program.plan("planar_2r", "workbench", "--planner", planner)
    seen = show_file(page)
    still = pixels(seen, "cspace")
    think(seen)
    phases = seen.do("cplan.model.replay")
    assert seen.do("cplan.duration") == pytest.approx(sum(phase["seconds"] for phase in phases))
    begin = 0
    for number, phase in enumerate(phases, 1):
        shown = set()
        for part in (0.05, 0.4, 0.7, 0.99):
            seen.do("(t) => cplan.seek(t)", begin + part * phase["seconds"])
            assert seen.page.locator(".step").inner_text() == f"{number} of {len(phases)}: {phase['caption']}"
            shown.add(pixels(seen, "cspace"))
        assert len(shown) > 2, phase["caption"]
        begin += phase["seconds"]
    seen.shoot(f"think_{planner}")
    # Back in the motion, everything is as before.
    seen.page.get_by_role("button", name="Motion", exact=True).click()
    assert pixels(seen, "cspace") == still


def test_thinking_is_played_by_keyboard_and_each_keeps_its_time(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    keyboard = seen.page.keyboard
    keyboard.press("Shift+ArrowRight")
    assert seen.do("cplan.time") == pytest.approx(0.5)
    keyboard.press("t")
    # The page begins at the end of the first phase, because its beginning shows nothing. Playing begins at the beginning.
    assert seen.do("cplan.mode") == "think" and seen.do("cplan.time") == pytest.approx(seen.do("cplan.replay[0].seconds"), abs=0.01)
    assert seen.page.locator(".caption .key li").all_inner_texts() == ["free", "colliding: white, or under a C-obstacle", "undecided"]
    seen.do("cplan.toggle()")
    seen.until("cplan.time < 0.5 * cplan.replay[0].seconds")
    seen.do("cplan.pause()")
    assert seen.page.locator(".plots").is_hidden()
    for _ in range(4):
        keyboard.press("+")
    keyboard.press(" ")
    seen.until("cplan.time === cplan.duration && !cplan.playing")
    assert "certified" in seen.page.locator(".step").inner_text()
    keyboard.press("Home")
    keyboard.press("ArrowRight")
    assert seen.do("cplan.time") == pytest.approx(seen.do("cplan.replay[0].seconds"), abs=0.01), "the end of the first phase"
    keyboard.press("t")
    assert (seen.do("cplan.mode"), seen.do("cplan.time")) == ("move", pytest.approx(0.5))
    # Screen readers announce each phase once.
    assert seen.page.locator(".step").get_attribute("aria-live") == "polite"
    pressed = seen.page.get_by_role("group", name="What is played").get_by_role("button", pressed=True)
    assert pressed.all_inner_texts() == ["Motion"]


def test_keys_act_after_a_click_on_the_mode(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    think(seen)
    assert "opening" in seen.page.locator(".play").get_attribute("class"), "the button to play stands out"
    opening = seen.do("cplan.time")
    keyboard = seen.page.keyboard
    keyboard.press("ArrowRight")
    assert seen.do("cplan.moment.index") == 1 and seen.do("cplan.time") > opening
    assert "opening" not in seen.page.locator(".play").get_attribute("class")
    keyboard.press("Home")
    assert seen.do("cplan.time") == 0
    # Space plays once, although a button has the focus.
    keyboard.press(" ")
    seen.until("cplan.playing && cplan.time > 0")
    assert seen.do("cplan.mode") == "think" and seen.do("document.activeElement.dataset.mode") == "think"
    keyboard.press(" ")
    assert not seen.do("cplan.playing")
    # On the button of another mode, Space chooses this mode.
    seen.page.get_by_role("button", name="Motion", exact=True).focus()
    keyboard.press(" ")
    assert seen.do("cplan.mode") == "move" and not seen.do("cplan.playing")


def test_the_arm_stands_where_the_planner_looks(program, show_file):
    page, _ = program.plan("planar_2r", "workbench", "--planner", "voronoi")
    seen = show_file(page)
    think(seen)
    edges = seen.do("cplan.world.trace.edges")
    ends = [tuple(edges[k : k + 2]) for k in range(0, len(edges), 2)]
    # A configuration at an edge's end, not the start.
    seen.do("cplan.seek(0.6 * cplan.model.replay[0].seconds)")
    at = seen.do("cplan.q")
    middles = [((a[0] + b[0]) / 2, (a[1] + b[1]) / 2) for a, b in zip(ends[::2], ends[1::2])]
    assert any(at == pytest.approx(q, abs=1e-9) for q in ends + middles)
    assert at != seen.do("cplan.beginning()")


def test_what_is_proven_impossible_is_told_at_once_and_ends_with_the_proof(program, show_file):
    page, _ = program.plan("planar_2r_continuous", "no_path", code=3)
    seen = show_file(page)
    assert seen.do("cplan.mode") == "think" and seen.do("cplan.time") == seen.do("cplan.duration")
    assert seen.page.locator("button[data-mode=think]").inner_text() == "How it was proven"
    assert "there is no path" in seen.page.locator(".step").inner_text()
    proven = pixels(seen, "cspace")
    seen.page.keyboard.press("Home")
    assert pixels(seen, "cspace") != proven
    seen.shoot("think_proof")


def test_each_motion_of_a_task_is_told(program, show_file):
    page, _ = program.plan("rrbot_vertical", "tasks/tower")
    seen = show_file(page)
    seen.do("cplan.seek(0)")
    still = pixels(seen, "cspace")
    # The replay of the current motion comes first.
    third = seen.do("cplan.model.motions[2].from")
    seen.do("(t) => cplan.seek(t + 0.01)", third)
    think(seen)
    steps = seen.page.locator(".gantt .bar")
    current = lambda: [seen.page.locator(".gantt [aria-current=step]").get_attribute("aria-label").split(".")[0]]
    assert current() == ["3"] and seen.do("cplan.moment.index") == 0
    told = set()
    for number in range(1, seen.do("cplan.model.motions.length")):
        steps.nth(number - 1).click()
        assert current() == [str(number)]
        phases = seen.do("cplan.replay")
        assert seen.do("cplan.duration") == pytest.approx(sum(phase["seconds"] for phase in phases))
        label = seen.do("(k) => cplan.model.motions[k].label", number - 1)
        seen.do("cplan.seek(cplan.duration)")
        assert seen.page.locator(".step").inner_text() == f"{label}. {len(phases)} of {len(phases)}: {phases[-1]['caption']}"
        # At the end, that motion's path is visible, and no other.
        path = seen.do("(k) => cplan.model.paths[cplan.model.motions[k].path].points", number - 1)
        assert seen.do("Think.paths(cplan, cplan.pathsHere()).map(({ points }) => points)") == [pytest.approx(path)]
        whole = pixels(seen, "cspace")
        seen.do("cplan.seek(0.3 * cplan.duration)")
        assert pixels(seen, "cspace") != whole
        told.add(tuple(phase["kind"] for phase in phases))
    assert {("path",), ("slabs", "slices", "path")} <= told, "straight ones, and some that had to be found"
    seen.shoot("think_task")
    # The last entry, after all steps, has no replay.
    assert steps.last.is_disabled()
    seen.page.keyboard.press("t")
    assert seen.do("cplan.mode") == "move" and seen.do("cplan.time") == pytest.approx(third + 0.01)
    seen.do("cplan.seek(0)")
    assert pixels(seen, "cspace") == still
    steps.nth(1).click()
    assert seen.do("cplan.time") == pytest.approx(seen.do("cplan.model.motions[1].from"))


def test_a_cell_of_many_steps_stays_small(program):
    page, _ = program.plan("scara", "tasks/kitting_cell")
    text = page.read_text()
    begin = text.index(">", text.index('<script id="view"')) + 1
    view = json.loads(text[begin : text.index("</script>", begin)])
    assert len(json.dumps(view["replays"], separators=(",", ":"))) <= 200_000
    assert all("replay" in motion for motion in view["motions"][:-1]) and len(view["motions"]) == 25


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_controls_fit_a_phone(program, show_file, scheme):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page, width=360, height=740, color_scheme=scheme)
    think(seen)
    seen.do("cplan.seek(cplan.duration / 2)")
    assert seen.do("document.documentElement.scrollWidth <= innerWidth")
    # The bar of time shares its row with the play button and the clock.
    assert seen.page.get_by_label("time", exact=True).bounding_box()["width"] > 180
    seen.shoot(f"think_phone_{scheme}")


def test_the_page_stays_small(program):
    page, _ = program.plan("planar_2r", "shelf")
    text = page.read_text()
    replay = text[text.index('"replay":') : text.index("</script>", text.index('"replay":'))]
    assert len(replay) < 60_000
