"""The page of `cplan cell` for arms with steps: the objects, the steps and the handovers."""

import bisect
import math
import tomllib
import xml.etree.ElementTree

import pytest
from conftest import ROOT
from test_cell import CELLS, planned, shown_time

#: Times between a grasp and a release, and between two changes, as shares.
SHARES = (0.02, 0.3, 0.6, 0.98)


@pytest.fixture(scope="module")
def handover(program):
    return "handover", *planned(program, "handover", CELLS / "handover.toml")


@pytest.fixture(scope="module")
def kitting(program):
    return "kitting", *planned(program, "kitting", CELLS / "kitting.toml")


@pytest.fixture(params=["handover", "kitting"])
def cell(request):
    name, page, result = request.getfixturevalue(request.param)
    return tomllib.loads((CELLS / f"{name}.toml").read_text()), page, result


def lengths():
    """Returns the lengths of both links of the SCARA: from the second joint's origin, and from those between it and the flange."""
    root = xml.etree.ElementTree.parse(ROOT / "robots/scara.urdf").getroot()
    along = {joint.get("name"): float(joint.find("origin").get("xyz").split()[0]) for joint in root.iter("joint")}
    return along["axis_2"], along["axis_3"] + along["axis_4"]


def position(trajectory, time):
    """Returns the joint values at a time, by the cubic between two samples."""
    times = trajectory["time"]
    k = min(max(bisect.bisect_right(times, time) - 1, 0), len(times) - 2)
    length = times[k + 1] - times[k]
    s = min(max((time - times[k]) / length, 0.0), 1.0)
    weights = (1 + 2 * s) * (1 - s) ** 2, s * (1 - s) ** 2 * length, s * s * (3 - 2 * s), s * s * (s - 1) * length
    ends = [trajectory[row][at] for at in (k, k + 1) for row in ("position", "velocity")]
    return [sum(weight * end[joint] for weight, end in zip(weights, ends)) for joint in range(2)]


def tip(table, own, time):
    """Returns the place of an arm's tip in the cell. `table` is its table in the file, `own` its entry in the result."""
    base = table.get("base", {"at": [0, 0], "angle": "0deg"})
    turn = math.radians(float(base["angle"].removesuffix("deg")))
    first, second = position(own["trajectory"], time)
    upper, fore = lengths()
    angles = (turn + first, upper), (turn + first + second, fore)
    return [base["at"][k] + sum(length * (math.cos, math.sin)[k](angle) for angle, length in angles) for k in range(2)]


def steps_of(result, name):
    """Returns the steps about an object in the order of time, each with the index of its arm."""
    steps = [(arm, step) for arm, own in enumerate(result["arms"]) for step in own["steps"] if step["object"] == name]
    return sorted(steps, key=lambda step: step[1]["event"])


def destination(step):
    """Reads the place from the words of a step: `place at (0.4, 0) m`."""
    assert step["action"].startswith("place at (")
    return [float(number) for number in step["action"].split("(")[1].split(")")[0].split(",")]


def expected(file, result, name):
    """Yields times, and where the object is then: at its place, at the tip of the arm that carries it, or at a destination."""
    place = next(table["at"] for table in file["object"] if table["name"] == name)
    before = 0.0
    steps = steps_of(result, name)
    for (arm, pick), (other, release) in zip(steps[::2], steps[1::2], strict=True):
        assert arm == other and pick["action"].startswith("pick")
        for share in SHARES:
            yield before + share * (pick["event"] - before), place
        for share in SHARES:
            time = pick["event"] + share * (release["event"] - pick["event"])
            yield time, tip(file["arm"][arm], result["arms"][arm], time)
        place, before = destination(release), release["event"]
    yield result["duration"], place


def are_alike(one, other):
    """Returns true if two colours, #rrggbb, differ by at most 8 % in each channel."""
    return all(abs(int(one[k : k + 2], 16) - int(other[k : k + 2], 16)) <= 20 for k in (1, 3, 5))


def seconds(words):
    """Reads times, such as 1.206 s."""
    assert all(word.endswith(" s") for word in words)
    return [float(word.removesuffix(" s")) for word in words]


#: Shows a time, and returns the corners of an object in the picture and the colours of the canvas around its middle.
LOOK = """([time, name]) => {
  cplan.layers.shown.set('names', false);
  cplan.seek(time);
  const { objects, arms } = cplan.cell;
  const times = [time, time];
  const held = arms.map((_, k) => [k, CellObjects.held(objects, k, times)]).find(([, one]) => one?.name === name);
  const pose = held && Geometry.payloadPose(arms[held[0]].arm, held[1], cplan.shown[held[0]], held[1].turned);
  const { pieces, color } = held?.[1] ?? CellObjects.lying(objects, times).find((one) => one.name === name);
  const corners = pieces.flatMap((piece) => [...Geometry.pointsOf(pose ? Geometry.placed(piece, pose).core : piece.core)]);
  const middle = [0, 1].map((k) => corners.reduce((sum, corner) => sum + corner[k], 0) / corners.length);
  const { workspace } = cplan.panels;
  const [x, y] = workspace.at(middle).map((spot) => Math.round(spot * workspace.ratio));
  const { data } = workspace.canvas.getContext('2d').getImageData(x - 1, y - 1, 3, 3);
  const drawn = Array.from({ length: 9 }, (_, k) => '#' + [...data.slice(4 * k, 4 * k + 3)].map((one) => one.toString(16).padStart(2, '0')).join(''));
  return { middle, corners, drawn, fill: workspace.theme.obstacle(color).fill, arm: held ? held[0] : null };
}"""


def test_objects_lie_move_with_the_tools_and_lie_at_their_destinations(cell, show_file):
    file, page, result = cell
    seen = show_file(page, width=1600, height=1400)
    for table in file["object"]:
        for time, place in expected(file, result, table["name"]):
            shown = seen.do(LOOK, [time, table["name"]])
            assert shown["middle"] == pytest.approx(place, abs=1e-4), (table["name"], time)
            # An arm and what it carries are a little transparent.
            assert any(are_alike(shown["fill"], color) for color in shown["drawn"]), (table["name"], time, shown)
            if "polygon" in table:
                # Level objects never turn.
                corners = [[corner[k] + shown["middle"][k] for k in range(2)] for corner in table["polygon"]]
                assert sorted(shown["corners"]) == [pytest.approx(corner, abs=1e-4) for corner in sorted(corners)]
    seen.shoot(f"cell_{file['name'].replace(' ', '_')}")


def test_the_wrist_turns_an_object_before_it_is_placed(program, show_file):
    text = (CELLS / "handover.toml").read_text().replace("../../robots", str(ROOT / "robots"))
    file = program.folder / "turned.toml"
    file.write_text(text.replace("at = [0.75, 0.3] }", 'at = [0.75, 0.3], angle = "90deg" }'))
    page, result = planned(program, "turned", file)
    *_, (_, release) = steps_of(result, "bracket 1")
    polygon = tomllib.loads(file.read_text())["object"][0]["polygon"]
    seen = show_file(page)

    def angle(time):
        """Returns the angle of the object at a time, from its first side. The side in the file has the angle 0."""
        assert polygon[0][1] == polygon[1][1] and polygon[0][0] < polygon[1][0]
        (x, y), (u, v), *_ = seen.do(LOOK, [time, "bracket 1"])["corners"]
        return math.atan2(v - y, u - x)

    # The arm rests, turns the object, and then lowers it.
    span = release["event"] - release["arrival"]
    turning = [angle(release["arrival"] + share * span) for share in (0, 0.1, 0.2, 0.3, 1.01)]
    assert angle(release["arrival"] - 0.1) == pytest.approx(0, abs=1e-3) and turning[0] == pytest.approx(0, abs=1e-3)
    assert turning == sorted(turning) and len(set(turning)) == len(turning)
    assert turning[-1] == pytest.approx(math.pi / 2, abs=1e-3)


def test_the_other_arm_takes_what_was_handed_over(handover, show_file):
    _, page, result = handover
    seen = show_file(page)
    for times in result["handovers"]:
        (giver, _), (_, placed), (taker, picked), _ = steps_of(result, times["object"])
        names = [own["name"] for own in result["arms"]]
        assert (names[giver], names[taker]) == (times["gives"], times["takes"])
        arms = [seen.do(LOOK, [time, times["object"]])["arm"] for time in (placed["event"] - 1e-3, placed["event"] + 1e-3, picked["event"] - 1e-3, picked["event"] + 1e-3)]
        assert arms == [giver, None, None, taker]
        # In the diagram, the place follows from the times of both arms: without the giver, the object is at its first place.
        seen.do("(times) => cplan.place(times)", [0, 0])
        assert seen.do("CellObjects.lying(cplan.cell.objects, cplan.shownTimes).length") == len(seen.do("cplan.cell.objects"))
        seen.page.keyboard.press("Escape")


def test_destinations_are_outlined_from_the_beginning(handover, show_file):
    _, page, result = handover
    seen = show_file(page, width=1600, height=1400)
    seen.do("() => { cplan.layers.shown.set('names', false); cplan.layers.shown.set('poses', false); cplan.layers.shown.set('path', false); cplan.refresh(); }")
    steps = [step for name in ("bracket 1", "bracket 2") for _, step in steps_of(result, name)[1::2]]
    outlines = seen.do(
        """() => cplan.model.places.map(({ name, color, outline: { polygon } }) => {
          const { workspace } = cplan.panels;
          const corners = [...Geometry.pointsOf(polygon)];
          const context = workspace.back.getContext('2d');
          const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
          const is = (a, b) => a.every((one, k) => Math.abs(one - b[k]) < 24);
          const line = rgb(workspace.theme.obstacle(color).line), paper = rgb(workspace.theme.paper);
          const along = corners.flatMap((from, k) => { const to = corners[(k + 1) % corners.length]; return Array.from({ length: 12 }, (_, i) => from.map((one, c) => one + ((to[c] - one) * i) / 12)); });
          const colors = along.map((spot) => { const [x, y] = workspace.at(spot).map((one) => Math.round(one * workspace.ratio)); return [...context.getImageData(x, y, 1, 1).data].slice(0, 3); });
          return { name, middle: [0, 1].map((k) => corners.reduce((sum, corner) => sum + corner[k], 0) / 4), lines: colors.filter((one) => is(one, line)).length, gaps: colors.filter((one) => !is(one, line)).length };
        })"""
    )
    assert [(place["name"], pytest.approx(place["middle"], abs=1e-4)) for place in outlines] == [(step["object"], destination(step)) for step in steps]
    # Both brackets are handed over at one place, where the second outline covers the first.
    for place in {tuple(round(value, 3) for value in place["middle"]): place for place in outlines}.values():
        assert place["lines"] >= 5 and place["gaps"] >= 5, f"{place}: dashed"


def test_rows_show_steps_waits_and_handovers(cell, show_file):
    file, page, result = cell
    seen = show_file(page, width=1280, height=720)
    bars = seen.do(
        """() => [...document.querySelectorAll('.gantt .steps .bar')].map((bar) => {
          const [lane, box] = [bar.closest('.lane'), bar].map((part) => part.getBoundingClientRect());
          return { label: bar.getAttribute('aria-label'), from: (box.left - lane.left) / lane.width, to: (box.right - lane.left) / lane.width, held: bar.classList.contains('held'), text: bar.textContent };
        })"""
    )
    steps = [(own["name"], step) for own in result["arms"] for step in own["steps"]]
    for bar, (name, step) in zip(bars, steps, strict=True):
        words, _, times = bar["label"].rpartition(", from ")
        assert words == f"{name}, step {step['step']}: {step['action']}"
        assert seconds(times.split(" to ")) == pytest.approx([step["begin"], step["end"]], abs=1e-3)
        assert bar["from"] == pytest.approx(step["begin"] / result["duration"], abs=0.004)
        assert bar["to"] == pytest.approx(step["end"] / result["duration"], abs=0.004)
        assert bar["held"] == (not step["action"].startswith("pick")), "picks are outlined, others filled"
        assert bar["text"] == (f"{step['action'].split()[0]} {step['object']}" if step["object"] else step["action"])
    waits = [wait for own in result["arms"] for wait in own["waits"]]
    assert seen.page.locator(".gantt .wait").count() == len(waits) >= 1
    rows = seen.page.locator(".gantt .signal").all()
    labels = [row.get_attribute("aria-label") for row in rows]
    assert len(rows) == len(result["handovers"]) + len(result["interlocks"])
    for label, times in zip(labels, result["handovers"]):
        words = label.removeprefix(f"Handover of {times['object']}: {times['gives']} has placed it at ").split(f", {times['takes']} takes it from ")
        assert seconds(words) == pytest.approx([times["placed"], times["taken"]], abs=1e-3)
    # A bar leads to its step, and the words above the rows say what both arms do.
    name, step = steps[1]
    seen.page.locator(".gantt .steps .bar").nth(1).click()
    assert shown_time(seen) == pytest.approx(step["begin"], abs=1e-3)
    assert f"{name}: place {step['object']}" in seen.page.locator(".step").inner_text()
    assert seen.page.locator(".gantt .bar[aria-current=step]").count() >= 1
