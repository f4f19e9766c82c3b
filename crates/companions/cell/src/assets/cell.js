// The page of two arms in one cell. The right picture is the plane of both times: a point of it is a pair of times, as a
// point of a configuration space is a pair of joint values.

/**
 * A step of an arm: `span` and `event` (the grasp or release) are in seconds, `object` is an index.
 * @typedef {{ span: [number, number], number: number, text: string, object: number | null, event: number | null, places: boolean }} CellStep
 */

/**
 * An arm with its motion: `waits` and `end` are in seconds, `arm`, `clock` and `start` are those of its view.
 * @typedef {{ name: string, color: string, waits: [number, number][], steps: CellStep[], end: number, arm: ArmModel, clock: ClockModel | null,
 *   start: Point, goals: Point[] }} CellArm
 */

/** Takes the dot of the schedule in the diagram. */
class ScheduleTool {
  /** @param {CellView} view */
  constructor(view) {
    this.view = view;
    this.holds = false;
  }

  /** Returns true if a pointer is at the dot, and no other place is kept. */
  grasps(panel, value, event) {
    const { view } = this;
    if (panel !== view.panels.cspace || view.pinned) return false;
    const [[x, y], [u, v]] = [panel.at(value), panel.at(view.q)];
    return Math.hypot(x - u, y - v) < (event.pointerType === 'mouse' ? NEAR_MOUSE : NEAR);
  }

  down(panel, value, event) {
    this.holds = this.grasps(panel, value, event);
    if (this.holds) {
      this.view.pause();
      this.view.examine(null);
    }
    return this.holds;
  }

  move(panel, value, event) {
    if (this.holds) this.view.seek(this.view.nearestTime(value));
    panel.canvas.style.cursor = this.holds ? 'grabbing' : this.grasps(panel, value, event) ? 'grab' : '';
    return this.holds;
  }

  up() {
    const held = this.holds;
    this.holds = false;
    return held;
  }

  tap() {}
}

class CellView extends View {
  /** Number of times among which the nearest place of the schedule is sought. A third of it are the places of a tip that are drawn, at least. */
  static PLACES = 600;
  /** Arms that are nearer than this share of the picture's smaller side have a line between them. */
  static NEAR = 0.12;
  /** Time between two places of a tip that are drawn, at most, in seconds. */
  static PATH_STEP = 0.005;
  /** Opacity of the path of all steps. That of the current step is opaque. */
  static FAINT = 0.25;

  /** Formats a time with milliseconds. */
  static seconds(value) {
    return `${value.toFixed(3)} s`;
  }

  constructor(root, model) {
    super(root, model);
    root.classList.add('cell');
    const { workspace, cspace } = this.panels;
    workspace.still = (context, panel) => this.drawStill(context, panel);
    workspace.moving = (context, panel) => this.drawMoving(context, panel);
    const { motions } = this.cell;
    cspace.still = (context, panel) => motions && CellDiagram.still(context, panel, this);
    cspace.moving = (context, panel) => motions && CellDiagram.moving(context, panel, this);
    cspace.beside = null;
    if (motions) {
      this.tool = new ScheduleTool(this);
      this.rows = new CellRows(this);
      this.parts.transport.after(this.rows.root);
    } else {
      root.classList.add('one-picture');
      cspace.canvas.parentElement.hidden = true;
    }
    workspace.canvas.setAttribute('aria-label', 'Workspace with both arms');
    this.explain.fold();
    this.recolor();
    this.seek(motions?.collides ?? 0);
  }

  /**
   * @returns {{ arms: CellArm[], objects: CellObject[], handovers: { object: number, giver: number, placed: number, taken: number }[], motions: any,
   *   cards: string[][], pairs: [number, number][], named: number, clearance: number, skew: number, paleness: number }}
   */
  get cell() {
    return this.model.cell;
  }

  get ownLayers() {
    return this.cell.motions ? ['path', 'poses'] : [];
  }

  // Content.

  update(model) {
    super.update(model);
    this.parts.transport.hidden = !this.duration;
    this.parts.modes.hidden = true;
    this.panels.cspace.titles = this.cell.arms.map(({ name }) => `${name}: time on its path (s)`);
    this.ready();
  }

  cards() {
    return this.cell.cards;
  }

  get space() {
    return 'Times of both arms';
  }

  get pointerHelp() {
    return [
      ['drag the dot of the diagram, or the rows of time', 'moves both arms along the schedule'],
      ['point into the diagram', 'shows both arms at those times; arms that are too near are red'],
      ['click, tap', 'keeps the arms there, or releases them'],
      ['arrow keys in the diagram', 'move one arm alone in small steps (with Shift in larger ones)'],
    ];
  }

  get hasModes() {
    return false;
  }

  /** Both arms move, although the page has no path. */
  get isMotion() {
    return true;
  }

  pathsHere() {
    return [];
  }

  get duration() {
    return this.cell.motions?.duration ?? 0;
  }

  // Times.

  /** Returns the time for which an arm has moved until a time on the clock, without its waits. */
  moved(arm, time) {
    const { waits, end } = this.cell.arms[arm];
    return Math.min(time, end) - waits.reduce((sum, [from, to]) => sum + Math.max(0, Math.min(time, to) - from), 0);
  }

  /** Returns the time on the clock at which an arm has moved for some time. */
  onClock(arm, moved) {
    let time = moved;
    for (const [from, to] of this.cell.arms[arm].waits) if (from < time) time += to - from;
    return time;
  }

  /** Returns the place on the schedule. */
  get q() {
    return [0, 1].map((arm) => (this.cell.motions ? this.moved(arm, this.time) : 0));
  }

  /** Returns the time at which the schedule is nearest to a place of the diagram. */
  nearestTime(place) {
    const { cspace } = this.panels;
    const [x, y] = cspace.at(place);
    let [best, least] = [0, Infinity];
    for (let k = 0; k <= CellView.PLACES; k += 1) {
      const time = (this.duration * k) / CellView.PLACES;
      const [u, v] = cspace.at([0, 1].map((arm) => this.moved(arm, time)));
      const apart = Math.hypot(u - x, v - y);
      if (apart < least) [best, least] = [time, apart];
    }
    return best;
  }

  /** Returns the configuration of an arm at a time on the clock. */
  placed(arm, time) {
    const { clock, start } = this.cell.arms[arm];
    return clock ? Geometry.moving(clock, time).position : start;
  }

  /** Returns the shown time of each arm: the examined ones, or the current time. */
  get shownTimes() {
    return this.probe ? this.probe.q.map((moved, arm) => this.onClock(arm, moved)) : [this.time, this.time];
  }

  /** Returns the shown configuration of each arm. */
  get shown() {
    return this.shownTimes.map((time, arm) => this.placed(arm, time));
  }

  /** Returns the step that an arm does at a time. Undefined before its first and after its last one. */
  stepOf(arm, time) {
    return this.cell.arms[arm].steps.find(({ span: [from, to] }) => from <= time && time < to);
  }

  /** Describes a step in a few words. */
  words({ text, object }) {
    return object === null ? text : `${text.split(' ')[0]} ${this.cell.objects[object].name}`;
  }

  /** Describes what each arm does at the shown times. */
  get doing() {
    const { arms } = this.cell;
    if (!arms.some(({ steps }) => steps.length)) return '';
    const texts = this.shownTimes.map((time, arm) => {
      const isWaiting = arms[arm].waits.some(([from, to]) => from <= time && time < to);
      const step = this.stepOf(arm, time);
      return `${arms[arm].name}: ${isWaiting ? 'waits' : step ? this.words(step) : 'rests'}`;
    });
    return texts.join(', ');
  }

  /** Returns the nearest parts of both arms: { distance, pair, ends }. `null` if no links can meet. */
  nearest() {
    const { arms, pairs } = this.cell;
    const shapes = this.shown.map((q, k) => Geometry.armShapes(arms[k].arm, undefined, q));
    let found = null;
    for (const pair of pairs) {
      const [one, two] = pair.map((part, k) => shapes[k][part]);
      const distance = Geometry.separation(one, two);
      if (!found || distance < found.distance) found = { distance, pair, one, two };
    }
    return found && { ...found, ends: Geometry.nearest(found.one, found.two).ends };
  }

  /** Returns true if the shown arms touch, or are nearer than their clearance. */
  get isTooNear() {
    const found = this.nearest();
    return Boolean(found) && (found.distance <= 0 || found.distance < this.cell.clearance);
  }

  // Texts.

  headings() {
    super.headings();
    document.title = this.model.title[0];
  }

  valued(q) {
    return this.cell.arms.map(({ name }, k) => `${name} at ${CellView.seconds(q[k])}`).join(', ');
  }

  /** Describes the distance between the shown arms. */
  touched() {
    const found = this.nearest();
    if (!found) return 'no links of the arms can meet';
    const parts = found.pair.map((part, k) => {
      const { arm, name } = this.cell.arms[k];
      return `${arm.links.flatMap((link) => link.parts)[part].body} of ${name}`;
    });
    const { distance } = found;
    const words = distance <= 0 ? `overlap by ${Numbers.length(-distance)}` : `are ${Numbers.length(distance)} apart`;
    const needed = distance > 0 && this.isTooNear ? `, less than the clearance of ${Numbers.length(this.cell.clearance)}` : '';
    return `${parts[0]} and ${parts[1]} ${words}${needed}`;
  }

  report() {
    const { probe, step } = this.parts;
    step.textContent = this.doing;
    step.setAttribute('aria-live', this.playing ? 'off' : 'polite');
    const at = this.cell.motions ? this.valued(this.probe?.q ?? this.q) : 'both arms at their starts';
    probe.textContent = `${at}: ${this.touched()}`;
    probe.setAttribute('aria-live', this.playing ? 'off' : 'polite');
    probe.classList.toggle('tried', Boolean(this.probe));
    probe.dataset.free = String(!this.isTooNear);
  }

  describe() {
    if (this.playing) return;
    this.parts.description.textContent = `${this.model.title[0]}. ${this.valued(this.q)}. ${this.touched()}.`;
  }

  get tourSteps() {
    const { parts, layers, panels, rows } = this;
    const { here, there, isNarrow } = Tour.sides(panels.workspace.canvas, panels.cspace.canvas);
    const workspace = panels.workspace.canvas.parentElement;
    if (!rows) return [['Two arms', 'The picture shows both arms at their starts. Parts that are too near to each other are red.', workspace]];
    return [
      ['Two arms, two times', `${here}, both arms. ${there}, how far each arm is on its path. In the coloured regions, the arms would be too near to each other.`, isNarrow ? workspace : parts.panels],
      ['Take the dot', 'Drag the dot along the schedule, or point anywhere else to see both arms at other times.', panels.cspace.canvas.parentElement],
      ['Who waits for whom', `Each arm has a row${this.doing && ' with its steps'}. Hatched parts are waits; each ${this.doing && 'handover and each '}signal has a row of its own.`, rows.root],
      ['Choose what is drawn', 'Each layer has its sign and a checkbox.', layers.root],
    ];
  }

  // Time.

  seek(time) {
    super.seek(time);
    this.parts.clock.textContent = `${this.time.toFixed(3)} / ${CellView.seconds(this.duration)}`;
    this.rows?.follow();
    this.report();
  }

  /** Keeps a pair of times. */
  place(q) {
    this.pinned = true;
    this.examine(this.model.arm.joints.map(({ domain: [low, high] }, k) => Math.min(high, Math.max(low, q[k]))));
  }

  /** The tips cannot be taken: the arms move along their paths. */
  isAtTip() {
    return false;
  }

  // Drawings.

  /** No obstacle is pale. */
  isIrrelevant() {
    return false;
  }

  /** Leaves out hidden obstacles and objects. */
  visible(all) {
    return all.filter(({ name }) => !this.hidden.has(name));
  }

  /** Draws the obstacles, the destinations of objects, the arms at their starts and goals, and the paths of their tips. */
  drawStill(context, panel) {
    const { theme } = panel;
    const { arms, motions } = this.cell;
    Workspace.destinations(context, panel, this);
    Workspace.solids(context, panel, this, this.world.obstacles);
    if (!motions) return;
    arms.forEach((own, k) => {
      const { color, start, end, steps } = own;
      const look = (paleness, alpha) => ({ fill: Theme.mixed(theme[color], theme.paper, paleness), line: Theme.mixed(theme[color], theme.paper, 0.35), width: 0.8, alpha });
      if (this.shows('poses')) {
        this.drawArm(context, panel, own, start, look(0.92, 0.75));
        // Arms with steps often end where they start.
        if (!steps.length) this.drawArm(context, panel, own, this.placed(k, end), look(0.72, 0.75));
      }
    });
    arms.forEach(({ end, steps }, k) => {
      if (this.shows('path')) panel.faded(context, steps.length ? CellView.FAINT : 1, (layer) => this.drawPath(layer, panel, k, [0, end]));
    });
  }

  /** Draws the path of an arm's tip between two times. Names dodge it, unless the arm has steps and it is the whole path. */
  drawPath(context, panel, k, [from, to]) {
    const { arm, color, end, steps } = this.cell.arms[k];
    const count = Math.max(CellView.PLACES / 3, Math.ceil((to - from) / CellView.PATH_STEP));
    const spots = Array.from({ length: count + 1 }, (_, i) => panel.at(Geometry.tipAt(arm, this.placed(k, from + ((to - from) * i) / count))));
    pathLine(context, panel.theme, { color, width: 2, dash: [] }, () => line(context, spots));
    if (!steps.length || to - from < end) Labels.blockLine(panel, spots);
  }

  /** Draws an arm with the object that it carries. */
  drawArm(context, panel, { arm }, q, look, held = undefined) {
    Workspace.arm(context, panel, /** @type {any} */ ({ model: { arm } }), /** @type {any} */ ({ payload: held }), q, { turned: held?.turned, ...look });
  }

  /** Draws the objects, both arms, the parts that are too near, and the line between the arms if it is short. */
  drawMoving(context, panel) {
    const { theme } = panel;
    const { arms, clearance } = this.cell;
    const [found, { shown, shownTimes: times }] = [this.nearest(), this];
    const isTooNear = found && (found.distance <= 0 || found.distance < clearance);
    const objects = this.visible(this.cell.objects);
    const lying = CellObjects.lying(objects, times);
    times.forEach((time, k) => {
      const step = this.stepOf(k, time);
      if (step && this.shows('path')) this.drawPath(context, panel, k, step.span);
    });
    // Objects that the arms move are above the arms, which would cover them.
    const moves = ({ changes }) => changes.length > 0;
    Workspace.solids(context, panel, this, lying.filter((object) => !moves(object)));
    arms.forEach((own, k) => {
      const fill = Theme.mixed(theme[own.color], theme.paper, 0.45);
      const look = { fill, line: theme[own.color], width: 1.5, alpha: 0.92, joints: true, blocks: true };
      this.drawArm(context, panel, own, shown[k], look, CellObjects.held(objects, k, times));
    });
    Workspace.solids(context, panel, this, lying.filter(moves));
    if (isTooNear) {
      for (const shape of [found.one, found.two]) {
        context.beginPath();
        rounded(context, panel, shape);
        [context.fillStyle, context.strokeStyle, context.lineWidth] = [Theme.mixed(theme.infeasible, theme.paper, 0.4), theme.infeasible, 2.5];
        context.globalAlpha = 0.8;
        context.fill();
        context.globalAlpha = 1;
        context.stroke();
      }
    }
    const size = Math.min(...panel.whole.map(([low, high]) => high - low));
    if (found && found.distance > 0 && found.distance < CellView.NEAR * size) {
      Workspace.distance(context, panel, { ends: found.ends, text: Numbers.length(found.distance) });
    }
    if (this.shows('names')) this.drawNames(context, panel, lying);
  }

  /** Draws the names of the arms, and of objects and obstacles where they lie. */
  drawNames(context, panel, lying) {
    const { shownTimes: times, shown } = this;
    const arms = this.cell.arms.map(({ name, arm }, k) => {
      const q = shown[k];
      const box = Labels.beyond(context, panel, name, panel.at(Geometry.tipAt(arm, q)), panel.at(Geometry.elbowAt(arm, q)));
      return [name, Labels.shaped(panel, box, Geometry.armShapes(arm, undefined, q))];
    });
    const current = times.map((time, k) => this.cell.objects[this.stepOf(k, time)?.object ?? -1]?.name);
    // The bases, which are the last obstacles, have the names of their arms.
    const all = [...this.visible(this.world.obstacles.slice(0, this.cell.named)), ...lying];
    Labels.beside(context, panel, [...arms, ...Workspace.families(panel, all, (name) => current.includes(name))]);
  }
}

{
  const data = JSON.parse(document.getElementById('cell').textContent);
  const { views, title, status, ending, facts, frame, obstacles, objects, clearance, motions } = data;
  /** @type {CellArm[]} */
  const arms = data.arms.map((own, k) => ({ ...own, arm: views[k].arm, clock: views[k].clock, start: views[k].start, goals: views[k].goals }));
  // The coordinates of the right picture are the times of both arms.
  const ends = arms.map(({ end, waits }) => (end ?? 1) - waits.reduce((sum, [from, to]) => sum + to - from, 0));
  const joints = arms.map(({ name }, k) => ({ name, unit: 's', direction: [1, 0], domain: [0, Math.max(ends[k], 1e-3)], circle: false }));
  const ratio = Math.max(...ends) / Math.min(...ends);
  const swatch = (color, text, more = {}) => ({ sign: 'swatch', color, text, ...more });
  const region = (arm) => swatch(arms[arm].color, `too near; ${arms[arm].name} passes first`, { pale: data.paleness });
  const schedule = motions?.certified
    ? [region(0), region(1), { sign: 'line', color: 'ink', width: 2.4, text: 'schedule of both arms' }, { sign: 'line', color: 'ink', width: 1, dash: [4, 3], text: `clocks that differ by ${Math.round(1000 * data.skew)} ms` }]
    : [swatch('undecided', 'too near to each other'), { sign: 'line', color: 'ink', width: 1.4, dash: [6, 4], text: 'both arms at once, not coordinated' }];
  const hasSteps = arms.some(({ steps }) => steps.length);
  const places = CellObjects.destinations(objects);
  if (places.length) schedule.push({ sign: 'dashed', color: places[0].color, text: 'where objects are placed' });
  const layers = [{ sign: 'path', text: 'paths of the tips', layers: ['path'] }, { sign: 'poses', text: hasSteps ? 'arms at their starts' : 'arms at start (pale) and goal', layers: ['poses'] }];
  const legend = [...arms.map(({ name, color }) => swatch(color, name)), ...(motions ? [...schedule, ...layers] : [])];
  const cell = { ...data, arms };
  const arm = { ...views[0].arm, joints, one_scale: ratio < 2 };
  const world = { label: '', clearance, obstacles, pairs: [], c_obstacles: [], regions: [], proof: [], unreached: [] };
  // Layers list the obstacles of all worlds. The first one is shown.
  const worlds = [world, { ...world, obstacles: objects }];
  const model = { title, status, ending, facts, arm, frame, start: [0, 0], goals: [], goal_lines: [], worlds, paths: [], motions: [], places, clock: null, frames: [], legend, cell };
  window.cplan = new CellView(document.querySelector('main'), model);
  cplan.tour.offer();
}
