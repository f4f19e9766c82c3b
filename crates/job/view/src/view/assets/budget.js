// The budget of errors of a motion: tables of the proven margins of bodies, and of the largest errors of the arm's model.
// Pointing at a row shows where the arm would touch first, and a click keeps it.
'use strict';

class Budget {
  /** Meaning of the errors of the arm's model. */
  static NOTES = { 'base position': 'in any direction', 'base angle': 'about the origin', 'link lengths': 'both at once', 'joint zeros': 'all at once' };

  /** @param {View} view the page whose pictures show the places */
  constructor(view) {
    this.view = view;
    this.root = element('div', { class: 'budget', onkeydown: (event) => this.key(event) });
    /** The rows with a place, in the order of the tables. @type {{ place: PlaceModel, row: HTMLElement, button: HTMLElement }[]} */
    this.rows = [];
    /** @type {?PlaceModel} */
    this.hovered = null;
    /** @type {?PlaceModel} */
    this.kept = null;
    /** @type {?PlaceModel} */
    this.shown = null;
    /** Time to which the page returns. */
    this.before = 0;
    /** The content, as JSON. */
    this.content = '';
  }

  /**
   * Adds the drawing of places to the workspace, once it exists.
   * @param {{ workspace: Panel }} panels
   */
  watch({ workspace }) {
    workspace.overlays.push((context, panel) => this.draw(context, panel));
  }

  /** @param {Model} model the model that the page is going to show */
  update({ budget }) {
    if (this.shown) [this.view.probe, this.view.pinned] = [null, false];
    this.release();
    const content = JSON.stringify(budget ?? null);
    if (content === this.content) return;
    this.content = content;
    this.rows = [];
    const { margins = [], tolerances = [] } = budget ?? {};
    const errors = tolerances.map((tolerance) => this.error(tolerance));
    const size = ({ clearance }) => clearance ?? Infinity;
    const bodies = [...margins].sort((a, b) => (size(a) === size(b) ? 0 : size(a) - size(b))).map((margin) => this.body(margin));
    this.root.replaceChildren(
      element('p', { class: 'about' }, 'How large may a single error be before this motion is no longer free? Each row assumes that nothing else is wrong; all numbers are proven. Point at a row to see where the arm would touch first.'),
      Budget.table('Errors of the arm', ['error of', 'free up to', 'would touch first'], errors),
      Budget.table('Displacement of one body', ['body', 'proven clearance', 'nearest to'], bodies),
    );
  }

  /**
   * Returns a table with a heading.
   * @param {string} title
   * @param {string[]} columns
   * @param {HTMLElement[]} rows
   */
  static table(title, columns, rows) {
    const head = element('thead', {}, element('tr', {}, ...columns.map((name) => element('th', { scope: 'col' }, name))));
    const table = element('table', {}, head, element('tbody', {}, ...rows));
    return element('section', { class: 'box', 'aria-label': title, hidden: !rows.length }, element('h2', {}, title), element('div', { class: 'scroll' }, table));
  }

  /** @param {MarginModel} margin */
  body(margin) {
    const { body, kind, clearance, between } = margin;
    const other = between?.find((name) => name !== body) ?? between?.[0];
    return this.row(margin, body, kind, clearance === null ? '\u2013' : Numbers.length(clearance, 0, Math.floor), other ?? 'meets nothing');
  }

  /** @param {ToleranceModel} tolerance */
  error(tolerance) {
    const { of, unit, error, between } = tolerance;
    const angle = () => `${Numbers.digits((error * 180) / Math.PI, error < 1e-3 ? 2 : 3, Math.floor)}\u00b0`;
    const size = error === null ? 'any' : unit === 'rad' ? angle() : Numbers.length(error, 0, Math.floor);
    return this.row(tolerance, of, Budget.NOTES[of], size, between ? `${between[1]} and ${between[0]}` : 'nothing');
  }

  /**
   * Returns a row. With a place, pointing at it shows the place.
   * @param {PlaceModel} place
   * @param {string} name
   * @param {string} note
   * @param {string} size
   * @param {string} touched
   */
  row(place, name, note, size, touched) {
    const small = (text) => element('small', {}, text);
    const cells = [element('td', { class: 'size' }, size), element('td', {}, touched, place.at ? small(`at ${Numbers.seconds(place.time)}`) : null)];
    const head = (title) => element('th', { scope: 'row' }, title, small(note));
    if (!place.at) return element('tr', {}, head(element('strong', {}, name)), ...cells);
    const isMouse = ({ pointerType }) => pointerType === 'mouse';
    const button = element(
      'button',
      {
        type: 'button', class: 'name', 'aria-pressed': 'false', title: 'show where it would touch',
        onfocus: (event) => event.target.matches(':focus-visible') && this.hover(place),
        onblur: () => this.hover(null),
        onclick: () => this.toggle(place),
      },
      name,
    );
    const row = element('tr', { onpointerenter: (event) => isMouse(event) && this.hover(place), onpointerleave: (event) => isMouse(event) && this.hover(null) }, head(button), ...cells);
    this.rows.push({ place, row, button });
    return row;
  }

  /**
   * Shows a place while the pointer or the focus is on its row.
   * @param {?PlaceModel} place
   */
  hover(place) {
    this.hovered = place;
    this.render();
  }

  /**
   * Keeps a place, or releases it.
   * @param {PlaceModel} place
   */
  toggle(place) {
    this.kept = this.kept === place ? null : place;
    this.hovered = this.kept;
    this.render();
    // On a small screen, the picture is above the visible part of the page.
    const { canvas } = this.view.panels.workspace;
    const { bottom, height } = canvas.getBoundingClientRect();
    if (this.kept && bottom < height / 2) canvas.scrollIntoView({ block: 'nearest', behavior: Settings.reducesMotion ? 'auto' : 'smooth' });
  }

  /**
   * Handles Escape, which releases the place.
   * @param {KeyboardEvent} event
   */
  key(event) {
    if (event.key !== 'Escape' || !this.shown) return;
    this.close();
    event.stopPropagation();
  }

  /** Shows the motion again as it was before. */
  close() {
    [this.hovered, this.kept] = [null, null];
    this.render();
  }

  /** Forgets the place, because the page shows something else. */
  release() {
    [this.hovered, this.kept, this.shown] = [null, null, null];
    this.mark();
  }

  mark() {
    for (const { place, row, button } of this.rows) {
      row.classList.toggle('lit', place === this.shown);
      button.setAttribute('aria-pressed', String(place === this.kept));
    }
  }

  /** Shows the place of the current row, or the motion as it was before. */
  render() {
    const place = this.hovered ?? this.kept;
    const { view, shown } = this;
    this.shown = place;
    this.mark();
    if (place === shown) return;
    if (!shown) {
      view.pause();
      this.before = view.time;
    }
    if (!place) view.examine(null);
    view.seek(place?.time ?? this.before);
    if (place) view.examine(place.at);
  }

  /**
   * Returns the shapes of a body at a place, and the obstacles among them.
   * @param {string} name
   */
  shapes(name) {
    const { view } = this;
    const { world, model: { arm } } = view;
    const { q } = view.probe;
    const movers = (world.movers ?? []).map((mover) => Geometry.moved(mover, view.now));
    const obstacles = [...world.obstacles, ...movers].filter((obstacle) => obstacle.name === name && obstacle.own > 0);
    const at = Geometry.poses(arm, q);
    const parts = arm.links.flatMap((link, k) => link.parts.filter(({ body }) => body === name).map((part) => Geometry.placed(part, at[k])));
    const { payload } = world;
    const carried = payload?.object === name ? payload.pieces.map((piece) => Geometry.placed(piece, Geometry.payloadPose(arm, payload, q, Height.turnedTo(view)))) : [];
    const own = [...parts, ...carried];
    return { obstacles, own, all: [...obstacles.flatMap((obstacle) => obstacle.pieces.slice(0, obstacle.own)), ...own] };
  }

  /**
   * Draws both bodies of the place, and the shortest line between them.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   */
  draw(context, panel) {
    const { view, shown } = this;
    if (!shown || view.probe?.q !== shown.at) return;
    const bodies = shown.between.map((name) => this.shapes(name));
    context.lineWidth = 3;
    context.strokeStyle = panel.theme.accent;
    for (const { obstacles, own } of bodies) {
      for (const obstacle of obstacles) {
        Workspace.outline(context, panel, obstacle);
        context.stroke();
      }
      context.beginPath();
      for (const shape of own) rounded(context, panel, shape);
      context.stroke();
    }
    const [first, second] = bodies;
    const pairs = first.all.flatMap((a) => second.all.map((b) => Geometry.nearest(a, b)));
    const apart = pairs.filter(({ distance }) => distance > 0);
    // Bodies at different heights may overlap in the plane.
    if (!apart.length || apart.length < pairs.length) return;
    const { ends, distance } = apart.reduce((best, pair) => (pair.distance < best.distance ? pair : best));
    Workspace.distance(context, panel, { ends, text: Numbers.length(distance) });
  }
}
