// The page: two panels, their layers, and time.
'use strict';

const SYMBOLS = { found: '\u2713', infeasible: '\u2715', unknown: '?', shown: '\u2022', waiting: '\u2026' };
/** A finger that begins within `NEAR` pixels of the cross, or of the arm's tip, takes it; a mouse within `NEAR_MOUSE`. */
const [NEAR, NEAR_MOUSE] = [24, 12];
/** Largest number of lines below the title. Further lines are folded. */
const MAX_LINES = 3;
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 10];
/** More obstacles than `NAMED` have numbers instead of names. With more than `CROWDED`, names appear only under the pointer. */
const [NAMED, CROWDED] = [16, 40];

class View {
  /**
   * Creates a view of a model.
   * @param {HTMLElement} root element that the view fills
   * @param {Model} model
   * @param {?() => void} recall requests the planner's replay, if there is a program to answer
   */
  constructor(root, model, recall = null) {
    this.root = root;
    /** @type {?Model} */
    this.model = null;
    /** The elements of the page by name. See `buildPage`. @type {Record<string, any>} */
    this.parts = {};
    /** @type {{ workspace: Panel, cspace: Panel }} */
    this.panels = null;
    /** @type {{ panel: Panel, fit: () => void }[]} */
    this.plots = [];
    /** @type {Steps} */
    this.steps = null;
    /** The height of a task's tool over its way. @type {SideView} */
    this.sideView = null;
    /** @type {Layers} */
    this.layers = null;
    /** @type {Tabs} */
    this.tabs = null;
    /** @type {Tour} */
    this.tour = null;
    /** Progress against time. @type {ReturnType<typeof Strip.mount>} */
    this.strip = null;
    this.height = null;
    /** The lengths that a search encloses. @type {ReturnType<typeof Closing.mount>} */
    this.closing = null;
    this.turns = null;
    this.toolAngle = null;
    /** True if obstacles are written with their names; otherwise with numbers. */
    this.named = true;
    /** True if names appear only under the pointer. */
    this.isCrowded = false;
    /** The name under the pointer and its spot, if names are not written. @type {?[string, number, number]} */
    this.hovered = null;
    /** Obstacles that the arm cannot meet, by world. @type {?{ world: WorldModel, pale: Set<ObstacleModel> }} */
    this.relevance = null;
    /** Traces of the tip. @type {any} */
    this.traces = null;
    root.classList.toggle('live', Boolean(recall));
    this.hidden = new Set();
    this.time = 0;
    /** Content that is played: 'move', the motion; 'think', the planner's replay; or 'learn', a lesson. Each keeps its time. */
    this.mode = 'move';
    this.times = { move: 0, think: 0, learn: 0 };
    /** Time at which the replay is shown first. It plays from its beginning, unless the reader has moved. @type {?number} */
    this.opening = null;
    /** True after the replay was shown. */
    this.hasThought = false;
    /** Index of a task's motion whose replay 'think' shows. */
    this.replayed = 0;
    this.recall = recall;
    /** Mode that the user has chosen. The view returns to it when it is available again. */
    this.chosen = 'move';
    this.learn = new Learn(this);
    this.explain = new Explain(this);
    this.budget = new Budget(this);
    this.speed = 1;
    this.playing = false;
    /** The examined arm. @type {?{ q: Point, contacts: ContactModel[] }} */
    this.probe = null;
    this.pinned = false;
    /** Handler that receives pointer events before the view. @type {?Tool} */
    this.tool = null;
    /** True if another script reports the outcome: see `say`. */
    this.judged = false;
    /** Map of the tip's reach; see `ReachMap`. */
    this.reachMap = null;
    /** The line that the tip follows; see `FollowedLine`. */
    this.followed = null;
    /** True to leave out everything that is slow to draw, while something moves. */
    this.light = false;
    buildPage(this);
    for (const panel of Object.values(this.panels)) new Pointer(this, panel);
    this.mark();
    this.recolor();
    this.update(model);
    const themes = matchMedia('(prefers-color-scheme: dark)');
    themes.addEventListener('change', () => this.recolor());
    new Keys(this);
  }

  // Content.

  /** The layers that the page draws itself, besides those of the model. Other pages override this. @returns {string[]} */
  get ownLayers() {
    return [];
  }

  /** Shows another model. Layers, hidden obstacles and, as far as possible, the time stay the same. */
  update(model) {
    this.model = model;
    this.traces = null;
    this.explain.update(model);
    this.budget.update(model);
    const count = model.worlds[0]?.obstacles.length ?? 0;
    // Objects of a task are named in groups.
    [this.named, this.isCrowded] = [count <= NAMED || this.isTask, count > CROWDED && !this.isTask];
    this.hovered = null;
    this.headings();
    this.steps.update(model);
    this.layers.update(model);
    const { workspace, cspace } = this.panels;
    const { joints, plane, one_scale: alike } = model.arm;
    [workspace.x, workspace.y] = this.isTask ? this.stage() : model.frame;
    workspace.titles = plane;
    [cspace.x, cspace.y] = joints.map((joint) => joint.domain);
    cspace.degrees = joints.map((joint) => joint.unit === 'rad');
    cspace.seams = joints.map((joint) => joint.circle);
    cspace.titles = joints.map((joint) => `${joint.name}${joint.unit === 'm' ? ' (m)' : ''}${joint.circle ? ', wraps around' : ''}`);
    cspace.scale = alike ? 'fit' : 'free';
    // Both panels have the same shape, so that their edges are aligned.
    const [width, height] = [cspace.x, cspace.y].map(([low, high]) => high - low);
    const shape = width / height;
    workspace.shape = alike && shape > 0.6 && shape < 1.7 && !this.sideView.isOffered ? shape : null;
    // No room stays empty below a wide configuration space.
    if (alike && shape > 0) this.parts.panels.style.setProperty('--height-per-width', String(1 / shape));
    else this.parts.panels.style.removeProperty('--height-per-width');
    for (const plot of this.plots) plot.fit();
    this.learn.update(model);
    if (!this.hasReplay(model.motions[this.replayed])) this.replayed = 0;
    const [moves, thinks, learns] = [Boolean(model.clock), this.thinks, this.learn.isOffered];
    const there = { move: moves || !thinks, think: thinks, learn: learns };
    for (const button of this.parts.modes.children) button.hidden = !(there[button.dataset.mode] || (button.dataset.mode === 'think' && this.recall));
    this.parts.modes.firstChild.textContent = moves ? 'Motion' : 'Picture';
    this.parts.modes.children[1].textContent = this.replayName;
    const choices = [...this.parts.modes.children].filter((button) => !button.hidden).length;
    this.parts.modes.hidden = choices < 2;
    this.parts.transport.hidden = !moves && !thinks && (this.light || choices < 2);
    if (!moves && !thinks) this.pause();
    if (!there[this.mode]) {
      // Initially, the end of the replay is visible, with everything that the planner found.
      this.times[this.mode] = this.time;
      this.mode = moves || !thinks ? 'move' : 'think';
      this.time = this.mode === 'think' ? this.duration : this.times.move;
    } else if (this.chosen === 'think' && this.mode === 'move' && thinks) this.enter('think');
    this.ready();
  }

  /** Switches to the motion, the planner's replay, or a lesson. */
  switchTo(mode) {
    const button = [...this.parts.modes.children].find((one) => one.dataset.mode === mode);
    if (this.parts.modes.hidden || button.hidden) return;
    this.chosen = mode;
    if (mode === this.mode) return;
    if (mode !== 'learn' && location.hash.startsWith('#learn')) this.learn.note(`#${mode}`);
    this.pause();
    if (mode === 'think' && !this.thinks) {
      this.recall();
      return;
    }
    this.enter(mode);
    if (mode === 'learn') this.examine(null);
    if (mode === 'learn') this.learn.resume();
    else this.ready();
  }

  enter(mode) {
    this.budget.close();
    this.times[this.mode] = this.time;
    // For a task, the replay is that of the current motion.
    const replayed = mode === 'think' && this.hasReplay(this.motion) ? this.model.motions.indexOf(this.motion) : this.replayed;
    if (replayed !== this.replayed) [this.replayed, this.times.think] = [replayed, 0];
    this.mode = mode;
    this.time = this.times[mode];
    if (mode !== 'think' || this.hasThought) return;
    // There is nothing to see at the very beginning.
    this.hasThought = true;
    if (this.time === 0) this.time = this.opening = Math.max(0, this.replay[0].seconds - 1e-3);
  }

  /** Returns true if there is a replay of the planner for a motion of a task. */
  hasReplay(motion) {
    return motion?.replay !== undefined;
  }

  /** Returns the name of the mode that replays the planner. */
  get replayName() {
    const { ending } = this.model;
    if (ending === 'infeasible' && !this.isTask) return 'How it was proven';
    return ending === 'infeasible' || ending === 'unknown' ? 'What was tried' : 'How it was found';
  }

  /** Returns true if there is any replay of the planner. */
  get thinks() {
    return Boolean(this.model.replay ?? this.model.replays);
  }

  /** Updates the controls of the current mode. */
  ready() {
    const { parts } = this;
    parts.plots.hidden = this.mode !== 'move' || !this.model.clock;
    this.learn.show();
    this.sideView.show();
    this.closing.show();
    this.strip.show();
    this.height.show();
    this.followed?.show();
    this.turns.show();
    this.toolAngle.show();
    parts.panels.hidden = this.drawn === 'pair';
    // Room for a scale of colours beside the panel.
    const { scale } = this;
    const margins = scale && this.showsSearch ? [48, 56, 8, 40] : undefined;
    for (const panel of Object.values(this.panels)) {
      panel.margins = margins;
      panel.layout();
    }
    if (!this.light) this.tabs.refresh();
    this.report();
    // While the user drags, hidden controls keep their room, because they come back.
    parts.transport.classList.toggle('still', !this.duration && !this.light);
    parts.transport.classList.toggle('timeless', this.isPlain);
    for (const button of parts.modes.children) button.setAttribute('aria-pressed', String(button.dataset.mode === this.mode));
    parts.scrubber.max = this.duration;
    this.tick();
    this.seek(Math.min(this.time, this.duration));
    this.refresh();
  }

  /** True if the page has the modes 'think' and 'learn'. */
  get hasModes() {
    return true;
  }

  /** Returns the title of the right picture. */
  get space() {
    return 'Configuration space';
  }

  /** Returns what a pointer and keys do in the pictures: pairs of an action and its effect. */
  get pointerHelp() {
    return [
      ['drag the tip of the arm', 'the arm follows; contacts are red'],
      ['Enter in the workspace, then arrow keys', 'the same by keys (with Shift in larger steps)'],
      ['point into the configuration space', 'shows the arm in that configuration, and its contacts'],
      ['click, tap', 'keeps the arm there, or releases it'],
      ['arrow keys in the configuration space', 'move the cross by a degree (with Shift by ten)'],
    ];
  }

  /** Returns what the pictures show: 'move', 'think', 'slice', or 'pair' for the two polygons of a lesson. */
  get drawn() {
    return this.mode === 'learn' ? this.learn.figure : this.mode;
  }

  get duration() {
    if (this.mode === 'learn') return this.learn.duration;
    if (this.drawn === 'think') return Think.duration(this.replay);
    return this.model.clock ? this.model.clock.time[this.model.clock.time.length - 1] : 0;
  }

  /** Returns the phase of the replay, and the part of it that has been shown; `null` in other modes. */
  get moment() {
    return this.drawn === 'think' && this.replay ? Think.moment(this.replay, this.time) : null;
  }

  /** Returns the replay of a task's motion: its phases, and the planner's trace. */
  get account() {
    return this.drawn === 'think' ? this.model.replays?.[this.model.motions[this.replayed].replay] : undefined;
  }

  /** Returns the phases of the current replay. */
  get replay() {
    return this.model.replay ?? this.account?.phases;
  }

  /** Returns the planner's trace. */
  get trace() {
    return (this.account ?? this.world).trace;
  }

  /** Returns the scale of the trace's colours. */
  get scale() {
    return (this.account ?? this.world).scale;
  }

  /** Returns the time that determines the poses of moving obstacles: that of the motion; in other modes 0. */
  get now() {
    return this.drawn === 'move' ? this.time : 0;
  }

  /** Returns the duration of the motion. */
  get motionDuration() {
    return this.model.clock ? this.model.clock.time[this.model.clock.time.length - 1] : 0;
  }

  /** Returns the current motion. */
  get motion() {
    const { motions } = this.model;
    if (this.drawn === 'think') return motions[this.replayed];
    const time = this.drawn === 'move' ? this.time : this.times.move;
    let found = 0;
    for (let i = 1; i < motions.length && motions[i].from <= time + 1e-6; i += 1) found = i;
    return motions[found];
  }

  get world() {
    return this.model.worlds[this.motion?.world ?? 0];
  }

  /** Returns the configuration of the arm. */
  get q() {
    if (this.drawn === 'slice') return this.learn.slices.q;
    if (this.reachMap?.q) return this.reachMap.q;
    if (this.explain.q) return this.explain.q;
    if (this.moment) return Think.focus(this) ?? this.beginning();
    return this.model.clock ? Geometry.moving(this.model.clock, this.time).position : this.beginning();
  }

  /** Returns true if the search of the planner is drawn: not over the motion, unless there is no replay. */
  get showsSearch() {
    return this.drawn === 'think' || this.chosen === 'think' || (!this.thinks && !this.recall);
  }

  /** Returns true if the current mode draws a layer, unless the reader hides it. */
  draws(layer) {
    if (this.drawn === 'slice') return SliceFigure.LAYERS.has(layer);
    if (this.isPlain) return SliceFigure.LAYERS.has(layer);
    return !PLANNER_LAYERS.has(layer) || this.showsSearch;
  }

  /** Returns true if the lesson is about the arm and the obstacles alone, without a motion. */
  get isPlain() {
    return this.mode === 'learn' && Boolean(this.learn.current?.isPlain);
  }

  /** Returns true if a layer is visible. */
  shows(layer) {
    return this.layers.shown.get(layer) && this.draws(layer);
  }

  /** Returns the path of a task's next motion, or `null`. */
  get nextPath() {
    const { motions, paths } = this.model;
    const next = this.isTask && this.motion ? motions[motions.indexOf(this.motion) + 1] : null;
    return paths[next?.path] ?? null;
  }

  /** Returns the paths in the current world. */
  pathsHere() {
    if (this.account) return [this.model.paths[this.motion.path]];
    const world = this.motion?.world ?? 0;
    return this.model.paths.filter((path) => path.world === world);
  }

  /** Returns the paths of the current world of which each ends elsewhere, or with another step, than those before. */
  pathsWithNames() {
    const seen = new Set();
    return this.pathsHere().filter(({ step, points }) => {
      const end = [step, ...points.slice(-2)].join();
      return !seen.has(end) && seen.add(end);
    });
  }

  /** Returns the configuration in which the current content begins. */
  beginning() {
    const { clock, start } = this.model;
    const { motion } = this;
    const [first] = this.pathsHere();
    if (first) return first.points.slice(0, 2);
    return motion && clock ? Geometry.moving(clock, motion.from).position : start;
  }

  /** Returns the ends of the visible paths, or the goals if there are no paths. */
  ends() {
    const ends = this.pathsHere().map((path) => path.points.slice(-2));
    return ends.length ? ends.slice(0, 1) : this.model.goals.slice(0, 1);
  }

  /** Returns goals, each with true if a path ends there (or if no path was found). */
  goals() {
    const ends = this.pathsHere().map((path) => path.points.slice(-2));
    const alone = ends.length === 0;
    const unreached = this.world.unreached.map((q) => [q, false]);
    return [...this.model.goals.map((q) => [q, alone]), ...unreached, ...ends.map((q) => [q, true])];
  }

  /** Returns the name of an obstacle, or its number if there are many. */
  called(obstacle) {
    return this.named ? this.world.obstacles[obstacle].name : String(obstacle + 1);
  }

  /**
   * Returns true if the arm cannot meet an obstacle anywhere: no part of the arm is compared with it, or it has no
   * C-obstacle. Such obstacles are drawn pale, except objects that the arm carries at some time.
   */
  isIrrelevant(obstacle) {
    const { world, model } = this;
    if (this.relevance?.world !== world) {
      const carried = new Set(model.worlds.map(({ payload }) => payload?.object));
      const pairs = new Set(world.pairs.map(([, , index]) => index));
      const shaping = new Set(world.c_obstacles.map(({ obstacle }) => obstacle));
      const meets = shaping.size ? shaping : pairs;
      this.relevance = { world, pale: new Set(world.obstacles.filter(({ name }, index) => !(meets.has(index) && pairs.has(index)) && !carried.has(name))) };
    }
    return this.relevance.pale.has(obstacle);
  }

  /**
   * Returns the part of the workspace in which a task happens: the places of tip, elbow and objects, and the base. If a step
   * fails, also tip and elbow at its goals, and the blocking obstacles within the swept part of the plane.
   */
  stage() {
    const { paths, worlds, motions, arm, places = [], frame, stuck } = this.model;
    const carried = new Set(worlds.map(({ payload }) => payload?.object));
    const objects = [...places, ...worlds.flatMap(({ obstacles }) => obstacles.filter(({ name }) => carried.has(name)))];
    const cornersOf = (shapes) => shapes.flatMap(({ pieces, own }) => pieces.slice(0, own)).flatMap(({ core, radius }) => [...Geometry.pointsOf(core)].flatMap(([x, y]) => [[x - radius, y - radius], [x + radius, y + radius]]));
    const last = worlds[motions[motions.length - 1]?.world ?? 0];
    const blockers = cornersOf((stuck?.blockers ?? []).map((number) => last.obstacles[number]));
    const blocking = blockers.map((corner) => corner.map((x, k) => Math.min(Math.max(x, frame[k][0]), frame[k][1])));
    const unreached = last.unreached.flatMap((q) => [Geometry.elbowAt(arm, q), Geometry.tipAt(arm, q)]);
    const elbows = paths.flatMap(({ points: ends }) => [ends.slice(0, 2), ends.slice(-2)]).map((q) => Geometry.elbowAt(arm, q));
    const points = [arm.base, ...cornersOf(objects), ...blocking, ...unreached, ...elbows, ...paths.flatMap((path) => Workspace.tipTrace(arm, path.points))];
    return [0, 1].map((k) => {
      const values = points.map((point) => point[k]);
      const [low, high] = [Math.min(...values), Math.max(...values)];
      const room = 0.08 * Math.max(high - low, 0.2 * (frame[k][1] - frame[k][0]));
      return [low - room, high + room];
    });
  }

  /** Returns the middle of the motion that keeps the least clearance, in seconds; of carrying motions if there are any. */
  get hardest() {
    const { motions, worlds } = this.model;
    const known = motions.filter(({ clearance }) => clearance !== undefined);
    const carrying = known.filter(({ world }) => worlds[world].payload);
    const [first, ...others] = carrying.length ? carrying : known;
    const hardest = others.reduce((least, motion) => (motion.clearance < least.clearance ? motion : least), first);
    if (!hardest) return 0;
    return (hardest.from + (motions[motions.indexOf(hardest) + 1]?.from ?? this.motionDuration)) / 2;
  }

  /** Returns true if the visible world is the one in which no motion exists: that of the last step. */
  get isStuckHere() {
    const { stuck, motions } = this.model;
    return Boolean(stuck) && (motions.length < 2 || this.motion === motions[motions.length - 1]);
  }

  get isTask() {
    return this.model.paths.some((path) => path.step);
  }

  /** Returns true if there is a path or a goal, and not only a configuration. */
  get isMotion() {
    return this.model.paths.length + this.model.goals.length > 0;
  }

  jointColors() {
    const { theme } = this.panels.workspace;
    return [theme.ink, theme.accent];
  }

  headings() {
    const { title, status, ending, facts } = this.model;
    const { parts } = this;
    /** Shows a text with angles in degrees; its tooltip has radians, too. */
    const readable = (text, tag = 'p') => {
      const shown = Numbers.readable(text);
      return element(tag, shown === text ? {} : { title: text }, shown);
    };
    parts.title.textContent = title[0] ?? '';
    parts.spaceTitle.textContent = this.isTask ? `${this.space} of this step` : this.space;
    const lines = title.slice(1).map((text) => readable(text));
    const further = lines.splice(MAX_LINES);
    const folded = further.length ? [element('details', {}, element('summary', {}, `${further.length} more ${further.length > 1 ? 'lines' : 'line'}`), ...further)] : [];
    parts.lines.replaceChildren(...lines, ...folded);
    if (!this.judged) this.say(ending, status);
    parts.facts.replaceChildren(...facts.flatMap(([name, text]) => [element('dt', {}, name), readable(text, 'dd')]));
    // The live page shows its own figures.
    this.showCards(this.recall ? [] : this.cards());
  }

  /** Shows key figures: name, value and meaning of each. */
  showCards(cards) {
    View.fillCards(this.parts.cards, cards);
  }

  /** Fills a list with key figures. @param {HTMLElement} list @param {any[][]} cards */
  static fillCards(list, cards) {
    list.hidden = !cards.length;
    list.replaceChildren(...cards.map(([name, value, note, kind]) => element('div', { class: kind ? `card ${kind}` : 'card' }, element('dt', {}, name), element('dd', {}, value, element('small', {}, note)))));
  }

  /**
   * Returns the key figures of the page: name, value and meaning.
   * @returns {any[][]}
   */
  cards() {
    return View.cards(this.model);
  }

  /**
   * Returns the key figures of a model: name, value and meaning. Proven bounds are rounded to the safe side.
   * @param {{ figures?: FiguresModel, line?: LineModel, worlds?: WorldModel[], arm?: ArmModel }} model
   */
  static cards({ figures = {}, line: given, worlds = [], arm }) {
    const { duration, gap, fastest, clearance, with_clearance: roomier } = figures;
    // No machine keeps less than a millimetre.
    const isTight = clearance < 1e-3 && !given && worlds[0]?.clearance === 0;
    const other = roomier ? `; --clearance ${Number((1000 * roomier[0]).toPrecision(3))}mm keeps this distance, with length ${Numbers.pathLength(arm.joints, roomier[1])}` : '';
    return [
      duration !== undefined && ['time', Numbers.seconds(duration), 'from rest to rest, within all limits'],
      given?.motion && ['off the line', `at most ${Numbers.length(given.motion.deviation, 0, Math.ceil)}`, `proven; the tolerance is ${Numbers.length(given.tolerance)}`],
      gap !== undefined && ['over the optimum', gap === 0 ? '0 %' : `at most ${Numbers.percent(gap, Math.ceil)}`, fastest ? 'longer than the fastest' : 'longer than the shortest'],
      clearance !== undefined && ['clearance', Numbers.length(clearance, 1, Math.floor), isTight ? `because none was required${other}` : 'proven, to the nearest obstacle', isTight && 'warning'],
    ].filter(Boolean);
  }

  /** Shows the outcome: `ending` for colour and symbol, and `words` as text. */
  say(ending, words) {
    const { status } = this.parts;
    if (status.dataset.ending === ending && status.dataset.words === words) return;
    Object.assign(status.dataset, { ending, words });
    status.replaceChildren(element('span', { 'aria-hidden': 'true' }, SYMBOLS[ending]), ` ${words}`);
  }

  /** Goes to a step: to its time, or to its replay. */
  go(motion) {
    if (this.drawn !== 'think') this.seek(motion.from);
    else if (this.hasReplay(motion)) {
      this.replayed = this.model.motions.indexOf(motion);
      this.time = 0;
      this.ready();
    }
  }

  /** Goes to the end of the phase of the replay that follows (1) or precedes (-1) the current one. */
  stepPhase(direction) {
    let end = 0;
    const ends = this.replay.map(({ seconds }) => (end += seconds) - 1e-3);
    const now = Think.moment(this.replay, this.time).index;
    const isWhole = this.time >= ends[now] - 1e-6;
    const next = direction > 0 && !isWhole ? now : now + direction;
    this.pause();
    this.seek(ends[Math.min(ends.length - 1, Math.max(0, next))]);
  }

  /** Sets marks on the scrubber at the beginnings of steps or phases. */
  tick() {
    let begin = 0;
    const phases = this.drawn === 'think' ? this.replay.map(({ seconds }) => (begin += seconds) - seconds) : this.model.motions.map(({ from }) => from);
    const marks = phases.filter((at) => at > 0 && at < this.duration);
    this.parts.ticks.replaceChildren(...marks.map((at) => {
      const mark = element('i');
      mark.style.setProperty('--at', String(at / this.duration));
      return mark;
    }));
  }

  /** Describes the pictures for users of screen readers. */
  describe() {
    if (this.playing || this.light) return;
    const { arm } = this.model;
    const touching = Geometry.contacts(arm, this.world, this.q);
    const stands = `The arm is at ${this.valued(this.q)}. ${this.touched(touching)}.`;
    const [path] = this.pathsHere();
    const goes = () => {
      const [n, end] = [path.points.length / 2, path.points.slice(-2)];
      return `The path leads from ${this.valued(path.points.slice(0, 2))} to ${this.valued(end)}, through ${n - 2} waypoints in between.`;
    };
    const proven = this.world.proof.length ? ' Boxes of colliding configurations, hatched, prove that there is no path.' : '';
    this.parts.description.textContent = `${stands} ${path ? goes() : this.isMotion ? 'There is no path here.' : ''}${proven}`;
  }

  recolor() {
    const theme = new Theme(document.documentElement);
    for (const panel of [...this.allPanels(), ...Object.values(this.learn.pair.panels)]) {
      panel.theme = theme;
      panel.layout();
    }
    if (!this.model) return;
    this.ready();
  }

  allPanels() {
    return [...Object.values(this.panels), ...this.plots.map((plot) => plot.panel)];
  }

  /** Draws everything again. */
  refresh() {
    if (!this.model) return;
    if (!this.light) this.layers.refresh();
    for (const panel of this.allPanels()) {
      panel.dirty = true;
      panel.draw();
    }
    this.learn.changed();
  }

  // Time.

  seek(time) {
    const before = this.motion;
    this.time = Math.min(this.duration, Math.max(0, Number.isFinite(time) ? time : 0));
    if (this.drawn === 'think' && this.time !== this.opening) this.opening = null;
    const { parts, motion } = this;
    parts.play.classList.toggle('opening', this.drawn === 'think' && this.time === this.opening);
    if (Number(parts.scrubber.value) !== this.time) parts.scrubber.value = this.time;
    const { moment } = this;
    if (this.mode === 'learn' && this.learn.own) {
      parts.clock.textContent = this.learn.clock;
      parts.scrubber.setAttribute('aria-valuetext', this.learn.clock);
      this.learn.changed();
      for (const panel of this.allPanels()) panel.draw();
      return;
    }
    parts.clock.textContent = `${this.time.toFixed(2)} / ${Numbers.seconds(this.duration)}`;
    parts.scrubber.setAttribute('aria-valuetext', `${this.time.toFixed(2)} seconds`);
    const owner = moment && this.account ? `${motion.label}. ` : '';
    const phase = moment && `${owner}${moment.index + 1} of ${this.replay.length}: ${moment.phase.caption}`;
    const step = phase ?? (this.model.motions.length > 1 && motion ? `${motion.label} (${this.world.label})` : '');
    if (parts.step.textContent !== step) parts.step.textContent = step;
    this.showKey(moment);
    if (motion !== before || moment) {
      for (const panel of Object.values(this.panels)) panel.dirty = true;
    }
    if (motion !== before) {
      if (this.probe) this.examine(this.probe.q);
    }
    const now = this.model.motions.indexOf(motion);
    this.steps.follow(now);
    this.sideView.follow();
    this.closing.follow();
    this.strip.follow();
    this.describe();
    for (const panel of this.allPanels()) panel.draw();
  }

  /** Shows the meaning of the colours of a phase that sorts parts of the configuration space. */
  showKey(moment) {
    const { key } = this.parts;
    const sorts = ['slabs', 'boxes'].includes(moment?.phase.kind);
    key.hidden = !sorts;
    if (!sorts || key.children.length) return;
    for (const [color, text] of [['free', 'free'], ['paper', 'colliding: white, or under a C-obstacle'], ['undecided', 'undecided']]) {
      key.append(element('li', {}, element('span', { class: 'swatch', style: `background:var(--${color})` }), text));
    }
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (!this.duration) return;
    if (this.probe) this.examine(null);
    if (this.time >= this.duration || (this.drawn === 'think' && this.time === this.opening)) this.seek(0);
    this.playing = true;
    this.mark();
    let before = null;
    let { time } = this;
    let last = time;
    const tick = (now) => {
      if (!this.playing) return;
      // The reader may have moved the scrubber.
      if (this.time !== last) ({ time } = this);
      if (before !== null) time = Math.min(this.duration, time + ((now - before) / 1000) * this.speed);
      const shown = this.shownTime(time);
      if (shown !== this.time) this.seek(shown);
      last = this.time;
      before = now;
      if (time >= this.duration) this.pause();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  /**
   * Returns the time to show while playing has reached `time`. For readers who prefer reduced motion, the replay shows
   * the end of each phase at once.
   */
  shownTime(time) {
    if (this.drawn !== 'think' || !Settings.reducesMotion) return time;
    let end = 0;
    for (const { seconds } of this.replay) {
      end += seconds;
      if (time < end) break;
    }
    return Math.min(this.duration, end - 1e-6);
  }

  pause() {
    this.playing = false;
    this.mark();
    if (this.model) this.describe();
  }

  mark() {
    const action = this.playing ? 'pause' : 'play';
    this.parts.play.replaceChildren(icon(action));
    this.parts.play.setAttribute('aria-label', action);
    this.parts.play.title = `${action} (Space)`;
  }

  setSpeed(speed) {
    this.speed = speed;
    this.parts.speed.value = String(speed);
  }

  // Examining a configuration.

  /** Returns the spot about which keys and buttons magnify a panel: that of the cross, or `null` for the middle. */
  zoomSpot(panel) {
    return panel === this.panels.cspace && this.probe ? panel.at(this.probe.q) : null;
  }

  /** Returns the spot of the tip of the examined arm, or of the current one. */
  get tipSpot() {
    return this.panels.workspace.at(Geometry.tipAt(this.model.arm, this.probe?.q ?? this.q));
  }

  /**
   * Returns true if a pointer at this spot takes the tip of the arm.
   * @param {Point} spot
   * @param {{ pointerType: string }} event
   */
  isAtTip([x, y], { pointerType }) {
    if (this.drawn === 'slice') return false;
    const [u, v] = this.tipSpot;
    return Math.hypot(u - x, v - y) < (pointerType === 'mouse' ? NEAR_MOUSE : NEAR);
  }

  /**
   * Returns true if a pointer at this spot takes the dot of the arm in the configuration space: the cross that is kept
   * there or, for a mouse, also that of the current arm. A finger that begins elsewhere scrolls the page.
   * @param {Point} spot
   * @param {{ pointerType: string }} event
   */
  isAtDot([x, y], { pointerType }) {
    const isMouse = pointerType === 'mouse';
    if (!isMouse && !(this.pinned && this.probe)) return false;
    const { cspace } = this.panels;
    const [u, v] = this.pinned && this.probe ? cspace.at(this.probe.q) : CSpace.place(this, cspace, this.q);
    return Math.hypot(u - x, v - y) < (isMouse ? NEAR_MOUSE : NEAR);
  }

  /** Moves the examined arm so that its tip is at a place of the workspace, or as near as the joints allow. */
  dragTip(place) {
    this.place(Geometry.inverse(this.model.arm, place, this.probe?.q ?? this.q));
  }

  /** Keeps the examined arm in a configuration, within the limits of its joints. */
  place(q) {
    this.pinned = true;
    this.examine(this.model.arm.joints.map((joint, k) => (joint.circle ? Geometry.wrap(joint, q[k]) : Math.min(joint.domain[1], Math.max(joint.domain[0], q[k])))));
  }

  /** Places a second arm at q, and shows what it touches; without q, removes it. */
  examine(q) {
    if (this.drawn === 'slice' && q) {
      // A slice is chosen by a click, not by every move of the mouse.
      if (this.pinned) this.learn.slices.goTo(q);
      this.pinned = false;
      return;
    }
    if (q !== this.budget.shown?.at) this.budget.release();
    this.probe = q && { q, contacts: Geometry.contacts(this.model.arm, this.world, q) };
    if (!q) this.pinned = false;
    this.report();
    if (q) this.follow(q);
    for (const panel of Object.values(this.panels)) panel.draw();
  }

  /** Returns the arm whose contacts are shown: the examined one or, on a page without a motion, the only one. */
  get examined() {
    if (this.probe || this.isMotion || this.reachMap || this.drawn === 'slice') return this.probe;
    const { q } = this;
    const contacts = Geometry.contacts(this.model.arm, this.world, q);
    return contacts.length ? { q, contacts } : null;
  }

  /** Describes the examined arm below the pictures. */
  report() {
    const { examined } = this;
    const text = examined ? `${this.valued(examined.q)}: ${this.touched(examined.contacts)}` : '';
    if (this.parts.probe.textContent !== text) this.parts.probe.textContent = text;
    this.parts.probe.classList.toggle('tried', Boolean(this.probe));
    this.parts.probe.title = examined ? Numbers.exact(this.model.arm.joints, examined.q) : '';
    this.parts.probe.dataset.free = examined ? String(!(examined.contacts[0]?.distance <= 0)) : '';
  }

  /** On a small screen, moves the description above the finger, as far as there is room. */
  follow(q) {
    const { canvas } = this.panels.cspace;
    // The page of an inspection has no configuration space.
    if (!canvas.offsetParent) return;
    const frame = /** @type {HTMLElement} */ (canvas.offsetParent);
    const [x, y] = this.panels.cspace.at(q);
    const { style } = this.parts.probe;
    style.setProperty('--x', `${Math.round(frame.offsetLeft + canvas.offsetLeft + x)}px`);
    style.setProperty('--y', `${Math.round(frame.offsetTop + canvas.offsetTop + y)}px`);
  }

  /** Describes a configuration. */
  valued(q) {
    // With more digits in a magnified picture.
    return Numbers.configuration(this.model.arm.joints, q, Math.floor(Math.log10(this.panels.cspace.times)));
  }

  /** Describes the contacts, or the nearest obstacle. */
  touched(contacts) {
    const { arm } = this.model;
    const hits = contacts.filter((c) => c.distance <= 0);
    const who = (c) => (c.carried ? `payload "${c.body}"` : `link "${arm.links[c.link].name}"`);
    const pair = (c) => `${who(c)} and "${this.world.obstacles[c.obstacle].name}"`;
    const depth = (c) => `${Numbers.length(-c.distance)} deep`;
    if (hits.length) return `touches: ${hits.map((c) => `${pair(c)}, ${depth(c)}`).join('; ')}`;
    const [nearest] = contacts;
    if (!nearest) return 'free; no obstacle within reach';
    const room = nearest.distance <= this.world.clearance ? 'closer than the requested clearance' : 'free';
    return `${room}; nearest: ${pair(nearest)}, ${Numbers.length(nearest.distance)}`;
  }
}
