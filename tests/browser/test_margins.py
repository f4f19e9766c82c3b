"""The table of margins: what the result states, and where the arm would touch."""

import math

import pytest
from test_page import pixels

#: Widths and heights of a desk and a phone.
LOOKS = [("light", 1400, 1000), ("dark", 390, 844)]


def opened(show_file, page, **options):
    seen = show_file(page, **options)
    seen.do("cplan.tour.end()")
    seen.page.get_by_role("tab", name="Margins").click()
    return seen


def row(seen, name):
    return seen.page.locator(".budget tr").filter(has=seen.page.get_by_role("button", name=name, exact=True))


def number(text):
    """Returns a length in metres, or an angle in radians."""
    size, unit = text[:-1].split() + ["deg"] if text.endswith("\u00b0") else text.split()
    return float(size) * {"mm": 1e-3, "m": 1.0, "deg": math.pi / 180}[unit]


@pytest.mark.parametrize(("scheme", "width", "height"), LOOKS)
def test_the_table_has_the_margins_of_the_result(program, show_file, scheme, width, height):
    page, result = program.plan("scara", "scara_cell")
    seen = opened(show_file, page, width=width, height=height, color_scheme=scheme)
    sizes = [(margin["body"], margin["clearance"]) for margin in result["margins"]]
    sizes += [(tolerance["of"], tolerance["error"]) for tolerance in result["tolerances"]]
    for name, size in sizes:
        if size is None:
            continue
        shown = number(row(seen, name).locator(".size").inner_text())
        assert 0.98 * size <= shown <= size * (1 + 1e-9), f"{name}: {shown} is shown instead of {size}"
    shown = seen.page.locator(".budget tbody tr").count()
    assert shown == len(sizes)
    # The bodies with the least clearance come first.
    bodies = [number(text) for text in seen.page.get_by_label("Displacement of one body").locator(".size").all_inner_texts() if text != "\u2013"]
    assert bodies == sorted(bodies)
    seen.shoot(f"margins-{scheme}-{width}")


def test_a_row_shows_where_the_arm_would_touch(program, show_file):
    page, result = program.plan("planar_2r", "workbench")
    seen = opened(show_file, page)
    before = pixels(seen, "workspace")
    seen.do("cplan.seek(0.25)")
    moved = pixels(seen, "workspace")
    assert moved != before
    for kind, name in [("margins", "body"), ("tolerances", "of")]:
        for margin in result[kind]:
            if "at" not in margin:
                continue
            row(seen, margin[name]).hover()
            probe = seen.do("cplan.probe.q")
            assert probe == pytest.approx(margin["at"], abs=1e-12)
            assert seen.do("cplan.time") == pytest.approx(margin["time"], abs=1e-9)
            shown = pixels(seen, "workspace")
            seen.do("cplan.budget.release()")
            seen.do("cplan.panels.workspace.draw()")
            assert pixels(seen, "workspace") != shown, "both bodies are marked"
            seen.page.mouse.move(5, 5)
            seen.do("cplan.examine(null)")
            seen.do("cplan.seek(0.25)")


def test_the_distance_in_the_picture_is_that_of_the_pair(program, show_file):
    page, result = program.plan("planar_2r", "workbench")
    seen = opened(show_file, page)
    margin = min((margin for margin in result["margins"] if margin["kind"] == "obstacle" and margin["clearance"]), key=lambda margin: margin["clearance"])
    row(seen, margin["body"]).hover()
    length = seen.do(
        """() => { const { budget } = cplan; let found = null; const draw = Workspace.distance;
             const [a, b] = budget.shown.between.map((name) => budget.shapes(name));
             const pairs = a.all.flatMap((one) => b.all.map((other) => Geometry.nearest(one, other)));
             const best = pairs.reduce((x, y) => (y.distance < x.distance ? y : x));
             return [best.distance, Math.hypot(best.ends[0][0] - best.ends[1][0], best.ends[0][1] - best.ends[1][1])]; }"""
    )
    assert length[0] == pytest.approx(length[1], rel=1e-6), "the ends of the line are as far apart as the shapes"
    # The proven clearance is within a few per cent below the true one.
    assert 0.9 * length[0] <= margin["clearance"] <= length[0] * (1 + 1e-3)


def test_a_click_keeps_a_place_until_something_else_is_shown(program, show_file):
    page, _ = program.plan("scara", "tasks/kitting_cell")
    seen = opened(show_file, page)
    button = seen.page.locator(".budget .name").nth(5)
    seen.do("cplan.seek(1)")
    button.click()
    seen.page.mouse.move(5, 5)
    assert button.get_attribute("aria-pressed") == "true"
    kept = seen.do("cplan.time")
    assert kept == seen.do("cplan.budget.kept.time") != 1
    button.press("Escape")
    assert button.get_attribute("aria-pressed") == "false"
    assert seen.do("[cplan.time, cplan.probe]") == [1, None], "the motion is where it was"
    button.click()
    seen.page.mouse.move(5, 5)
    seen.do("cplan.play()")
    assert button.get_attribute("aria-pressed") == "false" and seen.do("cplan.budget.shown") is None
    # With the keyboard, the focus shows a place.
    seen.do("cplan.pause()")
    seen.page.keyboard.press("Tab")
    assert seen.do("cplan.budget.shown !== null && cplan.probe !== null")
    seen.do("cplan.switchTo('think')")
    assert seen.do("[cplan.budget.shown, cplan.probe]") == [None, None]


def test_pages_without_a_motion_have_no_margins(program, show_file):
    page, _ = program.plan("planar_2r_continuous", "no_path", code=3)
    seen = show_file(page)
    assert seen.page.get_by_role("tab", name="Margins").count() == 0


def test_on_a_phone_a_tap_shows_the_picture(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = opened(show_file, page, width=390, height=844, has_touch=True)
    seen.page.locator(".budget .name").last.tap()
    seen.until("cplan.panels.workspace.canvas.getBoundingClientRect().top >= -1")
    seen.until("cplan.panels.workspace.canvas.getBoundingClientRect().bottom <= innerHeight + 1")
    assert seen.do("cplan.budget.kept !== null")


def test_the_live_page_has_margins_of_the_current_plan(serve):
    from live import PLANAR

    seen = serve(*PLANAR)
    names = ["shelf", "forearm", "upper_arm", "crate"]
    assert seen.do("cplan.view.budget.rows.map(({ button }) => button.textContent)")[-4:] == names
    seen.page.get_by_role("tab", name="Margins").click()
    row(seen, "crate").hover()
    assert seen.do("cplan.view.probe.q[0]") == pytest.approx(-0.9, abs=0.5)
