// The right panel: the configuration space, with the planner's trace.
'use strict';

const CSpace = (() => {
  const { TURN, wrap } = Geometry;

  /** With more obstacles than this, the crowd is drawn in a simpler style. */
  const CROWD = 100;
  /** Cells narrower than this have finer sides, in pixels. */
  const NARROW = 5;
  /** Opacity that is indistinguishable from 1, for drawings on a layer of their own. */
  const ALMOST_OPAQUE = 0.999;

  function bounds(flat) {
    let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
    for (let i = 0; i + 1 < flat.length; i += 2) {
      const [x, y] = [flat[i], flat[i + 1]];
      if (x < x0) x0 = x;
      if (x > x1) x1 = x;
      if (y < y0) y0 = y;
      if (y > y1) y1 = y;
    }
    return [[x0, x1], [y0, y1]];
  }

  /** Returns shifts by whole turns that bring a part of a shape into view, along axes that repeat. */
  function shifts(panel, flat, repeats) {
    const box = bounds(flat);
    const along = (k) => {
      const [low, high] = panel.shown[k];
      if (!repeats[k]) return box[k][0] <= high && box[k][1] >= low ? [0] : [];
      const found = [];
      const first = Math.ceil((low - box[k][1]) / TURN - 1e-9);
      for (let n = first; box[k][0] + n * TURN <= high && found.length < 64; n += 1) found.push(n * TURN);
      return found;
    };
    const up = along(1);
    return along(0).flatMap((a) => up.map((b) => [a, b]));
  }

  function shifted(context, panel, flat, repeats, closed) {
    for (const by of shifts(panel, flat, repeats)) trace(context, panel, flat, closed, by);
  }

  /**
   * Returns for each joint whether it is revolute. A static shape then repeats after each turn, whether or not the
   * joint has limits.
   */
  const turning = (view) => view.model.arm.joints.map((joint) => joint.sign !== undefined);
  const circles = (view) => view.model.arm.joints.map((joint) => joint.circle);

  function cObstacles(context, panel, view, world) {
    const repeats = turning(view);
    // In a crowd, all shapes of one colour are drawn at once, with hairlines as outlines. Browsers do that in a
    // fraction of the time.
    const isCrowd = world.obstacles.length > CROWD;
    const groups = new Map();
    for (const { obstacle, contour } of world.c_obstacles) {
      const { name, color } = world.obstacles[obstacle];
      if (view.hidden.has(name)) continue;
      const key = isCrowd ? color : obstacle;
      if (!groups.has(key)) groups.set(key, { color, contours: [] });
      groups.get(key).contours.push(contour);
    }
    for (const { color, contours } of groups.values()) {
      const { fill, line: edge } = panel.theme.obstacle(color);
      context.beginPath();
      for (const contour of contours) shifted(context, panel, contour, repeats, true);
      context.lineWidth = isCrowd ? 1 : 2;
      context.strokeStyle = edge;
      context.stroke();
      context.fillStyle = fill;
      context.fill();
    }
  }

  /** Draws the C-obstacles of moving obstacles at the time of the motion. */
  function inTime(context, panel, view, world) {
    if (!world.moments || !view.shows('c-obstacles')) return;
    const next = world.moments.findIndex(({ time }) => time > view.now);
    const moment = world.moments[next < 0 ? world.moments.length - 1 : Math.max(0, next - 1)];
    for (const { obstacle, contour } of moment.c_obstacles) {
      const { name, color } = world.movers[obstacle];
      if (view.hidden.has(name)) continue;
      const { fill, line: edge } = panel.theme.obstacle(color);
      context.beginPath();
      shifted(context, panel, contour, turning(view), true);
      context.lineWidth = 2;
      context.strokeStyle = edge;
      context.stroke();
      context.globalAlpha = 0.7;
      context.fillStyle = fill;
      context.fill();
      context.globalAlpha = 1;
    }
    if (view.shows('names')) names(context, panel, view, (obstacle) => world.movers[obstacle].name, byObstacle(view, moment.c_obstacles, world.movers));
  }

  function rectangles(context, panel, boxes, least = 0) {
    for (let i = 0; i + 3 < boxes.length; i += 4) {
      const [x0, y1] = panel.at([boxes[i], boxes[i + 1]]);
      const [x1, y0] = panel.at([boxes[i + 2], boxes[i + 3]]);
      if (x1 - x0 >= least && y1 - y0 >= least) context.rect(x0, y0, x1 - x0, y1 - y0);
    }
  }

  function surfaces(context, panel, boxes, color) {
    context.beginPath();
    rectangles(context, panel, boxes);
    context.fillStyle = color;
    context.fill();
  }

  const LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/';

  function wavefront(context, panel, { blocks, extent, levels }) {
    const [nx, ny] = blocks;
    const raster = document.createElement('canvas');
    [raster.width, raster.height] = [nx, ny];
    const pixels = new ImageData(nx, ny);
    const palette = [...LETTERS].map((_, k) => {
      const color = Theme.mixed(panel.theme.scale(k / 63), panel.theme.paper, 0.25);
      return [0, 1, 2].map((c) => parseInt(color.slice(1 + 2 * c, 3 + 2 * c), 16));
    });
    for (let k = 0; k < levels.length; k += 1) {
      const level = LETTERS.indexOf(levels[k]);
      if (level < 0) continue;
      const at = 4 * ((ny - 1 - (k % ny)) * nx + Math.floor(k / ny));
      pixels.data.set([...palette[level], 255], at);
    }
    raster.getContext('2d').putImageData(pixels, 0, 0);
    const far = panel.whole.map(([low, high], k) => low + (high - low) * extent[k]);
    const [[x0, y0], [x1, y1]] = [panel.at([panel.whole[0][0], far[1]]), panel.at([far[0], panel.whole[1][0]])];
    context.imageSmoothingEnabled = false;
    context.drawImage(raster, x0, y0, x1 - x0, y1 - y0);
  }

  function below(context, panel, view, seen) {
    const { theme } = panel;
    if (seen.kind === 'wavefront' && view.shows('wavefront')) wavefront(context, panel, seen);
    if (seen.kind === 'boxes' && view.shows('boxes')) {
      surfaces(context, panel, seen.free, theme.free);
      surfaces(context, panel, seen.mixed, theme.undecided);
      if (seen.rest) surfaces(context, panel, seen.rest, theme.undecided);
    }
    if (seen.kind === 'channel' && view.shows('channel')) {
      context.beginPath();
      for (const i of seen.channel) if (seen.cells[i]) shifted(context, panel, seen.cells[i], circles(view), true);
      context.globalAlpha = 0.75;
      context.fillStyle = theme.channel;
      context.fill();
      context.globalAlpha = 1;
    }
  }

  /** Draws the slices of a round of the lower bound; those that are new in it stand out. */
  function slices(context, panel, { slices: all, before }) {
    const { theme, rect } = panel;
    const known = new Set(before);
    for (const isNew of [false, true]) {
      context.beginPath();
      for (const value of all.filter((one) => known.has(one) !== isNew)) {
        const [x] = panel.at([value, 0]);
        if (x < rect.x || x > rect.x + rect.width) continue;
        context.moveTo(x, rect.y);
        context.lineTo(x, rect.y + rect.height);
      }
      [context.globalAlpha, context.lineWidth, context.strokeStyle] = isNew ? [0.8, 1.2, theme.accent] : [0.5, 0.8, theme.grey];
      context.stroke();
    }
    [context.globalAlpha, context.lineWidth, context.strokeStyle] = [0.75, 0.8, theme.edge];
  }

  function above(context, panel, view, seen) {
    const { theme } = panel;
    context.strokeStyle = theme.edge;
    context.lineWidth = 0.8;
    context.globalAlpha = 0.75;
    if (['roadmap', 'roads'].includes(seen.kind) && view.shows(seen.kind)) {
      context.beginPath();
      for (let i = 0; i + 3 < seen.edges.length; i += 4) {
        shifted(context, panel, seen.edges.slice(i, i + 4), circles(view), false);
      }
      context.stroke();
    }
    if (seen.nodes) dots(context, panel, view, seen.nodes);
    if (seen.slices) slices(context, panel, seen);
    if (seen.kind === 'rows' && view.shows('rows')) {
      context.beginPath();
      for (let i = 0; i + 3 < seen.free.length; i += 4) {
        shifted(context, panel, seen.free.slice(i, i + 4), circles(view), false);
      }
      context.stroke();
    }
    if (seen.kind === 'channel' && view.shows('cells')) {
      for (const wide of [false, true]) {
        context.lineWidth = wide ? 0.8 : 0.3;
        context.beginPath();
        for (const cell of seen.cells) if (isWide(panel, cell) === wide) shifted(context, panel, cell, circles(view), true);
        context.stroke();
      }
      context.lineWidth = 0.8;
    }
    if (seen.kind === 'boxes' && view.shows('boxes')) {
      context.beginPath();
      for (const boxes of [seen.free, seen.stuck, seen.mixed]) rectangles(context, panel, boxes, 2);
      context.lineWidth = 0.5;
      context.stroke();
    }
    context.globalAlpha = 1;
    if (seen.sweep !== undefined) {
      context.lineWidth = 2;
      context.strokeStyle = theme.accent;
      const [x] = panel.at([seen.sweep, 0]);
      line(context, [[x, panel.rect.y], [x, panel.rect.y + panel.rect.height]]);
    }
    if (seen.numbers && view.shows('wavefront')) numbers(context, panel, seen);
    if (seen.expanded && view.shows('expanded')) expanded(context, panel, view, seen.expanded);
    if (seen.kind === 'field') field(context, panel, view, seen);
  }

  /** Draws the number of each cell that a wave reached, if there is room for it. */
  function numbers(context, panel, { blocks, numbers: all }) {
    const [nx, ny] = blocks;
    const [[x0, y0], [x1, y1]] = [panel.at(panel.whole.map((side) => side[0])), panel.at(panel.whole.map((side) => side[1]))];
    const [width, height] = [(x1 - x0) / nx, (y0 - y1) / ny];
    const digits = `${Math.max(...all)}`.length;
    const { text } = panel.theme;
    const size = Math.min(width / (0.6 * digits), 0.75 * height, text);
    if (size < 5) return;
    context.font = panel.theme.font(400, size / text);
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.lineWidth = 2;
    context.strokeStyle = panel.theme.paper;
    context.fillStyle = panel.theme.ink;
    all.forEach((number, k) => {
      if (number < 0) return;
      const at = [x0 + (Math.floor(k / ny) + 0.5) * width, y0 - ((k % ny) + 0.5) * height];
      context.strokeText(number, ...at);
      context.fillText(number, ...at);
    });
  }

  /** Draws centres of the channel's cells (discs), and middles of the portals between them (rings). */
  function channelPoints(context, panel, view, { centers = [], middles = [] }) {
    const { theme } = panel;
    for (const [flat, inside, edge] of [[centers, theme.ink, theme.paper], [middles, theme.paper, theme.ink]]) {
      context.fillStyle = inside;
      context.strokeStyle = edge;
      context.lineWidth = 1;
      for (let i = 0; i + 1 < flat.length; i += 2) {
        const [x, y] = place(view, panel, [flat[i], flat[i + 1]]);
        context.beginPath();
        context.arc(x, y, 3, 0, 2 * Math.PI);
        context.fill();
        context.stroke();
      }
    }
  }

  /** Returns true if a cell is wide. The sides of many narrow cells would make a moire pattern. */
  function isWide(panel, cell) {
    const [[low, high]] = bounds(cell);
    return (high - low) * panel.pixels >= NARROW;
  }

  /** Draws samples: the first ends of edges. */
  function dots(context, panel, view, flat) {
    context.fillStyle = panel.theme.accent;
    for (let i = 0; i + 3 < flat.length; i += 4) {
      for (const by of shifts(panel, flat.slice(i, i + 2), circles(view))) {
        const [x, y] = panel.at([flat[i] + by[0], flat[i + 1] + by[1]]);
        context.fillRect(x - 1.5, y - 1.5, 3, 3);
      }
    }
  }

  /** Draws places that a search expanded; earlier ones are darker. */
  function expanded(context, panel, view, flat) {
    const last = Math.max(flat.length / 2 - 1, 1);
    context.globalAlpha = 0.8;
    for (let i = 0; i + 1 < flat.length; i += 2) {
      context.fillStyle = panel.theme.scale(i / 2 / last);
      for (const by of shifts(panel, flat.slice(i, i + 2), circles(view))) {
        const [x, y] = panel.at([flat[i] + by[0], flat[i + 1] + by[1]]);
        context.beginPath();
        context.arc(x, y, 2.2, 0, 2 * Math.PI);
        context.fill();
      }
    }
    context.globalAlpha = 1;
  }

  function field(context, panel, view, seen) {
    const { theme } = panel;
    if (view.shows('equipotentials')) {
      context.lineWidth = 1.2;
      for (const { part, lines } of seen.levels) {
        context.strokeStyle = theme.scale(part);
        context.beginPath();
        for (const flat of lines) trace(context, panel, flat, false);
        context.stroke();
      }
    }
    if (!view.shows('flow')) return;
    context.strokeStyle = theme.accent;
    context.fillStyle = theme.accent;
    context.lineWidth = 1;
    context.globalAlpha = 0.8;
    for (const flat of seen.flow) {
      context.beginPath();
      trace(context, panel, flat, false);
      context.stroke();
      arrow(context, panel, flat);
    }
    context.globalAlpha = 1;
  }

  /** Draws an arrow head a little after the beginning of a line of steepest ascent. */
  function arrow(context, panel, flat) {
    const at = 2 * Math.min(3, Math.floor(flat.length / 2) - 2);
    if (at < 0) return;
    const [a, b] = [panel.at([flat[at], flat[at + 1]]), panel.at([flat[at + 2], flat[at + 3]])];
    const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
    context.beginPath();
    for (const [r, turn] of [[6, 0], [4, 2.5], [4, -2.5]]) {
      context.lineTo(b[0] + r * Math.cos(angle + turn), b[1] + r * Math.sin(angle + turn));
    }
    context.fill();
  }

  /** Draws the boxes of a proof: hatched, as nothing else is, over a translucent ground. */
  function proof(context, panel, boxes) {
    context.beginPath();
    rectangles(context, panel, boxes);
    context.globalAlpha = 0.45;
    context.fillStyle = panel.theme.paper;
    context.fill();
    context.globalAlpha = 1;
    hatch(context, panel.rect, panel.theme.proof);
    context.beginPath();
    rectangles(context, panel, boxes);
    context.lineWidth = 1.1;
    context.strokeStyle = panel.theme.proof;
    context.stroke();
  }

  function regions(context, panel, view, world) {
    for (const region of world.regions.filter((r) => r.joints)) {
      context.beginPath();
      shifted(context, panel, region.corners, circles(view), true);
      context.setLineDash([7, 4]);
      context.lineWidth = 1.4;
      context.strokeStyle = region.epsilon > 0 ? panel.theme.avoided : panel.theme.preferred;
      context.stroke();
      context.setLineDash([]);
    }
  }

  /** Draws names on the visible parts of the C-obstacles. `contours` are those of the C-obstacles by obstacle, in order. */
  function names(context, panel, view, named, contours) {
    const repeats = turning(view);
    const regions = [...contours].map(([obstacle, own]) => ({
      text: named(obstacle),
      paint: (painter) => {
        painter.beginPath();
        for (const contour of own) shifted(painter, panel, contour, repeats, true);
        painter.fill();
      },
    }));
    Labels.onRegions(context, panel, regions);
  }

  /** Returns the contours of the visible C-obstacles by obstacle. `obstacles` are the shapes that the contours belong to. */
  function byObstacle(view, all, obstacles) {
    const groups = new Map();
    for (const { obstacle, contour } of all) {
      if (view.hidden.has(obstacles[obstacle].name)) continue;
      if (!groups.has(obstacle)) groups.set(obstacle, []);
      groups.get(obstacle).push(contour);
    }
    return groups;
  }

  /** Draws everything that stays while the arm moves. */
  function still(context, panel, view) {
    const { world } = view;
    const seen = Think.seen(view, view.trace);
    if (seen) below(context, panel, view, seen);
    if (view.model.reach && view.shows('access')) ReachMap.drawSolutions(context, panel, view, view.model.reach);
    if (view.shows('c-obstacles')) cObstacles(context, panel, view, world);
    if (seen) above(context, panel, view, seen);
    if (view.shows('regions')) regions(context, panel, view, world);
    if (view.shows('proof') && world.proof.length) proof(context, panel, Think.firstItems(world.proof, 4, Think.part(view, 'proof')));
    if (view.shows('path')) {
      for (const path of Think.paths(view, view.pathsHere())) pathOf(context, panel, view, path);
    }
    view.followed?.inCSpace(context, panel, (flat) => shifted(context, panel, flat, circles(view), false));
    if (seen?.kind === 'channel' && view.shows('channel')) channelPoints(context, panel, view, seen);
    if (view.model.checked?.nearest_free) ring(context, panel, place(view, panel, view.model.checked.nearest_free), 5, panel.theme.grey);
    if (view.isStuckHere && view.model.stuck.at) cross(context, panel.theme, place(view, panel, view.model.stuck.at[0]));
    if (view.isPlain) Labels.blockSpot(panel, place(view, panel, view.beginning()), 10);
    else ends(context, panel, view);
    if (view.isTask && !view.isPlain) {
      const ends = view.pathsWithNames().map((path) => [`step ${path.step}`, Labels.spotted(place(view, panel, path.points.slice(-2)), 7)]);
      Labels.beside(context, panel, ends);
    }
    view.followed?.names(context, panel);
    obstacleNames(context, panel, view, world);
  }

  /** Draws the start and the goals. Names avoid them. */
  function ends(context, panel, view) {
    goalLines(context, panel, view);
    view.goals().forEach(([q, reached]) => diamond(context, panel, place(view, panel, q), reached, view.followed ? 0.65 : 1));
    if (view.followed?.motion ?? true) ring(context, panel, place(view, panel, view.beginning()), view.followed ? 4.5 : 7);
    for (const spot of markers(panel, view)) Labels.blockSpot(panel, spot, 10);
  }

  /** Draws only the outlines of the C-obstacles. */
  function outlines(context, panel, view, world) {
    for (const [obstacle, contours] of byObstacle(view, world.c_obstacles, world.obstacles)) {
      // On a layer of its own, because lines within a C-obstacle of several pieces are removed.
      panel.faded(context, ALMOST_OPAQUE, (layer) => {
        layer.beginPath();
        for (const contour of contours) shifted(layer, panel, contour, turning(view), true);
        layer.lineWidth = 3;
        layer.strokeStyle = panel.theme.obstacle(world.obstacles[obstacle].color).line;
        layer.stroke();
        layer.globalCompositeOperation = 'destination-out';
        layer.fill();
        layer.globalCompositeOperation = 'source-over';
      });
    }
  }

  /** Draws the names of the C-obstacles. */
  function obstacleNames(context, panel, view, world) {
    if (!view.shows('names') || !view.shows('c-obstacles') || view.isCrowded) return;
    names(context, panel, view, (obstacle) => view.called(obstacle), byObstacle(view, world.c_obstacles, world.obstacles));
  }

  /** Draws a path, on circles also its parts beyond a turn. Names dodge it. */
  function pathOf(context, panel, view, path) {
    pathLine(context, panel.theme, path, () => {
      context.beginPath();
      shifted(context, panel, path.points, circles(view), false);
      context.stroke();
    });
    for (const by of shifts(panel, path.points, circles(view))) {
      Labels.blockLine(panel, [...Geometry.pointsOf(path.points)].map((q) => panel.at([q[0] + by[0], q[1] + by[1]])));
    }
  }

  /** Draws goals with a free joint: dots along a line. */
  function goalLines(context, panel, view) {
    for (const [width, color] of [[4.6, panel.theme.paper], [2, panel.theme.ink]]) {
      context.beginPath();
      for (const line of view.model.goal_lines) shifted(context, panel, line, circles(view), false);
      context.setLineDash(width > 2 ? [] : [1.5, 3.5]);
      context.lineWidth = width;
      context.strokeStyle = color;
      context.stroke();
    }
    context.setLineDash([]);
  }

  function place(view, panel, q) {
    return panel.at(q.map((value, k) => wrap(view.model.arm.joints[k], value)));
  }

  /** Returns the configurations with markers: start, goals, and where the arm gets stuck. */
  const markers = (panel, view) => [view.beginning(), ...view.goals().map(([q]) => q), ...((view.isStuckHere && view.model.stuck.at?.slice(0, 1)) || [])].map((q) => place(view, panel, q));

  function ring(context, panel, [x, y], r, color = panel.theme.ink) {
    context.beginPath();
    context.arc(x, y, r, 0, 2 * Math.PI);
    context.fillStyle = panel.theme.paper;
    context.fill();
    context.lineWidth = 2.2;
    context.strokeStyle = color;
    context.stroke();
  }

  function diamond(context, panel, [x, y], reached, size = 1) {
    for (const [r, color] of [[10, panel.theme.paper], [7.5, panel.theme.ink], [reached ? 0 : 5, panel.theme.paper]]) {
      context.beginPath();
      for (const [dx, dy] of [[0, -r * size], [r * size, 0], [0, r * size], [-r * size, 0]]) context.lineTo(x + dx, y + dy);
      context.fillStyle = color;
      context.fill();
    }
  }

  /** Draws everything that moves: the arm's configuration, and the one that the user examines. */
  function moving(context, panel, view) {
    const { theme } = panel;
    const time = view.world.moments ? Numbers.seconds(view.now) : null;
    // Names avoid the stamp, which lies over the C-obstacles.
    if (time) panel.blocked.boxes.push(stampBox(context, panel, time));
    inTime(context, panel, view, view.world);
    view.reachMap?.inCSpace(context, panel);
    if (time) stamp(context, panel, time);
    view.followed?.movingInCSpace(context, panel);
    const [x, y] = place(view, panel, view.q);
    context.beginPath();
    context.arc(x, y, 4.8, 0, 2 * Math.PI);
    context.fillStyle = theme.accent;
    context.fill();
    context.lineWidth = 1.2;
    context.strokeStyle = theme.paper;
    context.stroke();
    if (!view.probe) return;
    const [px, py] = panel.at(view.probe.q);
    const hit = view.probe.contacts[0]?.distance <= 0;
    const { rect } = panel;
    context.setLineDash([3, 3]);
    context.lineWidth = 1;
    context.strokeStyle = hit ? theme.infeasible : theme.found;
    line(context, [[px, rect.y], [px, rect.y + rect.height]]);
    line(context, [[rect.x, py], [rect.x + rect.width, py]]);
    context.setLineDash([]);
    context.lineWidth = 2.4;
    line(context, [[px - 7, py], [px + 7, py]]);
    line(context, [[px, py - 7], [px, py + 7]]);
  }

  /**
   * Returns the place of the stamp: a corner of the panel.
   * @returns {Rect}
   */
  function stampBox(context, { rect, theme, zoom }, text) {
    context.font = theme.font(600);
    const [width, height] = [context.measureText(text).width + 12 * zoom, 22 * zoom];
    return { x: rect.x + rect.width - width - 6, y: rect.y + 6, width, height };
  }

  /** Writes the time for which the C-obstacles of moving obstacles are drawn. */
  function stamp(context, panel, text) {
    const { theme } = panel;
    const { x, y, width, height } = stampBox(context, panel, text);
    context.fillStyle = theme.paper;
    context.strokeStyle = theme.grey;
    context.lineWidth = 1;
    context.beginPath();
    context.roundRect(x, y, width, height, 4);
    context.fill();
    context.stroke();
    context.fillStyle = theme.ink;
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.fillText(text, x + width / 2, y + height / 2);
  }

  /** Draws the scale of colours, to the right of the panel. */
  function beside(context, panel, view) {
    const { scale, trace: seen } = view;
    if (!scale || !view.shows(seen.kind === 'field' ? 'equipotentials' : seen.kind)) return;
    const { rect, theme } = panel;
    const height = Math.min(200, rect.height);
    const [x, y] = [rect.x + rect.width + 14, rect.y + rect.height - height];
    for (let k = 0; k < height; k += 1) {
      const color = theme.scale(1 - k / (height - 1));
      context.fillStyle = scale.soft ? Theme.mixed(color, theme.paper, 0.25) : color;
      context.fillRect(x, y + k, 12, 1.5);
    }
    context.font = theme.font();
    context.fillStyle = theme.grey;
    context.textAlign = 'left';
    context.textBaseline = 'middle';
    scale.ends.forEach((end, k) => context.fillText(end, x + 17, y + (k ? height - 5 : 5)));
    context.save();
    context.translate(x + 25, y + height / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = 'center';
    context.fillStyle = theme.ink;
    context.fillText(scale.title, 0, 0);
    context.restore();
  }

  return { still, moving, beside, place, path: pathOf, outlines, obstacleNames, ends };
})();
