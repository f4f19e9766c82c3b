"""Pages of tasks as storyboards, and the proof that closes for the default planner."""

import pytest

LOOKS = [("light", 1280, 720), ("dark", 1280, 720), ("light", 390, 844), ("dark", 390, 844)]


@pytest.fixture(scope="module")
def kitting(program):
    return program.plan("scara", "tasks/kitting_cell")


def shown(seen):
    """The steps in the chart: label, and left and right end as shares of the time."""
    return seen.do(
        """() => { const lane = document.querySelector('.gantt .lane').getBoundingClientRect();
        return [...document.querySelectorAll('.gantt .bar')].map((bar) => { const box = bar.getBoundingClientRect();
          return [bar.getAttribute('aria-label'), (box.left - lane.left) / lane.width, (box.right - lane.left) / lane.width,
            bar.closest('.row').querySelector('.object').textContent, bar.classList.contains('held')]; }); }"""
    )


def test_each_object_has_a_row_with_its_steps_in_time(kitting, show_file):
    page, plan = kitting
    seen = show_file(page, width=1280, height=720)
    duration, steps = plan["duration"], plan["steps"]
    bars = shown(seen)
    rows = seen.page.locator(".gantt .row").count()
    assert len(bars) == len(seen.do("cplan.model.motions")) >= len(steps) and rows == 13, "twelve objects, and the arm alone"
    by_label = {label.split(",")[0].split(". ", 1)[0]: (left, right, object_, held) for label, left, right, object_, held in bars}
    for number in range(1, len(steps) + 1):
        left, right, object_, held = by_label[str(number)]
        start = seen.do(f"cplan.model.motions[{number - 1}].from")
        assert left == pytest.approx(start / duration, abs=0.004) and right > left
        assert held == (number % 2 == 0), "picks are outlined, transports filled"
        carried = seen.do(f"cplan.model.worlds[cplan.model.motions[{number - 1 + number % 2}].world].payload.object")
        assert object_ == carried


def test_the_chart_is_the_scrubber(kitting, show_file):
    page, plan = kitting
    seen = show_file(page, width=1280, height=720)
    seen.page.evaluate("document.querySelector('.gantt').scrollIntoView()")
    lane = seen.page.locator(".gantt .lane").first.bounding_box()
    mouse, y = seen.page.mouse, lane["y"] + 2 * lane["height"] + 1
    mouse.move(lane["x"] + 0.25 * lane["width"], y)
    mouse.down()
    mouse.move(lane["x"] + 0.5 * lane["width"], y, steps=4)
    mouse.up()
    assert seen.do("cplan.time") == pytest.approx(plan["duration"] / 2, rel=0.01)
    cursor = seen.page.locator(".gantt .cursor").bounding_box()
    assert cursor["x"] + 1 == pytest.approx(lane["x"] + lane["width"] / 2, abs=2)
    slider = seen.do("Number(cplan.parts.scrubber.value)")
    assert slider == pytest.approx(seen.do("cplan.time")), "the slider above the rows follows"
    seen.page.locator(".gantt .bar").nth(4).click()
    assert seen.do("cplan.time") == seen.do("cplan.model.motions[4].from")
    assert seen.page.locator(".gantt .bar[aria-current=step]").count() == 1


def test_a_task_opens_at_its_hardest_motion(kitting, show_file):
    page, plan = kitting
    seen = show_file(page)
    motions = seen.do("cplan.model.motions")
    carrying = [m for m in motions if "clearance" in m and seen.do(f"Boolean(cplan.model.worlds[{m['world']}].payload)")]
    hardest = min(carrying, key=lambda motion: motion["clearance"])
    assert seen.do("cplan.motion.label") == hardest["label"]
    assert seen.do("cplan.time") > hardest["from"]
    assert min(m["clearance"] for m in motions if "clearance" in m) >= plan["clearance"] - 1e-12
    # An address that asks for the motion opens it at its beginning.
    seen.page.goto(f"{page.as_uri()}#move")
    seen.page.reload()
    assert seen.do("cplan.time") == 0


def test_destinations_are_outlined_from_the_beginning(kitting, show_file):
    page, plan = kitting
    seen = show_file(page)
    places = seen.do("cplan.model.places.map(({ name }) => name)")
    assert sorted(set(places)) == sorted({step["object"] for step in plan["steps"] if "object" in step})
    # The plan view is zoomed to where things happen: all places and the base are in sight, and fill most of it.
    inside = """() => { const [x, y] = [cplan.panels.workspace.x, cplan.panels.workspace.y];
      return cplan.model.places.every(({ pieces }) => pieces.every(({ core }) => core[0] > x[0] && core[0] < x[1] && core[1] > y[0] && core[1] < y[1])); }"""
    assert seen.do(inside)
    size = lambda ranges: (ranges[0][1] - ranges[0][0]) * (ranges[1][1] - ranges[1][0])
    assert size(seen.do("[cplan.panels.workspace.x, cplan.panels.workspace.y]")) < 0.6 * size(seen.do("cplan.model.frame"))


def test_an_arch_is_seen_from_the_side(kitting, show_file):
    page, _ = kitting
    seen = show_file(page)
    view, space = seen.page.locator(".side-view canvas"), seen.page.locator("canvas[aria-label='Configuration space']")
    assert view.is_visible() and not space.is_visible()
    places = seen.do("cplan.sideView.placesOf(cplan.motion)")
    heights, ways = [height for *_, height in places], [way for _, way, _ in places]
    assert ways == sorted(ways) and max(heights) > heights[0] + 50
    assert heights[0] == pytest.approx(min(heights), abs=0.1) and heights[-1] == pytest.approx(min(heights), abs=0.1)
    # In the middle of the way the tool is up.
    middle = min(places, key=lambda place: abs(place[1] - ways[-1] / 2))
    assert middle[2] > min(heights) + 0.8 * (max(heights) - min(heights))
    seen.page.get_by_role("button", name="Space of this step").click()
    assert space.is_visible() and not view.is_visible()
    # The replay and the course show the configuration space.
    seen.page.get_by_role("button", name="Side view").click()
    seen.do("cplan.switchTo('think')")
    assert space.is_visible() and not view.is_visible()


def test_a_task_without_strokes_keeps_its_configuration_space(program, show_file):
    page, _ = program.plan("rrbot_vertical", "tasks/tower")
    seen = show_file(page)
    assert seen.page.locator("canvas[aria-label='Configuration space']").is_visible()
    assert seen.page.locator(".right-choice").is_hidden() and seen.page.locator(".gantt").is_visible()


def test_rounds_and_waits_are_marked(program, show_file):
    page, plan = program.plan("scara", "arch/pick_and_place")
    seen = show_file(page)
    rounds = max(step.get("cycle", 1) for step in plan["steps"])
    if rounds > 1:
        assert seen.page.locator(".gantt .rounds span").all_inner_texts()[0] == f"round 1 of {rounds}"
    page, plan = program.plan("planar_2r", "shelf")
    alone = show_file(page)
    assert alone.page.locator(".gantt").is_hidden() and alone.page.locator(".transport .slider").is_visible()


@pytest.mark.parametrize(("scheme", "width", "height"), LOOKS)
def test_storyboards_fit_their_pages(kitting, show_file, scheme, width, height):
    seen = show_file(kitting[0], width=width, height=height, color_scheme=scheme)
    seen.shoot(f"storyboard-{scheme}-{width}")
    assert seen.do("document.documentElement.scrollWidth") <= width
    if width > 1000:
        head = seen.page.locator(".gantt .head").bounding_box()
        assert head["y"] + head["height"] <= height, "the scrubber is in sight"
    # No name lies on another one.
    assert seen.page.locator(".gantt .bar").first.bounding_box()["height"] >= 10


def test_the_proof_closes(program, show_file):
    page, plan = program.plan("planar_2r", "shelf")
    seen = show_file(page, width=1280, height=720)
    assert seen.page.locator(".closing").is_hidden()
    seen.do("cplan.switchTo('think')")
    assert seen.page.locator(".closing canvas").is_visible()
    found = seen.do("Closing.curves(cplan.replay)")
    lower, upper = [[value for _, value in found[kind]] for kind in ("lower", "upper")]
    assert lower == sorted(lower) and upper == sorted(upper, reverse=True) and len(lower) > 3
    assert max(lower) <= min(upper), "a lower bound is never above a path"
    assert upper[-1] == pytest.approx(plan["optimum"]["length"], abs=1e-9)
    assert lower[-1] == pytest.approx(plan["optimum"]["lower_bound"], abs=1e-9)
    # Without any wall, no motion is shorter than the straight line from start to goal.
    (a, b), (c, d) = plan["path"][0], plan["path"][-1]
    assert lower[0] == pytest.approx(((a - c) ** 2 + (b - d) ** 2) ** 0.5, abs=1e-6)
    phases = seen.do("cplan.replay.map(({ kind, seconds, caption }) => [kind, seconds, caption])")
    assert [kind for kind, *_ in phases] == ["slabs", "first", "bound", "slices", "path"]
    assert all(4 <= seconds <= 6 for _, seconds, _ in phases)
    seen.do("cplan.seek(cplan.duration)")
    assert "at most 0.009 % apart" in seen.page.locator(".closing p").inner_text()
    seen.shoot("proof-closes")


def test_arrow_keys_step_from_phase_to_phase(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    seen.do("cplan.switchTo('think'); document.activeElement.blur()")
    seen.do("cplan.seek(0)")
    captions = []
    for _ in range(5):
        seen.page.keyboard.press("ArrowRight")
        captions.append(seen.page.locator(".step").inner_text()[:6])
    assert captions == [f"{k} of 5" for k in range(1, 6)]
    seen.page.keyboard.press("ArrowLeft")
    assert seen.page.locator(".step").inner_text().startswith("4 of 5")


def test_a_clearance_that_no_machine_keeps_is_a_warning(program, show_file):
    page, plan = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    card = seen.page.locator(".card.warning")
    other = program.plan("planar_2r", "shelf", "--clearance", "10mm")[1]["length"]
    assert plan["clearance"] < 1e-3 and f"--clearance 10mm keeps this distance, with length {other:.4f} rad" in card.inner_text()
    assert seen.page.locator("h1").inner_text() == "The shortest path: 4.4920 rad, proven within 0.009 %"
    kept, _ = program.plan("planar_2r", "shelf", "--clearance", "20mm")
    assert show_file(kept).page.locator(".card.warning").count() == 0


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (1440, 900), (390, 844)])
def test_a_page_without_a_path_says_what_opens_one(program, show_file, width, height):
    page, result = program.plan("planar_2r", "no_path", code=3)
    seen = show_file(page, width=width, height=height)
    assert seen.page.locator("h1").inner_text() == "No path: the front wall is in the way"
    cards = seen.page.locator(".change .title").all_inner_texts()
    assert any(card.startswith("Move it ") for card in cards) and "Remove it" in cards
    # The blamed wall is marked, and the arm is at the start, not on the wall.
    assert seen.do("cplan.model.stuck.blockers.map((k) => cplan.world.obstacles[k].name)") == ["front wall"]
    assert seen.do("cplan.q") == pytest.approx(seen.do("cplan.model.start"))
    # The bar with the time covers no picture.
    bar = seen.page.locator(".transport").bounding_box()
    for name in ("Workspace", "Configuration space"):
        box = seen.page.locator(f"canvas[aria-label='{name}']").bounding_box()
        assert bar["y"] >= box["y"] + box["height"] - 1
    seen.shoot(f"no-path-{width}")


def test_a_task_that_fails_opens_before_its_step_and_says_what_opens_a_path(program, show_file):
    page, _ = program.plan("gantry", "tasks/board_and_gate", code=3)
    seen = show_file(page, width=1280, height=1300)
    title = seen.page.locator("h1").inner_text()
    assert title == "Step 3 fails: the lower wall and the upper wall are in the way, and the head slide cannot slide far enough"
    assert seen.do("cplan.time") == seen.do("cplan.duration") and seen.do("cplan.isStuckHere")
    walls = "cplan.model.stuck.blockers.map((k) => cplan.world.obstacles[k].name)"
    assert sorted(seen.do(walls)) == ["lower wall", "upper wall"]
    # Elsewhere, nothing is blamed.
    seen.do("cplan.seek(0.1)")
    assert not seen.do("cplan.isStuckHere")
    # A card shows the failed step in the changed world: only the moved wall is elsewhere, and the path is free.
    card = seen.page.get_by_role("button", name="Move the lower wall 101 mm down")
    old = seen.do("JSON.stringify(cplan.model.worlds.map(({ obstacles }) => obstacles))")
    card.click()
    assert seen.do("cplan.time") == seen.do("cplan.duration")
    assert "undefined" not in seen.do("cplan.pathsWithNames().map(({ step }) => String(step)).join()")
    hits = """(() => { const points = [...Geometry.pointsOf(cplan.pathsHere()[0].points)];
        const world = cplan.world; let worst = Infinity;
        for (let k = 0; k + 1 < points.length; k += 1) for (let i = 0; i <= 40; i += 1) {
          const q = points[k].map((x, j) => x + (points[k + 1][j] - x) * i / 40);
          worst = Math.min(worst, Geometry.contacts(cplan.model.arm, world, q)[0]?.distance ?? Infinity);
        }
        return worst; })()"""
    assert seen.do(hits) >= -1e-6
    names = seen.do("cplan.world.obstacles.map(({ name }) => name)")
    lower = names.index("lower wall")
    assert seen.do(f"cplan.world.obstacles[{lower}].pieces") != seen.do(f"cplan.explain.base.worlds[cplan.explain.place].obstacles[{lower}].pieces")
    card.click()
    assert seen.do("JSON.stringify(cplan.model.worlds.map(({ obstacles }) => obstacles))") == old
    seen.shoot("task-fails")


def test_the_goals_of_a_failed_step_and_its_blocking_obstacles_are_in_sight(program, show_file):
    page, _ = program.plan("scara", "tasks/slot_rigid", code=3)
    seen = show_file(page, width=390, height=844)
    # The rail is picked at y = -0.2 m, and the far jaw ends at y = 0.4 m.
    low, high = seen.do("cplan.panels.workspace.y")
    assert low < -0.2 and high > 0.4
    # The joint values of all attempts are folded.
    attempt = seen.page.locator(".lines details p").first
    assert seen.page.locator(".lines > p").count() == 3 and not attempt.is_visible()
    seen.page.locator(".lines summary").click()
    assert attempt.is_visible()
    assert "With nothing in the way, there is a certified path." in seen.page.locator(".explain").inner_text()
    assert seen.page.locator(".status").bounding_box()["height"] < 40
