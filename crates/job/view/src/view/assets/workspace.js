// The left panel: obstacles, the arm, and the path of its tip.
'use strict';

const Workspace = (() => {
  const { poses, tipAt, elbowAt, payloadPose, placed, pointsOf } = Geometry;

  /** Length of a straight piece of a tip's path, as a fraction of a turn. */
  const FINE = 0.0125;
  /** Opacity of the region that a moving obstacle sweeps, and the number of places from which the region is made. */
  const [SWEPT_OPACITY, SWEPT_PLACES] = [0.22, 120];
  /** Half the width of a joint's disc, in pixels. */
  const JOINT = 5.5;
  /** Length of the axes of joint frames, in pixels. */
  const AXIS = 46;

  function outline(context, panel, obstacle) {
    context.beginPath();
    const { polygon, circle, polyline } = obstacle.outline;
    if (polygon) trace(context, panel, polygon, true);
    else if (polyline) trace(context, panel, polyline, false);
    else if (circle) rounded(context, panel, { core: circle.slice(0, 2), radius: Math.max(circle[2], 1 / panel.pixels) });
    else for (const piece of obstacle.pieces.slice(0, obstacle.own)) rounded(context, panel, piece);
  }

  function obstacles(context, panel, view, world) {
    solids(context, panel, view, world.obstacles);
  }

  /** Draws only the outlines of the obstacles. */
  function outlines(context, panel, view, world) {
    for (const obstacle of world.obstacles.filter(({ name }) => !view.hidden.has(name))) {
      outline(context, panel, obstacle);
      context.lineWidth = obstacle.outline.polyline ? 3 : 1.6;
      context.strokeStyle = panel.theme.obstacle(obstacle.color).line;
      context.stroke();
    }
  }

  /** Draws moving obstacles at their current poses. */
  function movers(context, panel, view, world) {
    solids(context, panel, view, (world.movers ?? []).map((mover) => Geometry.moved(mover, view.now)));
  }

  /** Draws the regions that moving obstacles sweep during the arm's motion, their trajectories, and their stops. */
  function courses(context, panel, view, world) {
    for (const mover of (world.movers ?? []).filter(({ name }) => !view.hidden.has(name))) {
      const duration = Math.min(view.motionDuration, mover.until ?? Infinity);
      const moments = [0, ...mover.stops.map(([time]) => time).filter((time) => 0 < time && time < duration), duration];
      const places = moments.map((time) => Geometry.moved(mover, time));
      panel.faded(context, SWEPT_OPACITY, (layer) => {
        layer.fillStyle = panel.theme.obstacle(mover.color).fill;
        for (let k = 0; k <= SWEPT_PLACES; k += 1) {
          outline(layer, panel, Geometry.moved(mover, (duration * k) / SWEPT_PLACES));
          layer.fill();
        }
      });
      const origin = { outline: { circle: [0, 0, 0] }, pieces: [], stops: mover.stops, velocity: mover.velocity };
      context.lineWidth = 1;
      context.strokeStyle = panel.theme.grey;
      context.setLineDash([5, 3]);
      line(context, moments.map((time) => panel.at(Geometry.moved(origin, time).outline.circle)));
      context.setLineDash([]);
      for (const place of places.slice(1)) {
        outline(context, panel, place);
        dashed(context, [5, 3], 1.2, panel.theme.obstacle(mover.color).line);
      }
    }
  }

  function solids(context, panel, view, all) {
    const { theme } = panel;
    all.forEach((obstacle) => {
      if (view.hidden.has(obstacle.name)) return;
      const { fill, line: edge } = view.isIrrelevant(obstacle) ? { fill: theme.faint, line: theme.pale } : theme.obstacle(obstacle.color);
      outline(context, panel, obstacle);
      context.fillStyle = fill;
      context.strokeStyle = edge;
      context.lineWidth = obstacle.outline.polyline ? 3 : 1.4;
      if (obstacle.outline.polyline) context.stroke();
      else {
        // Sides between pieces are not part of the outline.
        context.stroke();
        context.fill();
      }
    });
  }

  /** Draws the names of the arm's poses and of the obstacles, above the arm. */
  function names(context, panel, view, world) {
    const shown = [];
    const { arm: model } = view.model;
    const beyond = (text, q) => {
      const box = Labels.beyond(context, panel, text, panel.at(tipAt(model, q)), panel.at(elbowAt(model, q)));
      return [text, Labels.shaped(panel, box, Geometry.armShapes(model, world.payload, q))];
    };
    if (view.isTask && !view.isPlain) {
      for (const path of view.pathsWithNames()) shown.push(beyond(`step ${path.step}`, path.points.slice(-2)));
    } else if (view.shows('poses') && view.isMotion) {
      for (const q of view.ends()) shown.push(beyond('goal', q));
      shown.push(beyond('start', view.beginning()));
    }
    if (!view.isCrowded) {
      const current = view.isTask && Steps.objects(view.model)[view.model.motions.indexOf(view.motion)]?.object;
      const written = view.isTask ? families(panel, world.obstacles.filter(({ name }) => !view.hidden.has(name)), (name) => name === current) : null;
      if (written) shown.push(...written);
      world.obstacles.forEach((obstacle, index) => {
        if (obstacle.own === 0 || view.hidden.has(obstacle.name)) return;
        if (!written) shown.push([view.called(index), named(panel, obstacle)]);
        const wall = obstacle.outline.polyline;
        if (wall) Labels.blockLine(panel, [...pointsOf(wall)].map((p) => panel.at(p)));
      });
      for (const mover of (world.movers ?? []).filter(({ name }) => !view.hidden.has(name))) {
        shown.push([mover.name, { ...named(panel, Geometry.moved(mover, view.now)), moves: true }]);
      }
    }
    if (view.shows('frames')) for (const { name, at } of view.model.frames) shown.push([name, Labels.spotted(panel.at(at), 10)]);
    Labels.beside(context, panel, shown);
  }

  /** Distance between objects of one kind up to which they share a name, in pixels. */
  const NEIGHBORS = 44;

  /**
   * Returns the names in a task, each with its shape: objects whose names differ only in a number at the end, and that lie
   * side by side, share one name with their count. `isAlone` returns true for objects with names of their own.
   */
  function families(panel, obstacles, isAlone) {
    const kind = (name) => name.replace(/[\s_-]*\d+(\s*,\s*\d+)*$/u, '') || name;
    const groups = [];
    for (const obstacle of obstacles) {
      if (obstacle.own === 0) continue;
      const own = box(panel, obstacle);
      if (!groups.length || isAlone(obstacle.name)) {
        groups.push({ name: obstacle.name, kind: obstacle.name, members: [obstacle], box: own });
        continue;
      }
      const isNear = ({ box: at }) => at.x - NEIGHBORS < own.x + own.width && own.x < at.x + at.width + NEIGHBORS && at.y - NEIGHBORS < own.y + own.height && own.y < at.y + at.height + NEIGHBORS;
      const group = groups.find((one) => one.kind === kind(obstacle.name) && isNear(one));
      if (!group) {
        groups.push({ name: obstacle.name, kind: kind(obstacle.name), members: [obstacle], box: own });
        continue;
      }
      const [right, bottom] = [Math.max(group.box.x + group.box.width, own.x + own.width), Math.max(group.box.y + group.box.height, own.y + own.height)];
      const [x, y] = [Math.min(group.box.x, own.x), Math.min(group.box.y, own.y)];
      group.members.push(obstacle);
      Object.assign(group, { box: { x, y, width: right - x, height: bottom - y } });
    }
    return groups.map(({ name, kind: shared, members, box: at }) => [
      members.length > 1 ? `${members.length} \u00d7 ${shared}` : name,
      Labels.shaped(panel, at, members.flatMap(({ pieces, own }) => pieces.slice(0, own))),
    ]);
  }

  /** Draws where a task puts its objects, as dashed outlines. */
  function destinations(context, panel, view) {
    for (const place of view.model.places ?? []) {
      if (view.hidden.has(place.name)) continue;
      outline(context, panel, place);
      dashed(context, [4, 3], 1.5, panel.theme.obstacle(place.color).line);
    }
  }

  /** Returns an obstacle as a shape with a name. */
  const named = (panel, obstacle) => Labels.shaped(panel, box(panel, obstacle), obstacle.pieces.slice(0, obstacle.own));

  /**
   * Returns the box that the name of an obstacle refers to, in pixels: of the whole shape, or in the middle of a wall's
   * longest piece.
   */
  function box(panel, { outline: { polyline }, pieces, own }) {
    if (polyline) {
      const points = [...pointsOf(polyline)];
      const sides = points.slice(1).map((b, i) => [points[i], b]);
      /** @param {Point[]} side */
      const length = ([a, b]) => Math.hypot(b[0] - a[0], b[1] - a[1]);
      const [a, b] = sides.reduce((best, side) => (length(side) > length(best) ? side : best));
      return Labels.about(panel.at([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]), 1.5);
    }
    let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
    for (const { core, radius } of pieces.slice(0, own)) {
      for (const [x, y] of pointsOf(core)) {
        [x0, x1, y0, y1] = [Math.min(x0, x - radius), Math.max(x1, x + radius), Math.min(y0, y - radius), Math.max(y1, y + radius)];
      }
    }
    const [[left, top], [right, bottom]] = [panel.at([x0, y1]), panel.at([x1, y0])];
    return { x: left, y: top, width: right - left, height: bottom - top };
  }

  /** Returns the index of the obstacle at a place, or `null`. */
  function found(view, place) {
    const point = { core: place, radius: 0 };
    const holds = ({ name, pieces, own }) => !view.hidden.has(name) && pieces.slice(0, own).some((piece) => Geometry.separation(point, piece) <= 0);
    const index = view.world.obstacles.findLastIndex(holds);
    return index < 0 ? null : index;
  }

  /**
   * Draws the arm at q. `look`: fill, line, width, alpha, whether joints are shown, whether names avoid it, and colours
   * of links that touch.
   */
  function arm(context, panel, view, world, q, look) {
    panel.faded(context, look.alpha ?? 1, (layer) => solid(layer, panel, view, world, q, look));
  }

  function solid(context, panel, view, world, q, look) {
    const model = view.model.arm;
    const at = poses(model, q);
    model.links.forEach((link, k) => {
      context.beginPath();
      for (const part of link.parts) {
        const shape = placed(part, at[k]);
        rounded(context, panel, shape);
        if (look.blocks) Labels.blockShape(panel, shape);
      }
      context.lineWidth = 2 * look.width;
      context.strokeStyle = look.line;
      context.stroke();
      context.fillStyle = look.touching?.has(k) ? look.touch : look.fill;
      context.fill();
    });
    if (look.joints) skeleton(context, panel, model, q, look.line);
    // The shapes of a link may leave its joint bare.
    if (look.joints && look.blocks) for (const joint of [model.base, elbowAt(model, q)]) Labels.blockSpot(panel, panel.at(joint), JOINT);
    // Above the arm, which would cover small objects.
    if (world.payload) {
      const pose = payloadPose(model, world.payload, q, look.turned);
      const { fill, line: edge } = panel.theme.obstacle(world.payload.color);
      context.beginPath();
      for (const piece of world.payload.pieces) {
        rounded(context, panel, placed(piece, pose));
        if (look.blocks) Labels.blockShape(panel, placed(piece, pose));
      }
      context.strokeStyle = edge;
      context.stroke();
      context.fillStyle = look.touching?.has('payload') ? look.touch : fill;
      context.fill();
    }
  }

  function skeleton(context, panel, model, q, color) {
    const [base, elbow, tip] = [model.base, elbowAt(model, q), tipAt(model, q)].map((p) => panel.at(p));
    context.lineWidth = 1;
    context.strokeStyle = color;
    line(context, [base, elbow, tip]);
    for (const [[x, y], r, filled] of [[base, 5, true], [elbow, 3.5, true], [tip, 3.5, false]]) {
      context.beginPath();
      context.arc(x, y, r, 0, 2 * Math.PI);
      context.fillStyle = filled ? color : panel.theme.paper;
      context.fill();
      context.lineWidth = 1.5;
      context.stroke();
    }
  }

  /** Returns the tip's path: straight motions in joint space are curves here. */
  function tipTrace(model, flat) {
    const spots = [];
    let before = null;
    for (const q of pointsOf(flat)) {
      const angle = before ? Math.max(...[0, 1].map((k) => (model.joints[k].sign ? Math.abs(q[k] - before[k]) : 0))) : 0;
      const pieces = Math.min(2000, Math.max(1, Math.ceil(angle / FINE)));
      for (let i = 1; before && i <= pieces; i += 1) {
        spots.push(tipAt(model, [0, 1].map((k) => before[k] + ((q[k] - before[k]) * i) / pieces)));
      }
      if (!before) spots.push(tipAt(model, q));
      before = q;
    }
    return spots;
  }

  function traces(context, panel, view) {
    if (view.moment) {
      for (const path of Think.paths(view, view.pathsHere())) {
        const there = tipTrace(view.model.arm, path.points).map((p) => panel.at(p));
        pathLine(context, panel.theme, path, () => line(context, there));
        Labels.blockLine(panel, there);
      }
      return;
    }
    const spots = view.traces ?? (view.traces = view.model.paths.map((path) => tipTrace(view.model.arm, path.points)));
    const draw = (i, path) => {
      const there = spots[i].map((p) => panel.at(p));
      pathLine(context, panel.theme, path, () => line(context, there));
    };
    // Of a task, the path of the next motion is pale, and others are left out.
    const here = new Set(view.pathsHere());
    const next = view.model.paths.indexOf(view.nextPath);
    context.globalAlpha = 0.3;
    if (next >= 0 && !here.has(view.nextPath)) draw(next, view.nextPath);
    context.globalAlpha = 1;
    view.model.paths.forEach((path, i) => {
      if (!here.has(path)) return;
      draw(i, path);
      Labels.blockLine(panel, spots[i].map((p) => panel.at(p)));
    });
  }

  function regions(context, panel, world) {
    for (const region of world.regions.filter((r) => !r.joints)) {
      context.beginPath();
      trace(context, panel, region.corners, true);
      dashed(context, [7, 4], 1.4, region.epsilon > 0 ? panel.theme.avoided : panel.theme.preferred);
    }
  }

  function dashed(context, dash, width, color) {
    context.setLineDash(dash);
    context.lineWidth = width;
    context.strokeStyle = color;
    context.stroke();
    context.setLineDash([]);
  }

  /** Draws the reachable cells, coloured by their kind. */
  function cells(context, panel, { corner, cell, size: [columns], colors: names, cells: all }) {
    const { theme } = panel;
    const colors = names.map((color) => theme.tint(color));
    for (const [place, kind] of [...all].entries()) {
      if (kind === '.') continue;
      const low = [corner[0] + cell * (place % columns), corner[1] + cell * Math.floor(place / columns)];
      const [[left, bottom], [right, top]] = [low, low.map((x) => x + cell)].map((p) => panel.at(p).map(Math.round));
      context.fillStyle = colors[Number(kind)];
      context.fillRect(left, top, right - left, bottom - top);
    }
  }

  /** Draws everything that stays while the arm moves. */
  function still(context, panel, view) {
    const { model, world } = view;
    const { theme } = panel;
    context.beginPath();
    rounded(context, panel, model.arm.reach);
    dashed(context, [2, 4], 1, theme.pale);
    if (model.reach && view.shows('access')) cells(context, panel, model.reach);
    if (view.isTask) destinations(context, panel, view);
    obstacles(context, panel, view, world);
    courses(context, panel, view, world);
    if (view.shows('regions')) regions(context, panel, world);
    if (view.shows('poses')) {
      const shown = view.pathsHere();
      if (shown.length === 1 && !view.light && !view.moment) {
        for (const q of pointsOf(shown[0].ghosts)) {
          arm(context, panel, view, world, q, { fill: theme.ghost, line: theme.grey, width: 0.8, alpha: 0.7 });
        }
      }
      const look = { line: theme.ink, width: 1, alpha: 0.85, joints: true, blocks: true };
      if (view.isMotion) arm(context, panel, view, world, view.beginning(), { ...look, fill: theme.paper });
      for (const q of view.ends()) arm(context, panel, view, world, q, { ...look, fill: theme.pale });
      for (const q of world.unreached) {
        arm(context, panel, view, world, q, { fill: theme.paper, line: theme.infeasible, width: 0.9, alpha: 0.65 });
      }
    }
    const nearestFree = model.checked?.nearest_free;
    if (nearestFree) arm(context, panel, view, world, nearestFree, { fill: theme.ghost, line: theme.grey, width: 1.2, alpha: 0.8, joints: true });
    if (view.isStuckHere) stuck(context, panel, view, model.stuck);
    view.followed?.inWorkspace(context, panel);
    if (view.shows('path') && !view.followed?.motion) traces(context, panel, view);
    if (model.line?.at) cross(context, theme, panel.at(model.line.at));
    if (view.shows('frames')) for (const frame of model.frames) axes(context, panel, frame);
  }

  /** Draws the blocking obstacles of a motion that does not exist, and the arm where it gets stuck. */
  function stuck(context, panel, view, { blockers, at }) {
    const { theme } = panel;
    for (const number of blockers) {
      outline(context, panel, view.world.obstacles[number]);
      dashed(context, [7, 3], 3, theme.infeasible);
    }
    if (!at) return;
    arm(context, panel, view, view.world, at[0], { fill: theme.paper, line: theme.infeasible, width: 0.9, alpha: 0.65 });
    cross(context, theme, panel.at(at[1]));
  }

  /** Draws the shortest line from the arm to the obstacles, with its length. */
  function distance(context, panel, { ends, text }) {
    const { theme } = panel;
    const [from, to] = ends.map((point) => panel.at(point));
    for (const [width, color] of [[5, theme.paper], [2, theme.ink]]) {
      [context.lineWidth, context.strokeStyle, context.fillStyle] = [width, color, color];
      line(context, [from, to]);
      for (const [x, y] of [from, to]) {
        context.beginPath();
        context.arc(x, y, 1 + width / 2, 0, 2 * Math.PI);
        context.fill();
      }
    }
    Labels.blockLine(panel, [from, to]);
    const [x, y] = [Math.min(from[0], to[0]), Math.min(from[1], to[1])];
    const rect = { x, y, width: Math.abs(from[0] - to[0]), height: Math.abs(from[1] - to[1]) };
    Labels.beside(context, panel, [[text, { rect, pieces: Labels.lines([[from, to]]) }]]);
  }

  /** Draws the outline of an obstacle in contact. */
  function struck(context, panel, obstacle) {
    outline(context, panel, obstacle);
    context.lineWidth = 4;
    context.strokeStyle = panel.theme.infeasible;
    context.stroke();
  }

  /** Draws everything that moves: the arm, and the examined one. */
  function moving(context, panel, view) {
    const { theme } = panel;
    movers(context, panel, view, view.world);
    view.reachMap?.inWorkspace(context, panel);
    view.followed?.belowArm(context, panel);
    const { examined } = view;
    // While another arm is examined, this one steps back.
    const alpha = view.probe ? 0.45 : 1;
    const turned = Height.turnedTo(view);
    arm(context, panel, view, view.world, view.q, { turned, fill: theme.paper, line: theme.accent, width: 1.6, alpha, joints: true, blocks: true });
    tool(context, panel, view);
    if (examined) tried(context, panel, view, examined);
    if (view.model.checked?.nearest && !view.probe) distance(context, panel, view.model.checked.nearest);
    view.reachMap?.aboveArm(context, panel);
    view.followed?.aboveArm(context, panel);
    if (view.shows('names')) names(context, panel, view, view.world);
    if (view.hovered) Labels.write(context, theme, ...view.hovered);
  }

  /** Length of the line that shows the direction of the tool, in pixels. */
  const TOOL_LENGTH = 26;

  /** Draws the direction of the tool at the tip, on a line along which a wrist turns it. */
  function tool(context, panel, view) {
    const angle = Height.toolAngle(view);
    if (angle === undefined || view.probe) return;
    const tip = tipAt(view.model.arm, view.q);
    const [from, beside] = [tip, [tip[0] + Math.cos(angle), tip[1] + Math.sin(angle)]].map((p) => panel.at(p));
    const length = Math.hypot(beside[0] - from[0], beside[1] - from[1]) || 1;
    const to = [0, 1].map((k) => from[k] + ((beside[k] - from[k]) * TOOL_LENGTH) / length);
    [context.lineWidth, context.strokeStyle] = [3, panel.theme.accent];
    line(context, [from, to]);
  }

  /** Draws the examined arm, and the obstacles that it touches. */
  function tried(context, panel, view, { contacts, q }) {
    const { theme } = panel;
    const hits = contacts.filter((c) => c.distance <= 0);
    const isMarked = view.marksContacts !== false;
    if (isMarked) for (const { obstacle } of hits) struck(context, panel, view.world.obstacles[obstacle]);
    const touching = new Set(hits.map((c) => (c.carried ? 'payload' : c.link)));
    arm(context, panel, view, view.world, q, {
      fill: theme.free,
      touch: isMarked ? Theme.mixed(theme.infeasible, theme.paper, 0.45) : theme.ghost,
      touching,
      line: !hits.length ? theme.found : isMarked ? theme.infeasible : theme.grey,
      width: 1.6,
      alpha: 0.92,
      joints: true,
      blocks: true,
    });
    for (const { at } of hits) if (at) touchMark(context, panel, at, isMarked ? theme.infeasible : theme.grey);
  }

  /** Marks the place of a contact. */
  function touchMark(context, panel, at, color) {
    const [x, y] = panel.at(at);
    Labels.blockSpot(panel, [x, y]);
    for (const [radius, fill] of [[7, panel.theme.paper], [5, color]]) {
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.fillStyle = fill;
      context.fill();
    }
    context.beginPath();
    context.arc(x, y, 11, 0, 2 * Math.PI);
    context.lineWidth = 2;
    context.strokeStyle = color;
    context.stroke();
  }

  /** Draws the axes of a link's frame. An axis perpendicular to the plane is a dot (towards the viewer) or a cross. */
  function axes(context, panel, frame) {
    const [x, y] = panel.at(frame.at);
    ['x', 'y', 'z'].forEach((letter, k) => {
      const [u, v, w] = frame.axes[k];
      const color = panel.theme.scale(0.25 + 0.3 * k);
      context.strokeStyle = color;
      context.fillStyle = color;
      context.lineWidth = 2.2;
      if (Math.hypot(u, v) < 0.1) {
        context.beginPath();
        context.arc(x, y, 7, 0, 2 * Math.PI);
        context.stroke();
        Labels.write(context, panel.theme, w > 0 ? '\u2022' : '\u00d7', x, y);
        return;
      }
      line(context, [[x, y], [x + AXIS * u, y - AXIS * v]]);
      Labels.write(context, panel.theme, letter, x + (AXIS + 9) * u, y - (AXIS + 9) * v);
    });
  }

  /** Returns the middle of an obstacle's bounding box, in pixels. */
  function middle(panel, obstacle) {
    const { x, y, width, height } = box(panel, { ...obstacle, outline: {} });
    return [x + width / 2, y + height / 2];
  }

  return { still, moving, found, arm, struck, outline, solids, destinations, families, tipTrace, outlines, middle, distance };
})();

/** Draws a path or trace in its colour, over a broad pale line that makes it visible on any ground. */
function pathLine(context, theme, path, stroke) {
  context.lineCap = 'round';
  for (const [color, width, dash] of [[theme.paper, path.width + 2.6, []], [theme.stroke(path.color ?? 'ink'), path.width, path.dash]]) {
    context.strokeStyle = color;
    context.lineWidth = width;
    context.setLineDash(dash);
    stroke();
  }
  context.setLineDash([]);
  context.lineCap = 'butt';
}
