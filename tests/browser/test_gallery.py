"""Worlds to open, puzzles, links and undo: on the page of a server and on the one with the program inside."""

import re

import pytest
from conftest import ROOT
from live import drag, path, settled


def crate(seen):
    return seen.do("cplan.scene.obstacles[1].shape.polygon")


def test_undo_survives_a_reload(either):
    seen = either()
    drag(seen, "workspace", [0.7, -1.5], [1.15, -0.75])
    settled(seen)
    moved = crate(seen)
    seen.page.reload()
    assert settled(seen)["certified"] and crate(seen) == moved
    seen.page.get_by_label("undo").click()
    settled(seen)
    assert crate(seen)[0] == [0.5, -1.6]


def test_a_link_holds_arm_world_and_options(either):
    seen = either("#cell", permissions=["clipboard-read", "clipboard-write"])
    seen.page.get_by_role("button", name="add a circle").click()
    settled(seen)
    seen.page.get_by_label("planner", exact=True).select_option("trapezoid")
    answer = settled(seen)
    seen.page.get_by_role("button", name="Copy link").click()
    seen.until("/link/i.test(cplan.remarked)")
    link = seen.do("navigator.clipboard.readText()")
    assert link.startswith(seen.page.url.split("#")[0]) and re.search(r"/#w=[\w-]+$", link)
    again = either(link[link.index("#"):])
    assert again.do("cplan.answered.verdict") == answer["verdict"] and path(again) == path(seen)
    assert again.do("cplan.words") == "trapezoid" and "scara" in again.page.locator("h1, .lines").first.inner_text().lower()
    assert [again.do("cplan.toml"), again.do("cplan.first.urdf")] == [seen.do("cplan.toml"), seen.do("cplan.first.urdf")]


def test_a_puzzle_is_judged_by_the_verdict(either):
    seen = either("#close")
    task = seen.page.locator(".task")
    assert "Close the gap" in task.inner_text() and "Solved" not in task.inner_text()
    # Another obstacle is against the rules.
    seen.page.get_by_role("button", name="add a circle").click()
    settled(seen)
    assert "Do not add or delete" in task.inner_text()
    seen.page.get_by_label("undo").click()
    settled(seen)
    # Half way there is still a path.
    drag(seen, "workspace", [0.01, -0.6], [0.01, -0.55])
    assert settled(seen)["verdict"] == "found" and "Solved" not in task.inner_text()
    drag(seen, "workspace", [0.01, -0.6], [0.01, -0.5])
    assert settled(seen)["verdict"] == "infeasible"
    assert "Solved" in task.inner_text() and seen.do("cplan.view.world.proof.length") > 0
    seen.shoot("gallery-puzzle")


def test_worlds_are_opened_by_name_and_left_again(either):
    seen = either()
    first = path(seen)
    for name, verdict in [("no_path", "infeasible"), ("maze", "found"), ("ring", "infeasible")]:
        seen.page.get_by_label("world to open").select_option(name)
        seen.until(f"cplan.gallery.choice?.name === '{name}' && cplan.isCurrent")
        assert settled(seen)["verdict"] == verdict, name
        assert seen.do("location.hash") == f"#{name}"
    # An edit of one world is not one of another, and waits there.
    seen.page.get_by_role("button", name="add a circle").click()
    settled(seen)
    for _ in range(3):
        seen.page.go_back()
    seen.until("cplan.gallery.isOwn && cplan.isCurrent")
    assert path(seen) == first and seen.page.locator(".remark").inner_text() == ""
    seen.page.get_by_label("world to open").select_option("ring")
    seen.until("cplan.gallery.choice?.name === 'ring' && cplan.isCurrent")
    assert "back" in seen.page.locator(".remark").inner_text()
    # Quick steps through the history announce the last address several times.
    seen.do("() => { location.hash = ''; window.dispatchEvent(new HashChangeEvent('hashchange')); }")
    seen.until("cplan.gallery.isOwn && cplan.isCurrent")
    assert path(seen) == first and seen.page.locator(".remark").inner_text() == ""


@pytest.mark.parametrize("broken", ["#w=nothing", "world"])
def test_an_address_without_a_world_opens_the_pages_own(either, broken):
    seen = either()
    if broken == "world":
        packed = seen.do("() => Packed.write(JSON.stringify({ urdf: cplan.first.urdf, world: '[[obstacle]]\\nimage = \"den.yaml\"', options: 'shortest' }))")
        broken = f"#w={packed}"
    seen.do("(hash) => { location.hash = hash; }", broken)
    seen.until("cplan.remarked?.includes('cannot be read') && cplan.isCurrent")
    assert settled(seen)["certified"] and crate(seen)[0] == [0.5, -1.6]


def test_what_names_files_is_in_no_link(serve):
    seen = serve(ROOT / "robots/room_gantry.urdf", ROOT / "workspaces/store_room.toml")
    copy = seen.page.get_by_role("button", name="Copy link")
    assert copy.is_disabled() and "name other files" in copy.get_attribute("title")
    # A puzzle names none.
    seen.page.get_by_label("world to open").select_option("berth")
    seen.until("cplan.gallery.choice?.name === 'berth' && cplan.isCurrent")
    assert copy.is_enabled()
