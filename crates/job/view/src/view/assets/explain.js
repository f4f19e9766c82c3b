// The cards of an explanation. Pointing at a card shows the changed world with the path that it opens, and a click keeps
// it.
'use strict';

/** Time in which the arm moves along a path, and the pause at its end, in milliseconds. */
const [EXPLAIN_MOVES, EXPLAIN_RESTS] = [2600, 700];
/** A move of an obstacle by fewer pixels has no arrow. */
const EXPLAIN_ARROW = 14;

class Explain {
  /** @param {View} view the page whose pictures show the cards */
  constructor(view) {
    this.view = view;
    /** @type {?ExplanationModel} */
    this.explanation = null;
    /** The model of the world as it is. @type {Model} */
    this.base = null;
    /** @type {Card | null} */
    this.hovered = null;
    /** @type {Card | null} */
    this.kept = null;
    /** @type {Card | null} */
    this.shown = null;
    /** Configuration of the arm on the path of the shown card; `null` without one. @type {?Point} */
    this.q = null;
    /**
     * Applies the change of a card. `null` on pages that cannot change the world.
     * @type {((card: Card) => void) | null}
     */
    this.apply = null;
    /** The buttons of the cards, in order. @type {HTMLElement[]} */
    this.buttons = [];
    /** Number of the requested frame. */
    this.request = 0;
    this.headline = element('p', { class: 'headline' });
    this.evidence = element('p', { class: 'evidence' });
    this.title = element('h2');
    this.list = element('ul', { class: 'changes' });
    /** The row with the narrowest place, which opens nothing. */
    this.places = element('div', { class: 'places' });
    /** The facts, which repeat in words what the cards show. `null` as long as they are open. @type {HTMLElement | null} */
    this.more = null;
    this.root = element('section', { class: 'explain', 'aria-label': 'Explanation', hidden: true, onkeydown: (event) => this.key(event) }, this.headline, this.evidence, this.title, this.list, this.places);
  }

  /**
   * Adds the drawing of changes to the panels, once they exist.
   * @param {{ workspace: Panel, cspace: Panel }} panels
   * @returns {void}
   */
  watch({ workspace }) {
    workspace.overlays.push((context, panel) => this.draw(context, panel));
  }

  /**
   * Shows the explanation of a model; without one, removes the cards.
   * @param {Model} model the model that the page is going to show
   * @returns {void}
   */
  update(model) {
    this.stop();
    [this.base, this.hovered, this.kept, this.shown] = [model, null, null, null];
    const { explanation = null } = model;
    if (explanation) model.frame = explanation.frame;
    if (explanation === this.explanation) return;
    this.explanation = explanation;
    this.root.hidden = !explanation;
    if (!explanation) return;
    const { headline, evidence, title, cards } = explanation;
    // On a page by itself, the headline is the title of the page.
    const said = headline.toLowerCase().replace(/\.$/u, '');
    this.headline.textContent = model.title[0]?.toLowerCase().includes(said) ? '' : headline;
    this.evidence.textContent = evidence;
    this.title.textContent = title;
    this.title.hidden = cards.every((card) => card.is_place);
    this.buttons = cards.map((card) => this.button(card));
    const items = cards.flatMap((card, k) => (card.is_place ? [] : [element('li', {}, this.buttons[k], this.applyButton(card))]));
    this.list.replaceChildren(...items);
    this.list.hidden = !items.length;
    const places = this.buttons.filter((_, k) => cards[k].is_place);
    this.places.replaceChildren(...places);
    this.places.hidden = !places.length;
    this.fold();
  }

  /**
   * Removes the cards, and shows the original world.
   * @returns {void}
   */
  clear() {
    if (!this.explanation) return;
    [this.hovered, this.kept] = [null, null];
    this.render();
    [this.base.stuck, this.base.explanation, this.explanation] = [null, null, null];
    this.root.hidden = true;
  }

  /**
   * Closes the facts below the pictures, because cards and pictures say the same.
   * @returns {void}
   */
  fold() {
    const { facts } = this.view.parts;
    if (this.more || !facts.parentElement) return;
    this.more = element('details', { class: 'folded' }, element('summary', {}, 'Details'));
    facts.replaceWith(this.more);
    this.more.append(facts);
  }

  /**
   * Creates the button of a card.
   * @param {Card} card
   * @returns {HTMLElement}
   */
  button(card) {
    const readable = (text) => text.replace(/(^|[\s(])-(?=\d)/g, '$1\u2212');
    const line = (sign, text) => (text ? element('span', { class: `line ${sign}` }, icon(sign), element('span', {}, readable(text))) : null);
    return element(
      'button',
      {
        type: 'button', class: card.is_place ? 'change place' : 'change', 'aria-pressed': 'false',
        onpointerenter: ({ pointerType }) => pointerType === 'mouse' && this.hover(card),
        onpointerleave: ({ pointerType }) => pointerType === 'mouse' && this.hover(null),
        onfocus: (event) => event.target.matches(':focus-visible') && this.hover(card),
        onblur: () => this.hover(null),
        onclick: () => this.toggle(card),
      },
      element('span', { class: 'title' }, readable(card.title)),
      line('found', card.opens),
      line('infeasible', card.closed),
      card.note ? element('span', { class: 'line' }, readable(card.note)) : null,
      card.is_place ? null : element('span', { class: 'preview', 'aria-hidden': 'true' }, 'Preview \u203a'),
    );
  }

  /**
   * Creates the button that applies a change, on pages that can.
   * @param {Card} card
   * @returns {HTMLElement | null}
   */
  applyButton(card) {
    if (!this.apply || !card.edit) return null;
    return element('button', { type: 'button', class: 'button apply', 'aria-label': `Apply: ${card.title}`, onclick: () => this.apply(card) }, 'Apply');
  }

  /** Returns the index of the world that the explanation is about: that of the last step. */
  get place() {
    const { motions } = this.base;
    return motions[motions.length - 1]?.world ?? 0;
  }

  /**
   * Shows a card while the pointer or the focus is on it.
   * @param {Card | null} card
   * @returns {void}
   */
  hover(card) {
    this.hovered = card;
    this.render();
  }

  /**
   * Keeps a card, or releases it.
   * @param {Card} card
   * @returns {void}
   */
  toggle(card) {
    this.kept = this.kept === card ? null : card;
    this.hovered = this.kept;
    this.render();
  }

  /**
   * Handles Escape, which releases the card.
   * @param {KeyboardEvent} event
   * @returns {void}
   */
  key(event) {
    if (event.key !== 'Escape' || !this.shown) return;
    [this.hovered, this.kept] = [null, null];
    this.render();
    event.stopPropagation();
  }

  /**
   * Shows the chosen card in the panels, or the original world.
   * @returns {void}
   */
  render() {
    // The pointer may leave a card after an edit has removed it.
    if (!this.explanation) return;
    const { view } = this;
    const card = this.hovered ?? this.kept;
    this.buttons.forEach((button, k) => {
      const own = this.explanation.cards[k];
      button.setAttribute('aria-pressed', String(own === this.kept));
      button.classList.toggle('shown', own === card);
    });
    if (card === this.shown) return;
    this.stop();
    this.shown = card;
    if (view.mode === 'learn') view.switchTo('move');
    if (card && this.base.motions.length > 1) this.beforeLastStep();
    view.model = card?.path ? this.changed(card) : this.base;
    view.traces = null;
    const { cspace } = view.panels;
    [cspace.x, cspace.y] = view.model.arm.joints.map((joint) => joint.domain);
    for (const panel of Object.values(view.panels)) {
      panel.layout();
      panel.dirty = true;
    }
    view.examine(card?.at ?? null);
    view.describe();
    if (card?.path) this.start(card);
  }

  /** Shows the time before the last step of a task, which the explanation is about. */
  beforeLastStep() {
    const { view } = this;
    if (view.mode !== 'move') view.switchTo('move');
    view.pause();
    view.seek(view.duration);
  }

  /**
   * Returns the model of the world with the change of a card.
   * @param {Card} card
   * @returns {Model}
   */
  changed(card) {
    const { base, view } = this;
    const { theme } = view.panels.workspace;
    const { obstacle, changed, removed = [], c_obstacles: own = [], domains, path } = card;
    const isGone = (index) => removed.includes(index);
    const first = base.worlds[this.place];
    const obstacles = first.obstacles.map((one, index) => {
      if (index === obstacle && changed) return { ...changed, color: one.color };
      return isGone(index) ? { ...one, outline: 'pieces', own: 0, pieces: [] } : one;
    });
    const keepsContours = ({ obstacle: index }) => !isGone(index) && !(index === obstacle && changed) && !(own.length && !changed);
    const world = {
      ...first,
      obstacles,
      c_obstacles: [...first.c_obstacles.filter(keepsContours), ...own],
      pairs: first.pairs.filter(([, , index, , end]) => end <= obstacles[index].pieces.length),
      proof: [],
    };
    // Paths of a task end with the number of their step.
    const step = base.motions.length > 1 ? parseInt(base.motions[base.motions.length - 1].label, 10) : undefined;
    const opened = { ...path, world: this.place, color: theme.found, step };
    const before = base.paths.map((one) => ({ ...one, color: theme.grey, width: 1.6, dash: [5, 4] }));
    const joint = (k) => ({ ...base.arm.joints[k], domain: domains?.[k] ?? base.arm.joints[k].domain });
    return { ...base, arm: { ...base.arm, joints: [joint(0), joint(1)] }, worlds: base.worlds.map((one, k) => (k === this.place ? world : one)), paths: base.motions.length > 1 ? [...base.paths, opened] : [opened, ...before], stuck: null };
  }

  /**
   * Moves the arm along the path of a card, again and again. For readers who prefer reduced motion, it stays in the
   * middle of the path.
   * @param {Card} card
   * @returns {void}
   */
  start(card) {
    const points = [...Geometry.pointsOf(card.path.points)];
    const parts = points.slice(1).map((to, i) => Math.hypot(to[0] - points[i][0], to[1] - points[i][1]));
    const total = parts.reduce((sum, part) => sum + part, 0);
    const at = (share) => {
      let left = share * total;
      for (const [i, part] of parts.entries()) {
        if (left <= part && part > 0) return points[i].map((x, k) => x + ((points[i + 1][k] - x) * left) / part);
        left -= part;
      }
      return points[points.length - 1];
    };
    const show = (share) => {
      this.q = at(share);
      for (const panel of Object.values(this.view.panels)) panel.draw();
    };
    if (Settings.reducesMotion) {
      show(0.5);
      return;
    }
    let begun = null;
    const step = (now) => {
      begun ??= now;
      const time = (now - begun) % (EXPLAIN_MOVES + EXPLAIN_RESTS);
      const share = Math.min(1, time / EXPLAIN_MOVES);
      // Slow at both ends.
      show(share * share * (3 - 2 * share));
      this.request = requestAnimationFrame(step);
    };
    show(0);
    this.request = requestAnimationFrame(step);
  }

  /**
   * Ends the motion of the arm.
   * @returns {void}
   */
  stop() {
    cancelAnimationFrame(this.request);
    this.q = null;
  }

  /**
   * Draws the change in the workspace: the obstacle before it, and an arrow to its new place.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @returns {void}
   */
  draw(context, panel) {
    const { shown, base } = this;
    if (!shown?.path) return;
    const { theme } = panel;
    const { obstacles } = base.worlds[this.place];
    const before = shown.changed ? [shown.obstacle] : shown.removed ?? [];
    for (const index of before) {
      Workspace.outline(context, panel, obstacles[index]);
      context.setLineDash([6, 4]);
      context.lineWidth = 1.6;
      context.strokeStyle = theme.grey;
      context.stroke();
      context.setLineDash([]);
    }
    if (!shown.changed) return;
    Workspace.outline(context, panel, shown.changed);
    context.lineWidth = 2.4;
    context.strokeStyle = theme.found;
    context.stroke();
    this.arrow(context, theme, Workspace.middle(panel, obstacles[shown.obstacle]), Workspace.middle(panel, shown.changed));
  }

  /**
   * Draws an arrow from the old place of an obstacle to the new one.
   * @param {CanvasRenderingContext2D} context
   * @param {Theme} theme
   * @param {Point} from in pixels
   * @param {Point} to in pixels
   * @returns {void}
   */
  arrow(context, theme, from, to) {
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    // A removed obstacle has no place.
    if (!(Math.hypot(dx, dy) >= EXPLAIN_ARROW)) return;
    const angle = Math.atan2(dy, dx);
    const wing = (turn) => [to[0] + 10 * Math.cos(angle + turn), to[1] + 10 * Math.sin(angle + turn)];
    for (const [width, color] of [[6, theme.paper], [2.6, theme.found]]) {
      [context.lineWidth, context.strokeStyle] = [width, color];
      line(context, [from, to]);
      line(context, [wing(2.6), to, wing(-2.6)]);
    }
  }
}
