"""The page of an exploration: it opens at the end, its time bar is the coverage curve, and its arm can be dragged."""

import json

import pytest
from conftest import ROOT

ROOMS = [ROOT / "robots/gantry.urdf", ROOT / "workspaces/explore/rooms.toml"]


@pytest.fixture(scope="module")
def rooms(program):
    """Returns the page of an exploration of three rooms, and its result."""
    page = program.folder / "rooms.html"
    result = program.run("explore", *ROOMS, "--grid", "48", "--json", "--picture", page)
    return page, json.loads(result)


def readings(seen):
    return seen.do("cplan.model.survey.count")


def current(seen):
    return seen.do("cplan.reading")


def test_the_page_opens_at_the_end_with_its_figures(rooms, show_file):
    page, result = rooms
    seen = show_file(page)
    count = len(result["readings"])
    assert seen.page.locator("h1").inner_text() == seen.page.title()
    known = result["map"]["free"] + result["map"]["occupied"]
    seen_share = 100 * known / (known + result["map"]["unknown"])
    assert seen.page.title() == f"The arm has seen {seen_share:.1f} % of the map, all that it can see, after {count} readings"
    assert (readings(seen), current(seen)) == (count, count - 1)
    play = seen.page.get_by_role("button", name="Replay", exact=True)
    assert play.inner_text().strip() == "Replay" and play.locator("svg").count() == 1
    cards = seen.page.locator(".card")
    texts = dict(zip(cards.locator("dt").all_inner_texts(), cards.locator("dd").all_inner_texts()))
    assert texts["coverage"].split("\n")[1] == f"{known} of {known + result['map']['unknown']} cells of the map"
    assert texts["readings"].startswith(str(count))
    assert float(texts["path length"].split(" ")[0]) == pytest.approx(result["length"], rel=5e-3)
    assert seen.page.locator(".status").inner_text() == "✓ explored"
    # Everything that the program saw is on the page.
    assert seen.do("cplan.model.survey.known.at(-1)") == known
    seen.shoot("explore")


def test_replay_starts_at_the_first_reading_and_space_pauses(rooms, show_file):
    seen = show_file(rooms[0])
    play = seen.page.locator(".play")
    seen.page.keyboard.press(" ")
    assert play.get_attribute("aria-label") == "Pause" and current(seen) < readings(seen) / 2
    seen.until("cplan.reading > 2")
    seen.page.keyboard.press(" ")
    assert play.get_attribute("aria-label") == "Play"
    # On a control, the key acts on the control.
    seen.page.get_by_label("speed").focus()
    seen.page.keyboard.press(" ")
    assert play.get_attribute("aria-label") == "Play"


def test_the_coverage_curve_is_the_time_bar(rooms, show_file):
    seen = show_file(rooms[0])
    slider = seen.page.get_by_role("slider", name="Reading")
    slider.focus()
    last = readings(seen) - 1
    for key, place in (("Home", 0), ("ArrowRight", 1), ("Shift+ArrowRight", 11), ("PageDown", 1), ("ArrowLeft", 0), ("ArrowLeft", 0), ("End", last)):
        seen.page.keyboard.press(key)
        assert current(seen) == place, key
        assert slider.get_attribute("aria-valuenow") == str(place + 1)
    # The place of the pointer is a path length.
    box = slider.bounding_box()
    wanted = readings(seen) // 3
    x, y = seen.do("(k) => cplan.coverage.panel.at([cplan.coverage.points[k].length, 50])", wanted)
    seen.page.mouse.move(box["x"] + x, box["y"] + y)
    seen.page.mouse.down()
    same = seen.do("(k) => cplan.coverage.points[k].length", wanted)
    assert seen.do("cplan.coverage.points[cplan.reading].length") == same
    seen.page.mouse.move(box["x"] + box["width"] - 2, box["y"] + y, steps=3)
    seen.page.mouse.up()
    assert current(seen) == last
    text = slider.get_attribute("aria-valuetext")
    assert text == seen.page.locator(".step").inner_text() and "of the map seen" in text and "path length" in text


def test_the_pictures_show_what_was_known_then(rooms, show_file):
    seen = show_file(rooms[0])
    seen.do("cplan.seek(0)")
    place = [1.6, 0.9]
    free = lambda: seen.do("(q) => cplan.model.survey.isKnownFree(q, cplan.reading, cplan.model.arm.joints)", place)
    assert not free()
    dark = seen.do(
        """() => { const panel = cplan.panels.workspace; const [x, y] = panel.at([1.9, 1.4]).map((p) => Math.round(p * panel.ratio));
             const color = () => [...panel.back.getContext('2d').getImageData(x, y, 1, 1).data];
             const before = color(); cplan.seek(cplan.duration); return [before, color()]; }"""
    )
    assert dark[0] != dark[1] and dark[1][:3] == [255, 255, 255]
    assert free()


def test_the_arm_is_dragged_and_compared_with_what_is_known(rooms, show_file):
    seen = show_file(rooms[0])
    seen.do("cplan.seek(0)")
    probe = seen.page.locator(".probe")
    seen.do("cplan.place([1.6, 0.9])")
    assert "not known to be free; in the real world: free" in probe.inner_text()
    seen.do("cplan.seek(cplan.duration)")
    assert ": known to be free; in the real world: free" in probe.inner_text()
    x, y = seen.do("cplan.tipSpot")
    box = seen.page.locator("canvas[aria-label='Workspace']").bounding_box()
    seen.page.mouse.move(box["x"] + x, box["y"] + y)
    seen.page.mouse.down()
    seen.page.mouse.move(box["x"] + x - 60, box["y"] + y, steps=4)
    seen.page.mouse.up()
    assert seen.do("cplan.probe.q[0]") < 1.6
    seen.page.keyboard.press("Escape")
    assert probe.inner_text() == ""


def test_layers_are_the_legend(rooms, show_file):
    seen = show_file(rooms[0])
    legend = seen.page.locator(".legend li:visible").all_inner_texts()
    for text in ("start", "free", "occupied", "unknown, counts as solid", "view of the sensor", "configurations that are known to be free", "7 chest"):
        assert text in legend
    assert "goal" not in legend
    for layer in ("map", "sensor", "known", "path", "c-obstacles"):
        name = "cspace" if layer in ("known", "c-obstacles") else "workspace"
        before = seen.do(f"cplan.panels.{name}.canvas.toDataURL()")
        seen.page.locator(f"[data-layer='{layer}']").uncheck()
        assert seen.do(f"cplan.panels.{name}.canvas.toDataURL()") != before, layer


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_phone_shows_both_panels_and_the_curve(rooms, show_file, scheme):
    seen = show_file(rooms[0], width=390, height=844, color_scheme=scheme)
    assert seen.do("document.documentElement.scrollWidth <= innerWidth")
    boxes = [seen.page.locator(f"canvas[aria-label='{name}']").bounding_box() for name in ("Workspace", "Configuration space", "Reading")]
    assert all(box["height"] > 90 for box in boxes) and boxes[2]["y"] < 844
    seen.shoot(f"explore_phone_{scheme}")


def test_times_of_decisions_are_shown_only_if_they_were_measured(program, rooms, show_file):
    files = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"]
    page = program.folder / "timed.html"
    program.run("explore", *files, "--quiet", "--timings", "--picture", page)
    seen = show_file(page)
    assert "decision" in seen.page.locator(".card dt").all_inner_texts()
    assert seen.page.locator(".status").inner_text() == "✓ reached"
    assert "goal" in seen.page.locator(".legend li:visible").all_inner_texts()
    assert "decision" not in show_file(rooms[0]).page.locator(".card dt").all_inner_texts()
