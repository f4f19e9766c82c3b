// The figure of two polygons, a part of link 2 and an obstacle: they can be dragged, and their Minkowski difference is
// beside them.
'use strict';

class PolygonFigure {
  /** Titles of the right picture by lesson. */
  static CAPTIONS = { tests: 'Minkowski difference: obstacle minus link', sweep: 'Minkowski difference: obstacle minus link', stack: 'One difference for each angle of the link' };

  /** Duration of a step of the sweep, and of a turn of the link, in seconds. */
  static SECONDS = { step: 0.9, turn: 8 };

  /** Number of angles whose differences are stacked. */
  static ANGLES = 12;

  /** @param {Learn} learn */
  constructor(learn) {
    this.learn = learn;
    this.view = learn.view;
    /** Index of the polygon of link 2, and index of the obstacle's piece. @type {number[]} */
    this.pair = [0, 0];
    /** The polygons of the model: corners, names. @type {{ a: any[], b: any[] }} */
    this.polygons = { a: [], b: [] };
    /** The polygons at their places. @type {{ a: Point[], b: Point[], at: Point }} */
    this.pieces = null;
    /** Size of the figure, in metres. */
    this.size = 1;
    /** Directions in which the stack is drawn. @type {any} */
    this.slant = null;
    /** @type {?string} */
    this.signature = null;
    const select = (label, change) => element('select', { 'aria-label': label, onchange: (event) => change(Number(event.target.value)) });
    const canvas = (label) => element('canvas', { tabindex: '0', role: 'img', 'aria-label': label });
    const [left, right] = [canvas('Two polygons: drag them and their corners'), canvas('Minkowski difference')];
    this.selects = {
      a: select('polygon of the arm', (value) => this.take([value, this.pair[1]])),
      b: select('polygon of an obstacle', (value) => this.take([this.pair[0], value])),
    };
    this.choice = element('p', { class: 'choice' }, this.selects.a, ' ', this.selects.b);
    this.root = element(
      'section',
      { class: 'panels' },
      element('figure', {}, element('figcaption', {}, 'Two polygons: drag them, or their corners'), left),
      element('figure', {}, element('figcaption', {}), right),
    );
    const panel = (of, draw) => new Panel(of, { x: [0, 1], y: [0, 1], scale: 'fill', moving: (context, it) => this.pieces && draw(context, it) });
    this.panels = { left: panel(left, (context, it) => this.drawPair(context, it)), right: panel(right, (context, it) => this.drawDifference(context, it)) };
    this.listen(this.panels.left);
  }

  /** Returns the name of a side of a polygon with `count` corners. */
  static side(letter, index, count) {
    return `${letter}${index + 1}${letter}${((index + 1) % count) + 1}`;
  }

  /**
   * Returns the polygons of link 2 and of the obstacles.
   * @param {Model} model
   */
  static polygonsOf({ arm, worlds: [world] }) {
    const [a, b] = [[], []];
    const own = arm.links[1].parts;
    own.forEach((part, number) => {
      if (part.core.length > 4) a.push({ name: own.length > 1 ? `${part.body}, part ${number + 1}` : part.body, core: part.core, number });
    });
    world?.obstacles.forEach((obstacle, index) => obstacle.pieces.slice(0, obstacle.own).forEach(({ core }, piece) => {
      if (core.length > 4) b.push({ name: obstacle.own > 1 ? `${obstacle.name}, piece ${piece + 1}` : obstacle.name, core, index });
    }));
    return { a, b };
  }

  /**
   * Returns true if a model has polygons of the arm and of obstacles.
   * @param {Model} model
   * @returns {boolean}
   */
  static isOffered(model) {
    const { a, b } = PolygonFigure.polygonsOf(model);
    return a.length > 0 && b.length > 0;
  }

  /** Switches to another model. Polygons that the reader has dragged stay until the model has other polygons. */
  update(model) {
    this.polygons = PolygonFigure.polygonsOf(model);
    const signature = JSON.stringify(this.polygons);
    if (signature === this.signature) return;
    this.signature = signature;
    for (const [k, list] of [this.polygons.a, this.polygons.b].entries()) {
      if (this.pair[k] >= list.length) this.pair[k] = 0;
      const select = this.selects['ab'[k]];
      select.hidden = list.length < 2;
      select.replaceChildren(...list.map(({ name }, index) => element('option', { value: index, selected: index === this.pair[k] }, name)));
    }
    if (PolygonFigure.isOffered(model)) this.take(this.pair);
  }

  /** Returns the name of the lesson: 'tests', 'sweep' or 'stack'. */
  get lesson() {
    return this.learn.lesson;
  }

  get duration() {
    if (this.lesson === 'tests') return 0;
    return this.lesson === 'sweep' ? PolygonFigure.SECONDS.step * this.steps.length : PolygonFigure.SECONDS.turn;
  }

  /** Returns the finished part of the lesson, from 0 to 1. */
  get part() {
    return this.duration ? this.view.time / this.duration : 0;
  }

  /** Places two polygons so that a corner of the obstacle lies in the link. */
  take(/** @type {number[]} */ [a, b]) {
    this.pair = [a, b];
    const { arm } = this.view.model;
    const [one, other] = [this.polygons.a[a], this.polygons.b[b]];
    const points = ({ core }) => [...Geometry.pointsOf(core)];
    const [, pose] = Geometry.poses(arm, this.view.model.start);
    const placed = points({ core: Geometry.placed({ core: one.core }, pose).core });
    const rests = points(other);
    const middle = placed.reduce(Contact.plus).map((x) => x / placed.length);
    const by = Contact.minus(rests[0], middle);
    this.size = Math.max(...[...placed, ...rests].flat().map(Math.abs), 1e-3);
    const snap = (corners) => Contact.snapped(corners, 4 * this.size);
    const [at] = snap([Contact.plus([pose[0], pose[1]], by)]);
    // Relative to the origin of link 2, because the difference is a set of positions of this origin.
    this.pieces = { a: snap(placed.map((p) => Contact.minus(p, pose))), b: snap(rests), at };
    this.frame();
    this.learn.changed();
  }

  /** Returns the link's polygon at its place, turned by the angle of the lesson. */
  get moved() {
    return this.turned.map((p) => Contact.plus(p, this.pieces.at));
  }

  get turned() {
    return this.lesson === 'stack' ? this.rotated(2 * Math.PI * this.part) : this.pieces.a;
  }

  rotated(angle) {
    const [cosine, sine] = [Math.cos(angle), Math.sin(angle)];
    return this.pieces.a.map(([x, y]) => [cosine * x - sine * y, sine * x + cosine * y]);
  }

  /** Returns the angles whose differences are stacked. */
  get angles() {
    return Array.from({ length: PolygonFigure.ANGLES }, (_, k) => (2 * Math.PI * k) / PolygonFigure.ANGLES);
  }

  get steps() {
    return Contact.difference(this.pieces.b, this.turned);
  }

  /** Returns the place in the right panel for a position of the link's origin; for a gantry, the joint values. */
  placeOf(p) {
    const { arm } = this.view.model;
    const [first, second] = arm.joints.map((joint) => joint.direction);
    const determinant = first && second ? Contact.cross(first, second) : 0;
    if (!determinant) return p;
    const by = Contact.minus(p, Contact.plus(arm.base, arm.offset));
    return [Contact.cross(by, second) / determinant, Contact.cross(first, by) / determinant];
  }

  /** Sets the ranges of the panels. */
  frame() {
    const { a, b, at } = this.pieces;
    const reach = Math.max(...a.map((p) => Math.hypot(...p)));
    const around = (points, room) => [0, 1].map((k) => {
      const values = points.map((p) => p[k]);
      return [Math.min(...values) - room, Math.max(...values) + room];
    });
    const { plane, joints } = this.view.model.arm;
    const { left, right } = this.panels;
    const gantry = joints.every((joint) => joint.direction);
    const all = [...b, at, ...a.map((p) => Contact.plus(p, at))];
    const turns = this.lesson === 'stack';
    [left.x, left.y] = around(turns ? b : all, turns ? 2 * reach : 0.35 * reach);
    const seen = [...this.steps.map((step) => step.at), at].map((p) => this.placeOf(p));
    [right.x, right.y] = around(seen, 0.15 * reach);
    if (turns) {
      // The second coordinate leads into the page.
      const [x, y] = around(b, reach);
      this.slant = { y: y[0], along: 0.45, up: (0.35 * Math.PI) / (y[1] - y[0]) };
      [right.x, right.y] = [[x[0], x[1] + this.slant.along * (y[1] - y[0])], [0, 2.35 * Math.PI]];
    }
    right.scale = turns ? 'free' : 'fill';
    right.degrees = [false, turns];
    left.titles = plane;
    right.titles = turns ? [`${plane[0]}, for the least ${plane[1].replace(/ .*/, '')}`, 'angle of the link'] : gantry ? joints.map((joint) => `${joint.name} (m)`) : plane;
    for (const panel of [left, right]) {
      panel.layout();
      panel.dirty = true;
    }
  }

  /** Fits the panels to the current lesson. */
  show() {
    this.root.querySelectorAll('figcaption')[1].textContent = PolygonFigure.CAPTIONS[this.lesson];
    this.frame();
    for (const panel of Object.values(this.panels)) panel.resize();
  }

  draw() {
    for (const panel of Object.values(this.panels)) panel.draw();
  }

  // Texts.

  /** Returns the text beside the scrubber. */
  get clock() {
    return this.lesson === 'stack' ? Numbers.angle(2 * Math.PI * this.part) : `step ${this.step + 1}`;
  }

  get caption() {
    if (this.lesson === 'tests') return this.testCaption;
    if (this.lesson === 'stack') return 'Positions of the link\u2019s origin in which the link collides, for each angle of the link';
    const { steps } = this;
    const { i, k, of } = steps[this.step];
    const [mine, other] = [PolygonFigure.side('a', i, this.pieces.a.length), PolygonFigure.side('b', k, this.pieces.b.length)];
    const next = { a: `${mine}, turned round`, b: other, both: `${other} and ${mine}, which are parallel, as one` }[of];
    // Without the number of steps, which is the answer to the question.
    return `Step ${this.step + 1}: corner b${k + 1} \u2212 a${i + 1}; next by its angle: ${next}`;
  }

  get step() {
    return Math.min(this.steps.length - 1, Math.floor(this.part * this.steps.length));
  }

  // The tests of penetration.

  test() {
    return Contact.polygonTest(this.moved, this.pieces.b);
  }

  get testCaption() {
    const { meet, mine, others, crossings } = this.test();
    const inside = [...mine, ...others].filter((test) => test.inside).length;
    return meet ? `They meet. Corners within the other one: ${inside}; crossings of sides: ${crossings.length}` : 'They do not meet.';
  }

  /** Returns the tables of both tests. */
  tables() {
    if (this.lesson !== 'tests') return [];
    const { mine, others, crossings } = this.test();
    const { a, b } = this.pieces;
    const distances = (letter, name, tests, count) => Learn.table(
      `Corners of ${name}: signed distances, mm`,
      ['corner', ...Array.from({ length: count }, (_, k) => PolygonFigure.side(letter === 'a' ? 'b' : 'a', k, count)), 'within'],
      tests.map((test, i) => element(
        'tr',
        {},
        element('th', { scope: 'row' }, `${letter}${i + 1}`),
        ...test.distances.map((d, k) => element('td', { class: k === test.side ? 'least' : undefined }, Numbers.digits(1000 * d))),
        element('td', {}, test.inside ? `${Numbers.length(test.depth)} deep` : 'no'),
      )),
    );
    const crossed = crossings.map(([i, k]) => `${PolygonFigure.side('a', i, a.length)} and ${PolygonFigure.side('b', k, b.length)}`).join('; ');
    return [
      distances('a', 'the link, sides of the obstacle', mine, b.length),
      distances('b', 'the obstacle, sides of the link', others, a.length),
      element('p', { class: 'crossings' }, crossings.length ? `Sides that cross: ${crossed}.` : 'No sides cross.'),
    ];
  }

  /** Draws corners that lie in the other polygon, each with its nearest side, and sides that cross. */
  drawTest(context, panel, a, b) {
    const { theme } = panel;
    const { mine, others, crossings } = this.test();
    for (const [corners, tests, polygon] of [[a, mine, b], [b, others, a]]) {
      tests.forEach(({ inside, depth, side }, i) => {
        if (!inside) return;
        const [p, q] = Contact.sides(polygon)[side];
        const [x, y] = Contact.minus(q, p);
        const length = Math.hypot(x, y);
        const foot = Contact.plus(corners[i], [(y * depth) / length, (-x * depth) / length]);
        context.setLineDash([4, 3]);
        context.strokeStyle = theme.infeasible;
        context.lineWidth = 1.6;
        line(context, [panel.at(corners[i]), panel.at(foot)]);
        context.setLineDash([]);
        this.dot(context, panel, corners[i], theme.infeasible, 6);
      });
    }
    context.strokeStyle = theme.infeasible;
    context.lineWidth = 3.5;
    for (const [i, k] of crossings) for (const [polygon, index] of [[a, i], [b, k]]) line(context, Contact.sides(polygon)[index].map((p) => panel.at(p)));
  }

  // Drawings.

  fill(context, panel, corners, fill, edge, width = 1.6) {
    context.beginPath();
    trace(context, panel, corners.flat(), true);
    context.fillStyle = fill;
    context.fill();
    context.lineWidth = width;
    context.strokeStyle = edge;
    context.stroke();
  }

  get color() {
    return this.view.model.worlds[0].obstacles[this.polygons.b[this.pair[1]].index].color;
  }

  dot(context, panel, place, color, radius = 5) {
    context.beginPath();
    context.arc(...panel.at(place), radius, 0, 2 * Math.PI);
    context.fillStyle = color;
    context.fill();
    context.lineWidth = 1.5;
    context.strokeStyle = panel.theme.paper;
    context.stroke();
  }

  drawPair(context, panel) {
    const { theme } = panel;
    const { b, at } = this.pieces;
    const { moved: a } = this;
    const { fill, line: edge } = theme.obstacle(this.color);
    if (this.lesson === 'stack') {
      context.setLineDash([5, 4]);
      this.fill(context, panel, this.steps.map((step) => step.at), 'transparent', edge);
      context.setLineDash([]);
    }
    this.fill(context, panel, b, fill, edge);
    panel.faded(context, 0.85, (layer) => this.fill(layer, panel, a, theme.paper, theme.ink));
    const names = (letter, corners, color) => {
      const middle = corners.reduce(Contact.plus).map((x) => x / corners.length);
      return corners.map((p, i) => {
        this.dot(context, panel, p, color, 4);
        const [[x, y], [u, v]] = [panel.at(p), panel.at(middle)];
        const away = Math.hypot(x - u, y - v) || 1;
        return [`${letter}${i + 1}`, [x + (15 * (x - u)) / away, y + (15 * (y - v)) / away], Infinity];
      });
    };
    Labels.inside(context, panel, [], [...names('a', a, theme.ink), ...names('b', b, edge)]);
    this.dot(context, panel, at, theme.accent, 5);
    if (this.lesson === 'tests') this.drawTest(context, panel, a, b);
    if (this.lesson === 'sweep') this.drawStep(context, panel, a, b);
  }

  /** Draws the corners whose difference is taken, and the next side by its angle. */
  drawStep(context, panel, a, b) {
    const { i, k, of } = this.steps[this.step];
    const { theme } = panel;
    this.dot(context, panel, a[i], theme.infeasible, 7);
    this.dot(context, panel, b[k], theme.infeasible, 7);
    context.strokeStyle = theme.infeasible;
    context.lineWidth = 4;
    if (of !== 'b') line(context, Contact.sides(a)[i].map((p) => panel.at(p)));
    if (of !== 'a') line(context, Contact.sides(b)[k].map((p) => panel.at(p)));
  }

  drawDifference(context, panel) {
    if (this.lesson === 'stack') {
      this.drawStack(context, panel);
      return;
    }
    const { theme } = panel;
    const { steps } = this;
    const { fill, line: edge } = theme.obstacle(this.color);
    const corners = steps.map((step) => this.placeOf(step.at));
    const there = this.lesson === 'sweep' ? corners.slice(0, this.step + 1) : corners;
    const done = there.length === corners.length;
    if (done) this.fill(context, panel, corners, fill, edge);
    context.lineWidth = 2.4;
    context.strokeStyle = edge;
    line(context, there.map((p) => panel.at(p)));
    for (const p of there) this.dot(context, panel, p, edge, 4);
    if (this.lesson === 'sweep') {
      this.drawDirections(context, panel, steps);
      Labels.blockLine(panel, there.map((p) => panel.at(p)));
      Labels.blockSpot(panel, panel.at(this.placeOf(this.pieces.at)));
      Labels.beside(context, panel, there.map((p, s) => [`b${steps[s].k + 1} \u2212 a${steps[s].i + 1}`, Labels.spotted(panel.at(p), 6)]));
      this.dot(context, panel, there[there.length - 1], theme.infeasible, 6);
    }
    this.dot(context, panel, this.placeOf(this.pieces.at), theme.accent, 6);
  }

  /** Draws the directions of the sides on a circle, and marks the next one. */
  drawDirections(context, panel, steps) {
    const { theme, rect } = panel;
    const r = Math.min(46, rect.width / 8);
    const [x, y] = [rect.x + rect.width - r - 14, rect.y + r + 14];
    Labels.blockSpot(panel, [x, y], r + 2);
    context.beginPath();
    context.arc(x, y, r, 0, 2 * Math.PI);
    context.fillStyle = theme.paper;
    context.fill();
    context.lineWidth = 1;
    context.strokeStyle = theme.grey;
    context.stroke();
    steps.forEach(({ direction: [u, v], of }, index) => {
      const length = Math.hypot(u, v);
      const next = index === this.step;
      context.strokeStyle = next ? theme.infeasible : of === 'a' ? theme.ink : theme.obstacle(this.color).line;
      context.lineWidth = next ? 4 : 2;
      line(context, [[x, y], [x + (r * u) / length, y - (r * v) / length]]);
    });
  }

  /** Draws the differences for a dozen angles, one above the other; the current one in bold, with the link's origin. */
  drawStack(context, panel) {
    const { theme } = panel;
    const { fill, line: edge } = theme.obstacle(this.color);
    const { y: near, along, up } = this.slant;
    const lift = (angle) => (/** @type {Point} */ [x, y]) => [x + along * (y - near), angle + up * (y - near)];
    const now = 2 * Math.PI * this.part;
    const angles = this.angles;
    for (const angle of angles) {
      const corners = Contact.difference(this.pieces.b, this.rotated(angle)).map((step) => lift(angle)(step.at));
      panel.faded(context, 0.55, (layer) => this.fill(layer, panel, corners, fill, edge, 1));
    }
    this.fill(context, panel, this.steps.map((step) => lift(now)(step.at)), fill, theme.infeasible, 3);
    // All angles of the link with its origin at the current place: a row of the configuration space.
    context.strokeStyle = theme.accent;
    context.lineWidth = 2;
    line(context, [0, 2 * Math.PI].map((angle) => panel.at(lift(angle)(this.pieces.at))));
    this.dot(context, panel, lift(now)(this.pieces.at), theme.accent, 6);
  }

  // Dragging.

  listen(panel) {
    const { canvas } = panel;
    const NEAR = 14;
    let held = null;
    const within = (corners, p) => Contact.pointTest(p, corners).inside;
    const snap = (p) => Contact.snapped([p], 4 * this.size)[0];
    /** Returns the grasped item at a spot: a corner, or a whole polygon. */
    const grasp = (spot) => {
      const value = panel.value(spot);
      for (const [name, corners, by] of [['a', this.moved, this.pieces.at], ['b', this.pieces.b, [0, 0]]]) {
        const index = corners.findIndex((p) => Math.hypot(...Contact.minus(panel.at(p), spot)) < NEAR);
        // A corner of the link can be dragged only if the link is not turned.
        if (index >= 0 && (name === 'b' || this.lesson !== 'stack')) return { name, index, by };
      }
      if (within(this.moved, value)) return { name: 'at', from: value, was: this.pieces.at };
      return within(this.pieces.b, value) ? { name: 'b', from: value, was: this.pieces.b } : null;
    };
    canvas.addEventListener('pointerdown', (event) => {
      held = grasp(panel.spot(event));
      if (!held) return;
      canvas.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    canvas.addEventListener('pointermove', (event) => held && this.drag(held, panel.value(panel.spot(event)), snap));
    for (const end of ['pointerup', 'pointercancel']) {
      canvas.addEventListener(end, () => {
        if (held) this.settle();
        held = null;
      });
    }
    canvas.addEventListener('touchstart', (event) => {
      const [{ clientX, clientY }] = event.touches;
      if (event.touches.length === 1 && grasp(panel.spot({ clientX, clientY }))) event.preventDefault();
    }, { passive: false });
    canvas.addEventListener('keydown', (event) => {
      const direction = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
      if (!direction || event.ctrlKey || event.metaKey || event.altKey) return;
      const step = (this.size / 100) * (event.shiftKey ? 10 : 1);
      this.pieces.at = snap(Contact.plus(this.pieces.at, direction.map((x) => x * step)));
      this.settle();
      event.preventDefault();
      event.stopPropagation();
    });
  }

  /** Moves the grasped item; a corner only as far as the polygon stays convex. */
  drag({ name, index, by, from, was }, value, snap) {
    if (index !== undefined) {
      const corners = this.pieces[name].map((p, i) => (i === index ? snap(Contact.minus(value, by)) : p));
      const n = corners.length;
      const bends = (i) => Contact.cross(Contact.minus(corners[(i + 1) % n], corners[i]), Contact.minus(corners[(i + 2) % n], corners[(i + 1) % n]));
      if (corners.some((_, i) => bends(i) <= 0)) return;
      this.pieces[name] = corners;
    } else {
      const shift = (p) => snap(Contact.plus(p, Contact.minus(value, from)));
      this.pieces[name] = name === 'at' ? shift(was) : was.map(shift);
    }
    this.learn.changed();
  }

  /** Fits the panels again after something was moved. */
  settle() {
    this.frame();
    this.view.ready();
  }
}
