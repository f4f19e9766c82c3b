// The figure of a slice: the arm at the contacts of link 2 for one value of joint 1, and the blocked intervals of joint 2.
'use strict';

class SliceFigure {
  /** Duration of the sweep over all values of joint 1, in seconds. */
  static SECONDS = 12;

  /** Number of slices from which the first one to show is chosen: the one with the most contacts. */
  static TRIED = 25;

  /** Layers that the figure shows. */
  static LAYERS = new Set(['c-obstacles', 'names', 'regions']);

  /** @param {Learn} learn */
  constructor(learn) {
    this.learn = learn;
    this.view = learn.view;
    /** Number of the chosen contact. */
    this.chosen = 0;
    /** The slice that was computed last. @type {any} */
    this.known = null;
  }

  /**
   * Returns true if a model has slices.
   * @param {Model} model
   * @returns {boolean}
   */
  static isOffered({ worlds: [world] }) {
    return Boolean(world?.pairs.some(([link]) => link === 1));
  }

  /** Returns the time of the slice with the most contacts. */
  get richest() {
    const { view } = this;
    const now = view.time;
    const contacts = (time) => {
      view.time = time;
      return this.slice.bands.length ? 0 : this.slice.contacts.length;
    };
    const times = Array.from({ length: SliceFigure.TRIED }, (_, k) => (SliceFigure.SECONDS * (k + 0.5)) / SliceFigure.TRIED);
    const counts = times.map(contacts);
    view.time = now;
    return times[counts.indexOf(Math.max(...counts))];
  }

  /** Returns the part of joint 1's range that is below the slice, from 0 to 1. */
  get part() {
    return this.view.time / SliceFigure.SECONDS;
  }

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
    this.view.seek((SliceFigure.SECONDS * (q1 - low)) / (high - low));
    const distance = ({ value }) => Math.abs(value - q2);
    this.choose(this.slice.contacts.reduce((best, c, i, all) => (distance(c) < distance(all[best]) ? i : best), 0));
  }

  choose(contact) {
    this.chosen = contact;
    this.learn.describe();
    for (const panel of Object.values(this.view.panels)) panel.draw();
  }

  /** Chooses a contact by its button. The list is built again, so the new button gets the focus. */
  pick(contact) {
    this.choose(contact);
    this.learn.parts.tables.querySelectorAll('button')[contact].focus();
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

  // Texts.

  /** Returns the text beside the scrubber. */
  get clock() {
    return `${this.view.model.arm.joints[0].name} ${this.value(0, this.q1)}`;
  }

  get caption() {
    const { joints } = this.view.model.arm;
    const { contacts, bands } = this.slice;
    const names = bands.map((index) => this.view.world.obstacles[index].name).join(', ');
    if (bands.length) return `Link 1 touches ${names} at every value of ${joints[1].name}`;
    return `Contacts of ${joints[1].name} here: ${contacts.length || 'none'}`;
  }

  /** Returns the table of the contacts. */
  tables() {
    const { contacts } = this.slice;
    const rows = contacts.map((contact, index) => element(
      'tr',
      { 'aria-current': contact === this.contact ? 'true' : undefined },
      element('td', {}, element('button', { type: 'button', class: 'button', onclick: () => this.pick(index) }, this.value(1, contact.value))),
      element('td', {}, this.touching(contact)),
    ));
    return rows.length ? [Learn.table('Contacts of this slice', [this.view.model.arm.joints[1].name, 'touching features'], rows)] : [];
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
}
