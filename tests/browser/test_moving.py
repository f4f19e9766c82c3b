"""Moving obstacles: their places in both panels, at any time of the motion."""

import math

from test_page import pixels


def test_what_moves_is_where_its_stops_say(program, show_file):
    page, plan = program.plan("planar_2r", "moving/crossing")
    seen = show_file(page)
    # The cart's stops: 2.6 m at 0 s, 1.4 m from 0.5 to 2.5 s, 2.6 m at 3.5 s.
    for time, x in [(0, 2.6), (0.25, 2.0), (0.5, 1.4), (1.7, 1.4), (3.0, 2.0), (3.5, 2.6), (9, 2.6)]:
        corners = seen.do("(time) => Geometry.moved(cplan.world.movers[0], time).outline.polygon", time)
        assert math.isclose(sum(corners[::2]) / 4, x, abs_tol=1e-9) and math.isclose(sum(corners[1::2]), 0, abs_tol=1e-9)
    assert math.isclose(seen.do("cplan.duration"), plan["duration"], abs_tol=1e-5)


def test_both_spaces_show_it_in_time(program, show_file):
    page, _ = program.plan("planar_2r", "moving/crossing")
    seen = show_file(page)
    shown = []
    for time in (0, 1.2):
        seen.do("(time) => cplan.seek(time)", time)
        shown.append([pixels(seen, panel) for panel in ("workspace", "cspace")])
        # The arm waits where it began: nothing else has moved.
        assert seen.do("cplan.q") == [-0.9, 0.3]
    for before, after in zip(*shown):
        assert before != after
    seen.page.get_by_role("checkbox", name="cart").uncheck()
    hidden = [pixels(seen, panel) for panel in ("workspace", "cspace")]
    assert all(a != b for a, b in zip(hidden, shown[1]))


def test_the_time_is_written_on_the_configuration_space(program, show_file):
    page, _ = program.plan("planar_2r", "moving/crossing")
    seen = show_file(page)
    seen.do("() => { window.written = []; const prototype = CanvasRenderingContext2D.prototype; const { fillText } = prototype; prototype.fillText = function (text, ...rest) { written.push(text); fillText.call(this, text, ...rest); }; }")
    seen.do("cplan.seek(1.46)")
    assert "1.46 s" in seen.do("written")
    # A world in which nothing moves has no time.
    page, _ = program.plan("planar_2r", "shelf")
    still = show_file(page)
    assert still.do("cplan.world.moments ?? null") is None


def test_the_strip_says_which_obstacle_the_arm_waits_for(program, show_file):
    page, plan = program.plan("planar_2r", "moving/crossing")
    seen = show_file(page)
    strip = seen.do("cplan.model.strip")
    assert [wait["text"] for wait in strip["waits"]] == ["waits 1.46 s for cart"]
    assert math.isclose(strip["duration"], plan["duration"], abs_tol=1e-3)
    wait = seen.page.get_by_role("button", name="waits 1.46 s for cart")
    wait.click()
    assert seen.do("cplan.time") == 0 and wait.get_attribute("aria-current") == "time"
    seen.do("cplan.seek(2)")
    assert wait.get_attribute("aria-current") is None
    assert "waits 1.46 s for cart" in seen.page.locator(".strip canvas").get_attribute("aria-label")


def test_the_motion_passes_between_the_blocked_regions(program, show_file):
    for world in ("crossing", "gate", "swing"):
        page, _ = program.plan("planar_2r", f"moving/{world}")
        seen = show_file(page)
        # Progress never decreases, from 0 to 1, and rests during a wait.
        strip = seen.do("cplan.model.strip")
        progress = strip["motion"][1::2]
        assert progress == sorted(progress) and (progress[0], progress[-1]) == (0, 1)
        for wait in strip["waits"]:
            ends = [seen.do("(t) => Timeline.valueAt(cplan.model.strip.motion, t)", wait[end]) for end in ("from", "to")]
            assert math.isclose(*ends, abs_tol=5e-3) and math.isclose(ends[0], wait["at"], abs_tol=5e-3)
        # No place of the motion lies clearly within a region that an obstacle blocks.
        inside = """(margin) => {
          const { obstacles, duration } = cplan.model.strip;
          const context = document.createElement('canvas').getContext('2d');
          const blocked = (t, p) => obstacles.some(({ regions }) => regions.some((flat) => {
            const path = new Path2D();
            for (let i = 0; i < flat.length; i += 2) path.lineTo(1e3 * flat[i], 1e3 * flat[i + 1]);
            return context.isPointInPath(path, 1e3 * t, 1e3 * p);
          }));
          let count = 0;
          for (let k = 0; k <= 400; k += 1) {
            const t = (k / 400) * duration;
            const p = Timeline.valueAt(cplan.model.strip.motion, t);
            if ([-1, 1].every((s) => blocked(t + s * margin, p))) count += 1;
          }
          return count;
        }"""
        assert seen.do(inside, 0.06) == 0, world
        assert strip["obstacles"], world


def test_the_strip_is_there_for_motions_among_moving_obstacles_alone(program, show_file):
    seen = show_file(program.plan("planar_2r", "shelf")[0])
    assert not seen.page.locator(".strip").is_visible()
    seen = show_file(program.plan("planar_2r", "moving/cart_in_task")[0])
    assert seen.page.locator(".strip").is_visible()
    assert seen.page.locator(".waits li").count() == 1


def test_the_height_of_the_tool_is_shown_in_time(program, show_file):
    page, plan = program.plan("scara", "arch/pick_and_place")
    seen = show_file(page)
    height = seen.do("cplan.model.height")
    assert height["joint"] == "axis_3" and math.isclose(height["duration"], plan["duration"], abs_tol=1e-3)
    canvas = seen.page.locator(".side-view canvas")
    assert canvas.is_visible() and "from -150 to -125 mm" in canvas.get_attribute("aria-label")
    # The tool is down when the gripper acts, and in between it is up at least once.
    at = lambda time: seen.do("(time) => Timeline.valueAt(cplan.model.height.motion, time)", time)
    times = [event["time"] for event in plan["events"]]
    assert all(math.isclose(at(time), -150, abs_tol=0.1) for time in times)
    for before, after in zip(times, times[1:]):
        assert max(at(before + (after - before) * k / 200) for k in range(201)) > -125.1
    # A task without strokes has no side view.
    page, _ = program.plan("rrbot_vertical", "tasks/tower")
    assert show_file(page).page.locator(".side-view").is_hidden()


def test_the_turns_of_the_wrist_are_shown_in_time(program, show_file):
    page, plan = program.plan("gantry", "tasks/board_turned")
    seen = show_file(page)
    turns = seen.do("cplan.model.turns")
    canvas = seen.page.locator(".turns canvas")
    assert canvas.is_visible() and "from 0 to 90 \u00b0" in canvas.get_attribute("aria-label")
    # The board has the angle of the pick when it is grasped, and that of the place when it is released.
    pick = next(step for step in plan["steps"] if step["turn"])
    begin = pick["end"] + pick["turn"]["after_departure"] - pick["turn"]["seconds"]
    angle = lambda time: seen.do("(time) => { cplan.seek(time); return Height.turnedTo(cplan) ?? null; }", time)
    middle = begin + pick["turn"]["seconds"] / 2
    assert math.isclose(angle(begin), 0, abs_tol=1e-3) and math.isclose(angle(middle), math.pi / 4, abs_tol=1e-2)
    assert angle(middle + pick["turn"]["seconds"]) is None and len(turns["turns"]) == 1
    # A task without turns has no strip of turns.
    page, _ = program.plan("rrbot_vertical", "tasks/tower")
    assert show_file(page).page.locator(".turns").is_hidden()


def test_a_page_without_an_answer_has_the_reason_as_title_and_shows_what_moves(program, show_file):
    page, _ = program.plan("planar_2r", "moving/parked", code=4)
    seen = show_file(page)
    assert seen.page.locator("h1").inner_text().startswith("Not known: a path exists past the static obstacles")
    assert seen.page.locator("button[data-mode=think]").inner_text() == "What was tried"
    # At 0 s, the cart reaches from 2.0 to 3.1 m.
    assert seen.do("cplan.now") == 0 and seen.do("cplan.model.frame[0][1]") > 2.5
