"""The defaults of the live page are those of the command line."""

import json

import pytest
from live import PLANAR, settled

PLANNERS = ["shortest", "visibility", "trapezoid", "wavefront", "harmonic", "subdivision", "first"]


def saved(seen, format_):
    with seen.page.expect_download() as download:
        seen.page.get_by_label("file to save").select_option(format_)
        seen.page.get_by_role("button", name="Save").click()
    return download.value.path().read_text()


def test_untouched_options_are_the_programs_defaults(serve, program):
    seen = serve(*PLANAR)
    for planner in PLANNERS:
        seen.page.get_by_label("planner", exact=True).select_option(planner)
        assert settled(seen)["certified"]
        assert seen.page.locator(".command code").inner_text().split("--planner ")[1] == planner
        assert json.loads(saved(seen, "json")) == json.loads(program.run(*PLANAR, "--planner", planner, "--json")), planner


def test_menus_keep_their_order_and_send_what_is_chosen(serve, program):
    seen = serve(*PLANAR, "--with", "wavefront --cells 64 --neighbors=8 --levels 3")
    option = lambda name: seen.page.locator(f"[data-option='{name}']")
    assert option("--cells").locator("option").all_inner_texts() == ["64", "128", "256", "512", "1024"]
    assert [option(name).input_value() for name in ("--cells", "--neighbors", "--search", "--path")] == ["64", "8", "", ""]
    assert seen.page.get_by_label("other options").input_value() == "--levels 3"
    option("--cells").select_option(label="256")
    option("--neighbors").select_option(label="4")
    option("--search").select_option("astar")
    seen.page.get_by_label("other options").fill("")
    seen.page.get_by_label("other options").press("Enter")
    settled(seen)
    assert seen.do("cplan.words") == "wavefront --search astar"
    expected = program.run(*PLANAR, "--planner", "wavefront", "--search", "astar", "--json")
    assert json.loads(saved(seen, "json")) == json.loads(expected)
    # Options that other planners do not know are not sent for them.
    seen.page.get_by_label("planner", exact=True).select_option("harmonic")
    assert settled(seen)["certified"]
    assert option("--search").count() == 0 and seen.do("cplan.words") == "harmonic"
