"""Small screens, tasks, and users who do not see the pictures."""

import pytest

PHONE = {"width": 390, "height": 844, "has_touch": True, "is_mobile": True, "device_scale_factor": 2}


def test_both_spaces_are_large_and_the_readout_is_where_the_finger_is(program, show_file):
    page, _ = program.plan("planar_2r", "workbench")
    seen = show_file(page, **PHONE)
    boxes = [seen.page.locator(f"canvas[aria-label='{name}']").bounding_box() for name in ("Workspace", "Configuration space")]
    rects = seen.do("['workspace', 'cspace'].map((name) => cplan.panels[name].rect)")
    assert all(min(rect["width"], rect["height"]) >= 260 for rect in rects)
    # The play button and the time stay in sight, in one row at the lower edge.
    for y in (0, 200, 400, 0):
        seen.page.evaluate("(y) => scrollTo(0, y)", y)
        bar = seen.page.locator(".transport").bounding_box()
        for part in (".play", ".track", ".clock"):
            box = seen.page.locator(f".transport {part}").bounding_box()
            assert bar["y"] <= box["y"] and box["y"] + box["height"] <= 844.5, part
        assert y > 0 or 844 - bar["y"] <= 60, "one row covers pictures"
    seen.page.locator("canvas[aria-label='Configuration space']").scroll_into_view_if_needed()
    boxes = [seen.page.locator(f"canvas[aria-label='{name}']").bounding_box() for name in ("Workspace", "Configuration space")]
    at = seen.do("cplan.panels.cspace.at([0.1, 0.2])")
    x, y = boxes[1]["x"] + at[0], boxes[1]["y"] + at[1]
    seen.page.touchscreen.tap(x, y)
    said = seen.page.locator(".probe")
    box = said.bounding_box()
    assert "touches" in said.inner_text()
    assert 0 < y - (box["y"] + box["height"]) < 60, "above the finger, and not under it"
    assert box["x"] >= 0 and box["x"] + box["width"] <= 390
    seen.shoot("phone-readout")


@pytest.mark.parametrize(("robot", "world", "code"), [("rrbot_vertical", "tasks/tower", 0), ("gantry", "tasks/board_and_gate", 3)])
def test_steps_can_be_gone_to(program, show_file, robot, world, code):
    page, result = program.plan(robot, world, code=code)
    seen = show_file(page)
    motions = seen.do("cplan.model.motions")
    steps = seen.page.locator(".gantt .bar")
    assert steps.count() == len(motions)
    begins = [motion["from"] for motion in motions]
    assert begins == sorted(begins), "in the order in which they are done"
    for k, motion in enumerate(motions):
        steps.nth(k).click()
        assert motion["label"] in steps.nth(k).get_attribute("aria-label")
        assert seen.do("cplan.time") == pytest.approx(min(motion["from"], seen.do("cplan.duration")))
        assert seen.page.locator(".gantt [aria-current=step]").count() == 1
        assert steps.nth(k).get_attribute("aria-current") == "step"
    marks = seen.do("[...document.querySelectorAll('.ticks i')].map((mark) => Number(mark.style.getPropertyValue('--at')))")
    duration = seen.do("cplan.duration")
    assert marks == pytest.approx([begin / duration for begin in begins if 0 < begin < duration])
    assert len(result["steps"]) <= len(motions)
    seen.shoot(f"steps-{world.split('/')[1]}")


def test_a_single_motion_has_no_steps_and_phases_have_marks(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    assert seen.page.locator(".gantt").is_hidden() and seen.page.locator(".ticks i").count() == 0
    seen.page.keyboard.press("t")
    assert seen.page.locator(".ticks i").count() == seen.do("cplan.model.replay.length") - 1


def test_pictures_are_told_to_who_does_not_see_them(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    for name in ("Workspace", "Configuration space"):
        canvas = seen.page.locator(f"canvas[aria-label='{name}']")
        assert canvas.get_attribute("aria-describedby") == seen.page.locator(".unseen").get_attribute("id")
    told = seen.page.locator("#description")
    first = told.text_content()
    assert "free" in first and "The path leads from shoulder" in first and "nearest: link" in first
    seen.do("cplan.seek(cplan.duration)")
    assert told.text_content() != first
    page, _ = program.plan("planar_2r_continuous", "no_path", code=3)
    assert "prove that there is no path" in show_file(page).page.locator("#description").text_content()


def test_layers_stand_beside_the_pictures_where_there_is_room(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    wide = show_file(page, width=1500, height=900)
    panels, side = wide.page.locator(".panels").first.bounding_box(), wide.page.locator(".side").bounding_box()
    assert side["x"] >= panels["x"] + panels["width"] and abs(side["y"] - panels["y"]) < 5
    narrow = show_file(page, width=900, height=900)
    panels, side = narrow.page.locator(".panels").first.bounding_box(), narrow.page.locator(".side").bounding_box()
    assert side["y"] >= panels["y"] + panels["height"]
