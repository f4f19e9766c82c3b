"""Edits of the live page survive a reload of the page and the end of the server."""

from conftest import ROOT
from live import PLANAR, badge, drag, path, settled


def crate(seen):
    return seen.do("cplan.scene.obstacles[1].shape.polygon")


def test_edits_survive_a_reload(serve):
    seen = serve(*PLANAR)
    drag(seen, "workspace", [0.7, -1.5], [1.15, -0.75])
    seen.page.get_by_role("button", name="add a thin wall").click()
    seen.page.get_by_label("planner", exact=True).select_option("wavefront")
    seen.page.locator("[data-option='--neighbors']").select_option("8")
    assert settled(seen)["certified"]
    before = [crate(seen), path(seen), seen.do("cplan.words"), seen.do("cplan.answered.figures.length")]
    seen.page.reload()
    assert settled(seen)["certified"]
    assert [crate(seen), path(seen), seen.do("cplan.words"), seen.do("cplan.answered.figures.length")] == before
    assert seen.page.get_by_label("planner", exact=True).input_value() == "wavefront"
    assert "back" in seen.page.locator(".remark").inner_text()
    # Undo still works.
    seen.page.get_by_label("undo").click()
    settled(seen)
    assert [name for name in seen.do("cplan.scene.obstacles.map(({ name }) => name)")] == ["shelf", "crate"]
    # Starting again returns to the world of the file permanently.
    seen.page.get_by_role("button", name="Start again").click()
    settled(seen)
    assert crate(seen)[0] == [0.5, -1.6]
    seen.page.get_by_label("planner", exact=True).select_option("shortest")
    settled(seen)
    seen.page.reload()
    settled(seen)
    assert crate(seen)[0] == [0.5, -1.6] and seen.page.locator(".remark").inner_text() == ""


def test_what_can_be_dragged_says_so_until_it_was(serve):
    seen = serve(*PLANAR)
    settled(seen)
    hint = seen.page.locator("figcaption .hint")
    assert seen.do("cplan.editor.isNew") and "drag" in hint.inner_text()
    drag(seen, "workspace", [0.7, -1.5], [1.15, -0.75])
    settled(seen)
    assert not seen.do("cplan.editor.isNew") and hint.count() == 0
    seen.page.reload()
    settled(seen)
    assert not seen.do("cplan.editor.isNew")


def test_a_loaded_world_survives_a_reload_with_its_edits(serve):
    seen = serve(*PLANAR)
    text = (ROOT / "workspaces/workbench.toml").read_bytes()
    seen.page.locator("input[type=file]").set_input_files({"name": "workbench.toml", "mimeType": "text/plain", "buffer": text})
    assert settled(seen)["certified"]
    seen.page.get_by_role("button", name="add a circle").click()
    assert settled(seen)["certified"]
    names, points = seen.do("cplan.scene.obstacles.map(({ name }) => name)"), path(seen)
    seen.page.reload()
    assert settled(seen)["certified"]
    assert seen.do("cplan.scene.obstacles.map(({ name }) => name)") == names and path(seen) == points


def test_edits_made_while_the_server_is_gone_are_sent_when_it_is_back(serve):
    seen = serve(*PLANAR)
    first = path(seen)
    drag(seen, "workspace", [0.7, -1.5], [0.9, -1.4])
    assert settled(seen)["certified"]
    complaints = len(seen.complaints)
    seen.server.stop()
    seen.until("!cplan.isUp")
    assert badge(seen) == "? no connection"
    lost = seen.page.locator(".connection")
    assert lost.is_visible() and "connection to cplan is lost" in lost.inner_text()
    # The page continues without it, and says so.
    drag(seen, "workspace", [0.9, -1.4], [1.15, -0.75])
    seen.page.get_by_role("button", name="add a thin wall").click()
    moved = crate(seen)
    assert badge(seen) == "? no connection"
    seen.shoot("live-lost")
    seen.server.start_again()
    seen.until("cplan.isUp && cplan.isCurrent")
    assert settled(seen)["certified"] and "certified" in badge(seen)
    assert not lost.is_visible() and crate(seen) == moved and path(seen) != first
    assert seen.do("cplan.view.world.obstacles.map(({ name }) => name)") == ["shelf", "crate", "wall 1"]
    outline = seen.do("cplan.view.world.obstacles[1].outline.polygon")
    assert outline == [x for corner in moved for x in corner], "the server has them"
    seen.page.get_by_label("undo").click()
    settled(seen)
    assert seen.do("cplan.scene.obstacles.length") == 2
    # A browser says in its console that it could not connect.
    assert all("WebSocket" in text for text in seen.complaints[complaints:])
    del seen.complaints[complaints:]


def test_a_reload_while_the_server_is_gone_loses_nothing(serve):
    seen = serve(*PLANAR)
    text = (ROOT / "workspaces/workbench.toml").read_bytes()
    seen.page.locator("input[type=file]").set_input_files({"name": "workbench.toml", "mimeType": "text/plain", "buffer": text})
    settled(seen)
    complaints = len(seen.complaints)
    seen.server.stop()
    seen.until("!cplan.isUp")
    seen.page.get_by_role("button", name="add a circle").click()
    names = seen.do("cplan.scene.obstacles.map(({ name }) => name)")
    seen.server.start_again()
    seen.page.reload()
    settled(seen)
    assert seen.do("cplan.view.world.obstacles.map(({ name }) => name)") == names
    del seen.complaints[complaints:]


def test_another_world_at_the_same_address_is_shown_as_it_is(serve):
    seen = serve(*PLANAR)
    drag(seen, "workspace", [0.7, -1.5], [1.15, -0.75])
    settled(seen)
    moved = crate(seen)
    complaints = len(seen.complaints)
    seen.server.stop()
    seen.until("!cplan.isUp")
    seen.server.start_again(ROOT / "robots/scara.urdf", ROOT / "workspaces/scara_tray.toml")
    seen.until("cplan.isUp && cplan.isCurrent")
    settled(seen)
    assert "scara" in seen.page.locator("h1").inner_text()
    assert "other world" in seen.page.locator(".remark").inner_text()
    seen.server.stop()
    seen.until("!cplan.isUp")
    seen.server.start_again(*PLANAR)
    seen.until("cplan.isUp && cplan.isCurrent")
    settled(seen)
    assert crate(seen) == moved, "kept for this world"
    del seen.complaints[complaints:]
