// The page of an exploration: the known part of the map, and the configurations that are known to be free. It opens
// at the end, with everything that was seen.
'use strict';

/** Time between two readings during the replay, in seconds. */
const SECONDS_PER_READING = 0.05;
/** A name of more letters is long. With more than so many long names, obstacles have numbers. */
const [LONG_NAME, MOST_LONG_NAMES] = [14, 3];
/** Opacity of the view of the sensor. */
const SENSOR_OPACITY = 0.16;

/**
 * Data of an exploration.
 * @typedef {object} ExplorationData
 * @property {{ q: number[], length: number, new: number[], sensor: number[] }[]} frames readings: configuration, path
 * length, cells of the map that became known, and the place and direction of the sensor
 * @property {{ origin: number[], cell: number, size: number[] }} map
 * @property {number[]} occupied occupied cells of the map
 * @property {number[]} surroundings cells that were known before the first reading
 * @property {[number, number[]][]} opened configurations that were known to be free after a number of readings
 * @property {number[]} grid cells of the joint space along both axes
 * @property {{ range: number, view: number }} sensor
 * @property {number | null} known_length path length in the known world
 * @property {number[] | null} decisions_ms times of the decisions
 * @property {string} text outcome in words
 */

/** The knowledge of the arm over time. */
class Survey {
  /** @param {ExplorationData} data */
  constructor(data) {
    this.data = data;
    this.count = data.frames.length;
    const [columns, rows] = data.map.size;
    /** Reading with which each cell became known: -1 for the surroundings of the start, or `count` for never. */
    this.since = new Int32Array(columns * rows).fill(this.count);
    for (const cell of data.surroundings) this.since[cell] = -1;
    data.frames.forEach((frame, reading) => frame.new.forEach((cell) => (this.since[cell] = reading)));
    this.occupied = new Set(data.occupied);
    /** Number of readings after which each configuration was known to be free; more than `count` for never. */
    this.opened = new Int32Array(data.grid[0] * data.grid[1]).fill(this.count + 1);
    for (const [readings, cells] of data.opened) for (const cell of cells) this.opened[cell] = readings;
    /** Number of known cells after each reading. */
    this.known = new Array(this.count).fill(0);
    for (const reading of this.since) if (reading < this.count) this.known[Math.max(reading, 0)] += 1;
    for (let k = 1; k < this.count; k += 1) this.known[k] += this.known[k - 1];
  }

  /**
   * Returns the fraction of the map that is known after a reading.
   * @param {number} reading
   * @returns {number}
   */
  seen(reading) {
    return this.known[reading] / this.since.length;
  }

  /** Returns the readings with path lengths, coverage and, if they were measured, times of decisions. */
  get points() {
    const { frames, opened, decisions_ms: times } = this.data;
    /** @type {CoveragePoint[]} */
    const points = frames.map(({ length }, reading) => ({ length, seen: this.seen(reading) }));
    (times ?? []).forEach((time, k) => (points[Math.max(opened[k + 1][0] - 1, 0)].decision = time));
    return points;
  }

  /**
   * Returns true if a configuration is known to be free after a reading.
   * @param {number[]} q
   * @param {number} reading
   * @param {{ domain: number[] }[]} joints
   * @returns {boolean}
   */
  isKnownFree(q, reading, joints) {
    const [i, j] = q.map((value, k) => {
      const [low, high] = joints[k].domain;
      const { grid } = this.data;
      return Math.min(grid[k] - 1, Math.max(0, Math.floor(((value - low) / (high - low)) * grid[k])));
    });
    return this.opened[i * this.data.grid[1] + j] <= reading + 1;
  }
}

class ExplorationView extends View {
  /** Returns the key figures: coverage, path length, readings and, if they were measured, times of decisions. */
  cards() {
    const { survey, arm, exploration: { frames, known_length: known, decisions_ms: times, opened, map: { size } } } = this.model;
    const last = frames.length - 1;
    const { length } = frames[last];
    const decided = [...(times ?? [])].sort((a, b) => a - b);
    return [
      ['coverage', Numbers.percent(survey.seen(last)), `${survey.known[last]} of ${size[0] * size[1]} cells of the map`],
      ['path length', Numbers.pathLength(arm.joints, length), known > 0 ? `${Numbers.digits(length / known)} times the length in the fully known world` : 'in joint space'],
      ['readings', String(frames.length), `${opened.length - 1} decisions`],
      decided.length && ['decision', `${Numbers.digits(decided[Math.floor(decided.length / 2)])} ms`, `median; longest ${Numbers.digits(decided[decided.length - 1])} ms`],
    ].filter(Boolean);
  }

  constructor(root, model) {
    super(root, model);
    const { arm: { joints }, exploration: { decisions_ms: times } } = model;
    this.coverage = new Coverage(model.survey.points, {
      title: `path length (${Numbers.pathUnit(joints)}); ticks: readings${times ? `; dots: times of decisions, up to ${Numbers.digits(Math.max(...times))} ms` : ''}`,
      describe: (reading) => this.reported(reading),
      seek: (reading) => {
        this.pause();
        this.seek(SECONDS_PER_READING * reading);
      },
    });
    this.parts.scrubber.closest('.track').replaceWith(this.coverage.canvas);
    // The curve is broad; buttons stand in a row below it.
    this.parts.transport.classList.add('charted');
    const { workspace, cspace } = this.panels;
    workspace.still = (context, panel) => this.drawMap(context, panel);
    workspace.moving = (context, panel) => this.drawArm(context, panel);
    cspace.still = (context, panel) => this.drawKnown(context, panel);
    this.recolor();
    this.seek(this.duration);
  }

  // Content.

  /** Shows an exploration. The transport stays although there is no timed motion. */
  update(model) {
    super.update(model);
    this.shorten(model);
    this.parts.transport.hidden = false;
    this.parts.modes.hidden = true;
  }

  /**
   * Numbers the obstacles if several of their names are long: many paths pass between them, and names would lie above
   * the paths. The legend has the names.
   * @param {Model} model
   */
  shorten(model) {
    const long = model.worlds[0].obstacles.filter(({ name }) => name.length > LONG_NAME).length;
    if (!this.named || long <= MOST_LONG_NAMES) return;
    this.named = false;
    this.layers.update(model);
    this.ready();
  }

  /** Returns no paths: the page draws the path up to the current reading itself. */
  pathsHere() {
    return [];
  }

  /** The arm moves, although there is no timed motion. */
  get isMotion() {
    return true;
  }

  get ownLayers() {
    return ['path', 'map', 'sensor', 'known'];
  }

  /** Returns true for the layers of an exploration. */
  draws(layer) {
    return layer !== 'poses' && super.draws(layer);
  }

  /** Describes the pictures for users of screen readers. */
  describe() {
    if (this.playing) return;
    this.parts.description.textContent = `The arm is at ${this.valued(this.q)}. ${this.reported(this.reading)}.`;
  }

  /** There is only the exploration to play. */
  get hasModes() {
    return false;
  }

  get duration() {
    return SECONDS_PER_READING * (this.model.survey.count - 1);
  }

  /** Obstacles stand still. */
  get now() {
    return 0;
  }

  /** Returns the number of the current reading, from 0. */
  get reading() {
    return Math.round(this.time / SECONDS_PER_READING);
  }

  get frame() {
    return this.model.exploration.frames[this.reading];
  }

  get q() {
    return this.frame.q;
  }

  allPanels() {
    return [...super.allPanels(), ...(this.coverage ? [this.coverage.panel] : [])];
  }

  // Time.

  /** Returns the time of the nearest reading. */
  shownTime(time) {
    const reading = Math.round((Number.isFinite(time) ? time : 0) / SECONDS_PER_READING);
    return SECONDS_PER_READING * Math.min(this.model.survey.count - 1, Math.max(0, reading));
  }

  /** Shows the knowledge after the reading that is nearest to a time. */
  seek(time) {
    this.time = this.shownTime(time);
    const { parts, reading } = this;
    parts.clock.textContent = `reading ${reading + 1} of ${this.model.survey.count}`;
    const step = this.reported(reading);
    if (parts.step.textContent !== step) parts.step.textContent = step;
    this.mark();
    this.describe();
    this.report();
    for (const panel of Object.values(this.panels)) {
      panel.dirty = true;
      panel.draw();
    }
    this.coverage?.show(reading);
  }

  /**
   * Describes a reading.
   * @param {number} reading
   * @returns {string}
   */
  reported(reading) {
    const { survey, arm, exploration: { frames } } = this.model;
    const { length, new: cells } = frames[reading];
    const gain = `${cells.length} new ${cells.length === 1 ? 'cell' : 'cells'}`;
    return `${Numbers.percent(survey.seen(reading))} of the map seen, ${gain}; path length ${Numbers.pathLength(arm.joints, length)}`;
  }

  /** Shows on the button what a click does. At the end, it offers to play everything again. */
  mark() {
    const isAtEnd = Boolean(this.model) && this.duration > 0 && this.time >= this.duration;
    const action = this.playing ? 'pause' : isAtEnd ? 'replay' : 'play';
    const { play } = this.parts;
    if (play.dataset.action === action) return;
    play.dataset.action = action;
    const label = action[0].toUpperCase() + action.slice(1);
    play.replaceChildren(icon(action === 'replay' ? 'reset' : action), ...(action === 'replay' ? [label] : []));
    play.setAttribute('aria-label', label);
    play.title = `${label} (Space)`;
  }

  /** Describes the contacts in the real world, and whether the arm knows the configuration. */
  touched(contacts) {
    const q = this.probe?.q;
    if (!q) return super.touched(contacts);
    const isKnown = this.model.survey.isKnownFree(q, this.reading, this.model.arm.joints);
    return `${isKnown ? 'known to be free' : 'not known to be free'}; in the real world: ${super.touched(contacts)}`;
  }

  // Drawings.

  /**
   * Draws a raster of cells over a rectangle of the panel's values, row by row from below.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {{ size: number[], from: number[], to: number[], color: (cell: number[]) => string | null }} raster
   */
  drawRaster(context, panel, { size: [columns, rows], from, to, color }) {
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [columns, rows];
    const painter = canvas.getContext('2d');
    for (let j = 0; j < rows; j += 1) {
      for (let i = 0; i < columns; i += 1) {
        const fill = color([i, j]);
        if (!fill) continue;
        painter.fillStyle = fill;
        painter.fillRect(i, rows - 1 - j, 1, 1);
      }
    }
    const [[x0, y1], [x1, y0]] = [panel.at(from), panel.at(to)];
    context.imageSmoothingEnabled = false;
    context.drawImage(canvas, x0, y0, x1 - x0, y1 - y0);
  }

  /** Draws the map, the real obstacles as outlines, and the path of the sensor so far. */
  drawMap(context, panel) {
    const { model: { survey, exploration }, reading } = this;
    const { theme } = panel;
    const { origin, cell, size } = exploration.map;
    if (this.shows('map')) {
      // Rows of the map count from above.
      const color = ([i, j]) => {
        const index = (size[1] - 1 - j) * size[0] + i;
        if (survey.since[index] > reading) return theme.pale;
        if (survey.occupied.has(index)) return theme.ink;
        return survey.since[index] === reading ? theme.channel : theme.paper;
      };
      this.drawRaster(context, panel, { size, from: origin, to: origin.map((x, k) => x + size[k] * cell), color });
    }
    Workspace.outlines(context, panel, this, this.world);
    if (!this.shows('path')) return;
    const spots = exploration.frames.slice(0, reading + 1).map(({ sensor: [x, y] }) => panel.at([x, y]));
    pathLine(context, theme, { width: 1.8, dash: [] }, () => line(context, spots));
    Labels.blockLine(panel, spots);
  }

  /** Draws the view of the sensor, and the arm. */
  drawArm(context, panel) {
    const { sensor: { range, view: angle } } = this.model.exploration;
    const { sensor: [x, y, ahead] } = this.frame;
    if (this.shows('sensor')) {
      const [cx, cy] = panel.at([x, y]);
      context.globalAlpha = SENSOR_OPACITY;
      context.fillStyle = panel.theme.accent;
      context.beginPath();
      if (angle < 2 * Math.PI) context.moveTo(cx, cy);
      context.arc(cx, cy, range * panel.pixels, -(ahead + angle / 2), -(ahead - angle / 2));
      context.closePath();
      context.fill();
      context.globalAlpha = 1;
    }
    Workspace.moving(context, panel, this);
  }

  /** Draws the configurations that are known to be free, the real C-obstacles as outlines, and the path so far. */
  drawKnown(context, panel) {
    const { model: { survey, exploration: { grid, frames }, arm: { joints } }, reading } = this;
    const { theme } = panel;
    if (this.shows('known')) {
      const color = ([i, j]) => (survey.opened[i * grid[1] + j] <= reading + 1 ? theme.free : theme.pale);
      this.drawRaster(context, panel, { size: grid, from: joints.map(({ domain }) => domain[0]), to: joints.map(({ domain }) => domain[1]), color });
    }
    if (this.shows('c-obstacles')) CSpace.outlines(context, panel, this, this.world);
    if (this.shows('path')) {
      pathLine(context, theme, { width: 1.8, dash: [] }, () => {
        context.beginPath();
        let before = null;
        for (const { q } of frames.slice(0, reading + 1)) {
          const goesRound = before && joints.some((joint, k) => joint.circle && Math.abs(q[k] - before[k]) > Math.PI);
          const spot = CSpace.place(this, panel, q);
          if (before && !goesRound) context.lineTo(...spot);
          else context.moveTo(...spot);
          before = q;
        }
        context.stroke();
      });
      // Single places, because a joint may pass its seam between them.
      for (const { q } of frames.slice(0, reading + 1)) Labels.blockLine(panel, [CSpace.place(this, panel, q)]);
    }
    CSpace.ends(context, panel, this);
    CSpace.obstacleNames(context, panel, this, this.world);
  }

  // Texts.

  /** Returns the steps of the tour. */
  get tourSteps() {
    const { parts, layers, panels } = this;
    const { here, there, isNarrow } = Tour.sides(panels.workspace.canvas, panels.cspace.canvas);
    const workspace = panels.workspace.canvas.parentElement;
    return [
      ['Exploring a world', `${here}, the part of the map that the sensor has seen. ${there}, the configurations that are therefore known to be free.`, isNarrow ? workspace : parts.panels],
      ['Take the arm', 'Drag the tip of the arm, or its dot in the configuration space. The page states what the arm knows about this place at the shown time, and what is really there. Escape puts the arm back.', workspace],
      ['Drag the curve', 'The time bar shows how much of the map has been seen, over the length of the path, with a tick for each reading. Space replays the exploration.', parts.transport],
      ['Choose what is drawn', 'Each layer has its sign and a checkbox.', layers.root],
    ];
  }
}

{
  const exploration = JSON.parse(document.getElementById('exploration').textContent);
  const { view } = exploration;
  const map = (color, text) => ({ sign: 'swatch', color, text, layers: ['map'] });
  const legend = [
    ...view.legend.filter(({ sign }) => sign === 'start' || sign === 'swatch' || (sign === 'goal' && view.goals.length)),
    map('paper', 'free'), map('channel', 'new with this reading'), map('ink', 'occupied'), map('pale', 'unknown, counts as solid'),
  ];
  window.cplan = new ExplorationView(document.querySelector('main'), { ...view, title: [view.title[0], `${view.title[1]} \u00b7 ${exploration.text}`], paths: [], legend, exploration, survey: new Survey(exploration) });
}
