// Editing: by pointer in both panels, and by keys.
'use strict';

/** Distance within which a pointer takes something, in pixels: a mouse, a pen, a finger. */
const GRASP_RADIUS = { mouse: 9, pen: 12, touch: 20 };
/** Longest time between the taps of a double tap, in milliseconds. */
const DOUBLE_TAP_TIME = 350;
/** Radius of the rings around items that can be dragged, on the first visit, in pixels. */
const HINT_RADIUS = 19;

class Editor {
  /**
   * `changed(final)` is called when the scene has changed, and `selected()` when the selection has changed.
   * `configurations()` returns the start and goals of the last answer; `blocked()` those that are not free, each with
   * the obstacles in contact. `isDrawn(obstacle)` returns whether an obstacle is drawn at its current place. `frames`
   * collects work for the next picture of the screen.
   * @param {View} view
   * @param {{ changed: (final: boolean) => void, selected: () => void, configurations: () => { start?: Point, goals: Point[] }, blocked: () => any[], isDrawn: (obstacle: any) => boolean, frames: Frames }} handlers
   */
  constructor(view, { changed, selected, configurations, blocked, isDrawn, frames }) {
    this.view = view;
    this.changed = changed;
    this.selected = selected;
    this.configurations = configurations;
    this.blocked = blocked;
    this.isDrawn = isDrawn;
    this.frames = frames;
    /** @type {?Scene} */
    this.scene = null;
    /** @type {?{ kind: 'obstacle' | 'start' | 'goal', index?: number, corner?: number | 'rim' }} */
    this.selection = null;
    /** The thing that the pointer has taken: its kind, the panel, and where it was. @type {any} */
    this.held = null;
    view.tool = {
      down: (panel, value, event) => this.down(panel, value, event),
      move: (panel, value, event) => this.move(panel, value, event),
      up: (panel, value, event) => this.up(panel, value, event),
      tap: (panel) => this.tap(panel),
      grasps: (panel, value, event) => Boolean(this.itemUnder(panel, value, event)),
    };
    /** True if nothing was ever dragged in this browser. The page then says what can be dragged. */
    this.isNew = !Keep.hasDragged();
    /** The invitation to drag, in the caption of the workspace: there it covers nothing. */
    this.hint = element('span', { class: 'hint' }, 'drag obstacles or goal');
    if (this.isNew) view.panels.workspace.canvas.parentElement.querySelector('figcaption').append(this.hint);
    /**
     * True if the corners of the selected obstacle can be dragged. On touch screens and small ones this is a mode of its
     * own, so that fingers do not grab corners by accident.
     */
    this.editsCorners = !Editor.hasCornerMode.matches;
    /** The last tap of a finger that moved nothing. */
    this.tapped = { at: -Infinity };
    const { workspace, cspace } = view.panels;
    workspace.overlays.push((context, panel) => this.drawWorkspace(context, panel));
    cspace.overlays.push((context, panel) => this.drawCSpace(context, panel));
    workspace.canvas.addEventListener('dblclick', (event) => this.insertCorner(workspace.value(workspace.spot(event)), workspace));
    for (const panel of [workspace, cspace]) panel.canvas.addEventListener('keydown', (event) => this.key(event, panel), true);
  }

  editScene(scene) {
    this.scene = scene;
    this.held = null;
    this.frames.drop('drag');
    // Tasks cannot be edited.
    this.hint.hidden = scene.world.has_steps;
    this.select(null);
  }

  select(selection) {
    this.selection = selection;
    this.selected();
    this.redraw();
  }

  redraw() {
    for (const panel of Object.values(this.view.panels)) panel.draw();
  }

  /** Directs keys to the workspace. */
  focus() {
    this.view.panels.workspace.canvas.focus({ preventScroll: true });
  }

  get obstacle() {
    return this.selection?.kind === 'obstacle' ? this.scene.obstacles[this.selection.index] : null;
  }

  /** Switches dragging of corners on or off. */
  setCornerMode(isOn) {
    this.editsCorners = isOn;
    this.selected();
    this.redraw();
  }

  // Places.

  get arm() {
    return this.view.model.arm;
  }

  get start() {
    return this.scene.start?.joints ?? this.configurations().start ?? this.view.model.start;
  }

  get goal() {
    const { goal } = this.scene;
    return goal?.joints ?? this.view.ends()[0] ?? this.configurations().goals[0];
  }

  /** Returns the tip at the start and at the goal. */
  get tips() {
    const { start, goal, arm } = this;
    const target = this.scene.goal?.tip ?? (goal ? Geometry.tipAt(arm, goal) : null);
    return { start: start && Geometry.tipAt(arm, start), goal: target };
  }

  // The pointer.

  /** Returns the item that a pointer at a place of the workspace would take. */
  itemAt(panel, value, event) {
    const near = GRASP_RADIUS[event.pointerType] ?? GRASP_RADIUS.mouse;
    const reach = near / panel.pixels;
    const apart = (p) => Math.hypot(p[0] - value[0], p[1] - value[1]);
    const shape = this.obstacle?.shape;
    if (shape && this.editsCorners) {
      const { index } = this.selection;
      const corners = Shapes.corners(shape) ?? [];
      const distances = corners.map(apart);
      const least = Math.min(...distances);
      if (least <= reach) return { kind: 'obstacle', index, corner: distances.indexOf(least) };
      if (shape.circle && Math.abs(apart(shape.circle.center) - shape.circle.radius) <= reach) return { kind: 'obstacle', index, corner: 'rim' };
    }
    const { tips } = this;
    if (tips.goal && apart(tips.goal) <= 1.3 * reach) return { kind: 'goal' };
    if (tips.start && apart(tips.start) <= 1.3 * reach) return { kind: 'start' };
    for (let index = this.scene.obstacles.length - 1; index >= 0; index -= 1) {
      const { shape: other } = this.scene.obstacles[index];
      if (other && Shapes.holds(other, value, reach / 2)) return { kind: 'obstacle', index, corner: null };
    }
    return null;
  }

  /** Returns the item that a pointer would take in the configuration space. */
  configurationAt(panel, event) {
    const near = 1.5 * (GRASP_RADIUS[event.pointerType] ?? GRASP_RADIUS.mouse);
    const [x, y] = panel.spot(event);
    const is = (q) => q && Math.hypot(...[0, 1].map((k) => CSpace.place(this.view, panel, q)[k] - [x, y][k])) <= near;
    if (is(this.goal)) return { kind: 'goal' };
    return is(this.start) ? { kind: 'start' } : null;
  }

  /** Returns the item that a pointer in one of the panels would take. */
  itemUnder(panel, value, event) {
    if (!this.scene || this.scene.world.has_steps) return null;
    return panel === this.view.panels.workspace ? this.itemAt(panel, value, event) : this.configurationAt(panel, event);
  }

  down(panel, value, event) {
    if (!this.scene || this.scene.world.has_steps || event.button > 0) return false;
    const found = this.itemUnder(panel, value, event);
    if (!found) {
      // A finger may be about to scroll.
      if (event.pointerType === 'mouse') this.tap(panel);
      return false;
    }
    this.view.pause();
    this.view.examine(null);
    this.view.seek(0);
    panel.canvas.focus({ preventScroll: true });
    this.held = { panel, from: value, shape: this.scene.obstacles[found.index]?.shape, moved: false, ...found };
    this.select(found);
    return true;
  }

  /** Handles a click or tap on nothing. */
  tap(panel) {
    if (panel === this.view.panels.workspace && this.selection) this.select(null);
  }

  move(panel, value, event) {
    if (!this.held) {
      if (event.pointerType === 'mouse') panel.canvas.style.cursor = this.itemUnder(panel, value, event) ? 'grab' : '';
      return false;
    }
    if (this.held.panel !== panel) return true;
    if (!this.held.moved) panel.canvas.style.cursor = 'grabbing';
    this.held.moved = true;
    // A mouse may report several places per picture of the screen.
    this.held.next = value;
    this.frames.request('drag', () => {
      this.held.next = null;
      this.moveHeldTo(value);
      this.changed(false);
    });
    return true;
  }

  up(panel, value, event) {
    if (!this.held) return false;
    const { moved, next } = this.held;
    // The last place of a drag, which waits for the next picture. (A cancelled touch has no place of its own.)
    this.frames.drop('drag');
    if (next) this.moveHeldTo(next);
    this.held.panel.canvas.style.cursor = '';
    this.held = null;
    if (moved && this.isNew) {
      this.isNew = false;
      this.hint.remove();
      Keep.recordDrag();
    }
    if (moved) this.changed(true);
    else if (event.pointerType === 'touch') this.detectDoubleTap(panel, value);
    return true;
  }

  /** Detects two taps of a finger as a double click. Browsers do not report one if it begins on a handle. */
  detectDoubleTap(panel, value) {
    const now = performance.now();
    const isSecond = now - this.tapped.at < DOUBLE_TAP_TIME && panel === this.view.panels.workspace && this.editsCorners;
    this.tapped = { at: isSecond ? -Infinity : now };
    if (isSecond) this.insertCorner(value, panel);
  }

  /** Moves the grasped item to a place. */
  moveHeldTo(value) {
    const { kind, index, corner, shape, from, panel } = this.held;
    const inWorkspace = panel === this.view.panels.workspace;
    if (kind === 'obstacle') {
      const of = this.scene.obstacles[index];
      if (corner === 'rim') {
        const { center } = shape.circle;
        const radius = Math.max(1e-3, rounded4(Math.hypot(value[0] - center[0], value[1] - center[1])));
        of.shape = { circle: { center, radius } };
      } else if (corner !== null) {
        of.shape = Shapes.cornered(shape, Shapes.corners(of.shape).map((p, i) => (i === corner ? roundedPoint(value) : p)));
      } else {
        of.shape = Shapes.moved(shape, [value[0] - from[0], value[1] - from[1]]);
      }
    } else if (inWorkspace) {
      this.placeTip(kind, value);
    } else {
      this.placeConfiguration(kind, value);
    }
    // The configuration space changes with the next answer.
    this.frames.draw(...(inWorkspace ? [panel] : Object.values(this.view.panels)));
  }

  placeTip(kind, value) {
    if (kind === 'goal') this.scene.goal = { tip: roundedPoint(value) };
    else this.scene.start = { tip: roundedPoint(value), near: this.start };
  }

  placeConfiguration(kind, value) {
    this.scene[kind] = { joints: this.arm.joints.map((joint, k) => rounded4(Editor.inDomain(joint, value[k]))) };
  }

  /** Returns the nearest value in the domain of a joint, or the same angle within a turn. */
  static inDomain(joint, value) {
    const [low, high] = joint.domain;
    return joint.circle ? Geometry.wrap(joint, value) : Math.min(high, Math.max(low, value));
  }

  // Exact coordinates, from the inspector.

  setShape(shape) {
    this.obstacle.shape = shape;
    this.finish();
  }

  setTip(kind, tip) {
    this.scene[kind] = kind === 'goal' ? { tip } : { tip, near: this.start };
    this.finish();
  }

  setConfiguration(kind, q) {
    this.scene[kind] = { joints: this.arm.joints.map((joint, k) => Editor.inDomain(joint, q[k])) };
    this.finish();
  }

  selectCorner(corner) {
    if (this.obstacle && this.selection.corner !== corner) this.select({ ...this.selection, corner });
  }

  finish() {
    this.redraw();
    this.changed(true);
  }

  // Buttons and keys.

  /** Returns a place for a new obstacle that leaves start and goal free and touches no other one, if there is one. */
  findRoom(make) {
    const { reach } = this.scene.world;
    const { base, links } = this.arm;
    const configurations = [this.start, ...this.configurations().goals].filter(Boolean);
    const parts = configurations.flatMap((q) => {
      const at = Geometry.poses(this.arm, q);
      return links.flatMap((link, k) => link.parts.map((part) => Geometry.placed(part, at[k])));
    });
    const others = this.scene.obstacles.flatMap(({ shape }) => (shape ? Shapes.pieces(shape) : []));
    const isApart = (piece, from, least) => from.every((other) => Geometry.separation(other, piece) > least);
    let first = null;
    for (const share of [0.7, 0.5, 0.9, 1.2]) {
      for (let turn = 0; turn < 16; turn += 1) {
        const angle = Math.PI / 2 + (turn % 2 ? -1 : 1) * Math.ceil(turn / 2) * (Math.PI / 8);
        const shape = make([base[0] + share * reach * Math.cos(angle), base[1] + share * reach * Math.sin(angle)].map(rounded4));
        first ??= shape;
        if (Shapes.pieces(shape).every((piece) => isApart(piece, parts, 0.02 * reach) && isApart(piece, others, 0))) return shape;
      }
    }
    return first;
  }

  add(kind) {
    const size = rounded4(this.scene.world.reach / 12);
    const makers = {
      polygon: ([x, y]) => ({ polygon: [[x - size, y - size], [x + size, y - size], [x + size, y + size], [x - size, y + size]].map(roundedPoint) }),
      circle: (center) => ({ circle: { center, radius: size } }),
      wall: ([x, y]) => ({ polyline: [[x - size, y], [x + size, y]].map(roundedPoint) }),
    };
    const index = this.scene.add(kind === 'polygon' ? 'block' : kind === 'circle' ? 'disc' : 'wall', this.findRoom(makers[kind]));
    this.select({ kind: 'obstacle', index, corner: null });
    // Arrow keys move the new obstacle, and Delete removes it.
    this.focus();
    this.changed(true);
  }

  insertCorner(value, panel) {
    const { obstacle } = this;
    if (!obstacle?.shape || obstacle.shape.circle) return;
    const corners = Shapes.corners(obstacle.shape);
    let side = value ? Shapes.nearestSide(obstacle.shape, value) : null;
    if (value && side.distance * panel.pixels > GRASP_RADIUS.touch) return;
    if (!side) {
      /** @param {number[]} side */
      const length = ([a, b]) => Math.hypot(corners[b][0] - corners[a][0], corners[b][1] - corners[a][1]);
      const [a, b] = Shapes.sides(obstacle.shape).reduce((best, s) => (length(s) > length(best) ? s : best));
      side = { distance: 0, after: a, at: [0, 1].map((k) => (corners[a][k] + corners[b][k]) / 2) };
    }
    obstacle.shape = Shapes.cornered(obstacle.shape, corners.toSpliced(side.after + 1, 0, roundedPoint(side.at)));
    this.select({ ...this.selection, corner: side.after + 1 });
    this.changed(true);
  }

  /** Deletes the selected corner, or the selected obstacle. */
  remove() {
    const { obstacle, selection } = this;
    if (!obstacle) return;
    const corners = Shapes.corners(obstacle.shape);
    const least = obstacle.shape?.polygon ? 3 : 2;
    if (Number.isInteger(selection.corner) && corners.length > least) {
      obstacle.shape = Shapes.cornered(obstacle.shape, corners.toSpliced(selection.corner, 1));
      this.select({ ...selection, corner: null });
    } else {
      this.scene.obstacles.splice(selection.index, 1);
      this.select(null);
    }
    this.changed(true);
  }

  /** Deletes the selection if this key event asks for it. Returns true if so. */
  deletes(event) {
    if (!this.obstacle || !['Delete', 'Backspace'].includes(event.key) || !Settings.hasShortcuts) return false;
    event.preventDefault();
    event.stopPropagation();
    this.remove();
    return true;
  }

  key(event, panel) {
    if (!this.selection || event.ctrlKey || event.metaKey || event.altKey) return;
    const directions = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] };
    const direction = directions[event.key];
    const { obstacle } = this;
    if (direction) this.nudge(direction, event.shiftKey ? 10 : 1, panel);
    else if (this.deletes(event)) return;
    else if (event.key === 'c' && Settings.hasShortcuts && obstacle?.shape && !obstacle.shape.circle) {
      const n = Shapes.corners(obstacle.shape).length;
      const next = this.selection.corner === null ? 0 : Number(this.selection.corner) + 1;
      this.select({ ...this.selection, corner: next < n ? next : null });
    } else if (event.key === 'Escape') this.select(null);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Handles arrow keys: they move by five millimetres for an arm of a metre, or by half a degree. */
  nudge([dx, dy], times, panel) {
    const { kind, index, corner } = this.selection;
    const inWorkspace = panel === this.view.panels.workspace;
    const step = times * (inWorkspace ? rounded4(this.scene.world.reach / 200) : Math.PI / 360);
    if (kind === 'obstacle') {
      const { shape } = this.scene.obstacles[index];
      if (!shape || !inWorkspace) return;
      this.held = { kind, index, corner, shape, from: [0, 0], panel };
      const at = Number.isInteger(corner) ? Shapes.corners(shape)[corner] : [0, 0];
      if (corner === 'rim') {
        const { center, radius } = shape.circle;
        this.moveHeldTo([center[0] + Math.max(step, radius + (dx + dy) * step), center[1]]);
      } else this.moveHeldTo([at[0] + dx * step, at[1] + dy * step]);
    } else {
      const at = inWorkspace ? this.tips[kind] : this[kind];
      if (!at) return;
      this.held = { kind, from: at, panel };
      this.moveHeldTo([at[0] + dx * step, at[1] + dy * step]);
    }
    this.held = null;
    this.changed(true);
  }

  // Drawing.

  drawWorkspace(context, panel) {
    if (!this.scene || this.scene.world.has_steps) return;
    const { theme } = panel;
    const { tips, selection, obstacle } = this;
    for (const other of this.scene.obstacles) if (other.shape && other !== obstacle && !this.isDrawn(other)) this.drawOutline(context, panel, other.shape);
    this.drawBlocked(context, panel);
    if (obstacle?.shape) this.drawSelected(context, panel, obstacle.shape);
    if (tips.goal) {
      const [x, y] = panel.at(tips.goal);
      context.strokeStyle = selection?.kind === 'goal' ? theme.accent : theme.ink;
      context.lineWidth = 2;
      for (const r of [4, 10]) {
        context.beginPath();
        context.arc(x, y, r, 0, 2 * Math.PI);
        context.stroke();
      }
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) line(context, [[x + 7 * dx, y + 7 * dy], [x + 14 * dx, y + 14 * dy]]);
    }
    if (tips.start) {
      const [x, y] = panel.at(tips.start);
      context.beginPath();
      context.arc(x, y, 7, 0, 2 * Math.PI);
      context.strokeStyle = theme.accent;
      context.lineWidth = selection?.kind === 'start' ? 4 : 2;
      context.stroke();
    }
    if (this.isNew) this.invite(context, panel);
  }

  /** Marks start and goal as draggable, on the first visit. */
  invite(context, panel) {
    const { start, goal } = this.tips;
    context.globalAlpha = 0.4;
    context.strokeStyle = panel.theme.accent;
    context.lineWidth = 3;
    for (const tip of [start, goal].filter(Boolean)) {
      context.beginPath();
      context.arc(...panel.at(tip), HINT_RADIUS, 0, 2 * Math.PI);
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  /** Draws configurations that are not free: links in contact in red, and the obstacles that they touch. */
  drawBlocked(context, panel) {
    const { theme } = panel;
    const { world } = this.view;
    for (const { hits } of this.blocked()) {
      for (const { obstacle } of hits) if (world.obstacles[obstacle]) Workspace.struck(context, panel, world.obstacles[obstacle]);
    }
    for (const { at, hits } of this.blocked()) {
      Workspace.arm(context, panel, this.view, world, at, {
        fill: theme.paper, touch: Theme.mixed(theme.infeasible, theme.paper, 0.25), touching: new Set(hits.map(({ link }) => link)),
        line: theme.infeasible, width: 1.6, alpha: 0.85, joints: true,
      });
    }
  }

  /** Draws the outline of an obstacle that the picture shows elsewhere, or not at all. */
  drawOutline(context, panel, shape) {
    context.beginPath();
    if (shape.circle) rounded(context, panel, { core: shape.circle.center, radius: shape.circle.radius });
    else trace(context, panel, Shapes.corners(shape).flat(), Boolean(shape.polygon));
    context.setLineDash([5, 4]);
    context.lineWidth = 2;
    context.strokeStyle = panel.theme.accent;
    context.stroke();
    context.setLineDash([]);
  }

  drawSelected(context, panel, shape) {
    const { theme } = panel;
    this.drawOutline(context, panel, shape);
    if (!this.editsCorners) return;
    const { center, radius } = shape.circle ?? {};
    const handles = shape.circle ? [[center[0] + radius, center[1]]] : Shapes.corners(shape);
    handles.forEach((p, i) => {
      const [x, y] = panel.at(p);
      const chosen = this.selection.corner === i || this.selection.corner === 'rim';
      context.fillStyle = chosen ? theme.accent : theme.paper;
      context.lineWidth = 1.8;
      context.fillRect(x - 5, y - 5, 10, 10);
      context.strokeRect(x - 5, y - 5, 10, 10);
    });
  }

  drawCSpace(context, panel) {
    for (const { at } of this.blocked()) this.drawBlockedConfiguration(context, panel, CSpace.place(this.view, panel, at));
    const kind = this.selection?.kind;
    if (kind !== 'start' && kind !== 'goal') return;
    const q = this[kind];
    if (!q) return;
    const [x, y] = CSpace.place(this.view, panel, q);
    context.beginPath();
    context.arc(x, y, 14, 0, 2 * Math.PI);
    context.strokeStyle = panel.theme.accent;
    context.lineWidth = 2.5;
    context.stroke();
  }

  /** Draws a configuration that is not free: a cross in a ring. */
  drawBlockedConfiguration(context, panel, [x, y]) {
    for (const [width, color] of [[6, panel.theme.paper], [3, panel.theme.infeasible]]) {
      [context.lineWidth, context.strokeStyle] = [width, color];
      context.beginPath();
      context.arc(x, y, 9, 0, 2 * Math.PI);
      context.stroke();
      for (const side of [1, -1]) line(context, [[x - 6, y - 6 * side], [x + 6, y + 6 * side]]);
    }
  }
}

/** Screens on which corners are dragged in a mode of its own. */
Editor.hasCornerMode = matchMedia('(max-width: 51.25rem), (pointer: coarse)');
