"""The page of `cplan serve`."""

import json
import math
import time
import urllib.request

import pytest
from conftest import ROOT
from live import PLANAR, drag, path, settled, spot


def test_an_obstacle_that_is_dragged_into_the_path_changes_it(serve):
    seen = serve(*PLANAR)
    first = settled(seen)
    assert first["verdict"] == "found" and first["certified"]
    before, c_obstacles = path(seen), seen.do("JSON.stringify(cplan.view.world.c_obstacles)")
    # Move the crate from below to a place that blocks the forearm.
    drag(seen, "workspace", [0.7, -1.5], [1.15, -0.75])
    after = settled(seen)
    assert after["final"] and after["verdict"] == "found" and after["certified"]
    assert path(seen) != before
    assert seen.do("JSON.stringify(cplan.view.world.c_obstacles)") != c_obstacles
    assert after["figures"]["length"] >= after["figures"]["lower_bound"] > 0
    assert after["figures"]["length"] > first["figures"]["length"], "it was in the way"
    seen.shoot("live-dragged")
    # The received path is free by the page's own contact test. The tests of pages compare this test with the program.
    worst = seen.do(
        """() => { const { view } = cplan; let least = Infinity;
             for (let k = 0; k <= 2000; k += 1) {
               const q = Geometry.moving(view.model.clock, (view.duration * k) / 2000).position;
               least = Math.min(least, Geometry.contacts(view.model.arm, view.world, q)[0].distance);
             } return least; }"""
    )
    assert worst > -2e-5
    seen.page.get_by_label("undo").click()
    settled(seen)
    assert path(seen) == before


def test_planners_can_be_switched(serve):
    seen = serve(*PLANAR)
    kinds = {"shortest": "rows", "visibility": "roadmap", "trapezoid": "channel", "wavefront": "wavefront", "harmonic": "field", "subdivision": "boxes"}
    for planner, kind in kinds.items():
        seen.page.get_by_label("planner", exact=True).select_option(planner)
        answer = settled(seen)
        assert answer["certified"] and seen.do("cplan.view.world.trace.kind") == kind
    seen.page.get_by_label("planner", exact=True).select_option("visibility")
    seen.page.locator("[data-option='--gap']").select_option("0.0001")
    figures = settled(seen)["figures"]
    assert figures["length"] <= 1.0001 * figures["lower_bound"]


def test_a_world_without_a_path_shows_its_proof(serve):
    seen = serve(ROOT / "robots/planar_2r_continuous.urdf", ROOT / "workspaces/no_path.toml")
    answer = settled(seen)
    assert answer["verdict"] == "infeasible" and not answer["certified"]
    assert seen.do("cplan.view.world.proof.length") > 0
    assert seen.page.locator(".figures").inner_text().lower().count("proven") == 1, "once"
    seen.shoot("live-no-path")


def test_a_world_that_is_saved_and_loaded_gives_the_same_plan(serve):
    seen = serve(*PLANAR)
    drag(seen, "workspace", [0.7, -1.5], [1.15, -0.75])
    assert settled(seen)["certified"]
    moved, answer = path(seen), seen.do("cplan.answered.figures")
    with seen.page.expect_download() as saved:
        seen.page.get_by_label("file to save").select_option("toml")
        seen.page.get_by_role("button", name="Save").click()
    text = saved.value.path().read_text()
    assert text.startswith(PLANAR[1].read_text()[:40]), "comments are kept"
    again = serve(*PLANAR)
    assert path(again) != moved
    file = saved.value.path()
    again.page.locator("input[type=file]").set_input_files({"name": "world.toml", "mimeType": "text/plain", "buffer": file.read_bytes()})
    assert settled(again)["certified"]
    assert path(again) == moved
    figures = again.do("cplan.answered.figures")
    assert {key: figures[key] for key in figures if key != "milliseconds"} == {key: answer[key] for key in answer if key != "milliseconds"}
    # Other files are the same as those of the main job.
    for format_ in ("json", "csv", "yaml", "svg", "html"):
        with again.page.expect_download() as saved:
            again.page.get_by_label("file to save").select_option(format_)
            again.page.get_by_role("button", name="Save").click()
        content = saved.value.path().read_text()
        assert saved.value.suggested_filename == f"plan.{format_}" and len(content) > 1000
        if format_ == "json":
            assert json.loads(content)["certified"] is True


def test_what_is_wrong_is_said_and_what_was_there_stays(serve):
    seen = serve(*PLANAR)
    before = path(seen)
    seen.page.locator(".world summary").click()
    seen.page.get_by_label("world as TOML").fill("[start]\njoints = [0.1]\n")
    seen.page.get_by_role("button", name="Plan in this world").click()
    seen.until("cplan.answered.error")
    assert "line 2" in seen.page.get_by_role("alert").inner_text()
    assert path(seen) == before
    # A start in collision: the shelf on the arm.
    drag(seen, "workspace", [1.3, 0.24], [0.85, -0.95])
    answer = settled(seen)
    assert answer["verdict"] is None and "shelf" in answer["error"]
    assert "shelf" in seen.page.get_by_role("alert").inner_text()
    seen.shoot("live-start-collides")
    seen.page.get_by_label("undo").click()
    assert settled(seen)["certified"]
    assert not seen.page.get_by_role("alert").is_visible()


def test_start_goal_and_tip_can_be_dragged(serve):
    seen = serve(*PLANAR)
    drag(seen, "cspace", [1.55, -0.35], [2.0, 0.5])
    answer = settled(seen)
    assert answer["certified"]
    assert path(seen)[-2:] == pytest.approx([2.0, 0.5], abs=0.03)
    target = seen.do("cplan.editor.tips.goal")
    drag(seen, "workspace", target, [-0.4, 1.2])
    answer = settled(seen)
    assert answer["certified"]
    end = seen.do("Geometry.tipAt(cplan.view.model.arm, cplan.view.model.paths[0].points.slice(-2))")
    assert math.dist(end, [-0.4, 1.2]) < 0.02
    tip = seen.do("cplan.editor.tips.start")
    drag(seen, "workspace", tip, [1.0, -1.0])
    assert settled(seen)["certified"]
    begin = seen.do("Geometry.tipAt(cplan.view.model.arm, cplan.view.model.paths[0].points.slice(0, 2))")
    assert math.dist(begin, [1.0, -1.0]) < 0.02


def test_obstacles_come_and_go_by_keyboard(serve):
    seen = serve(*PLANAR)
    names = "cplan.view.world.obstacles.map(({ name }) => name)"
    assert seen.do(names) == ["shelf", "crate"]
    for button in ("add a polygon", "add a circle", "add a thin wall"):
        seen.page.get_by_role("button", name=button).click()
        settled(seen)
    assert len(seen.do(names)) == 5
    seen.page.get_by_label("selected", exact=True).select_option("obstacle 2")
    before = seen.do("cplan.view.world.obstacles[2].outline.polygon")
    seen.page.keyboard.press("Shift+ArrowUp")
    settled(seen)
    after = seen.do("cplan.view.world.obstacles[2].outline.polygon")
    assert [b > a for a, b in zip(before[1::2], after[1::2])] == [True] * 4
    seen.page.keyboard.press("c")
    seen.page.keyboard.press("Delete")
    settled(seen)
    assert len(seen.do("cplan.view.world.obstacles[2].outline.polygon")) == 6, "a corner less"
    seen.page.keyboard.press("Delete")
    settled(seen)
    assert len(seen.do(names)) == 4


def test_a_slow_plan_is_given_up_for_the_next_drag(serve):
    seen = serve(*PLANAR, "--with", "harmonic --cells 2048")
    begin = time.monotonic()
    seen.page.get_by_label("planner", exact=True).select_option("harmonic")
    for _ in range(5):
        drag(seen, "workspace", seen.do("cplan.scene.obstacles[1].shape.polygon[0].map((x) => x + 0.05)"), [0.6, -1.3], steps=4)
        drag(seen, "workspace", seen.do("cplan.scene.obstacles[1].shape.polygon[0].map((x) => x + 0.05)"), [0.7, -1.45], steps=4)
    seen.page.get_by_label("planner", exact=True).select_option("visibility")
    answer = settled(seen)
    assert answer["certified"] and answer["final"]
    print(f"\nten drags with harmonic fields of 2048 x 2048 under way: answered after {time.monotonic() - begin:.1f} s")


def test_strangers_are_refused(serve):
    seen = serve(*PLANAR)
    address = seen.page.url
    with urllib.request.urlopen(address) as page:
        assert "connect-src 'self'" in page.headers["content-security-policy"]
    for path_, headers, code in [("robots", {}, 404), ("live", {}, 400), ("", {"Host": "evil.example"}, 421), ("", {"Origin": "http://evil.example"}, 403)]:
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(urllib.request.Request(address + path_, headers=headers))
        assert refused.value.code == code, path_


TEN = """
[start]
joints = [-0.9, 0.4]
[goal]
joints = [1.55, -0.35]
""" + "".join(
    f'[[obstacle]]\nname = "block {i}"\npolygon = [[{x:.3f}, {y:.3f}], [{x + 0.12:.3f}, {y:.3f}], [{x + 0.12:.3f}, {y + 0.1:.3f}], [{x:.3f}, {y + 0.1:.3f}]]\n'
    for i, (x, y) in enumerate(
        [(1.3, 0.25), (1.55, -0.05), (0.6, -1.6), (1.2, 0.9), (-0.9, 1.3), (-1.3, 0.3), (-1.5, -0.5), (-0.6, -1.4), (0.1, -1.75), (-0.2, 1.7)]
    )
)


def test_the_configuration_space_follows_ten_obstacles(serve, tmp_path):
    """Drags one of ten obstacles for three seconds, and prints the answers per second that were received and drawn."""
    world = tmp_path / "ten.toml"
    world.write_text(TEN)
    seen = serve(ROOT / "robots/planar_2r.urdf", world)
    assert settled(seen)["certified"] and seen.do("cplan.view.world.obstacles.length") == 10
    seen.do(
        """() => { Object.assign(window, { drawn: [], shapes: [] }); const take = cplan.take.bind(cplan);
             cplan.take = (message) => {
               take(message);
               if (message.final || !message.view) return;
               drawn.push(performance.now());
               shapes.push(JSON.stringify(cplan.view.world.obstacles[0].outline));
             }; }"""
    )
    mouse = seen.page.mouse
    ends = [spot(seen, "workspace", place) for place in ([1.3, 0.27], [1.46, 0.36])]
    mouse.move(*ends[0])
    mouse.down()
    begin = time.monotonic()
    count = 0
    while (passed := time.monotonic() - begin) < 3:
        count += 1
        # As many intermediate places as a mouse moved by hand reports.
        mouse.move(*ends[count % 2], steps=40)
    drawn = seen.do("drawn.length")
    gaps = seen.do("drawn.slice(1).map((t, i) => t - drawn[i]).sort((a, b) => a - b)")
    shapes = seen.do("new Set(shapes).size")
    mouse.up()
    answer = settled(seen)
    assert answer["final"] and answer["certified"]
    print(
        f"\n{drawn / passed:.1f} updates a second from {40 * count / passed:.0f} places; between two of them "
        f"{gaps[len(gaps) // 2]:.0f} ms (median), {gaps[-1]:.0f} ms (longest)"
    )
    assert shapes > 5, "it moves while it is dragged"
    seen.shoot("live-ten")


def test_three_hundred_obstacles_are_followed_while_one_is_dragged(serve, tmp_path):
    """Drags one of three hundred obstacles until answers have been drawn eleven times, and measures when."""
    inside = lambda x, y: 0.25 < math.hypot(x, y) < 1.95 and not (abs(math.atan2(y, x) + 0.75) < 0.35 or abs(math.atan2(y, x) - 1.5) < 0.25)
    places = [(0.14 * i, 0.14 * k) for i in range(-14, 15) for k in range(-14, 15)]
    places = sorted((place for place in places if inside(*place)), key=lambda place: -math.hypot(*place))[:300]
    blocks = [f"[[obstacle]]\npolygon = [[{x:.3f}, {y:.3f}], [{x + 0.02:.3f}, {y:.3f}], [{x:.3f}, {y + 0.02:.3f}]]\n" for x, y in places]
    assert len(blocks) == 300
    world = tmp_path / "crowd.toml"
    world.write_text("[start]\njoints = [-0.9, 0.4]\n[goal]\njoints = [1.55, -0.35]\n" + "".join(blocks))
    seen = serve(ROOT / "robots/planar_2r.urdf", world)
    assert seen.do("cplan.view.world.obstacles.length") == 300
    seen.do("() => { window.drawn = []; const take = cplan.take.bind(cplan); cplan.take = (m) => { take(m); if (!m.final && m.view) drawn.push(performance.now()); }; }")
    middle = [sum(p[k] for p in seen.do("cplan.scene.obstacles[0].shape.polygon")) / 3 for k in (0, 1)]
    ends = [spot(seen, "workspace", middle), spot(seen, "workspace", [middle[0] + 0.05, middle[1] + 0.05])]
    mouse = seen.page.mouse
    mouse.move(*ends[0])
    mouse.down()
    shortest = "Math.min(...drawn.slice(10).map((t, i) => t - drawn[i]))"
    begin, moves = time.monotonic(), 0
    while seen.do("drawn.length") < 11:
        assert time.monotonic() - begin < 60, "answers are drawn while it is dragged"
        for _ in range(25):
            moves += 1
            mouse.move(*ends[moves % 2], steps=4)
        assert "certified" not in seen.page.locator("p.status").inner_text()
    rate = seen.do("drawn.length") / (time.monotonic() - begin)
    mouse.up()
    settled(seen)
    print(f"\n300 obstacles: {rate:.1f} updates a second, ten in {seen.do(shortest):.0f} ms")


def test_how_a_plan_was_found_is_told_when_somebody_asks(serve):
    seen = serve(*PLANAR)
    assert seen.do("cplan.view.model.replay") is None, "nobody has asked"
    seen.page.get_by_role("button", name="How it was found", exact=True).click()
    assert settled(seen)["certified"]
    seen.until("cplan.view.mode === 'think'")
    phases = seen.do("cplan.view.replay")
    assert len(phases) > 1 and seen.page.locator(".step").inner_text() == f"1 of {len(phases)}: {phases[0]['caption']}"
    seen.do("cplan.view.seek(0.5 * cplan.view.duration)")
    seen.shoot("live_think")
    # Every following plan has a replay, too, until the user selects the motion again.
    drag(seen, "workspace", [0.7, -1.5], [1.15, -0.75])
    assert settled(seen)["certified"]
    assert seen.do("cplan.view.mode") == "think" and seen.do("cplan.view.replay") != phases
    seen.page.get_by_role("button", name="Motion", exact=True).click()
    drag(seen, "workspace", [1.15, -0.75], [0.7, -1.5])
    assert settled(seen)["certified"]
    assert seen.do("cplan.view.mode") == "move" and seen.do("cplan.view.model.replay") is None


def test_a_proof_is_told_too(serve):
    seen = serve(ROOT / "robots/planar_2r_continuous.urdf", ROOT / "workspaces/no_path.toml")
    seen.page.locator("button[data-mode=think]").click()
    settled(seen)
    seen.until("cplan.view.mode === 'think'")
    seen.do("cplan.view.seek(cplan.view.duration)")
    assert "there is no path" in seen.page.locator(".step").inner_text()
