"""Names in the pages of all shipped worlds: each lies within its shape, touches it, or has a line that ends on it."""

import pytest
from conftest import ROOT

DESK = {"width": 1400, "height": 1000}
PHONE = {"width": 390, "height": 844}

# Draws a panel, and returns its names, each with the distances in pixels from its shape: of its box, and of the end of its
# line. Shapes are those of the model; the name's box and line are what the panel has drawn.
DRAWN = """
(name) => {
  const [view, panel] = [cplan, cplan.panels[name]];
  const { world, model } = view;
  const [texts, lines, points] = [[], [], []];
  const prototype = CanvasRenderingContext2D.prototype;
  const { fillText, beginPath, moveTo, lineTo, stroke } = prototype;
  prototype.beginPath = function () { points.length = 0; beginPath.call(this); };
  prototype.moveTo = function (x, y) { points.push([x, y]); moveTo.call(this, x, y); };
  prototype.lineTo = function (x, y) { points.push([x, y]); lineTo.call(this, x, y); };
  prototype.stroke = function (...rest) {
    if (points.length === 2 && this.lineWidth === 1 && !this.getLineDash().length) lines.push([...points]);
    stroke.apply(this, rest);
  };
  prototype.fillText = function (text, x, y) {
    if (this.font.includes('600')) {
      const [width, height] = [this.measureText(text).width + 6 * panel.zoom, 15 * panel.zoom];
      texts.push({ text, x: x - width / 2, y: y - height / 2, width, height });
    }
    fillText.call(this, text, x, y);
  };
  panel.dirty = true;
  panel.draw();
  Object.assign(prototype, { fillText, beginPath, moveTo, lineTo, stroke });



  const back = (spot) => panel.value(spot);
  const arms = (all) => all.flatMap((q) => Geometry.armShapes(model.arm, world.payload, q));
  const own = (all) => all.flatMap(({ pieces, own }) => pieces.slice(0, own));

  /** Returns the shapes of a name in the workspace. */
  const shapes = (text) => {
    if (text === 'start' && !view.isTask) return arms([view.beginning()]);
    if (text === 'goal' && !view.isTask) return arms(view.ends());
    const step = /^step (.*)$/.exec(text);
    if (step) return arms(model.paths.filter((path) => String(path.step) === step[1]).map(({ points }) => points.slice(-2)));
    const many = /^\\d+ \\u00d7 (.*)$/.exec(text);
    const moved = (world.movers ?? []).map((mover) => Geometry.moved(mover, view.now)).filter(({ name }) => name === text);
    const all = world.obstacles.filter((one, k) => (many ? one.name.startsWith(many[1]) : [view.called(k), one.name].includes(text)));
    return [...own(all), ...own(moved)];
  };
  const workspace = (text) => {
    const all = shapes(text);
    if (!all.length) return null;
    return (spot) => panel.pixels * Math.min(...all.map((shape) => Geometry.separation({ core: back(spot), radius: 0 }, shape)));
  };

  /** Returns the regions of a name in the configuration space: the winding number of its contours, also a turn away. */
  const winding = (contour, [px, py]) => {
    let count = 0;
    for (let i = 0; i < contour.length; i += 2) {
      const [x, y] = [contour[i], contour[i + 1]];
      const k = (i + 2) % contour.length;
      const [u, v] = [contour[k], contour[k + 1]];
      if ((y <= py) !== (v <= py) && px < x + ((u - x) * (py - y)) / (v - y)) count += v > y ? 1 : -1;
    }
    return count;
  };
  const turns = model.arm.joints.map(({ sign }) => (sign ? [-2, -1, 0, 1, 2].map((k) => 2 * Math.PI * k) : [0]));
  const isIn = (obstacle, spot) => {
    const [a, b] = back(spot);
    let count = 0;
    for (const { contour } of world.c_obstacles.filter((one) => one.obstacle === obstacle)) {
      for (const i of turns[0]) for (const j of turns[1]) count += winding(contour, [a + i, b + j]);
    }
    return count !== 0;
  };
  const cspace = (text) => {
    const named = world.obstacles.flatMap((one, k) => ([view.called(k), one.name].includes(text) ? [k] : []));
    if (!named.length) return null;
    return ([x, y]) => {
      for (let r = 0; r <= 8; r += 1) for (let k = 0; k < 16; k += 1) {
        const spot = [x + r * Math.cos((k * Math.PI) / 8), y + r * Math.sin((k * Math.PI) / 8)];
        if (named.some((obstacle) => isIn(obstacle, spot))) return r;
      }
      return Infinity;
    };
  };

  return texts.flatMap((box) => {
    const distance = (name === 'workspace' ? workspace : cspace)(box.text);
    if (!distance) return [];
    const spots = [];
    for (let i = 0; i <= 12; i += 1) for (let j = 0; j <= 4; j += 1) spots.push([box.x + (box.width * i) / 12, box.y + (box.height * j) / 4]);
    const isOn = ([x, y]) => x >= box.x - 1 && x <= box.x + box.width + 1 && y >= box.y - 1 && y <= box.y + box.height + 1;
    const ends = lines.filter(([from]) => isOn(from)).map(([, to]) => distance(to));
    return [{ text: box.text, beside: Math.min(...spots.map(distance)), end: ends.length ? Math.min(...ends) : null }];
  });
}
"""


def worlds(folder):
    """Returns the shipped worlds of a folder, each with its robot."""
    for path in sorted((ROOT / folder).glob("*.toml")):
        robot = next((line.split(":")[1].strip() for line in path.read_text().splitlines() if line.startswith("# robot:")), None)
        if robot:
            yield ROOT / f"robots/{robot}.urdf", path


@pytest.mark.parametrize(("folder", "command", "least"), [("workspaces", [], 300), ("workspaces/tasks", [], 100), ("workspaces/moving", [], 40), ("workspaces/explore", ["explore"], 20)])
def test_names_are_at_their_shapes(program, show, folder, command, least):
    seen = show("about:blank")
    count, wrong = 0, []
    for robot, world in worlds(folder):
        page = program.folder / "names.html"
        page.unlink(missing_ok=True)
        program.attempt(*command, robot, world, "--quiet", "--picture", page)
        if not page.exists():
            continue
        for size in (DESK, PHONE):
            seen.page.set_viewport_size(size)
            seen.page.goto(page.as_uri())
            seen.do("document.fonts.ready.then(() => new Promise(requestAnimationFrame)).then(() => true)")
            for panel in ("workspace", "cspace"):
                for name in seen.do(DRAWN, panel):
                    # The samples of a name and of the places around are some pixels apart.
                    if name["beside"] > 7 and (name["end"] is None or name["end"] > 2):
                        wrong.append(f"{world.name}, {panel}, {size['width']} px: {name}")
                    count += 1
    assert not wrong, "\n".join(wrong)
    assert count >= least, f"{folder}: {count} names"
