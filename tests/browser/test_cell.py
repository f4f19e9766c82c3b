"""The page of `cplan cell`: the answer first, both arms, the diagram of their times, and rows of time."""

import json

import pytest
from conftest import ROOT

CELLS = ROOT / "workspaces/cells"
#: Two arms whose starts overlap.
COLLIDING = """
[[arm]]
name = "left"
urdf = "{robot}"
base = {{ at = [-0.4, 0.0] }}
start = {{ joints = [0.0, 0.0] }}
goal = {{ joints = [1.0, 0.0] }}

[[arm]]
name = "right"
urdf = "{robot}"
base = {{ at = [0.4, 0.0], angle = "180deg" }}
start = {{ joints = [0.0, 0.0] }}
goal = {{ joints = [1.0, 0.0] }}
"""
#: Schemes and sizes: a desk, a small laptop, a phone.
LOOKS = [(scheme, *size) for scheme in ("light", "dark") for size in ((1440, 900), (1280, 720), (390, 844))]


def planned(program, name, cell, code=0):
    """Returns the page of a cell, and its result."""
    page = program.folder / f"cell_{name}.html"
    return page, json.loads(program.run("cell", cell, "--json", "--quiet", "--picture", page, code=code))


@pytest.fixture(scope="module")
def crossing(program):
    return planned(program, "crossing", CELLS / "crossing.toml")


@pytest.fixture(scope="module")
def handover(program):
    return planned(program, "handover", CELLS / "handover.toml")


@pytest.fixture(scope="module")
def no_room(program):
    return planned(program, "no_room", CELLS / "no_room.toml", code=3)


@pytest.fixture(scope="module")
def waiting(program):
    """Arms with motors on their bases cannot be shaped together, so one waits for the other."""
    cell = (CELLS / "crossing.toml").read_text().replace("../../robots", str(ROOT / "robots"))
    file = program.folder / "waiting.toml"
    file.write_text(cell.replace('tip = "flange"', 'tip = "flange", drives = "standard_scara"'))
    return planned(program, "waiting", file)


@pytest.fixture(scope="module")
def colliding(program):
    file = program.folder / "colliding.toml"
    file.write_text(COLLIDING.format(robot=ROOT / "robots/planar_2r.urdf"))
    return planned(program, "colliding", file, code=3)


def cards(seen):
    """Returns the values of the cards by their names."""
    of = lambda name: seen.page.locator(f".card {name}").all_inner_texts()
    return dict(zip(of("dt"), (text.split("\n")[0] for text in of("dd"))))


def title(seen):
    return seen.page.locator("h1").inner_text()


def shown_time(seen):
    return float(seen.page.locator(".clock").inner_text().split(" ")[0])


def test_the_answer_comes_first(crossing, show_file):
    page, result = crossing
    seen = show_file(page)
    cycle, bound, gap = (result[name] for name in ("duration", "lower_bound", "gap"))
    words = title(seen)
    assert words == seen.page.title() and words.startswith(f"Both arms arrive after {cycle:.3f} s, proven within ")
    percent = float(words.split("within ")[1].split(" ")[0])
    assert 100 * gap <= percent <= 100 * gap + 0.0101
    assert seen.page.locator(".lines").inner_text().startswith("crossing goals")
    assert seen.page.locator(".status").inner_text() == "✓ found, certified"
    shown = cards(seen)
    assert list(shown) == ["cycle", "over the least time", "between the arms", "skew", "signals"]
    assert shown["cycle"] == f"{cycle:.3f} s" and shown["over the least time"] == f"at most {percent:.2f} %"
    kept = float(shown["between the arms"].removeprefix("at least ").removesuffix(" mm")) / 1000
    assert 0.99 * result["clearance_between"] <= kept <= result["clearance_between"]
    assert (shown["skew"], shown["signals"]) == ("20 ms", str(len(result["interlocks"])))
    notes = seen.page.locator(".card small").all_inner_texts()
    stated = float(next(note for note in notes if "take less than" in note).split("than ")[1].split(" ")[0])
    assert bound - 1e-3 <= stated <= bound


def test_the_clock_moves_both_arms(crossing, show_file):
    page, result = crossing
    seen = show_file(page)
    for arm, own in enumerate(result["arms"]):
        assert seen.do("cplan.shown")[arm] == pytest.approx(own["start"], abs=1e-4)
    seen.page.locator("input[type=range]").fill(str(result["duration"]))
    for arm, own in enumerate(result["arms"]):
        assert seen.do("cplan.shown")[arm] == pytest.approx(own["trajectory"]["position"][-1], abs=1e-4)
    assert seen.page.locator(".clock").inner_text() == f"{result['duration']:.3f} / {result['duration']:.3f} s"
    seen.page.get_by_role("button", name="play").click()
    seen.until("!cplan.playing && cplan.time === cplan.duration")
    seen.shoot("cell")


def test_the_distance_is_that_of_the_program(crossing, show_file):
    page, result = crossing
    seen = show_file(page)
    seen.do("(times) => cplan.place(times)", result["nearest"]["times"])
    assert seen.do("cplan.nearest().distance") == pytest.approx(result["nearest"]["distance"], abs=1e-4)
    assert "apart" in seen.page.locator(".probe").inner_text() and seen.do("cplan.isTooNear") is False


def spot(seen, place):
    """Returns the place of the diagram on the screen."""
    x, y = seen.do("(place) => cplan.panels.cspace.at(place)", place)
    box = seen.page.locator('canvas[aria-label="Times of both arms"]').bounding_box()
    return box["x"] + x, box["y"] + y


def test_the_dot_of_the_diagram_moves_the_time(crossing, show_file):
    page, result = crossing
    seen = show_file(page)
    half = result["duration"] / 2
    seen.page.mouse.move(*spot(seen, [0, 0]))
    seen.page.mouse.down()
    seen.page.mouse.move(*spot(seen, [half, half]), steps=4)
    seen.page.mouse.up()
    assert shown_time(seen) == pytest.approx(half, abs=0.01)
    # The slider and the rows are in step.
    assert float(seen.page.locator("input[type=range]").input_value()) == pytest.approx(half, abs=0.01)
    at = seen.do("Number(document.querySelector('.gantt .cursor').style.getPropertyValue('--at'))")
    assert at == pytest.approx(0.5, abs=0.02)
    lane = seen.page.locator(".gantt .lane").first.bounding_box()
    seen.page.mouse.click(lane["x"] + 0.25 * lane["width"], lane["y"] + lane["height"] / 2)
    assert shown_time(seen) == pytest.approx(half / 2, abs=0.01)


def test_in_a_region_the_arms_are_too_near(crossing, show_file):
    page, _ = crossing
    seen = show_file(page)
    # The middle of the largest rectangle.
    middle = seen.do(
        """() => {
          const all = cplan.cell.motions.regions.flatMap((flat) => Array.from({ length: flat.length / 4 }, (_, k) => flat.slice(4 * k, 4 * k + 4)));
          const [x0, y0, x1, y1] = all.sort((a, b) => (b[2] - b[0]) * (b[3] - b[1]) - (a[2] - a[0]) * (a[3] - a[1]))[0];
          return [(x0 + x1) / 2, (y0 + y1) / 2];
        }"""
    )
    seen.page.mouse.move(*spot(seen, middle))
    probe = seen.page.locator(".probe")
    assert "overlap by" in probe.inner_text() and probe.get_attribute("data-free") == "false"
    assert shown_time(seen) == 0, "the schedule stays"
    seen.page.mouse.click(*spot(seen, middle))
    seen.page.keyboard.press("Escape")
    assert probe.get_attribute("data-free") == "true"


def test_keys_move_one_arm_alone(crossing, show_file):
    page, _ = crossing
    seen = show_file(page)
    seen.page.locator('canvas[aria-label="Times of both arms"]').focus()
    seen.page.keyboard.press("ArrowRight")
    left, right = seen.do("cplan.probe.q")
    assert left > 0 and right == 0
    seen.page.keyboard.press("Shift+ArrowUp")
    assert seen.do("cplan.probe.q")[1] > left
    seen.page.keyboard.press("Escape")
    seen.page.locator("h1").click()
    seen.page.keyboard.press("End")
    assert seen.do("cplan.time === cplan.duration")
    names = seen.do("[...document.querySelectorAll('canvas, button')].filter((part) => part.offsetParent).map((part) => (part.getAttribute('aria-label') ?? part.textContent).trim())")
    assert all(names) and "Workspace with both arms" in names and "Times of both arms" in names


def test_signals_and_waits_have_rows(waiting, show_file):
    page, result = waiting
    seen = show_file(page)
    waits = [(own["name"], wait) for own in result["arms"] for wait in own["waits"]]
    assert waits, "this cell needs a wait"
    for arm in result["arms"]:
        total = sum(wait["to"] - wait["from"] for wait in arm["waits"])
        assert (f"{arm['name']} waits {total:.2f} s" in title(seen)) == (total >= 0.005)
    stops = seen.page.locator(".gantt .wait")
    assert stops.count() == len(waits)
    for stop, (name, wait) in zip(stops.all(), waits):
        assert stop.get_attribute("aria-label") == f"{name} waits from {wait['from']:.3f} s to {wait['to']:.3f} s"
        stop.click()
        assert shown_time(seen) == pytest.approx(wait["from"], abs=1e-3)
        still = [seen.do("(time) => cplan.placed(cplan.cell.arms.findIndex(({ name }) => name === time[0]), time[1])", [name, wait[end]]) for end in ("from", "to")]
        assert still[0] == pytest.approx(still[1], abs=1e-4)
    signals = seen.page.locator(".gantt .signal")
    assert signals.count() == len(result["interlocks"])
    for row, signal in zip(signals.all(), result["interlocks"]):
        words = f"Signal {signal['signal']}: {signal['waits']} waits at {signal['at']['time']:.3f} s until {signal['sets']} has passed {signal['after']['time']:.3f} s"
        assert row.get_attribute("aria-label") == words
    seen.shoot("cell_waiting")


def test_without_motions_the_first_collision_is_shown(no_room, show_file):
    page, result = no_room
    seen = show_file(page)
    assert title(seen) == "No motions: on every route to their goals, the arms collide"
    assert seen.page.locator(".status").inner_text() == "✕ infeasible: proven"
    assert f"{len(result['proof']['boxes'])} boxes" in seen.page.locator(".lines").inner_text()
    assert cards(seen)["proof"] == f"{len(result['proof']['boxes'])} boxes"
    starts = seen.do("cplan.cell.arms.map(({ start }) => start)")
    assert starts == [pytest.approx(arm["start"], abs=1e-4) for arm in result["arms"]]
    assert seen.do("cplan.isTooNear") is True
    probe = seen.page.locator(".probe").inner_text()
    assert "of left" in probe and "of right" in probe and "overlap by" in probe
    # Until then, the arms are apart.
    moment = seen.do("cplan.time")
    assert cards(seen)["first collision"] == f"at {moment:.3f} s"
    for share in (0, 0.5, 0.97):
        seen.do("(time) => cplan.seek(time)", share * moment)
        assert seen.do("cplan.isTooNear") is False
    seen.shoot("cell_no_room")


def test_starts_that_collide_are_shown_alone(colliding, show_file):
    page, result = colliding
    seen = show_file(page)
    assert title(seen).startswith("No motions: at the starts, ") and "overlap by" in title(seen)
    assert result["proof"]["contact"].replace('"', "") in title(seen)
    assert "overlap" in cards(seen) and seen.do("cplan.isTooNear") is True
    assert not seen.page.locator(".pictures > .panels > figure:nth-child(2)").first.is_visible()
    assert seen.page.locator(".gantt:visible, .controls-of-time:visible").count() == 0
    seen.shoot("cell_colliding")


@pytest.mark.parametrize(("scheme", "width", "height"), LOOKS)
@pytest.mark.parametrize("name", ["crossing", "waiting", "handover", "no_room", "colliding"])
def test_it_fits_the_window(request, show_file, name, scheme, width, height):
    page, _ = request.getfixturevalue(name)
    seen = show_file(page, width=width, height=height, color_scheme=scheme)
    assert seen.do("document.documentElement.scrollWidth <= innerWidth")
    parts = seen.do(
        """[...document.querySelectorAll('header, .cards, .panels > figure, .gantt, .below, .side')]
          .map((part) => ({ name: part.className || part.tagName, ...part.getBoundingClientRect().toJSON() }))
          .filter(({ width, height }) => width && height)"""
    )
    for part in parts:
        assert part["left"] >= 0 and part["right"] <= width, f"{part['name']} is cut"
    for k, one in enumerate(parts):
        for other in parts[k + 1 :]:
            across = min(one["right"], other["right"]) - max(one["left"], other["left"])
            down = min(one["bottom"], other["bottom"]) - max(one["top"], other["top"])
            assert across <= 0.5 or down <= 0.5, f"{one['name']} overlaps {other['name']}"
    if width > 1000 and name != "colliding":
        bottom = seen.do("document.querySelector('.controls-of-time').getBoundingClientRect().bottom")
        assert bottom <= height, "pictures and time are in sight"
    seen.shoot(f"cell_{name}_{scheme}_{width}")
