// The side view of a task's motion: the height of the tool along the path of its tip. Arches look like arches.
'use strict';

class SideView {
  /** Number of places at which a motion is drawn. */
  static PLACES = 160;
  /** Room above and below the motion, as a share of the stroke. */
  static ROOM = 0.14;
  /** Size of the carried object, in pixels. */
  static OBJECT = [22, 9];

  /** @param {View} view */
  constructor(view) {
    this.view = view;
    const canvas = element('canvas', { role: 'img', 'aria-label': 'Height of the tool over the path of its tip' });
    const tab = (name, text) => element('button', { type: 'button', class: 'button', 'data-right': name, onclick: () => this.choose(name) }, text);
    /** Chooses between the side view and the configuration space. */
    this.choice = element('span', { class: 'modes right-choice', role: 'group', 'aria-label': 'Right picture', hidden: true }, tab('height', 'Side view'), tab('space', 'Space of this step'));
    this.caption = element('figcaption', {}, 'Height of the tool');
    this.root = element('figure', { class: 'side-view', hidden: true }, this.caption, canvas);
    this.chosen = 'height';
    /** Places of each motion: time, way and height. @type {Map<MotionModel, [number, number, number][]>} */
    this.places = new Map();
    /** @type {?MotionModel} */
    this.shown = null;
    this.panel = new Panel(canvas, {
      x: [0, 1],
      y: [-1, 0],
      titles: ['path of the tip (m)', 'height (mm)'],
      margins: [66, 10, 8, 40],
      still: (context, panel) => this.isOffered && this.draw(context, panel),
      moving: (context, panel) => this.isOffered && this.drawNow(context, panel),
    });
  }

  /** Returns true if the page has a side view: of tasks whose tool is lowered. */
  get isOffered() {
    const { model } = this.view;
    return Boolean(model?.height && model.motions.length > 1 && model.clock);
  }

  /** Returns true if the side view takes the place of the configuration space. */
  get isShown() {
    return this.isOffered && this.view.drawn === 'move' && this.chosen === 'height';
  }

  choose(name) {
    this.chosen = name;
    this.show();
    this.view.refresh();
  }

  /** Shows the side view or the configuration space. */
  show() {
    const { view, isShown } = this;
    this.root.hidden = !isShown;
    this.choice.hidden = !(this.isOffered && view.drawn === 'move');
    view.parts.panels.classList.toggle('from-the-side', isShown);
    for (const button of this.choice.children) button.setAttribute('aria-pressed', String(/** @type {HTMLElement} */ (button).dataset.right === this.chosen));
    if (isShown) this.follow();
  }

  /** Fits the panel to another model. */
  fit() {
    this.places.clear();
    this.shown = null;
    this.show();
  }

  /** Returns the places of a motion. */
  placesOf(motion) {
    const known = this.places.get(motion);
    if (known) return known;
    const { clock, motions, height, arm } = this.view.model;
    const until = motions[motions.indexOf(motion) + 1]?.from ?? clock.time[clock.time.length - 1];
    /** @type {[number, number, number][]} */
    const found = [];
    let [way, before] = [0, null];
    for (let k = 0; k <= SideView.PLACES; k += 1) {
      const time = motion.from + ((until - motion.from) * k) / SideView.PLACES;
      const tip = Geometry.tipAt(arm, Geometry.moving(clock, time).position);
      if (before) way += Math.hypot(tip[0] - before[0], tip[1] - before[1]);
      before = tip;
      found.push([time, way, Timeline.valueAt(height.motion, time)]);
    }
    this.places.set(motion, found);
    return found;
  }

  /** Shows the motion of the current time. */
  follow() {
    const { view, panel } = this;
    const { motion } = view;
    if (motion === this.shown || !this.isOffered) return;
    this.shown = motion;
    const places = this.placesOf(motion);
    const way = Math.max(places[places.length - 1][1], 1e-3);
    const values = view.model.height.motion.filter((_, index) => index % 2 === 1);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const room = SideView.ROOM * (high - low || 1);
    panel.x = [-0.06 * way, 1.06 * way];
    panel.y = [low - room, high + room];
    this.caption.textContent = motion.label;
    panel.canvas.setAttribute('aria-label', `Height of the tool over the path of its tip, ${motion.label}: from ${low} to ${high} mm on ${Numbers.length(way)}`);
    panel.layout();
    panel.dirty = true;
  }

  /** @param {CanvasRenderingContext2D} context @param {Panel} panel */
  draw(context, panel) {
    const { view } = this;
    const { theme, rect } = panel;
    const values = view.model.height.motion.filter((_, index) => index % 2 === 1);
    [context.lineWidth, context.strokeStyle] = [1, theme.grey];
    for (const value of [Math.min(...values), Math.max(...values)]) {
      const [, y] = panel.at([0, value]);
      line(context, [[rect.x, y], [rect.x + rect.width, y]]);
      // The upper one is the height of the raised tool.
      context.setLineDash([2, 4]);
    }
    context.setLineDash([]);
    if (!this.shown) return;
    const held = view.model.worlds[this.shown.world].payload;
    const spots = this.placesOf(this.shown).map(([, way, height]) => panel.at([way, height]));
    for (const [width, color] of [[5.5, theme.paper], [2.6, held ? theme.obstacle(held.color).line : theme.ink]]) {
      [context.lineWidth, context.strokeStyle] = [width, color];
      line(context, spots);
    }
  }

  /** Draws the tool and what it carries at the current time. @param {CanvasRenderingContext2D} context @param {Panel} panel */
  drawNow(context, panel) {
    const { view } = this;
    const { theme, rect } = panel;
    const { motion } = view;
    if (motion !== this.shown) this.follow();
    const places = this.placesOf(motion);
    const next = Math.max(1, places.findIndex(([time]) => time >= view.time));
    const [[t0, x0, y0], [t1, x1, y1]] = [places[next - 1], places[next]];
    const part = Math.min(1, Math.max(0, (view.time - t0) / Math.max(t1 - t0, 1e-9)));
    const [x, y] = panel.at([x0 + (x1 - x0) * part, y0 + (y1 - y0) * part]);
    [context.lineWidth, context.strokeStyle] = [3, theme.accent];
    line(context, [[x, rect.y], [x, y]]);
    const held = view.world.payload;
    const [width, height] = SideView.OBJECT;
    if (held) {
      const { fill, line: edge } = theme.obstacle(held.color);
      [context.fillStyle, context.strokeStyle, context.lineWidth] = [fill, edge, 1.4];
      context.fillRect(x - width / 2, y, width, height);
      context.strokeRect(x - width / 2, y, width, height);
    }
    context.beginPath();
    context.arc(x, y, 4, 0, 2 * Math.PI);
    [context.fillStyle, context.strokeStyle, context.lineWidth] = [theme.accent, theme.paper, 1.5];
    context.fill();
    context.stroke();
  }
}
