// A line that the tip follows: its path coloured by the limit that the motion reaches, both IK solutions, and the tip's speed and
// distance from the line over time.
'use strict';

class FollowedLine {
  /** Overview of a magnified workspace: its size as a share of the panel, its distance from the sides in pixels, and the magnification from which it appears. */
  static OVERVIEW = [0.3, 8, 1.4];
  /** Least distance of two points of a drawn path, as a share of the workspace. */
  static FINE = 1 / 4000;

  /** @param {View} view */
  constructor(view) {
    this.view = view;
    /** @type {LineModel} */
    this.line = view.model.line;
    this.motion = this.line.motion;
    if (this.motion) {
      this.trace();
      this.build();
    }
    view.followed = this;
    view.layers.show('poses', false);
    if (this.line.focus) this.focus();
    view.recolor();
    view.ready();
  }

  /** Computes the path of the tip and of the joints for each stretch with one limit. */
  trace() {
    const { view: { model }, motion } = this;
    const { clock, arm, frame } = model;
    const fine = FollowedLine.FINE * (frame[0][1] - frame[0][0]);
    let [from, last] = [0, null];
    this.stretches = motion.stretches.map(([to, limit]) => {
      const joints = [];
      const tips = [];
      const times = [from, ...clock.time.filter((time) => from < time && time < to), to];
      times.forEach((time, index) => {
        const q = Geometry.moving(clock, time).position;
        const tip = Geometry.tipAt(arm, q);
        if (index > 0 && index + 1 < times.length && Math.hypot(tip[0] - last[0], tip[1] - last[1]) < fine) return;
        last = tip;
        joints.push(...q);
        tips.push(...tip);
      });
      from = to;
      return { limit, joints, tips };
    });
    this.stops = motion.stops.map((time) => this.tipAt(time));
  }

  /** Magnifies the workspace so that the line fills it. */
  focus() {
    const { workspace } = this.view.panels;
    const { ranges } = this.line.focus;
    const aim = () => {
      workspace.times = 1;
      workspace.layout();
      const shares = ranges.map(([low, high], k) => (workspace.whole[k][1] - workspace.whole[k][0]) / (high - low));
      workspace.times = Math.max(1, Math.min(...shares));
      workspace.middle = ranges.map(([low, high]) => (low + high) / 2);
      workspace.layout();
      workspace.redraw();
    };
    aim();
    // The first layout may come before the panel has a size.
    requestAnimationFrame(aim);
  }

  /** Returns the place of the tip at a time, from the same polynomials between samples as the controller's. */
  tipAt(time, k = Geometry.interval(this.view.model.clock, time)) {
    const { clock, arm } = this.view.model;
    const { position } = Geometry.moving(clock, time, k, this.line.smooth);
    return Geometry.tipAt(arm, position);
  }

  /** Creates the lens and the plots. */
  build() {
    const { view, motion, line: { tolerance } } = this;
    const { clock } = view.model;
    this.lens = new Lens(this);
    const choice = (text, stays) => element('button', { type: 'button', class: 'button', 'aria-pressed': String(this.lens.stays === stays), onclick: () => this.choose(stays) }, text);
    this.choices = [choice('farthest', true), choice('now', false)];
    this.caption = element('p', { class: 'lens-caption' });
    const end = clock.time[clock.time.length - 1];
    const speeds = [...Geometry.pointsOf(motion.speeds)];
    const top = 1.12 * Math.max(...speeds.map(([, speed]) => speed));
    const unit = tolerance < 1e-4 ? 1e6 : 1e3;
    const bins = motion.deviations;
    const plot = (label, time, title, range, still, moving) => {
      const canvas = element('canvas', { role: 'img', 'aria-label': label });
      const panel = new Panel(canvas, { x: [0, Math.max(end, 1e-6)], y: range, titles: [time, title], margins: [58, 12, 6, time ? 40 : 24], still, moving });
      Timeline.scrub(canvas, panel, view);
      return { canvas, panel, fit: () => panel.layout() };
    };
    const room = 1.25 * tolerance * unit;
    this.plots = [
      plot('Speed of the tip over time, coloured by the limit that it reaches', '', 'm/s', [0, top], (context, panel) => this.speed(context, panel, speeds), (context, panel) => Timeline.dot(context, panel, view, motion.speeds)),
      plot('Distance of the tip from the line over time, within the tolerance', 'time (s)', unit > 1e3 ? '\u00b5m' : 'mm', [-room, room], (context, panel) => this.deviation(context, panel, bins, end, unit), (context, panel) => Timeline.cursor(context, panel, view)),
    ];
    const [speed, deviation] = this.plots.map(({ canvas }) => canvas);
    this.root = element(
      'section',
      { class: 'followed', 'aria-label': 'The tip on the line' },
      element('figure', {}, element('figcaption', {}, 'Tube of the tolerance', element('span', { class: 'modes', role: 'group', 'aria-label': 'Place of the lens' }, ...this.choices)), this.lens.canvas, this.caption),
      element('figure', {}, element('figcaption', {}, 'Speed of the tip'), speed, element('figcaption', {}, 'Distance from the line'), deviation),
    );
    view.height.root.after(this.root);
    view.plots.push(...this.plots, { panel: /** @type {any} */ (this.lens), fit: () => {} });
  }

  /** Hides lens and plots unless the motion is played. */
  show() {
    if (this.root) this.root.hidden = this.view.mode !== 'move';
  }

  /** Puts the lens where the tip is farthest from the line, or lets it follow the motion. */
  choose(stays) {
    this.lens.stays = stays;
    this.choices.forEach((button, index) => button.setAttribute('aria-pressed', String(stays === (index === 0))));
    this.view.refresh();
  }

  /** Describes the lens. */
  say(time, off) {
    const text = `${off === null ? '' : `${Numbers.length(off)} off the line `}at ${Numbers.seconds(time)}; tube \u00b1 ${Numbers.length(this.line.tolerance)}`;
    if (this.caption.textContent !== text) this.caption.textContent = text;
  }

  color(theme, limit) {
    return theme.stroke(this.motion.limits[limit][1]);
  }

  speed(context, panel, speeds) {
    let from = 0;
    for (const [to, limit] of this.motion.stretches) {
      const value = (time) => [time, Timeline.valueAt(this.motion.speeds, time)];
      const points = [value(from), ...speeds.filter(([time]) => from < time && time < to), value(to)];
      [context.lineWidth, context.strokeStyle] = [2.4, this.color(panel.theme, limit)];
      line(context, points.map((point) => panel.at(point)));
      from = to;
    }
  }

  deviation(context, panel, bins, end, unit) {
    const { theme, rect } = panel;
    const tolerance = this.line.tolerance * unit;
    const [[, top], [, bottom]] = [panel.at([0, tolerance]), panel.at([0, -tolerance])];
    context.fillStyle = theme.faint;
    context.fillRect(rect.x, rect.y, rect.width, top - rect.y);
    context.fillRect(rect.x, bottom, rect.width, rect.y + rect.height - bottom);
    [context.strokeStyle, context.lineWidth] = [theme.grey, 1];
    for (const y of [top, bottom]) line(context, [[rect.x, y], [rect.x + rect.width, y]]);
    const at = (index, value) => panel.at([((index + 0.5) / bins.length) * end, (value / 1000) * tolerance]);
    const upper = bins.map(([, value], index) => at(index, value));
    const lower = bins.map(([value], index) => at(index, value)).reverse();
    [context.fillStyle, context.strokeStyle] = [theme.accent, theme.accent];
    line(context, [...upper, ...lower, upper[0]]);
    context.fill();
    const [time, off] = this.motion.farthest;
    this.frame(context, theme, panel.at([time, off * unit]), 5);
  }

  /** Draws the sign of the lens's place. */
  frame(context, theme, [x, y], half) {
    for (const [width, color] of [[4, theme.paper], [1.6, theme.ink]]) {
      [context.lineWidth, context.strokeStyle] = [width, color];
      context.strokeRect(x - half, y - half, 2 * half, 2 * half);
    }
  }

  /** Returns the other IK solution for the current place of the tip, and whether the arm could be there; or `null`. */
  get other() {
    const { model, q, world } = this.view;
    if (!this.motion || this.view.drawn !== 'move') return null;
    const { arm } = model;
    const all = Geometry.solutions(arm, Geometry.tipAt(arm, q));
    const apart = (one) => Math.hypot(...arm.joints.map((joint, k) => (joint.sign === undefined ? one[k] - q[k] : 2 * Math.sin((one[k] - q[k]) / 2))));
    const found = all.reduce((a, b) => (apart(b) > apart(a) ? b : a));
    if (all.length < 2 || apart(found) < 1e-3) return null;
    const placed = arm.joints.map((joint, k) => (joint.sign === undefined ? found[k] : found[k] - Geometry.TURN * Math.round((found[k] - (joint.domain[0] + joint.domain[1]) / 2) / Geometry.TURN)));
    const isWithin = arm.joints.every((joint, k) => joint.circle || (placed[k] >= joint.domain[0] - 1e-6 && placed[k] <= joint.domain[1] + 1e-6));
    const [nearest] = Geometry.contacts(arm, world, placed);
    return { q: placed, isFree: isWithin && !(nearest && (nearest.distance <= 0 || nearest.distance < world.clearance)) };
  }

  /** Draws the line below the arm, and the arms that are excluded. */
  inWorkspace(context, panel) {
    const { view, line: { strokes, marked, excluded } } = this;
    const { theme } = panel;
    for (const q of excluded) Workspace.arm(context, panel, view, view.world, q, { fill: theme.paper, line: theme.infeasible, width: 0.9, alpha: 0.65, blocks: true });
    if (!view.shows('path')) return;
    [context.lineWidth, context.strokeStyle, context.lineCap] = [marked ? 3 : 7, this.motion ? theme.ghost : theme.grey, 'round'];
    for (const stroke of strokes) line(context, [...Geometry.pointsOf(stroke)].map((p) => panel.at(p)));
    for (const [color, points] of marked ?? []) {
      [context.lineWidth, context.strokeStyle] = [3, theme.stroke(color)];
      line(context, [...Geometry.pointsOf(points)].map((p) => panel.at(p)));
    }
    context.lineCap = 'butt';
  }

  /** Draws the other IK solution, below the arm. */
  belowArm(context, panel) {
    const { other, view } = this;
    if (!other || !view.shows('solutions')) return;
    const { theme } = panel;
    const look = other.isFree ? { fill: theme.ghost, line: theme.grey, width: 0.9, alpha: 0.7 } : { fill: theme.paper, line: theme.infeasible, width: 0.9, alpha: 0.6 };
    Workspace.arm(context, panel, view, view.world, other.q, { ...look, joints: true });
  }

  /** Draws the path of the tip above the arm, which would hide it, and the overview of a magnified panel. */
  aboveArm(context, panel) {
    const { view, motion } = this;
    const { theme } = panel;
    if (motion && view.shows('path') && view.drawn === 'move') {
      this.paths(context, panel, 'tips', (flat) => trace(context, panel, flat, false));
      for (const stop of this.stops) FollowedLine.dot(context, theme, panel.at(stop), 3.2, theme.paper, theme.ink);
      this.frame(context, theme, panel.at(this.tipAt(this.lens.time)), 8);
      FollowedLine.dot(context, theme, panel.at(Geometry.tipAt(view.model.arm, view.q)), 5, theme.accent, theme.paper);
    }
    if (this.line.focus && panel.times > FollowedLine.OVERVIEW[2]) this.overview(context, panel);
  }

  static dot(context, theme, [x, y], radius, fill, edge) {
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    [context.fillStyle, context.strokeStyle, context.lineWidth] = [fill, edge, 1.5];
    context.fill();
    context.stroke();
  }

  /** Draws the path of each stretch in the colour of its limit. */
  paths(context, panel, key, each) {
    const { theme } = panel;
    context.lineCap = 'round';
    for (const isHalo of [true, false]) {
      for (const stretch of this.stretches) {
        [context.lineWidth, context.strokeStyle] = isHalo ? [5, theme.paper] : [3, this.color(theme, stretch.limit)];
        context.beginPath();
        each(stretch[key]);
        context.stroke();
      }
    }
    context.lineCap = 'butt';
  }

  /** Draws the whole workspace into a corner of the magnified one. */
  overview(context, panel) {
    const { view, line: { focus: { corner } } } = this;
    const { theme, rect, whole, shown } = panel;
    const [share, gap] = FollowedLine.OVERVIEW;
    const size = share * Math.min(rect.width, rect.height);
    const box = { x: corner[0] > 0 ? rect.x + rect.width - gap - size : rect.x + gap, y: corner[1] > 0 ? rect.y + gap : rect.y + rect.height - gap - size, width: size, height: size };
    const length = Math.max(...whole.map(([low, high]) => high - low));
    const middle = whole.map(([low, high]) => (low + high) / 2);
    const pixels = size / length;
    const mini = /** @type {any} */ ({
      theme, rect: box, pixels,
      at: ([x, y]) => [box.x + size / 2 + (x - middle[0]) * pixels, box.y + size / 2 - (y - middle[1]) * pixels],
      faded: (_, alpha, draw) => {
        context.save();
        context.globalAlpha = alpha;
        draw(context);
        context.restore();
      },
    });
    panel.blocked.boxes.push(box);
    context.save();
    context.beginPath();
    context.rect(box.x, box.y, size, size);
    context.clip();
    context.fillStyle = theme.paper;
    context.fill();
    [context.lineWidth, context.strokeStyle] = [1, theme.pale];
    context.beginPath();
    rounded(context, mini, view.model.arm.reach);
    context.setLineDash([2, 4]);
    context.stroke();
    context.setLineDash([]);
    for (const obstacle of view.world.obstacles) {
      if (view.hidden.has(obstacle.name)) continue;
      Workspace.outline(context, mini, obstacle);
      context.fillStyle = theme.obstacle(obstacle.color).fill;
      if (!obstacle.outline.polyline) context.fill();
      context.strokeStyle = theme.obstacle(obstacle.color).line;
      context.stroke();
    }
    this.belowArm(context, mini);
    Workspace.arm(context, mini, view, view.world, view.q, { fill: theme.paper, line: theme.accent, width: 1 });
    const [[left, top], [right, bottom]] = [mini.at([shown[0][0], shown[1][1]]), mini.at([shown[0][1], shown[1][0]])];
    [context.lineWidth, context.strokeStyle] = [1.5, theme.ink];
    context.strokeRect(left, top, right - left, bottom - top);
    context.restore();
    [context.lineWidth, context.strokeStyle] = [1, theme.grey];
    context.strokeRect(box.x, box.y, size, size);
  }

  /** Draws the images of the line under both IK solutions, and the configurations that are excluded. */
  inCSpace(context, panel, shifted) {
    const { view, line: { solutions, excluded } } = this;
    const { theme } = panel;
    if (view.shows('solutions')) {
      for (const part of solutions) {
        [context.lineWidth, context.strokeStyle] = [2.2, part.excluded ? theme.infeasible : theme.grey];
        context.setLineDash(part.excluded ? [5, 3] : []);
        context.beginPath();
        shifted(part.points);
        context.stroke();
      }
      context.setLineDash([]);
    }
    if (this.motion && view.shows('path')) {
      this.paths(context, panel, 'joints', shifted);
    }
    for (const q of excluded) cross(context, theme, CSpace.place(view, panel, q));
  }

  /** Draws the names of the IK solutions in the configuration space. */
  names(context, panel) {
    const { view, line: { solutions, names } } = this;
    if (!view.shows('names') || !view.shows('solutions')) return;
    for (const { points } of solutions) Labels.blockLine(panel, [...Geometry.pointsOf(points)].map((q) => CSpace.place(view, panel, q)));
    const boxes = names.map((name, solution) => {
      const parts = solutions.filter((part) => part.solution === solution).map(({ points }) => [...Geometry.pointsOf(points)].map((q) => CSpace.place(view, panel, q)));
      const [xs, ys] = [0, 1].map((k) => parts.flat().map((spot) => spot[k]));
      const [x, y] = [Math.min(...xs), Math.min(...ys)];
      return { text: name, rect: { x, y, width: Math.max(...xs) - x, height: Math.max(...ys) - y }, pieces: Labels.lines(parts) };
    });
    Labels.beside(context, panel, boxes.filter(({ rect }) => Number.isFinite(rect.x)).map(({ text, ...shape }) => [text, shape]));
  }

  /** Draws the other IK solution of the current place. */
  movingInCSpace(context, panel) {
    const { other, view } = this;
    if (!other || !view.shows('solutions')) return;
    const { theme } = panel;
    FollowedLine.dot(context, theme, CSpace.place(view, panel, other.q), 4.5, theme.paper, other.isFree ? theme.grey : theme.infeasible);
  }
}
