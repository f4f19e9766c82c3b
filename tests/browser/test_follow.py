"""The page of a line that the tip follows: lens, speed, distance, both IK solutions."""

import csv
import json
import math

import pytest

from conftest import ROOT

FILES = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/follow/engraving.toml"]


def followed(program, name, *words, line=ROOT / "workspaces/follow/plate.gcode", world=FILES[1], code=0):
    page = program.folder / f"{name}.html"
    program.run("follow", FILES[0], world, line, "--picture", page, *words, code=code)
    return page


def test_the_page_shows_speed_lens_and_both_solutions(program, show_file):
    page = followed(program, "plate")
    seen = show_file(page)
    seen.page.wait_for_timeout(200)
    assert seen.do("cplan.panels.workspace.times") > 3, "the line fills the workspace"
    boxes = seen.do("[...document.querySelectorAll('.followed canvas')].map((c) => [c.clientWidth, c.clientHeight])")
    assert len(boxes) == 3 and all(width > 150 and 80 < height < 400 for width, height in boxes), boxes
    text = seen.page.locator(".layers, .side, main").first.inner_text()
    for part in ["speed limit of the tip", "acceleration limit of shoulder", "excluded IK solution"]:
        assert part in text, part
    assert "tube \u00b1 0.01 mm" in seen.page.locator(".lens-caption").inner_text()
    seen.do("cplan.seek(10.5)")
    # The tip is where the line is: on the lower side of the slot.
    [x, y] = seen.do("cplan.followed.tipAt(10.5)")
    assert abs(y + 0.06) < 1e-5 and 1.15 < x < 1.25
    other = seen.do("cplan.followed.other")
    [a, b] = other["q"]
    reached = [math.cos(a) + 0.8 * math.cos(a + b), math.sin(a) + 0.8 * math.sin(a + b)]
    assert math.dist(reached, [x, y]) < 1e-6 and b < 0, "the other solution has its tip at the same place"
    assert not other["isFree"], "the clamp excludes it"
    seen.shoot("follow")


def middle(one, two):
    """Returns the middle of the cubic through two samples: positions and velocities."""
    time, values, rates = two[0] - one[0], zip(one[1:3], two[1:3]), zip(one[3:5], two[3:5])
    return [one[0] + time / 2, *((p + q) / 2 + time * (v - w) / 8 for (p, q), (v, w) in zip(values, rates))]


def test_the_lens_shows_the_samples_as_a_controller_plays_them(program, show_file):
    """The place of the tip on the page is compared with the exact samples: a pixel of the lens is about 0.6 micrometres."""
    page = followed(program, "exact", "--output", program.folder / "exact.csv")
    seen = show_file(page)
    rows = [[float(x) for x in row] for row in list(csv.reader(open(program.folder / "exact.csv")))[1:]]
    for k in range(0, len(rows) - 1, len(rows) // 50):
        # The page's times are rounded to microseconds, which shifts the tip along its path.
        for row, time in ((rows[k], "time[k]"), (middle(rows[k], rows[k + 1]), "(time[k] + time[k + 1]) / 2")):
            a, b = row[1:3]
            exact = [math.cos(a) + 0.8 * math.cos(a + b), math.sin(a) + 0.8 * math.sin(a + b)]
            shown = seen.do(f"(k) => (({{ time }}) => cplan.followed.tipAt({time}))(cplan.model.clock)", k)
            assert math.dist(exact, shown) < 2e-7, (k, exact, shown)
    # The lens follows the motion if asked.
    seen.do("cplan.seek(8)")
    seen.page.get_by_role("button", name="now", exact=True).click()
    assert "at 8.00 s" in seen.page.locator(".lens-caption").inner_text()
    seen.page.get_by_role("button", name="farthest", exact=True).click()
    [time, off] = seen.do("cplan.followed.motion.farthest")
    caption = seen.page.locator(".lens-caption").inner_text()
    assert f"at {time:.2f} s" in caption and abs(off) <= seen.do("cplan.followed.motion.deviation") <= 1e-5


def test_an_infeasible_line_shows_both_solutions(program, show_file):
    world, line = program.folder / "walls.toml", program.folder / "up.gcode"
    box = '[[obstacle]]\nname = "{}"\npolygon = [[0.2, {}], [1.0, {}], [1.0, {}], [0.2, {}]]\n'
    world.write_text(box.format("above", 0.3, 0.3, 0.6, 0.6) + box.format("below", -0.6, -0.6, -0.3, -0.3))
    line.write_text("G21 G0 X1000 Y-100\nG1 Y100 F3000\n")
    seen = show_file(followed(program, "walls", line=line, world=world, code=3))
    excluded = seen.do("cplan.model.line.excluded")
    assert len(excluded) == 2 and excluded[0][1] * excluded[1][1] < 0
    for a, b in excluded:
        assert math.dist([math.cos(a) + 0.8 * math.cos(a + b), math.sin(a) + 0.8 * math.sin(a + b)], [1.0, -0.1]) < 1e-4
    text = seen.page.locator("header").inner_text()
    assert 'hits obstacle "above"' in text and 'hits obstacle "below"' in text
    assert seen.page.locator(".followed").count() == 0
    seen.shoot("follow_infeasible")


@pytest.mark.parametrize("scheme, width", [("dark", 1400), ("light", 390)])
def test_the_page_suits_dark_rooms_and_phones(program, show_file, scheme, width):
    seen = show_file(followed(program, f"plate_{scheme}"), width=width, color_scheme=scheme)
    assert seen.do("document.documentElement.scrollWidth") <= width
    seen.shoot(f"follow_{scheme}_{width}")


def test_a_motion_with_limited_jerk_is_smooth(program, show_file):
    world, line = program.folder / "smooth.toml", program.folder / "corner.gcode"
    world.write_text("[robot]\njerk = { shoulder = 60.0, elbow = 90.0 }\n")
    line.write_text("G21 G0 X1000 Y-100\nG1 Y100 F60000\nG1 X1200\n")
    page = followed(program, "smooth", "--output", program.folder / "smooth.json", line=line, world=world)
    seen = show_file(page)
    limits = [name for name, _ in seen.do("cplan.followed.motion.limits")]
    assert any("jerk limit" in name for name in limits), limits
    trajectory = json.loads((program.folder / "smooth.json").read_text())["trajectory"]
    # The arm stops at the corner and at both ends.
    stops = seen.do("cplan.followed.motion.stops")
    assert len(stops) == 3 and stops[0] == 0 and abs(stops[2] - trajectory["time"][-1]) < 1e-8
    assert seen.do("cplan.followed.line.smooth")
