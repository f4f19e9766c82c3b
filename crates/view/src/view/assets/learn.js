// Lessons in geometry, beside the motion and the planner's replay: slices with their contact angles, two polygons with
// the tests of penetration, their Minkowski difference, and how that turns with the arm.
'use strict';

class Learn {
  /** Lessons with their titles and durations in seconds; the sweep has this duration for each corner. */
  static LESSONS = [
    ['slice', 'Contact angles of a slice', 12],
    ['tests', 'When do two polygons meet?', 0],
    ['sweep', 'Minkowski difference, corner by corner', 0.9],
    ['stack', 'Minkowski differences of a link that turns', 8],
  ];

  /** Number of slices from which the first one to show is chosen: the one with the most contacts. */
  static TRIED = 25;

  /** Returns the name of a side of a polygon with `count` corners. */
  static side(letter, index, count) {
    return `${letter}${index + 1}${letter}${((index + 1) % count) + 1}`;
  }

  /** Layers that lessons show. */
  static LAYERS = new Set(['c-obstacles', 'names', 'regions']);

  constructor(view) {
    this.view = view;
    this.lesson = 'slice';
    this.chosen = 0;
    /** Index of the polygon of link 2, and index of the obstacle's piece. */
    this.pair = [0, 0];
    const select = (label, change) => element('select', { 'aria-label': label, onchange: (event) => change(event.target.value) });
    const canvas = (label) => element('canvas', { tabindex: '0', role: 'img', 'aria-label': label });
    const [left, right] = [canvas('Two polygons: drag them and their corners'), canvas('Minkowski difference')];
    this.parts = {
      lesson: select('lesson', (value) => this.start(value)),
      a: select('polygon of the arm', (value) => this.take([Number(value), this.pair[1]])),
      b: select('polygon of an obstacle', (value) => this.take([this.pair[0], Number(value)])),
      text: element('div', { class: 'lesson' }),
    };
    this.parts.choice = element('p', { class: 'choice' }, this.parts.lesson, ' ', this.parts.a, ' ', this.parts.b);
    this.parts.panels = element(
      'section',
      { class: 'panels' },
      element('figure', {}, element('figcaption', {}, 'Two polygons: drag them, or their corners'), left),
      element('figure', {}, element('figcaption', {}), right),
    );
    const panel = (of, draw) => new Panel(of, { x: [0, 1], y: [0, 1], scale: 'fill', moving: (context, it) => this.pieces && draw(context, it) });
    this.panels = { left: panel(left, (context, it) => this.drawPair(context, it)), right: panel(right, (context, it) => this.drawDifference(context, it)) };
    this.listen(this.panels.left);
  }

  // The subjects of the lessons.

  /** Switches to another model. */
  update(model) {
    this.polygons = { a: [], b: [] };
    const [world] = model.worlds;
    const own = model.arm.links[1].parts;
    own.forEach((part, number) => {
      if (part.core.length > 4) this.polygons.a.push({ name: own.length > 1 ? `${part.body}, part ${number + 1}` : part.body, core: part.core, number });
    });
    world?.obstacles.forEach((obstacle, index) => obstacle.pieces.slice(0, obstacle.own).forEach(({ core }, piece) => {
      if (core.length > 4) this.polygons.b.push({ name: obstacle.own > 1 ? `${obstacle.name}, piece ${piece + 1}` : obstacle.name, core, index });
    }));
    const polygons = this.polygons.a.length && this.polygons.b.length;
    const slices = world?.pairs.some(([link]) => link === 1);
    const turns = model.arm.joints.some((joint) => joint.sign !== undefined);
    this.lessons = Learn.LESSONS.filter(([name]) => (name === 'slice' ? slices : polygons && (name !== 'stack' || turns)));
    this.known = null;
    // Polygons that the user has dragged stay until the model has other polygons.
    const signature = JSON.stringify([this.polygons, this.lessons]);
    if (signature === this.signature) return;
    this.signature = signature;
    const option = (chosen) => ([value, text]) => element('option', { value, selected: value === chosen }, text);
    this.parts.lesson.replaceChildren(...this.lessons.map(option(this.lesson)));
    for (const [k, list] of [this.polygons.a, this.polygons.b].entries()) {
      if (this.pair[k] >= list.length) this.pair[k] = 0;
      this.parts['ab'[k]].replaceChildren(...list.map(({ name }, index) => option(this.pair[k])([index, name])));
    }
    if (!this.lessons.some(([name]) => name === this.lesson)) this.lesson = this.lessons[0]?.[0];
    if (polygons) this.take(this.pair);
  }

  /** Starts a lesson. For slices, it seeks the one with the most contacts. */
  start(lesson) {
    this.lesson = lesson;
    this.parts.lesson.value = lesson;
    this.view.pause();
    this.view.time = 0;
    if (this.isSlice) {
      const contacts = (time) => {
        this.view.time = time;
        return this.slice.bands.length ? 0 : this.slice.contacts.length;
      };
      const times = Array.from({ length: Learn.TRIED }, (_, k) => (this.duration * (k + 0.5)) / Learn.TRIED);
      const most = Math.max(...times.map(contacts));
      this.view.time = times.find((time) => contacts(time) === most);
    }
    this.view.ready();
  }

  /** Returns true if the lesson shows the arm and its configuration space. */
  get isSlice() {
    return this.lesson === 'slice';
  }

  get duration() {
    const [, , seconds] = Learn.LESSONS.find(([name]) => name === this.lesson);
    return this.lesson === 'sweep' ? seconds * this.steps.length : seconds;
  }

  /** Returns the finished part of the lesson, from 0 to 1. */
  get part() {
    return this.duration ? this.view.time / this.duration : 0;
  }

  // A slice.

  /** Returns the value of joint 1. */
  get q1() {
    const [low, high] = this.view.model.arm.joints[0].domain;
    return low + this.part * (high - low);
  }

  /**
   * Returns the slice at that value for the visible obstacles, and its contacts by obstacle: { obstacle, value,
   * features, shape, piece, body }.
   */
  get slice() {
    const { q1, view: { world, hidden, model } } = this;
    const key = JSON.stringify([q1, [...hidden]]);
    if (this.known?.key !== key || this.known.world !== world) {
      const { bands, rows } = Contact.slice(model.arm, world, q1);
      const isShown = (obstacle) => !hidden.has(world.obstacles[obstacle].name);
      const shown = rows.filter((row) => isShown(row.obstacle));
      const contacts = shown.flatMap(({ obstacle, intervals }) => intervals.flat().filter((end) => end.features).map((end) => ({ obstacle, ...end })));
      this.known = { q1, key, world, bands: bands.filter(isShown), rows: shown, contacts };
    }
    return this.known;
  }

  get contact() {
    const { contacts } = this.slice;
    return contacts[Math.min(this.chosen, contacts.length - 1)];
  }

  /** Returns the configuration of the arm. */
  get q() {
    const [low, high] = this.view.model.arm.joints[1].domain;
    return [this.q1, this.contact?.value ?? Math.min(high, Math.max(low, 0))];
  }

  /** Moves to the slice through a configuration, and chooses the contact nearest to it. */
  goTo([q1, q2]) {
    const [low, high] = this.view.model.arm.joints[0].domain;
    this.view.seek((this.duration * (q1 - low)) / (high - low));
    const distance = ({ value }) => Math.abs(value - q2);
    this.choose(this.slice.contacts.reduce((best, c, i, all) => (distance(c) < distance(all[best]) ? i : best), 0));
  }

  choose(contact) {
    this.chosen = contact;
    this.describe();
    for (const panel of Object.values(this.view.panels)) panel.draw();
  }

  /** Chooses a contact by its button. The list is built again, so the new button gets the focus. */
  pick(contact) {
    this.choose(contact);
    this.parts.text.querySelectorAll('button')[contact].focus();
  }

  /** Formats a value of a joint with its unit. */
  value(k, value) {
    return Numbers.joint(this.view.model.arm.joints[k], value);
  }

  /** Describes the features that touch. */
  touching({ features: [mine, i, other, k], shape, piece, body, obstacle }) {
    const feature = (kind, index, { core, radius }) => (core.length === 2 ? 'the disc' : `${kind} ${index + 1}${radius ? ' (rounded)' : ''}`);
    return `${feature(mine, i, shape)} of ${body} on ${feature(other, k, piece)} of ${this.view.world.obstacles[obstacle].name}`;
  }

  // Two polygons.

  /** Places two polygons so that a corner of the obstacle lies in the link. */
  take([a, b]) {
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
    this.changed();
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

  changed() {
    if (this.view.mode !== 'learn') return;
    this.describe();
    for (const panel of Object.values(this.panels)) panel.draw();
  }

  /** Updates the panels and texts after a change of the time or of a polygon. */
  show() {
    const pair = !this.isSlice;
    const active = this.view.mode === 'learn';
    this.parts.choice.hidden = this.parts.text.hidden = !active;
    this.parts.panels.hidden = !active || !pair;
    this.parts.a.hidden = this.parts.b.hidden = !pair;
    if (!active || !pair) return;
    const captions = { tests: 'Minkowski difference: obstacle minus link', sweep: 'Minkowski difference: obstacle minus link', stack: 'One difference for each angle of the link' };
    this.parts.panels.querySelectorAll('figcaption')[1].textContent = captions[this.lesson];
    this.frame();
    for (const panel of Object.values(this.panels)) panel.resize();
  }

  // Texts.

  /** Returns the text beside the scrubber. */
  get clock() {
    if (this.isSlice) return `${this.view.model.arm.joints[0].name} ${this.value(0, this.q1)}`;
    return this.lesson === 'stack' ? Numbers.angle(2 * Math.PI * this.part) : `${this.step + 1} of ${this.steps.length}`;
  }

  get caption() {
    const { joints } = this.view.model.arm;
    if (this.isSlice) {
      const { contacts, bands } = this.slice;
      const names = bands.map((index) => this.view.world.obstacles[index].name).join(', ');
      if (bands.length) return `Link 1 touches ${names} at every value of ${joints[1].name}`;
      return `Contacts of ${joints[1].name} here: ${contacts.length || 'none'}`;
    }
    if (this.lesson === 'tests') {
      const { meet, mine, others, crossings } = this.test();
      const inside = [...mine, ...others].filter((test) => test.inside).length;
      return meet ? `They meet. Corners within the other one: ${inside}; crossings of sides: ${crossings.length}` : 'They do not meet.';
    }
    if (this.lesson === 'stack') return 'Positions of the link\u2019s origin in which the link collides, for each angle of the link';
    const { steps } = this;
    const { i, k, of } = steps[this.step];
    const [mine, other] = [Learn.side('a', i, this.pieces.a.length), Learn.side('b', k, this.pieces.b.length)];
    const next = { a: `${mine}, turned round`, b: other, both: `${other} and ${mine}, which are parallel, as one` }[of];
    return `${this.step + 1} of ${steps.length}: corner b${k + 1} \u2212 a${i + 1}; next by its angle: ${next}`;
  }

  get step() {
    return Math.min(this.steps.length - 1, Math.floor(this.part * this.steps.length));
  }

  test() {
    return Contact.polygonTest(this.moved, this.pieces.b);
  }

  /** Writes the caption, and the tables below the pictures. */
  describe() {
    const cell = (tag, content, attributes = {}) => element(tag, attributes, content);
    const table = (caption, head, rows) => element(
      'table',
      {},
      element('caption', {}, caption),
      element('thead', {}, element('tr', {}, ...head.map((name) => cell('th', name, { scope: 'col' })))),
      element('tbody', {}, ...rows),
    );
    const { text } = this.parts;
    const { step } = this.view.parts;
    if (step.textContent !== this.caption) step.textContent = this.caption;
    if (this.isSlice) {
      const { contacts } = this.slice;
      const rows = contacts.map((contact, index) => element(
        'tr',
        { 'aria-current': contact === this.contact ? 'true' : undefined },
        element('td', {}, element('button', { type: 'button', class: 'button', onclick: () => this.pick(index) }, this.value(1, contact.value))),
        cell('td', this.touching(contact)),
      ));
      text.replaceChildren(...(rows.length ? [table('Contacts of this slice', [this.view.model.arm.joints[1].name, 'touching features'], rows)] : []));
    } else if (this.lesson === 'tests') {
      const { mine, others, crossings } = this.test();
      const distances = (letter, name, tests, count) => table(
        `Corners of ${name}: signed distances, mm`,
        ['corner', ...Array.from({ length: count }, (_, k) => Learn.side(letter === 'a' ? 'b' : 'a', k, count)), 'within'],
        tests.map((test, i) => element(
          'tr',
          {},
          cell('th', `${letter}${i + 1}`, { scope: 'row' }),
          ...test.distances.map((d, k) => cell('td', Numbers.digits(1000 * d), { class: k === test.side ? 'least' : undefined })),
          cell('td', test.inside ? `${Numbers.length(test.depth)} deep` : 'no'),
        )),
      );
      const { a, b } = this.pieces;
      const crossed = crossings.map(([i, k]) => `${Learn.side('a', i, a.length)} and ${Learn.side('b', k, b.length)}`).join('; ');
      text.replaceChildren(
        distances('a', 'the link, sides of the obstacle', mine, b.length),
        distances('b', 'the obstacle, sides of the link', others, a.length),
        element('p', { class: 'crossings' }, crossings.length ? `Sides that cross: ${crossed}.` : 'No sides cross.'),
      );
    } else text.replaceChildren();
  }

  // Drawings.

  /** Draws the arm at all contacts of the slice, and the chosen one. */
  drawArm(context, panel) {
    const { view, slice: { contacts, bands }, contact } = this;
    const { theme } = panel;
    const { world } = view;
    const draw = (at, look) => Workspace.arm(context, panel, view, world, [this.q1, at.value], look);
    for (const other of contacts) {
      const { line: edge } = theme.obstacle(world.obstacles[other.obstacle].color);
      if (other !== contact) draw(other, { fill: theme.faint, line: edge, width: 1, alpha: 0.6 });
    }
    for (const obstacle of bands) Workspace.struck(context, panel, world.obstacles[obstacle]);
    const touching = new Set(bands.length ? [0] : []);
    Workspace.arm(context, panel, view, world, this.q, { fill: theme.paper, touch: Theme.mixed(theme.infeasible, theme.paper, 0.45), touching, line: theme.ink, width: 1.4, joints: true });
    if (contact) this.drawTouch(context, panel, contact);
  }

  /** Draws the touching features in bold. */
  drawTouch(context, panel, { value, features: [mine, i, other, k], shape, piece }) {
    const [, pose] = Geometry.poses(this.view.model.arm, [this.q1, value]);
    context.strokeStyle = panel.theme.infeasible;
    context.fillStyle = panel.theme.infeasible;
    for (const [kind, index, { core }] of [[mine, i, Geometry.placed(shape, pose)], [other, k, piece]]) {
      const corners = [...Geometry.pointsOf(core)].map((p) => panel.at(p));
      context.lineWidth = 4;
      if (kind === 'side') line(context, [corners[index], corners[(index + 1) % corners.length]]);
      else {
        context.beginPath();
        context.arc(...corners[index], 5, 0, 2 * Math.PI);
        context.fill();
      }
    }
  }

  /** Draws the slice in the configuration space: the blocked intervals of each obstacle, and the contacts. */
  drawSlice(context, panel) {
    const { view, slice: { rows, contacts, bands } } = this;
    const { theme } = panel;
    const [low, high] = view.model.arm.joints[1].domain;
    const stroke = (color, width, from, to) => {
      context.strokeStyle = color;
      context.lineWidth = width;
      line(context, [panel.at([this.q1, from]), panel.at([this.q1, to])]);
    };
    stroke(theme.paper, 7, low, high);
    stroke(bands.length ? theme.infeasible : theme.found, 3, low, high);
    for (const { obstacle, intervals } of bands.length ? [] : rows) {
      for (const [from, to] of intervals) stroke(theme.obstacle(view.world.obstacles[obstacle].color).line, 7, from.value, to.value);
    }
    for (const contact of contacts) {
      const chosen = contact === this.contact;
      context.beginPath();
      context.arc(...panel.at([this.q1, contact.value]), chosen ? 7 : 4.5, 0, 2 * Math.PI);
      context.fillStyle = chosen ? theme.infeasible : theme.paper;
      context.fill();
      context.lineWidth = 2;
      context.strokeStyle = theme.ink;
      context.stroke();
    }
  }

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
      Labels.beside(context, panel, there.map((p, s) => [`b${steps[s].k + 1} \u2212 a${steps[s].i + 1}`, Labels.about(panel.at(p), 6)]));
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
    const lift = (angle) => ([x, y]) => [x + along * (y - near), angle + up * (y - near)];
    const now = 2 * Math.PI * this.part;
    const angles = Array.from({ length: 12 }, (_, k) => (k * Math.PI) / 6);
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
    this.changed();
  }

  /** Fits the panels again after something was moved. */
  settle() {
    this.frame();
    this.view.ready();
  }
}
