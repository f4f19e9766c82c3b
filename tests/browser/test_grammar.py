"""Pages and pictures state the same facts with the same signs."""

import re
import xml.etree.ElementTree as ElementTree

import pytest
from conftest import ROOT
from test_page import pixels

CASES = [
    ("planar_2r", "workbench", ("--planner", "shortest"), 0),
    ("planar_2r", "workbench", ("--planner", "wavefront"), 0),
    ("planar_2r_continuous", "torus_open", ("--planner", "harmonic"), 0),
    ("planar_2r", "workbench", ("--planner", "subdivision"), 0),
    ("planar_2r", "shelf", ("--planner", "voronoi"), 0),
    ("planar_2r_continuous", "no_path", (), 3),
    ("gantry", "tasks/board_and_gate", (), 3),
]
# Labels that only pictures have. They show worlds side by side, and pages one after the other.
STILL_ALONE = {"open to link 2 (picked or placed)"}


def picture(program, robot, world, *words, code=0):
    """Returns the texts of the picture."""
    program.run(ROOT / f"robots/{robot}.urdf", ROOT / f"workspaces/{world}.toml", *words, "--quiet", "--picture", "picture.svg", code=code)
    tree = ElementTree.parse(program.folder / "picture.svg")
    return [text.text.strip() for text in tree.iter("{http://www.w3.org/2000/svg}text")]


@pytest.mark.parametrize(("robot", "world", "words", "code"), CASES, ids=lambda value: str(value))
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_legend_is_that_of_the_picture(program, show_file, robot, world, words, code, scheme):
    page, _ = program.plan(robot, world, *words, code=code)
    seen = show_file(page, color_scheme=scheme)
    # The planner's work is shown and explained under "How it was found", "How it was proven" or "What was tried".
    if seen.page.locator("button[data-mode=think]").is_visible():
        seen.do("cplan.switchTo('think')")
        seen.do("cplan.seek(cplan.duration)")
    entries = seen.page.locator(".legend li:visible").all_inner_texts()
    texts = picture(program, robot, world, *words, code=code)
    # The legend is the last part of the picture.
    begin = len(texts) - 1 - texts[::-1].index("start")
    assert {text for text in texts[begin:] if text not in STILL_ALONE} <= set(entries)
    signs = seen.page.locator(".legend li:visible svg")
    assert signs.count() == len(entries), "each layer has a sign"
    # Each sign is visible.
    bare = seen.do("[...document.querySelectorAll('.legend svg')].filter((sign) => ![...sign.children].some((part) => ['fill', 'stroke'].some((name) => !/^(none|)$/.test(part.getAttribute(name) ?? '')))).length")
    assert bare == 0
    title = seen.do("cplan.model.worlds[0].scale?.title ?? null")
    assert title is None or title in texts
    if title:
        shown = pixels(seen, "cspace")
        seen.do("cplan.model.worlds[0].scale.title = 'another'")
        seen.do("cplan.refresh()")
        assert pixels(seen, "cspace") != shown, "the scale of colours stands beside the space"
        seen.do("cplan.switchTo('move')")
        assert seen.do("cplan.panels.cspace.margins ?? null") is None, "but not beside the motion"
    seen.shoot(f"grammar-{world.replace('/', '_')}-{'-'.join(words)}-{scheme}")


def test_a_proof_is_hatched_in_a_colour_of_its_own(program, show_file):
    page, result = program.plan("planar_2r_continuous", "no_path", code=3)
    seen = show_file(page)
    colors = seen.do(
        """() => { const { canvas, ratio } = cplan.panels.cspace; const found = {};
             const { x, y, width, height } = cplan.panels.cspace.rect;
             const { data } = canvas.getContext('2d').getImageData(x * ratio, y * ratio, width * ratio, height * ratio);
             for (let k = 0; k < data.length; k += 4) { const key = data.slice(k, k + 3).join(); found[key] = (found[key] ?? 0) + 1; }
             return found; }"""
    )
    proof = seen.do("cplan.panels.cspace.theme.proof")
    rgb = ",".join(str(int(proof[k : k + 2], 16)) for k in (1, 3, 5))
    assert colors.get(rgb, 0) > 200
    assert proof not in seen.do("cplan.world.obstacles.map(({ color }) => color)")
    sentence = f"there is no path; {result['reason']}"
    assert sentence in seen.page.locator(".lines").inner_text()
    assert any(sentence in text for text in picture(program, "planar_2r_continuous", "no_path", code=3))


def test_where_it_gets_stuck_is_marked_in_both_spaces(program, show_file):
    files = [ROOT / "robots/planar_2r_continuous.urdf", ROOT / "workspaces/no_path.toml"]
    program.run("explain", *files, "--quiet", "--picture", "why.html", "--picture", "why.svg", code=3)
    seen = show_file(program.folder / "why.html")
    entries = [key["text"] for key in seen.do("cplan.model.legend")]
    assert set(entries) <= set(seen.page.get_by_role("list", name="Legend").get_by_role("listitem").all_inner_texts())
    assert {"in the way", "x: the narrowest place, and the arm there"} <= set(entries)
    drawn = (program.folder / "why.svg").read_text()
    assert all(entry in drawn for entry in entries)
    before = [pixels(seen, "workspace"), pixels(seen, "cspace")]
    seen.do("() => { delete cplan.model.stuck; cplan.refresh(); }")
    after = [pixels(seen, "workspace"), pixels(seen, "cspace")]
    assert before[0] != after[0] and before[1] != after[1]
    seen.shoot("stuck")


def test_arms_and_obstacles_are_named_alike(program, show_file):
    texts = picture(program, "planar_2r", "workbench")
    assert [texts.count(name) for name in ("start", "goal")] == [2, 2], "at the arms, and in the legend"
    page, _ = program.plan("planar_2r", "workbench")
    seen = show_file(page)
    seen.do("() => { window.written = []; const of = CanvasRenderingContext2D.prototype; const fill = of.fillText; of.fillText = function (text, ...rest) { written.push(text); fill.call(this, text, ...rest); }; }")
    seen.do("cplan.refresh()")
    written = seen.do("written")
    assert {"start", "goal"} <= set(written)
    for name in ("vice", "bottle", "lamp", "rack", "board"):
        # In both panels; in pictures also in the legend.
        assert (written.count(name), texts.count(name)) == (2, 3), name
    # Every number of the axes has its unit.
    seen.do("() => { written.length = 0; cplan.panels.cspace.dirty = true; cplan.panels.cspace.draw(); }")
    numbers = [text for text in seen.do("written") if re.match("\u2212?[0-9]", text)]
    assert len(numbers) > 8 and all(text.endswith("\u00b0") for text in numbers)
    assert set(numbers) & set(texts), "in pictures, too"


def test_of_many_obstacles_the_names_show_under_the_pointer(program, show_file):
    page, _ = program.plan("planar_2r", "crowd")
    seen = show_file(page)
    assert seen.do("cplan.isCrowded")
    obstacle = seen.do("cplan.world.obstacles.findIndex(({ outline }) => outline.circle)")
    x, y, _ = seen.do("(i) => cplan.world.obstacles[i].outline.circle", obstacle)
    box = seen.page.locator("canvas[aria-label='Workspace']").bounding_box()
    at = seen.do("(p) => cplan.panels.workspace.at(p)", [x, y])
    before = pixels(seen, "workspace")
    seen.page.mouse.move(box["x"] + at[0], box["y"] + at[1])
    name = seen.do("(i) => cplan.world.obstacles[i].name", obstacle)
    assert seen.do("cplan.hovered[0]") == f"{obstacle + 1} {name}"
    assert pixels(seen, "workspace") != before
    seen.page.mouse.move(5, 5)
    assert pixels(seen, "workspace") == before


def test_the_start_is_seen_where_the_arm_stands_on_it(program, show_file):
    page, _ = program.plan("planar_2r", "shelf")
    seen = show_file(page)
    ring = """() => { const { cspace } = cplan.panels; const [x, y] = cspace.at(cplan.q);
        const at = (dx) => [...cspace.canvas.getContext('2d').getImageData((x + dx) * cspace.ratio, y * cspace.ratio, 1, 1).data].slice(0, 3);
        return [at(0), at(7)]; }"""
    middle, edge = seen.do(ring)
    assert middle[2] > 150 and middle[0] < 50, "blue: where the arm is"
    assert max(edge) < 90, "ink: where it begins"


# Texts that a panel draws in its picture, each as left, top, width and height in pixels.
NAMES = """(panel) => { const written = []; const prototype = CanvasRenderingContext2D.prototype; const { fillText } = prototype;
  prototype.fillText = function (text, x, y, ...rest) {
    if (this.font.includes('600')) { const { width } = this.measureText(text); written.push([text, x - width / 2, y - 6, width, 12]); }
    fillText.call(this, text, x, y, ...rest); };
  cplan.panels[panel].dirty = true; cplan.panels[panel].draw(); prototype.fillText = fillText; return written; }"""
# Points of boxes that lie on the arm at its current configuration.
ON_THE_ARM = """(boxes) => { const { workspace } = cplan.panels; const { arm } = cplan.model; const at = Geometry.poses(arm, cplan.q);
  const parts = arm.links.flatMap((link, k) => link.parts.map((part) => Geometry.placed(part, at[k])));
  return boxes.flatMap(([text, x, y, width, height]) => [0, 0.25, 0.5, 0.75, 1].flatMap((u) => [0, 0.5, 1].map((v) => [text, workspace.value([x + u * width, y + v * height])])))
    .filter(([, place]) => parts.some((part) => Geometry.separation({ core: place, radius: 0 }, part) < 0)); }"""


@pytest.mark.parametrize(("robot", "world"), [("planar_2r", "shelf"), ("planar_2r", "workbench"), ("scara", "tasks/kitting_cell"), ("planar_2r", "moving/crossing")])
def test_names_lie_on_nothing(program, show_file, robot, world):
    page, _ = program.plan(robot, world)
    seen = show_file(page)
    count = 0
    for part in (0, 0.15, 0.4, 0.6, 0.85, 1):
        seen.do("(part) => cplan.seek(part * cplan.duration)", part)
        for panel in ("workspace", "cspace"):
            boxes = seen.do(NAMES, panel)
            count += len(boxes)
            for i, (one, x, y, width, height) in enumerate(boxes):
                for other, u, v, w, h in boxes[:i]:
                    assert x + width <= u or u + w <= x or y + height <= v or v + h <= y, (one, other)
            if panel == "workspace":
                assert seen.do(ON_THE_ARM, boxes) == []
    assert count > 20


def test_names_in_the_configuration_space_lie_in_the_visible_part(program, show_file):
    page, _ = program.plan("planar_2r", "workbench")
    seen = show_file(page)
    inside = """(boxes) => boxes.map(([text, x, y, width, height]) => { const { cspace } = cplan.panels;
      const own = cplan.world.c_obstacles.filter(({ obstacle }) => cplan.world.obstacles[obstacle].name === text);
      const [u, v] = cspace.value([x + width / 2, y + height / 2]);
      const holds = (points) => points.reduce((odd, [a, b], k) => { const [c, d] = points[(k + 1) % points.length];
        return odd !== ((b > v) !== (d > v) && u < a + ((c - a) * (v - b)) / (d - b)); }, false);
      const turns = [-1, 0, 1].map((n) => 2 * Math.PI * n);
      return own.some(({ contour }) => turns.some((a) => turns.some((b) => holds([...Geometry.pointsOf(contour)].map(([p, q]) => [p + a, q + b]))))); })"""
    boxes = seen.do(NAMES, "cspace")
    assert sorted(name for name, *_ in boxes) == ["board", "bottle", "lamp", "rack", "vice"]
    assert all(seen.do(inside, boxes))
    # Where a part is magnified, names move into it.
    seen.do("cplan.panels.cspace.magnify(4, cplan.panels.cspace.at([0.5, 0.2]))")
    boxes = seen.do(NAMES, "cspace")
    assert boxes and all(seen.do(inside, boxes))
    rect = seen.do("cplan.panels.cspace.rect")
    assert all(rect["x"] <= x and x + width <= rect["x"] + rect["width"] for _, x, _, width, _ in boxes)
    # A hidden C-obstacle has no name.
    seen.do("cplan.panels.cspace.reset()")
    seen.do("() => { cplan.hidden.add('vice'); cplan.refresh(); }")
    assert "vice" not in [name for name, *_ in seen.do(NAMES, "cspace")]


def test_no_number_of_an_axis_is_cut_off(program, show_file):
    page, _ = program.plan("planar_2r_continuous", "torus_open")
    seen = show_file(page)
    ends = seen.do(
        """() => { const ends = []; const prototype = CanvasRenderingContext2D.prototype; const { fillText } = prototype;
             prototype.fillText = function (text, x, y, ...rest) {
               const width = this.measureText(text).width; if (this.textAlign === 'center') ends.push([text, x + width / 2]); fillText.call(this, text, x, y, ...rest); };
             cplan.panels.cspace.dirty = true; cplan.panels.cspace.draw(); prototype.fillText = fillText; return ends; }"""
    )
    assert "180°" in [text for text, _ in ends]
    assert all(right <= seen.do("cplan.panels.cspace.size[0]") for _, right in ends)
