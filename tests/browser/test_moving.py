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
    seen.page.get_by_label("cart").uncheck()
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
