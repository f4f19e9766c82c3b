"""The page of `--picture plan.html`."""

import json
import math
import random
import re

import pytest
from conftest import ROOT

# Robots of all kinds, each with a workspace.
CASES = [
    ("planar_2r", "workbench"),
    ("planar_2r_continuous", "torus_open"),
    ("scara", "scara_tray"),
    ("polar", "polar_gate"),
    ("slide_arm", "slide_table"),
    ("gantry", "gantry_maze"),
    ("l_forearm", "l_hook"),
]


def pixels(seen, panel):
    """Returns the pixels of a panel, to detect changes."""
    return seen.do("(panel) => cplan.panels[panel].canvas.toDataURL()", panel)


@pytest.mark.parametrize(("robot", "world"), CASES)
def test_contacts_are_those_of_the_program(program, show_file, robot, world):
    page, _ = program.plan(robot, world)
    seen = show_file(page)
    domains = seen.do("cplan.model.arm.joints.map((joint) => joint.domain)")
    source = random.Random(1)
    files = [ROOT / f"robots/{robot}.urdf", ROOT / f"workspaces/{world}.toml"]
    touching = 0
    for _ in range(25):
        q = [source.uniform(*domain) for domain in domains]
        seen.do("(q) => cplan.examine(q)", q)
        shown = seen.do("cplan.probe.contacts")
        said = json.loads(program.run("check", *files, f"--at={q[0]!r},{q[1]!r}", "--json"))
        assert shown[0]["distance"] == pytest.approx(said["clearance"], abs=3e-5)
        tip = seen.do("(q) => Geometry.tipAt(cplan.model.arm, q)", q)
        assert tip == pytest.approx(said["tip"], abs=1e-9)
        hits = {contact["obstacle"] for contact in said["contacts"] if contact["touching"]}
        names = seen.do("cplan.world.obstacles.map((obstacle) => obstacle.name)")
        assert {names[c["obstacle"]] for c in shown if c["distance"] <= 0} == hits
        text = seen.page.locator(".probe").inner_text()
        assert all(name in text for name in hits)
        assert ("touches" in text) == bool(hits)
        touching += bool(hits)
    assert 0 < touching < 25, "both are seen"


def test_the_arm_is_where_the_trajectory_says(program, show_file):
    page, result = program.plan("planar_2r", "workbench")
    seen = show_file(page)
    motion = result["trajectory"]
    for k in range(0, len(motion["time"]), 7):
        seen.do("(t) => cplan.seek(t)", motion["time"][k])
        assert seen.do("cplan.q") == pytest.approx(motion["position"][k], abs=2e-5)
    seen.do("(t) => cplan.seek(t)", motion["time"][-1] + 5)
    assert seen.do("cplan.time") == pytest.approx(motion["time"][-1], abs=1e-6)


def test_time_runs_and_obeys(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    duration = seen.do("cplan.duration")
    before = pixels(seen, "workspace")
    seen.page.get_by_label("speed").select_option("10")
    seen.page.get_by_role("button", name="play").click()
    seen.until("cplan.time === cplan.duration && !cplan.playing")
    assert pixels(seen, "workspace") != before
    seen.page.get_by_label("time", exact=True).fill(str(duration / 2))
    assert seen.do("cplan.time") == pytest.approx(duration / 2)
    # The middle of the third plot is the middle of the time.
    plot = seen.page.locator(".plots canvas").nth(2)
    box = plot.bounding_box()
    plot.click(position={"x": box["width"] * 0.3, "y": box["height"] / 2})
    assert 0.1 * duration < seen.do("cplan.time") < 0.4 * duration


def test_everything_can_be_done_by_keyboard(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    keyboard = seen.page.keyboard
    keyboard.press("ArrowRight")
    assert seen.do("cplan.time") == pytest.approx(0.05)
    keyboard.press("End")
    assert seen.do("cplan.time") == seen.do("cplan.duration")
    keyboard.press("Home")
    keyboard.press("+")
    assert seen.do("cplan.speed") == 2
    keyboard.press(" ")
    assert seen.do("cplan.playing")
    keyboard.press(" ")
    assert not seen.do("cplan.playing")
    # The tab key reaches every control, and each has a name.
    reached = set()
    for _ in range(40):
        keyboard.press("Tab")
        reached.add(seen.do("document.activeElement.dataset.layer ?? document.activeElement.dataset.obstacle ?? document.activeElement.tagName"))
    layers = {"c-obstacles", "path", "poses", "names"}
    assert layers | {"shelf", "crate", "CANVAS", "BUTTON", "INPUT", "SELECT", "SUMMARY"} <= reached
    nameless = seen.do(
        """[...document.querySelectorAll('button, input, select, canvas')].filter((e) =>
             !(e.getAttribute('aria-label') || e.closest('label, button')?.textContent.trim())).length"""
    )
    assert nameless == 0
    # The cross in the configuration space begins where the arm is.
    seen.do("cplan.seek(0)")
    seen.page.locator("canvas[aria-label='Configuration space']").focus()
    for _ in range(6):
        keyboard.press("Shift+ArrowLeft")
    q = seen.do("cplan.probe.q")
    assert q == pytest.approx([-0.9 - math.radians(60), 0.4], abs=1e-4)
    keyboard.press("Escape")
    assert seen.do("cplan.probe") is None


def test_pointing_into_the_configuration_space_puts_the_arm_there(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    box = seen.page.locator("canvas[aria-label='Configuration space']").bounding_box()
    spot = seen.do("cplan.panels.cspace.at([0.139626, 0])")
    before = pixels(seen, "workspace")
    seen.page.mouse.move(box["x"] + spot[0], box["y"] + spot[1])
    text = seen.page.locator(".probe").inner_text()
    assert "touches" in text and 'link "forearm" and "shelf"' in text
    assert pixels(seen, "workspace") != before
    seen.page.mouse.down()
    seen.page.mouse.up()
    seen.page.mouse.move(5, 5)
    assert "touches" in seen.page.locator(".probe").inner_text(), "a click holds it"
    seen.shoot("contact")
    seen.page.keyboard.press("Escape")
    assert seen.page.locator(".probe").inner_text() == ""


LAYERS = [
    (("planar_2r", "workbench"), ("--planner", "visibility"), {"roadmap"}),
    (("planar_2r", "workbench"), ("--planner", "trapezoid"), {"cells", "channel"}),
    (("planar_2r", "workbench"), ("--planner", "triangles"), {"cells", "channel", "expanded"}),
    (("planar_2r_continuous", "torus_open"), ("--planner", "prm"), {"roads", "expanded"}),
    (("planar_2r", "shelf"), ("--planner", "voronoi"), {"roads", "expanded"}),
    (("planar_2r", "workbench"), ("--planner", "wavefront"), {"wavefront"}),
    (("planar_2r_continuous", "torus_open"), ("--planner", "harmonic"), {"equipotentials", "flow"}),
    (("planar_2r", "workbench"), ("--planner", "subdivision"), {"boxes"}),
]


@pytest.mark.parametrize(("files", "words", "layers"), LAYERS, ids=lambda value: value[-1] if isinstance(value, tuple) else "")
def test_layers_come_and_go(program, show_file, files, words, layers):
    page, _ = program.plan(*files, *words)
    seen = show_file(page)
    shown = lambda: set(seen.do("[...document.querySelectorAll('.legend li:not([hidden]) [data-layer]')].map((box) => box.dataset.layer)"))
    motion = {"c-obstacles", "path", "poses", "names"}
    # What the planner did is not drawn over the motion.
    assert shown() == motion
    seen.do("cplan.switchTo('think')")
    seen.do("cplan.seek(cplan.duration)")
    there = shown()
    assert there == layers | motion
    for layer in sorted(there):
        panel = "workspace" if layer == "poses" else "cspace"
        before = pixels(seen, panel)
        seen.page.locator(f"[data-layer='{layer}']").click()
        assert pixels(seen, panel) != before, layer
        seen.page.locator(f"[data-layer='{layer}']").click()
        assert pixels(seen, panel) == before, layer
    if "flow" in there:
        seen.page.locator("[data-layer='flow']").check()
    seen.shoot(f"planner-{words[-1]}")


def test_obstacles_can_be_hidden_one_by_one(program, show_file):
    page, _ = program.plan("planar_2r", "workbench")
    seen = show_file(page)
    before = [pixels(seen, "workspace"), pixels(seen, "cspace")]
    seen.page.locator("[data-obstacle='vice']").uncheck()
    after = [pixels(seen, "workspace"), pixels(seen, "cspace")]
    assert before[0] != after[0] and before[1] != after[1], "alike in both"


def test_no_path_shows_its_proof(program, show_file):
    page, result = program.plan("planar_2r_continuous", "no_path", code=3)
    seen = show_file(page)
    assert "infeasible: proven" in seen.page.get_by_role("status").inner_text()
    assert seen.do("cplan.world.proof.length") == 4 * len(result["proof"])
    before = pixels(seen, "cspace")
    seen.page.locator("[data-layer='proof']").uncheck()
    assert pixels(seen, "cspace") != before
    # Nothing moves, but the planner's replay can be played.
    assert seen.do("cplan.mode") == "think" and not seen.page.locator(".plots").is_visible()
    seen.page.locator("[data-layer='proof']").check()
    seen.shoot("no-path")


def test_unknown_says_so(program, show_file):
    words = ("--planner", "wavefront", "--cells", "8", "--levels", "1")
    page, result = program.plan("planar_2r", "narrow_slot", *words, code=4)
    seen = show_file(page)
    assert "unknown" in seen.page.get_by_role("status").inner_text()
    assert result["reason"] in seen.page.locator(".facts").inner_text()
    title = seen.page.locator("h1").inner_text()
    assert title.startswith("Not known: ") and result["reason"] in title


def test_a_task_is_followed_step_by_step(program, show_file):
    page, result = program.plan("rrbot_vertical", "tasks/tower")
    seen = show_file(page)
    for event in result["events"]:
        carried = "cplan.world.payload?.object"
        seen.do("(t) => cplan.seek(t)", event["time"] - 0.01)
        before = seen.do(carried)
        seen.do("(t) => cplan.seek(t)", event["time"] + 0.01)
        after = seen.do(carried)
        assert {before, after} == {None, event["object"]}
    for step in result["steps"]:
        seen.do("(t) => cplan.seek(t)", (step["begin"] + step["arrival"]) / 2)
        assert seen.page.locator(".step").inner_text().startswith(f"{step['step']}. ")
    seen.do("(t) => cplan.seek(t)", result["events"][0]["time"] + 0.5)
    seen.shoot("task")


def test_a_step_that_fails_shows_why(program, show_file):
    page, _ = program.plan("gantry", "tasks/board_and_gate", code=3)
    seen = show_file(page)
    seen.do("cplan.seek(cplan.duration)")
    assert "fails" in seen.page.locator(".step").inner_text()
    assert seen.do("cplan.world.proof.length") > 0
    seen.shoot("task-fails")


def test_it_is_readable_in_the_dark_and_on_a_phone(program, show_file):
    page, _ = program.plan("planar_2r", "workbench", "--planner", "wavefront")
    for scheme in ("light", "dark"):
        seen = show_file(page, width=390, height=844, color_scheme=scheme)
        wide = seen.do("document.documentElement.scrollWidth > document.documentElement.clientWidth")
        assert not wide, "nothing sticks out to the side"
        light = seen.do(
            """() => { const rgb = (name) => getComputedStyle(document.body)[name].match(/\\d+/g).map(Number);
                 const luminance = (c) => c.map((v) => v / 255).map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
                   .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
                 return [luminance(rgb('color')), luminance(rgb('backgroundColor'))]; }"""
        )
        assert (light[0] > light[1]) == (scheme == "dark")
        # WCAG's contrast for text.
        assert (max(light) + 0.05) / (min(light) + 0.05) > 7
        seen.shoot(f"phone-{scheme}")


def test_other_commands_make_pages_too(program, show_file):
    files = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"]
    folder = program.folder
    program.run("check", *files, "--at=0.1,0.2", "--picture", "check.html")
    program.run("compare", *files, "--quiet", "--picture", "compare.html")
    program.run("inspect", files[0], "--picture", "inspect.html")
    program.run(*files, "--quiet", "--output", "plan.json")
    program.run("verify", *files, "plan.json", "--picture", "verify.html")
    assert show_file(folder / "check.html").do("cplan.q") == pytest.approx([0.1, 0.2])
    assert show_file(folder / "compare.html").do("cplan.model.paths.length") == 10
    assert show_file(folder / "inspect.html").do("cplan.model.frames.length") == 3
    assert show_file(folder / "verify.html").do("cplan.model.paths.length") == 1


def test_where_the_tip_can_get_is_seen_as_in_the_picture(program, show_file):
    files = [ROOT / "robots/polar.urdf", ROOT / "workspaces/polar_gate.toml"]
    page, picture = program.folder / "reach.html", program.folder / "reach.svg"
    told = json.loads(program.run("reach", *files, "--cell", "0.05", "--json", "--picture", page, "--picture", picture))
    seen = show_file(page)
    reach = seen.do("cplan.model.reach")
    assert reach["size"] == told["reach"]["size"]
    kinds = {"reachable": "01", "unreachable": "2", "blocked": "3", "unknown": "4"}
    for access, letters in kinds.items():
        assert sum(letter in letters for letter in reach["cells"]) == told["cells"][access], access
    # The cells are visible: hiding them changes both panels.
    full = pixels(seen, "workspace"), pixels(seen, "cspace")
    legend = seen.page.locator(".legend li:visible")
    drawn = picture.read_text()
    keys = [key["text"] for key in seen.do("cplan.model.legend")]
    assert set(keys) <= set(legend.all_inner_texts()) and all(text in drawn for text in keys)
    seen.shoot("reach")
    before = legend.count()
    seen.page.get_by_role("checkbox", name="reachable tip positions").uncheck()
    assert pixels(seen, "workspace") != full[0] and pixels(seen, "cspace") != full[1]
    assert legend.count() < before, "the meanings of its colours are hidden, too"


def test_steps_are_numbered_as_they_are_done(program, show_file):
    page, result = program.plan("scara", "tasks/kitting_cell")
    seen = show_file(page)
    labels = seen.do("cplan.model.motions.map(({ label }) => label)")[:-1]
    assert [int(label.split(".")[0]) for label in labels] == list(range(1, 25))
    # The number in the file is shown if it differs.
    named = [re.search(r"\((\d+) in the file\)$", label) for label in labels]
    filed = [int(found[1]) if found else number for number, found in enumerate(named, 1)]
    assert filed == [step["step"] for step in result["steps"]] and filed != sorted(filed)
    assert seen.do("cplan.model.paths.map(({ step }) => step)") == list(range(1, 25))
    assert any("of the file" in text for _, text in seen.do("cplan.model.facts"))


def test_icons_are_drawn_and_not_written(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    play = seen.page.locator(".play")
    assert play.inner_text() == "" and play.locator("svg").get_attribute("data-icon") == "play"
    play.click()
    assert play.locator("svg").get_attribute("data-icon") == "pause" and play.get_attribute("aria-label") == "pause"
    play.click()
    assert play.get_attribute("aria-label") == "play"
    assert seen.page.locator(".zoom svg").count() == seen.page.locator(".zoom button").count() == 6


def test_the_rows_of_steps_follow_the_motion(program, show_file):
    page, _ = program.plan("scara", "tasks/kitting_cell")
    seen = show_file(page, reduced_motion="reduce")
    scrolled = seen.do("window.scrollY")
    for part in (0.3, 0.6, 0.95, 0.1):
        seen.do("(part) => cplan.seek(part * cplan.duration)", part)
        current = seen.page.locator(".gantt [aria-current=step]")
        assert current.count() == 1
        box, around = current.bounding_box(), seen.page.locator(".gantt .rows").bounding_box()
        assert around["y"] - 1 <= box["y"] and box["y"] + box["height"] <= around["y"] + around["height"] + 1
    assert seen.do("window.scrollY") == scrolled, "only the rows scroll"


def test_keys_of_one_character_can_be_switched_off(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    keyboard = seen.page.keyboard
    seen.page.get_by_text("Keys and pointer").click()
    box = seen.page.get_by_role("checkbox", name="Keys of a single character")
    assert box.is_checked()
    box.uncheck()
    box.blur()
    for key in ("k", "t", "l", "+"):
        keyboard.press(key)
    assert seen.do("[cplan.mode, cplan.playing, cplan.speed]") == ["move", False, 1]
    keyboard.press("ArrowRight")
    assert seen.do("cplan.time") == pytest.approx(0.05), "other keys still act"
    keyboard.press(" ")
    assert seen.do("cplan.playing")
    seen.page.reload()
    assert not seen.page.get_by_role("checkbox", name="Keys of a single character", include_hidden=True).is_checked(), "remembered"
    keyboard.press("t")
    assert seen.do("cplan.mode") == "move"


def test_the_replay_shows_whole_phases_to_readers_who_prefer_reduced_motion(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page, reduced_motion="reduce")
    seen.do("cplan.switchTo('think')")
    ends = seen.do("(() => { let sum = 0; return cplan.model.replay.map(({ seconds }) => (sum += seconds)); })()")
    shown = seen.do("[0, 0.1, cplan.duration / 2, cplan.duration].map((time) => cplan.shownTime(time))")
    assert all(any(time == pytest.approx(end, abs=1e-3) for end in ends) for time in shown)
    seen.do("cplan.switchTo('move')")
    assert seen.do("cplan.shownTime(0.1)") == 0.1, "the motion itself moves: the reader started it"


def test_text_in_pictures_follows_the_text_size(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    size = "Number(/([\\d.]+)px/.exec(cplan.panels.workspace.theme.font())[1])"
    before = seen.do(size)
    seen.do("document.documentElement.style.fontSize = '200%'")
    seen.until(f"Math.abs({size} - 2 * {before}) < 0.01")
    assert seen.do("document.documentElement.scrollWidth <= innerWidth")
    seen.shoot("text-200")
    phone = show_file(page, width=390, height=844)
    phone.do("document.documentElement.style.fontSize = '200%'")
    assert phone.do("document.documentElement.scrollWidth <= innerWidth")


def test_the_focus_ring_does_not_cross_titles(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    seen.page.keyboard.press("Tab")
    for name in ("Workspace", "Configuration space"):
        canvas = seen.page.locator(f"canvas[aria-label='{name}']")
        canvas.focus()
        offset, width = seen.do("(() => { const style = getComputedStyle(document.activeElement); return [style.outlineOffset, style.outlineWidth].map(parseFloat); })()")
        assert width > 0 and offset <= -width


def test_numbers_have_few_digits_and_units(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    lengths = seen.do("[4e-6, 0.0204, 0.614, 1.4201, 0, -0.0312].map((x) => Numbers.length(x))")
    assert lengths == ["0.004 mm", "20.4 mm", "614 mm", "1.42 m", "0 mm", "\u221231.2 mm"]
    assert seen.do("[0.9, -1.8136, 0].map((x) => Numbers.angle(x))") == ["51.6°", "\u2212103.9°", "0.0°"]
    bounds = seen.do("[8.4e-5, 0.0341, 1.1964, 0, 1e-9].map((x) => Numbers.percent(x, Math.ceil))")
    assert bounds == ["0.009 %", "3.41 %", "119.64 %", "0 %", "0.001 %"]
    # The readout has degrees, and radians under the pointer.
    seen.do("cplan.examine([0.139626, 0])")
    readout = seen.page.locator(".probe")
    assert readout.inner_text().startswith("shoulder 8.0°, elbow 0.0°: touches")
    assert readout.get_attribute("title") == "shoulder 0.1396 rad, elbow 0.0000 rad"


def test_the_result_comes_first_and_the_panels_are_equal(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page, width=1400, height=1000)
    left, right = (seen.page.locator(f"canvas[aria-label='{name}']").bounding_box() for name in ("Workspace", "Configuration space"))
    assert (left["y"], left["width"], left["height"]) == pytest.approx((right["y"], right["width"], right["height"]))
    rects = seen.do("['workspace', 'cspace'].map((name) => cplan.panels[name].rect)")
    for side in ("x", "y", "width", "height"):
        assert rects[0][side] == pytest.approx(rects[1][side], abs=0.5), side
    # The scrubber stays in sight.
    box = seen.page.locator(".transport").bounding_box()
    assert box["y"] + box["height"] <= 1000.5
    small = show_file(page, width=1400, height=500)
    box = small.page.locator(".transport").bounding_box()
    assert box["y"] + box["height"] <= 500.5


def test_key_figures_are_cards_and_bounds_are_rounded_to_the_safe_side(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    figures = {"duration": 2.063, "gap": 8.41e-5, "clearance": 0.0204999}
    texts = seen.do("(figures) => View.cards({ figures }).map(([, value]) => value)", figures)
    assert texts == ["2.06 s", "at most 0.009 %", "20.49 mm"]
    assert len(seen.do("View.cards({ figures: { duration: 1 } })")) == 1, "what is not proven has no card"
    seen.do("() => { cplan.model.figures = undefined; cplan.headings(); }")
    assert seen.page.locator(".cards").is_hidden(), "no figures, no row"
    seen.do("(figures) => { cplan.model.figures = figures; cplan.headings(); }", figures)
    assert seen.page.locator(".card").count() == 3


def test_tabs_show_one_part_at_a_time(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page, width=1000, height=900)
    parts = {"Layers": ".legend", "Plots": ".plots", "Margins": ".budget", "Details": ".facts"}
    tabs = seen.page.get_by_role("tab")
    assert tabs.all_inner_texts() == list(parts)
    for name in parts:
        tabs.filter(has_text=name).click()
        assert [other for other, where in parts.items() if seen.page.locator(where).is_visible()] == [name]
    seen.page.keyboard.press("ArrowRight")
    assert seen.page.locator(".legend").is_visible(), "arrow keys go round"
    # On a wide page, the layers stand beside the pictures.
    seen.page.set_viewport_size({"width": 1500, "height": 900})
    seen.until("document.querySelectorAll('[role=tab]:not([hidden])').length === 3")
    assert seen.page.locator(".legend").is_visible() and seen.page.locator(".plots").is_visible()
    seen.do("cplan.switchTo('think')")
    assert seen.page.locator(".facts").is_visible(), "the replay has no plots"


def screen(seen, panel, place):
    """Returns the place on the screen for a value in a panel."""
    name = {"workspace": "Workspace", "cspace": "Configuration space"}[panel]
    box = seen.page.locator(f"canvas[aria-label='{name}']").bounding_box()
    x, y = seen.do("([panel, place]) => cplan.panels[panel].at(place)", [panel, place])
    return box["x"] + x, box["y"] + y


TIP = "Geometry.tipAt(cplan.model.arm, cplan.probe?.q ?? cplan.q)"


def test_the_arm_is_dragged_by_its_tip(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    mouse = seen.page.mouse
    mouse.move(*screen(seen, "workspace", seen.do(TIP)))
    assert seen.do("cplan.panels.workspace.canvas.style.cursor") == "grab"
    mouse.down()
    # Into the shelf.
    mouse.move(*screen(seen, "workspace", [1.3, 0.25]), steps=12)
    mouse.up()
    assert seen.do(TIP) == pytest.approx([1.3, 0.25], abs=0.02)
    readout = seen.page.locator(".probe")
    assert "touches" in readout.inner_text() and "shelf" in readout.inner_text()
    # The place of the contact lies in both shapes.
    places = seen.do("cplan.probe.contacts.filter((c) => c.distance <= 0).map(({ at, obstacle }) => [at, cplan.world.obstacles[obstacle].pieces])")
    assert places
    for at, pieces in places:
        assert seen.do("([at, pieces]) => Math.min(...pieces.map((piece) => Geometry.separation({ core: at, radius: 0 }, piece)))", [at, pieces]) < 1e-3
    seen.shoot("dragged")
    # It stays until Escape, or until the motion is played.
    mouse.move(5, 5)
    assert seen.do("cplan.probe") is not None
    seen.page.keyboard.press("Escape")
    assert seen.do("cplan.probe") is None
    mouse.move(*screen(seen, "workspace", seen.do(TIP)))
    mouse.down()
    mouse.move(*screen(seen, "workspace", [-0.5, 0.5]), steps=5)
    mouse.up()
    assert seen.do("cplan.probe") is not None
    seen.page.keyboard.press(" ")
    assert seen.do("cplan.playing") and seen.do("cplan.probe") is None


def test_the_dot_in_the_configuration_space_is_dragged(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    mouse = seen.page.mouse
    mouse.move(*screen(seen, "cspace", seen.do("cplan.q")))
    mouse.down()
    mouse.move(*screen(seen, "cspace", [-2.0, 1.5]), steps=6)
    mouse.up()
    mouse.move(5, 5)
    assert seen.do("cplan.probe.q") == pytest.approx([-2.0, 1.5], abs=0.03)
    mouse.move(*screen(seen, "cspace", [-2.0, 1.5]))
    mouse.down()
    mouse.move(*screen(seen, "cspace", [2.0, 1.0]), steps=6)
    mouse.up()
    mouse.move(5, 5)
    assert seen.do("cplan.probe.q") == pytest.approx([2.0, 1.0], abs=0.03)


def test_the_arm_is_moved_by_keys(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    seen.page.locator("canvas[aria-label='Workspace']").focus()
    seen.page.keyboard.press("Enter")
    before = seen.do(TIP)
    for _ in range(3):
        seen.page.keyboard.press("Shift+ArrowUp")
    after = seen.do(TIP)
    assert after[0] == pytest.approx(before[0], abs=0.05) and after[1] > before[1] + 0.3
    assert seen.do("cplan.time") == 0
    seen.page.keyboard.press("Escape")
    seen.page.keyboard.press("ArrowRight")
    assert seen.do("cplan.time") > 0, "without the examined arm, the keys move in time"


@pytest.mark.parametrize(("robot", "world"), CASES)
def test_inverse_kinematics_keeps_to_limits_and_comes_near(program, show_file, robot, world):
    page, _ = program.plan(robot, world)
    seen = show_file(page)
    worst = seen.do(
        """() => { const { arm } = cplan.model; let worst = 0;
             for (let k = 1; k < 200; k += 1) {
               const part = [(k * 0.618034) % 1, (k * 0.754878) % 1];
               const q = arm.joints.map(({ domain: [low, high] }, j) => low + part[j] * (high - low));
               const place = Geometry.tipAt(arm, q);
               const found = Geometry.inverse(arm, place, q.map((x, j) => Math.min(arm.joints[j].domain[1], x + 0.01)));
               if (found.some((x, j) => x < arm.joints[j].domain[0] - 1e-9 || x > arm.joints[j].domain[1] + 1e-9)) return Infinity;
               worst = Math.max(worst, Math.hypot(...Geometry.tipAt(arm, found).map((x, j) => x - place[j])));
             } return worst; }"""
    )
    assert worst < 1e-6


def test_a_tour_of_four_steps_is_offered_once(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    tour = seen.page.get_by_role("dialog", name="Tour")
    assert not tour.is_visible(), "not to browsers that a program drives"
    seen.do("() => { Object.defineProperty(navigator, 'webdriver', { value: false }); cplan.tour.offer(); }")
    titles = set()
    for number in (1, 2, 3, 4):
        assert f"{number} of 4" in tour.inner_text()
        titles.add(tour.get_by_role("heading").inner_text())
        assert seen.page.locator(".toured").count() == 1
        seen.shoot(f"tour-{number}")
        tour.get_by_role("button", name="Done" if number == 4 else "Next").click()
    assert len(titles) == 4 and not tour.is_visible() and seen.page.locator(".toured").count() == 0
    seen.do("cplan.tour.offer()")
    assert not tour.is_visible(), "only once"
    # It can be seen again, and closed at any step.
    seen.page.get_by_text("Keys and pointer").click()
    seen.page.get_by_role("button", name="Show the tour").click()
    assert tour.is_visible()
    tour.get_by_role("button", name="Close").click()
    assert not tour.is_visible()


@pytest.mark.parametrize("size", [(1400, 900), (1100, 700), (390, 844)])
@pytest.mark.parametrize(("robot", "world", "code"), [("planar_2r", "shelf", 0), ("rrbot_vertical", "tasks/tower", 0), ("planar_2r_continuous", "no_path", 3)])
def test_the_tour_stands_beside_what_it_explains(program, show_file, robot, world, code, size):
    page, _ = program.plan(robot, world, code=code)
    seen = show_file(page, width=size[0], height=size[1])
    seen.do("cplan.tour.start()")
    tour = seen.page.get_by_role("dialog", name="Tour")
    words = ""
    for step in range(seen.do("cplan.tour.steps.length")):
        words += tour.inner_text()
        about = seen.page.locator(".toured")
        if about.is_visible():
            own, other = tour.bounding_box(), about.bounding_box()
            common = [min(own[x] + own[side], other[x] + other[side]) - max(own[x], other[x]) for x, side in (("x", "width"), ("y", "height"))]
            fits = other["height"] + own["height"] + 100 < size[1]
            assert min(common) <= 1 or not fits, (step, own, other)
        tour.locator(".primary").click()
    assert ("Below" in words) == (size[0] < 800) and ("On the left" in words) != ("Below" in words)
    assert ("Space plays" in words) == (code == 0 and not world.startswith("tasks")), "only of a motion that there is"


def test_only_this_path_and_the_next_are_drawn(program, show_file):
    page, _ = program.plan("rrbot_vertical", "tasks/tower")
    seen = show_file(page)
    motions = seen.do("cplan.model.motions")
    for k, motion in enumerate(motions[:-1]):
        seen.do("(t) => cplan.seek(t)", motion["from"] + 1e-3)
        own, following = seen.do("[cplan.pathsHere().map(({ step }) => step), cplan.nextPath?.step ?? null]")
        assert own == [k + 1] and following == (k + 2 if k + 2 < len(motions) else None)
    # A path further on is not drawn.
    seen.do("cplan.seek(0)")
    before = pixels(seen, "workspace")
    seen.do("() => { cplan.model.paths[3].points = cplan.model.paths[0].points; cplan.traces = null; cplan.refresh(); }")
    assert pixels(seen, "workspace") == before


def test_obstacles_that_shape_nothing_fade(program, show_file):
    world = (ROOT / "workspaces/shelf.toml").read_text()
    far = '\n[[obstacle]]\nname = "far"\npolygon = [[2.6, 2.0], [2.9, 2.0], [2.9, 2.3], [2.6, 2.3]]\n'
    (program.folder / "far.toml").write_text(world + far)
    program.run(ROOT / "robots/planar_2r.urdf", "far.toml", "--quiet", "--picture", "far.html")
    seen = show_file(program.folder / "far.html")
    pale = seen.do("cplan.world.obstacles.filter((obstacle) => cplan.isIrrelevant(obstacle)).map(({ name }) => name)")
    assert pale == ["far"]


def test_a_checked_configuration_shows_its_contacts_at_once(program, show_file):
    files = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"]
    program.run("check", *files, "--at=8deg,0deg", "--picture", "hits.html")
    seen = show_file(program.folder / "hits.html")
    readout = seen.page.locator(".probe")
    assert "touches" in readout.inner_text() and '"shelf"' in readout.inner_text()
    assert readout.get_attribute("data-free") == "false"
    # Another configuration can be examined, and the first one comes back.
    seen.do("cplan.place([-2, 1.5])")
    assert "free" in readout.inner_text()
    seen.page.keyboard.press("Escape")
    assert "touches" in readout.inner_text()


def test_a_checked_configuration_shows_where_it_touches_and_the_nearest_free_one(program, show_file):
    page = program.folder / "contact.html"
    files = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"]
    report = json.loads(program.run("check", *files, "--at=0.9,-1.8", "--json", "--picture", page))
    seen = show_file(page)
    checked = seen.do("cplan.model.checked")
    assert checked["is_blocked"] and checked["nearest_free"] == report["nearest_free"]["configuration"]
    corner = report["contacts"][0]["link_corners_inside"][0]["at"]
    assert corner in checked["contacts"] and len(checked["contacts"]) == 3
    keys = seen.page.get_by_role("list", name="Legend").get_by_role("listitem").all_inner_texts()
    assert {"contact", "nearest free configuration"} <= set(keys)
    details = seen.page.locator(".facts").inner_text()
    assert "penetrates by 8.064 mm" in details and "free: shoulder 51.19°" in details


@pytest.mark.parametrize(("robot", "world", "unit"), [("planar_2r", "shelf", "rad"), ("gantry", "gantry_maze", "m"), ("polar", "polar_gate", "in joint space")])
def test_lengths_of_paths_have_units_and_numbers_those_of_the_terminal(program, show_file, robot, world, unit):
    page, result = program.plan(robot, world)
    seen = show_file(page)
    length = f"{result['length']:.4f} {unit}"
    assert length in seen.page.locator("h1").inner_text() and f"length {length}" in seen.page.locator(".lines").inner_text()
    card = seen.page.locator(".card").filter(has_text="clearance").locator("dd").evaluate("(card) => card.firstChild.textContent")
    assert f"proven clearance {card}" in seen.page.locator(".lines").inner_text(), "one number, one rounding"
    if unit == "m":
        return  # Its shortest path is exact, without a search for a bound.
    seen.do("cplan.switchTo('think')")
    seen.do("cplan.seek(cplan.duration)")
    assert f"best path {length}" in seen.page.locator(".lengths").inner_text()


@pytest.mark.parametrize(("robot", "world"), [("planar_2r", "workbench"), ("gantry", "gantry_maze"), ("planar_2r", "narrow_slot")])
def test_on_a_laptop_the_bar_of_time_covers_no_picture(program, show_file, robot, world):
    page, _ = program.plan(robot, world, "--planner", "wavefront")
    seen = show_file(page, width=1280, height=720)
    bar = seen.page.locator(".transport").bounding_box()
    assert bar["y"] + bar["height"] <= 720.5
    for figure in seen.page.locator(".panels figure:visible").all():
        box = figure.bounding_box()
        assert box["y"] + box["height"] <= bar["y"] + 0.5
