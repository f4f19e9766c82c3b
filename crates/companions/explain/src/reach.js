// The map of a reach: the cell that the reader points at, its IK solutions as arms and dots, and the certified motion
// from home to the chosen one, which the arm plays.
'use strict';

/**
 * Reachable places, as in the page's data; see `ReachView` in the program.
 * @typedef {{ corner: number[], cell: number, size: number[], colors: string[], cells: string, counts: string,
 *   solutions: number[], access: string, origins: number[], routes: number[][] }} ReachData
 */

/**
 * Outcome, short and long description of each kind of cell, and colour of the arms.
 * @type {Object<string, { ending: string, short: string, long: string, color: string }>}
 */
const REACH_KINDS = {
  0: { ending: 'found', short: 'reached', long: 'The tip can reach this cell', color: 'found' },
  1: { ending: 'found', short: 'reached', long: 'The tip can reach this cell', color: 'found' },
  2: { ending: 'infeasible', short: 'free, but proven unreachable', long: 'The arm would be free here, but no motion leads here from home (proven)', color: 'infeasible' },
  3: { ending: 'infeasible', short: 'not free', long: 'The arm would not be free here', color: 'infeasible' },
  4: { ending: 'unknown', short: 'unknown', long: 'It is unknown whether the tip can reach this cell', color: 'grey' },
};

class ReachMap {
  /** Seconds of the shortest and of the longest play, and seconds for each radian or metre in between. */
  static DURATION = { least: 0.7, most: 4, unit: 0.9 };

  /** Side of the squares in which the configuration space is coloured, in pixels. */
  static PIXEL = 3;

  /** Radius of the numbered dots of IK solutions, in pixels. */
  static BADGE = 8;

  /**
   * Adds the map to a view whose model has a reach.
   * @param {View} view
   */
  constructor(view) {
    this.view = view;
    /** @type {ReachData} */
    this.data = view.model.reach;
    /** Index of the first solution of each cell. */
    this.firsts = [];
    let count = 0;
    for (const digit of this.data.counts) {
      this.firsts.push(count);
      count += Number(digit);
    }
    /** Index of the cell that is pointed at. */
    this.cell = this.firstCell();
    /** Index of the chosen solution among those of the cell. */
    this.chosen = 0;
    /** True if the cell stays when the mouse moves. */
    this.isKept = false;
    /** Part of the motion that the arm has gone, from 0 to 1. */
    this.part = 1;
    this.isPlaying = false;
    /** @type {HTMLElement} */
    this.root = element('section', { class: 'box cell-report', 'aria-label': 'Cell' });
    this.build();
    view.reachMap = this;
    view.root.classList.add('maps');
    const wide = matchMedia(WIDE);
    // Beside the panels if there is room, otherwise right below them.
    const place = () => (wide.matches ? view.root.querySelector('.side').prepend(this.root) : view.parts.panels.after(this.root));
    wide.addEventListener('change', place);
    place();
    view.parts.modes.querySelector('[data-mode=move]').textContent = 'Map';
    view.showCards(this.cards());
    this.listen(view.panels.workspace);
    this.pointAt(this.cell);
    view.refresh();
  }

  // The data.

  /**
   * Returns the solutions of a cell.
   * @param {number} cell
   * @returns {{ number: number, q: number[], kind: string }[]}
   */
  solutions(cell) {
    const first = this.firsts[cell];
    const { solutions, access, counts } = this.data;
    return Array.from({ length: Number(counts[cell]) }, (_, k) => first + k).map((number) => ({ number, q: solutions.slice(2 * number, 2 * number + 2), kind: access[number] }));
  }

  /**
   * Returns the certified motion from home to a solution as a flat list of joint values, or `null` if the solution is not reached. Its
   * pieces are the straight motions that the program certified; values of a circle continue beyond a turn.
   * @param {number} number
   * @returns {number[] | null}
   */
  motionTo(number) {
    const { origins, routes, solutions } = this.data;
    const later = [];
    let at = number;
    while (at >= 0) {
      later.push(at);
      at = origins[at];
    }
    if (at === -1) return null;
    const points = routes[-2 - at].slice();
    const { joints } = this.view.model.arm;
    for (const one of later.reverse()) {
      const last = points.slice(-2);
      const step = joints.map((joint, k) => Geometry.wrap(joint, solutions[2 * one + k] - last[k]));
      if (step.some((x) => Math.abs(x) > 1e-9)) points.push(...last.map((x, k) => x + step[k]));
    }
    return points;
  }

  /**
   * Returns the centre of a cell.
   * @param {number} cell
   * @returns {number[]}
   */
  center(cell) {
    const { corner, cell: side, size: [columns] } = this.data;
    return [corner[0] + side * (cell % columns + 0.5), corner[1] + side * (Math.floor(cell / columns) + 0.5)];
  }

  /**
   * Returns the cell at a place, or `null` outside the cells and where there is no IK solution.
   * @param {number[]} place
   * @returns {number | null}
   */
  cellAt(place) {
    const { corner, cell: side, size, counts } = this.data;
    const at = [0, 1].map((k) => Math.floor((place[k] - corner[k]) / side));
    if (at.some((n, k) => n < 0 || n >= size[k])) return null;
    const cell = at[1] * size[0] + at[0];
    return counts[cell] === '0' ? null : cell;
  }

  /**
   * Returns a cell that is a good example: one with solutions of different kinds, and a motion that bends. Of
   * several, it is the one whose solutions keep most distance from the limits of the joints.
   * @returns {number | null}
   */
  firstCell() {
    const { counts, access, origins, solutions } = this.data;
    const { joints } = this.view.model.arm;
    const room = (number) => Math.min(...joints.map(({ domain: [low, high] }, k) => Math.min(solutions[2 * number + k] - low, high - solutions[2 * number + k]) / (high - low || 1)));
    let [best, value] = [null, -Infinity];
    for (let cell = 0; cell < counts.length; cell += 1) {
      if (counts[cell] === '0') continue;
      const own = Array.from({ length: Number(counts[cell]) }, (_, k) => this.firsts[cell] + k);
      const reached = own.filter((number) => origins[number] !== -1);
      const kinds = new Set(own.map((number) => access[number])).size;
      const bends = reached.some((number) => origins[number] >= 0);
      const score = 10 * kinds + 5 * Number(reached.length > 0) + 2 * Number(bends) + Math.min(...own.map(room));
      if (score > value + 1e-9) [best, value] = [cell, score];
    }
    return best;
  }

  /**
   * Returns the key figures: name, value and meaning.
   * @returns {string[][]}
   */
  cards() {
    const { cells, cell } = this.data;
    const count = (letters) => [...cells].filter((kind) => letters.includes(kind)).length;
    const grouped = (number) => String(number).replace(/\B(?=(\d{3})+$)/g, '\u202f');
    const area = (number) => `${Numbers.digits(number * cell * cell)} m\u00b2`;
    const [one, several, out, blocked, unknown] = [...'01234'].map(count);
    const cards = [
      ['reachable area', area(one + several), `in cells of ${Numbers.length(cell)}`],
      ['reached cells', grouped(one + several), `${grouped(several)} of them with several IK solutions`],
      ['proven out of reach', grouped(out), out ? `free cells, ${area(out)}` : 'the arm can reach every free cell'],
      ['not free', grouped(blocked), `cells in which every IK solution collides, ${area(blocked)}`],
    ];
    return unknown ? [...cards, ['unknown', grouped(unknown), 'cells that were not decided']] : cards;
  }

  /**
   * Colours each configuration as the nearest solution in the cell of its tip, or in a cell beside it if that has none, as
   * at the edge of the workspace. So there are no gaps where the tip hardly moves.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {View} view
   * @param {ReachData} reach
   */
  static drawSolutions(context, panel, view, { corner, cell, size: [columns, rows], colors, counts, solutions, access }) {
    const { arm } = view.model;
    const { rect, theme } = panel;
    const firsts = [0];
    for (const digit of counts) firsts.push(firsts[firsts.length - 1] + Number(digit));
    /** Returns the nearest solution of a cell, and its distance. */
    const nearest = (q, i, j) => {
      let [best, least] = [-1, Infinity];
      if (i < 0 || j < 0 || i >= columns || j >= rows) return [best, least];
      const at = j * columns + i;
      for (let k = firsts[at]; k < firsts[at + 1]; k += 1) {
        const distance = Math.hypot(...arm.joints.map((joint, c) => {
          const by = q[c] - solutions[2 * k + c];
          return joint.circle ? Math.atan2(Math.sin(by), Math.cos(by)) : by;
        }));
        if (distance < least) [best, least] = [k, distance];
      }
      return [best, least];
    };
    const kindAt = (q) => {
      const [i, j] = Geometry.tipAt(arm, q).map((x, c) => Math.floor((x - corner[c]) / cell));
      let [best] = nearest(q, i, j);
      for (let k = 0, least = Infinity; best < 0 && k < 9; k += 1) {
        const [other, distance] = nearest(q, i + (k % 3) - 1, j + Math.floor(k / 3) - 1);
        if (distance < least) [best, least] = [other, distance];
      }
      return best < 0 ? '3' : access[best];
    };
    for (let y = 0; y < rect.height; y += ReachMap.PIXEL) {
      const height = Math.min(ReachMap.PIXEL, rect.height - y);
      for (let x = 0, from = 0, before = '3'; ; x += ReachMap.PIXEL) {
        const kind = x < rect.width ? kindAt(panel.value([rect.x + x + ReachMap.PIXEL / 2, rect.y + y + ReachMap.PIXEL / 2])) : null;
        if (kind === before) continue;
        if (before !== '3') {
          context.fillStyle = theme.tint(before === '1' ? colors[0] : colors[Number(before)]);
          context.fillRect(rect.x + from, rect.y + y, Math.min(x, rect.width) - from, height);
        }
        if (kind === null) break;
        [from, before] = [x, kind];
      }
    }
  }

  // The state.

  /**
   * Configuration of the arm: on the motion to the chosen solution, or `null` if no motion leads there.
   * @returns {number[] | null}
   */
  get q() {
    if (!this.motion) return null;
    const { lengths } = this;
    const total = lengths[lengths.length - 1];
    let k = 1;
    while (k < lengths.length - 1 && lengths[k] < this.part * total) k += 1;
    if (lengths.length < 2) return this.motion.slice(0, 2);
    const along = (this.part * total - lengths[k - 1]) / (lengths[k] - lengths[k - 1] || 1);
    return [0, 1].map((j) => this.motion[2 * k - 2 + j] + (this.motion[2 * k + j] - this.motion[2 * k - 2 + j]) * along);
  }

  /**
   * Points at a cell, and chooses the reached solution with the shortest motion.
   * @param {number | null} cell
   */
  pointAt(cell) {
    this.stop();
    this.cell = cell;
    this.own = cell === null ? [] : this.solutions(cell);
    const lengths = this.own.map(({ number }) => {
      const motion = this.motionTo(number);
      return motion ? ReachMap.lengths(motion).at(-1) : Infinity;
    });
    this.choose(Math.max(0, lengths.indexOf(Math.min(...lengths))));
  }

  /**
   * Chooses a solution of the cell. The arm goes there.
   * @param {number} index
   */
  choose(index) {
    this.stop();
    this.chosen = index;
    this.motion = this.own.length ? this.motionTo(this.own[index].number) : null;
    this.lengths = this.motion ? ReachMap.lengths(this.motion) : [0];
    this.trace = this.motion ? Workspace.tipTrace(this.view.model.arm, this.motion) : [];
    this.part = 1;
    this.report();
    this.draw();
  }

  /**
   * Returns the length of a path up to each of its points.
   * @param {number[]} flat
   * @returns {number[]}
   */
  static lengths(flat) {
    const lengths = [0];
    for (let i = 2; i < flat.length; i += 2) lengths.push(lengths[lengths.length - 1] + Math.hypot(flat[i] - flat[i - 2], flat[i + 1] - flat[i - 1]));
    return lengths;
  }

  /** Plays the motion from home. Readers who prefer reduced motion see its end at once. */
  play() {
    this.stop();
    this.view.examine(null);
    if (!this.motion || Settings.reducesMotion) {
      this.show(1);
      return;
    }
    const { least, most, unit } = ReachMap.DURATION;
    const duration = 1000 * Math.min(most, Math.max(least, unit * this.lengths.at(-1)));
    this.isPlaying = true;
    this.mark();
    let began = null;
    const tick = (now) => {
      if (!this.isPlaying) return;
      began ??= now;
      const part = Math.min(1, (now - began) / duration);
      this.show(part);
      if (part === 1) this.stop();
      else requestAnimationFrame(tick);
    };
    this.show(0);
    requestAnimationFrame(tick);
  }

  stop() {
    this.isPlaying = false;
    this.mark();
  }

  /**
   * Shows the arm on its motion.
   * @param {number} part
   */
  show(part) {
    this.part = part;
    this.slider.value = String(part);
    this.slider.setAttribute('aria-valuetext', `${Math.round(100 * part)} % of the motion`);
    this.draw();
  }

  draw() {
    if (!this.view.reachMap) return;
    this.view.report();
    this.view.describe();
    for (const panel of Object.values(this.view.panels)) panel.draw();
  }

  // Input.

  /**
   * Lets the pointer and the arrow keys choose a cell of the workspace.
   * @param {Panel} panel
   */
  listen({ canvas }) {
    const panel = this.view.panels.workspace;
    const isMap = () => this.view.mode !== 'learn';
    let press = null;
    canvas.addEventListener('pointermove', (event) => {
      const spot = panel.spot(event);
      if (event.buttons || event.pointerType !== 'mouse' || this.isKept || this.view.probe || !isMap() || !panel.contains(spot)) return;
      const cell = this.cellAt(panel.value(spot));
      if (cell !== null && cell !== this.cell) this.pointAt(cell);
    });
    canvas.addEventListener('pointerdown', (event) => (press = panel.spot(event)));
    canvas.addEventListener('pointerup', (event) => {
      const spot = panel.spot(event);
      if (!press || Math.hypot(spot[0] - press[0], spot[1] - press[1]) >= TAP || !panel.contains(spot) || !isMap()) return;
      const cell = this.cellAt(panel.value(spot));
      if (cell === null) return;
      const isAgain = this.isKept && cell === this.cell;
      this.isKept = !isAgain;
      if (cell !== this.cell) this.pointAt(cell);
      if (isAgain) this.report();
      else {
        this.report();
        this.play();
      }
    });
    canvas.addEventListener('keydown', (event) => {
      if (this.view.probe || !isMap() || !this.key(event)) return;
      event.preventDefault();
      event.stopPropagation();
    });
    document.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape' || !this.isKept) return;
      this.isKept = false;
      this.report();
    });
  }

  /**
   * Handles a key in the workspace: arrows point at the next cell with a solution, Enter and Space play the motion.
   * @param {KeyboardEvent} event
   * @returns {boolean} true if the key has an effect
   */
  key(event) {
    if (['Enter', ' '].includes(event.key)) {
      this.play();
      return true;
    }
    const direction = DIRECTIONS[event.key];
    if (!direction || (event.shiftKey && this.view.panels.workspace.times > 1)) return false;
    const step = this.data.cell * (event.shiftKey ? 5 : 1);
    const { size } = this.data;
    let place = this.cell === null ? this.center(0) : this.center(this.cell);
    for (let k = 0; k < Math.max(...size); k += 1) {
      place = place.map((x, j) => x + step * direction[j]);
      const cell = this.cellAt(place);
      if (cell === null) continue;
      this.isKept = true;
      this.pointAt(cell);
      this.view.panels.workspace.reveal(place);
      break;
    }
    return true;
  }

  // The text beside the panels.

  build() {
    this.slider = element('input', {
      type: 'range', min: '0', max: '1', step: 'any', value: '1', 'aria-label': 'part of the motion',
      oninput: (event) => {
        const part = Number(event.target.value);
        this.stop();
        this.show(part);
      },
    });
    this.button = element('button', { type: 'button', class: 'play', onclick: () => (this.isPlaying ? this.stop() : this.play()) });
    this.title = element('h2', {});
    this.verdict = element('p', { class: 'verdict', 'aria-live': 'polite' });
    this.list = element('ol', { class: 'solutions', 'aria-label': 'IK solutions' });
    this.route = element('p', { class: 'route' });
    this.controls = element('p', { class: 'slider' }, this.button, this.slider);
    this.hint = element('p', { class: 'hint' });
    this.root.append(this.title, this.verdict, this.list, this.route, this.controls, this.hint);
    this.mark();
  }

  mark() {
    const action = this.isPlaying ? 'pause' : 'play';
    this.button.replaceChildren(icon(action));
    this.button.setAttribute('aria-label', `${action} the motion from home`);
    this.button.title = action;
  }

  /** Describes the cell, its solutions, and the motion. */
  report() {
    const { own, cell, data, view, motion } = this;
    this.hint.textContent = this.isKept ? 'This cell stays selected. To release it, click on it or press Escape.' : 'Point at a cell to see its solutions; click or tap to play the motion to this cell. Arrow keys move from cell to cell.';
    if (cell === null) {
      this.title.textContent = 'No cell has an IK solution';
      return;
    }
    const [x, y] = this.center(cell).map((value) => Numbers.length(value));
    this.title.textContent = `Cell at ${x}, ${y}`;
    const { ending, long } = REACH_KINDS[data.cells[cell]];
    const count = own.filter(({ kind }) => kind === '1').length;
    const ways = ending === 'found' ? `, with ${count === 1 ? 'one IK solution' : `${count} IK solutions`}` : '';
    this.verdict.dataset.ending = ending;
    this.verdict.replaceChildren(element('span', { 'aria-hidden': 'true' }, SYMBOLS[ending]), ` ${long}${ways}.`);
    this.list.replaceChildren(...own.map((solution, k) => this.item(solution, k)));
    this.controls.hidden = !motion;
    const pieces = motion ? motion.length / 2 - 1 : 0;
    const tip = this.trace.reduce((sum, p, i) => sum + (i ? Math.hypot(p[0] - this.trace[i - 1][0], p[1] - this.trace[i - 1][1]) : 0), 0);
    const straight = pieces === 1 ? 'one straight motion' : `${pieces} straight motions`;
    if (!motion) this.route.textContent = 'No certified motion leads to this solution.';
    else this.route.textContent = pieces ? `Certified motion from home: ${straight} of the joints; the tip travels ${Numbers.length(tip)}.` : 'This is the home configuration.';
    view.parts.description.textContent = '';
  }

  /**
   * Returns the line of a solution.
   * @param {{ q: number[], kind: string }} solution
   * @param {number} index
   * @returns {HTMLElement}
   */
  item({ q, kind }, index) {
    const { joints } = this.view.model.arm;
    const { short, ending } = REACH_KINDS[kind];
    const values = joints.map((joint, k) => element('span', {}, `${joint.name} ${Numbers.joint(joint, Geometry.wrap(joint, q[k]))}`));
    const badge = element('span', { class: 'badge', 'data-ending': ending, 'aria-hidden': 'true' }, String(index + 1));
    const text = element('span', {}, element('span', { class: 'values' }, ...values), element('small', {}, short));
    return element('li', {}, element('button', { type: 'button', 'aria-pressed': String(index === this.chosen), title: Numbers.exact(joints, q), onclick: () => this.press(index) }, badge, text));
  }

  /**
   * Chooses a solution by its button, and plays the motion to it.
   * @param {number} index
   */
  press(index) {
    this.isKept = true;
    this.choose(index);
    this.list.children[index].firstChild.focus();
    this.play();
  }

  // Pictures.

  /** Returns true if the pictures show the cell. */
  get isShown() {
    return this.view.mode !== 'learn' && this.cell !== null && this.view.shows('access');
  }

  /**
   * Draws the cell, its other solutions as arms, and the tip's path, below the arm.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   */
  inWorkspace(context, panel) {
    if (!this.isShown) return;
    const { theme } = panel;
    const { view, own, motion } = this;
    const arm = (q, look) => Workspace.arm(context, panel, view, view.world, q, look);
    if (motion) arm(view.model.start, { fill: theme.ghost, line: theme.grey, width: 1, alpha: 0.75, joints: true });
    own.forEach(({ q, kind }, k) => {
      if (k === this.chosen && motion && this.part === 1) return;
      const color = theme.tint(REACH_KINDS[kind].color);
      const fill = kind === '3' ? Theme.mixed(color, theme.paper, 0.6) : theme.paper;
      arm(q, { fill, line: REACH_KINDS[kind].ending === 'found' ? theme.grey : color, width: 1.1, alpha: k === this.chosen ? 0.95 : 0.75, joints: true, blocks: true });
    });
    if (motion) {
      const spots = this.trace.map((p) => panel.at(p));
      pathLine(context, theme, { width: 2.4, dash: [] }, () => line(context, spots));
      Labels.blockLine(panel, spots);
    }
  }

  /**
   * Draws the outline of the cell and the numbers of its solutions, above the arm.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   */
  aboveArm(context, panel) {
    if (!this.isShown) return;
    const { theme } = panel;
    const { view, own } = this;
    const [x, y] = panel.at(this.center(this.cell));
    const half = Math.max(5, (this.data.cell * panel.pixels) / 2);
    for (const [width, color] of [[5, theme.paper], [2, theme.ink]]) {
      context.lineWidth = width;
      context.strokeStyle = color;
      context.strokeRect(x - half, y - half, 2 * half, 2 * half);
    }
    if (own.length < 2) return;
    own.forEach(({ q, kind }, k) => this.badge(context, panel, panel.at(Geometry.elbowAt(view.model.arm, q)), k, kind));
  }

  /**
   * Draws the solutions and the motion in the configuration space.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   */
  inCSpace(context, panel) {
    if (!this.isShown) return;
    const { view, own, motion } = this;
    if (motion) CSpace.path(context, panel, view, { points: motion, width: 2.6, dash: [] });
    own.forEach(({ q, kind }, k) => this.badge(context, panel, CSpace.place(view, panel, q), k, kind));
  }

  /**
   * Draws the number of a solution on a dot.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {number[]} spot
   * @param {number} index
   * @param {string} kind
   */
  badge(context, panel, [x, y], index, kind) {
    const { theme, zoom } = panel;
    const radius = ReachMap.BADGE * zoom;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fillStyle = theme.tint(REACH_KINDS[kind].color);
    context.fill();
    context.lineWidth = index === this.chosen ? 2.5 : 1.2;
    context.strokeStyle = index === this.chosen ? theme.ink : theme.paper;
    context.stroke();
    context.font = theme.font(700, 0.85);
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.fillStyle = theme.paper;
    context.fillText(String(index + 1), x, y + 0.5);
    Labels.blockSpot(panel, [x, y], radius + 1);
  }
}
