// The page: two panels, their layers, and time.
'use strict';

/** Creates an element with attributes and children. */
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (value !== undefined && value !== false) made.setAttribute(name, value === true ? '' : value);
  }
  made.append(...children.filter((child) => child !== undefined && child !== null));
  return made;
}

const SYMBOLS = { found: '\u2713', infeasible: '\u2715', unknown: '?', shown: '\u2022', waiting: '\u2026' };
/**
 * A finger that moves less than `TAP` has tapped. One that begins within `NEAR` of the cross, or of the arm's tip, takes
 * it; a mouse within `NEAR_MOUSE`. In pixels.
 */
const [TAP, NEAR, NEAR_MOUSE] = [10, 24, 12];
/** Directions of arrow keys, and the pixels (`PAN`) by which they move a magnified picture. */
const DIRECTIONS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] };
const PAN = 40;
/** A larger movement drags a magnified picture, in pixels. */
const DRAG = 4;
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 10];
/** More obstacles than `NAMED` have numbers instead of names. With more than `CROWDED`, names appear only under the pointer. */
const [NAMED, CROWDED] = [16, 40];
/** Magnification by a key or button, and its logarithm per pixel of a wheel. */
const [MAGNIFIES, A_PIXEL] = [1.5, 0.002];
/** A wheel that scrolled the page within this time continues to do so, in milliseconds. */
const SCROLLING = 300;

/** Width of the page from which layers and steps stand beside the pictures. */
const WIDE = '(min-width: 77.5rem)';

class View {
  /** Creates a view of `model` within `root`. `recall` requests the planner's replay, if there is a program to answer. */
  constructor(root, model, recall = null) {
    this.root = root;
    root.classList.toggle('live', Boolean(recall));
    this.hidden = new Set();
    this.time = 0;
    /** Content that is played: 'move', the motion; 'think', the planner's replay; or 'learn', a lesson. Each keeps its time. */
    this.mode = 'move';
    this.times = { move: 0, think: 0, learn: 0 };
    /** Index of a task's motion whose replay 'think' shows. */
    this.replayed = 0;
    this.recall = recall;
    /** Mode that the user has chosen. The view returns to it when it is available again. */
    this.chosen = 'move';
    this.learn = new Learn(this);
    this.speed = 1;
    this.playing = false;
    this.probe = null;
    this.pinned = false;
    /**
     * Handler that receives pointer events before the view: { down, move, up }, each called with panel, value and
     * event. `tap(panel)` is called for a finger's tap on nothing, and `grasps(panel, value, event)` returns whether
     * there is something to take.
     */
    this.tool = null;
    /** True if another script reports the outcome: see `say`. */
    this.judged = false;
    /** True to leave out everything that is slow to draw, while something moves. */
    this.light = false;
    this.build();
    this.update(model);
    const themes = matchMedia('(prefers-color-scheme: dark)');
    themes.addEventListener('change', () => this.recolor());
    document.addEventListener('keydown', (event) => this.key(event));
  }

  // Content.

  /** Shows another model. Layers, hidden obstacles and, as far as possible, the time stay the same. */
  update(model) {
    this.model = model;
    this.traces = null;
    const count = model.worlds[0]?.obstacles.length ?? 0;
    [this.named, this.isCrowded] = [count <= NAMED, count > CROWDED];
    this.hovered = null;
    this.headings();
    this.steps.update(model);
    this.layers.update(model);
    const { workspace, cspace } = this.panels;
    const { joints, plane, one_scale: alike } = model.arm;
    [workspace.x, workspace.y] = model.frame;
    workspace.titles = plane;
    [cspace.x, cspace.y] = joints.map((joint) => joint.domain);
    cspace.degrees = joints.map((joint) => joint.unit === 'rad');
    cspace.seams = joints.map((joint) => joint.circle);
    cspace.titles = joints.map((joint) => `${joint.name}${joint.unit === 'm' ? ' (m)' : ''}${joint.circle ? ', wraps around' : ''}`);
    cspace.scale = alike ? 'fit' : 'free';
    // Both panels have the same shape, so that their edges are aligned.
    const [width, height] = [cspace.x, cspace.y].map(([low, high]) => high - low);
    const shape = width / height;
    workspace.shape = alike && shape > 0.6 && shape < 1.7 ? shape : null;
    for (const plot of this.plots) plot.fit();
    this.learn.update(model);
    if (!this.hasReplay(model.motions[this.replayed])) this.replayed = 0;
    const [moves, thinks, learns] = [Boolean(model.clock), this.thinks, this.learn.lessons.length > 0];
    const there = { move: moves || !thinks, think: thinks, learn: learns };
    for (const button of this.parts.modes.children) button.hidden = !(there[button.dataset.mode] || (button.dataset.mode === 'think' && this.recall));
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
    this.pause();
    if (mode === 'think' && !this.thinks) {
      this.recall();
      return;
    }
    this.enter(mode);
    if (mode === 'learn') this.examine(null);
    if (mode === 'learn' && !this.time) this.learn.start(this.learn.lesson);
    else this.ready();
  }

  enter(mode) {
    this.times[this.mode] = this.time;
    // For a task, the replay is that of the current motion.
    const replayed = mode === 'think' && this.hasReplay(this.motion) ? this.model.motions.indexOf(this.motion) : this.replayed;
    if (replayed !== this.replayed) [this.replayed, this.times.think] = [replayed, 0];
    this.mode = mode;
    this.time = this.times[mode];
  }

  /** Returns true if there is a replay of the planner for a motion of a task. */
  hasReplay(motion) {
    return motion?.replay !== undefined;
  }

  /** Returns true if there is any replay of the planner. */
  get thinks() {
    return Boolean(this.model.replay ?? this.model.replays);
  }

  /** Updates the controls of the current mode. */
  ready() {
    const { parts } = this;
    const learns = this.mode === 'learn';
    parts.plots.hidden = this.mode !== 'move' || !this.model.clock;
    this.learn.show();
    this.strip.show();
    parts.panels.hidden = learns && !this.learn.isSlice;
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
    for (const button of parts.modes.children) button.setAttribute('aria-pressed', String(button.dataset.mode === this.mode));
    parts.scrubber.max = this.duration;
    this.tick();
    this.seek(Math.min(this.time, this.duration));
    this.refresh();
  }

  get duration() {
    if (this.mode === 'learn') return this.learn.duration;
    if (this.mode === 'think') return Think.duration(this.replay);
    return this.model.clock ? this.model.clock.time[this.model.clock.time.length - 1] : 0;
  }

  /** Returns the phase of the replay, and the part of it that has been shown; `null` in other modes. */
  get moment() {
    return this.mode === 'think' && this.replay ? Think.moment(this.replay, this.time) : null;
  }

  /** Returns the replay of a task's motion: its phases, and the planner's trace. */
  get account() {
    return this.mode === 'think' ? this.model.replays?.[this.model.motions[this.replayed].replay] : undefined;
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
    return this.mode === 'move' ? this.time : 0;
  }

  /** Returns the duration of the motion. */
  get motionDuration() {
    return this.model.clock ? this.model.clock.time[this.model.clock.time.length - 1] : 0;
  }

  /** Returns the current motion. */
  get motion() {
    const { motions } = this.model;
    if (this.mode === 'think') return motions[this.replayed];
    const time = this.mode === 'move' ? this.time : this.times.move;
    let found = 0;
    for (let i = 1; i < motions.length && motions[i].from <= time + 1e-6; i += 1) found = i;
    return motions[found];
  }

  get world() {
    return this.model.worlds[this.motion?.world ?? 0];
  }

  /** Returns the configuration of the arm. */
  get q() {
    if (this.mode === 'learn' && this.learn.isSlice) return this.learn.q;
    if (this.moment) return Think.focus(this) ?? this.beginning();
    return this.model.clock ? Geometry.moving(this.model.clock, this.time).position : this.beginning();
  }

  /** Returns true if the search of the planner is drawn: not over the motion, unless there is no replay. */
  get showsSearch() {
    return this.mode === 'think' || this.chosen === 'think' || (!this.thinks && !this.recall);
  }

  /** Returns true if the current mode draws a layer, unless the reader hides it. */
  draws(layer) {
    if (this.mode === 'learn') return Learn.LAYERS.has(layer);
    return !PLANNER_LAYERS.has(layer) || this.showsSearch;
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

  // Elements of the page.

  build() {
    const canvas = (label) => element('canvas', { tabindex: '0', role: 'img', 'aria-label': label, 'aria-describedby': 'description' });
    const [left, right] = [canvas('Workspace'), canvas('Configuration space')];
    const parts = {
      title: element('h1'),
      lines: element('div', { class: 'lines' }),
      cards: element('dl', { class: 'cards', 'aria-label': 'Key figures', hidden: true }),
      status: element('p', { class: 'status', role: 'status' }),
      facts: element('dl', { class: 'facts' }),
      probe: element('p', { class: 'probe', 'aria-live': 'polite' }),
      description: element('p', { class: 'unseen', id: 'description' }),
      measure: element('span', { class: 'measure', 'aria-hidden': 'true' }),
      ticks: element('span', { class: 'ticks', 'aria-hidden': 'true' }),
      play: element('button', { type: 'button', class: 'play', onclick: () => this.toggle() }),
      scrubber: element('input', {
        type: 'range', min: '0', max: '1', step: 'any', value: '0', 'aria-label': 'time',
        oninput: (event) => this.seek(Number(event.target.value)),
      }),
      clock: element('span', { class: 'clock' }),
      step: element('p', { class: 'step', 'aria-live': 'polite' }),
      plots: element('section', { class: 'plots', 'aria-label': 'Motion over time' }),
    };
    const speed = element('select', { 'aria-label': 'speed', onchange: (event) => this.setSpeed(Number(event.target.value)) });
    for (const value of SPEEDS) speed.append(element('option', { value, selected: value === 1 }, `${value}\u00d7`));
    parts.speed = speed;
    const mode = (name, text) => element('button', { type: 'button', class: 'button', 'data-mode': name, onclick: () => this.switchTo(name) }, text);
    parts.modes = element('span', { class: 'modes', role: 'group', 'aria-label': 'What is played' }, mode('move', 'Motion'), mode('think', 'How it was found'), mode('learn', 'Learn'));
    this.steps = new Steps(this);
    this.layers = new Layers(this);
    const track = element('div', { class: 'track' }, this.steps.timeline, element('span', { class: 'slider' }, parts.ticks, parts.scrubber));
    const controls = element('div', { class: 'controls-of-time' }, parts.modes, parts.play, track, parts.clock, speed);
    parts.transport = element('section', { class: 'transport', 'aria-label': 'Time' }, parts.step, controls);
    parts.panels = element(
      'section',
      { class: 'panels' },
      element('figure', {}, element('figcaption', {}, 'Workspace'), left, this.buttons('workspace', 'Workspace')),
      element('figure', {}, element('figcaption', {}, 'Configuration space'), right, this.buttons('cspace', 'Configuration space')),
      parts.probe,
    );
    this.parts = parts;
    this.tabs = this.buildTabs();
    this.tour = new Tour(this);
    this.strip = Strip.mount(this);
    this.root.append(
      element('header', {}, element('div', {}, parts.title, parts.lines), parts.status),
      parts.cards,
      element(
        'div',
        { class: 'stage' },
        element('div', { class: 'pictures' }, parts.panels, this.learn.parts.panels, parts.description, parts.measure, this.strip.root, parts.transport, this.learn.parts.choice, this.learn.parts.text),
        element('div', { class: 'below' }, this.tabs.root, ...this.tabs.entries.filter(({ isAside }) => !isAside).map(({ panel }) => panel)),
        element('aside', { class: 'side', 'aria-label': 'Steps and layers' }, this.steps.root, this.layers.root),
      ),
      help(this),
      this.tour.root,
    );
    this.panels = {
      workspace: new Panel(left, {
        x: [0, 1], y: [0, 1], scale: 'fill',
        still: (context, panel) => Workspace.still(context, panel, this),
        moving: (context, panel) => (this.mode === 'learn' ? this.learn.drawArm(context, panel) : Workspace.moving(context, panel, this)),
      }),
      cspace: new Panel(right, {
        x: [0, 1], y: [0, 1], scale: 'fit',
        still: (context, panel) => CSpace.still(context, panel, this),
        moving: (context, panel) => (this.mode === 'learn' ? this.learn.drawSlice(context, panel) : CSpace.moving(context, panel, this)),
        beside: (context, panel) => CSpace.beside(context, panel, this),
      }),
    };
    // Texts on canvases follow the text size of the page.
    new ResizeObserver(() => this.model && this.recolor()).observe(parts.measure);
    this.plots = [...Plots.mount(parts.plots, this), this.strip];
    for (const panel of Object.values(this.panels)) {
      this.listen(panel);
      this.magnifies(panel);
    }
    this.mark();
    this.recolor();
  }

  /** Creates the tabs. Steps and layers stand beside the pictures if there is room. */
  buildTabs() {
    const wide = matchMedia(WIDE);
    const never = () => false;
    const isBeside = () => wide.matches;
    const tabs = new Tabs('More', [
      { name: 'layers', title: 'Layers', panel: this.layers.root, isAside: true, isOffered: () => true, isBeside },
      { name: 'steps', title: 'Steps', panel: this.steps.root, isAside: true, isOffered: () => this.steps.buttons.length > 0, isBeside },
      { name: 'plots', title: 'Plots', panel: element('div', {}, this.parts.plots), isOffered: () => Boolean(this.model?.clock) && this.mode === 'move', isBeside: never },
      { name: 'details', title: 'Details', panel: element('div', {}, this.parts.facts), isOffered: () => Boolean(this.model?.facts.length), isBeside: never },
    ]);
    wide.addEventListener('change', () => tabs.refresh());
    return tabs;
  }

  headings() {
    const { title, status, ending, facts } = this.model;
    const { parts } = this;
    parts.title.textContent = title[0] ?? '';
    parts.lines.replaceChildren(...title.slice(1).map((text) => element('p', {}, text)));
    if (!this.judged) this.say(ending, status);
    parts.facts.replaceChildren(...facts.flatMap(([name, text]) => [element('dt', {}, name), element('dd', {}, text)]));
    // The live page shows its own figures.
    const cards = this.recall ? [] : View.cards(this.model);
    parts.cards.hidden = !cards.length;
    parts.cards.replaceChildren(...cards.map(([name, value, note]) => element('div', { class: 'card' }, element('dt', {}, name), element('dd', {}, value, element('small', {}, note)))));
  }

  /** Returns the key figures of a model: name, value and meaning. Proven bounds are rounded to the safe side. */
  static cards({ figures = {} }) {
    const { duration, gap, fastest, clearance } = figures;
    return [
      duration !== undefined && ['time', Numbers.seconds(duration), 'from rest to rest, within all limits'],
      duration !== undefined && gap === undefined && ['over the optimum', 'not proven', 'no bound on the optimum is known'],
      gap !== undefined && ['over the optimum', gap === 0 ? '0 %' : `at most ${Numbers.percent(gap, Math.ceil)}`, fastest ? 'longer than the fastest' : 'longer than the shortest'],
      clearance !== undefined && ['clearance', Numbers.length(clearance, 0, Math.floor), 'proven, to the nearest obstacle'],
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
    if (this.mode !== 'think') this.seek(motion.from);
    else if (this.hasReplay(motion)) {
      this.replayed = this.model.motions.indexOf(motion);
      this.time = 0;
      this.ready();
    }
  }

  /** Sets marks on the scrubber at the beginnings of steps or phases. */
  tick() {
    let begin = 0;
    const phases = this.mode === 'think' ? this.replay.map(({ seconds }) => (begin += seconds) - seconds) : this.model.motions.map(({ from }) => from);
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
    for (const panel of [...this.allPanels(), ...Object.values(this.learn.panels)]) {
      panel.theme = theme;
      panel.layout();
    }
    if (!this.model) return;
    this.ready();
  }

  allPanels() {
    return [...Object.values(this.panels), ...(this.plots ?? []).map((plot) => plot.panel)];
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
    const { parts, motion } = this;
    if (Number(parts.scrubber.value) !== this.time) parts.scrubber.value = this.time;
    const { moment } = this;
    if (this.mode === 'learn') {
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
    if (motion !== before || moment) {
      for (const panel of Object.values(this.panels)) panel.dirty = true;
    }
    if (motion !== before) {
      if (this.probe) this.examine(this.probe.q);
    }
    const now = this.mode === 'learn' ? -1 : this.model.motions.indexOf(motion);
    this.steps.follow(now);
    this.strip.follow();
    this.describe();
    for (const panel of this.allPanels()) panel.draw();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (!this.duration) return;
    if (this.probe) this.examine(null);
    if (this.time >= this.duration) this.seek(0);
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
    if (this.mode !== 'think' || !Settings.reducesMotion) return time;
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

  listen(panel) {
    const { canvas } = panel;
    const asTool = (name, event) => this.tool?.[name]?.(panel, panel.value(panel.spot(event)), event);
    const isCSpace = panel === this.panels.cspace;
    /** True while the tool has the pointer. */
    let taken = false;
    /** Place where the pointer was pressed, whether it took the cross, and the last place of a drag. */
    let press = null;
    /** Distance of two fingers that pinch, and the spot between them. */
    let pinch = null;
    canvas.addEventListener('pointerdown', (event) => {
      press = null;
      taken = Boolean(asTool('down', event));
      if (taken) {
        canvas.setPointerCapture(event.pointerId);
        event.preventDefault();
      } else if (event.button === 0) {
        const spot = panel.spot(event);
        const holds = this.mode !== 'learn' && (isCSpace ? this.isAtDot(spot, event) : this.isAtTip(spot, event));
        press = { from: spot, last: spot, holds, drags: false };
        if (!isCSpace && holds) {
          this.pause();
          press.grip = this.tipSpot.map((x, k) => x - spot[k]);
        }
        if (holds || (panel.times > 1 && event.pointerType === 'mouse')) canvas.setPointerCapture(event.pointerId);
      }
    });
    canvas.addEventListener('pointermove', (event) => {
      if (asTool('move', event) || pinch) return;
      const spot = panel.spot(event);
      if (press && !press.holds && panel.times > 1) {
        press.drags ||= Math.hypot(spot[0] - press.from[0], spot[1] - press.from[1]) > DRAG;
        if (!press.drags) return;
        panel.move(spot[0] - press.last[0], spot[1] - press.last[1]);
        press.last = spot;
        return;
      }
      if (press?.grip) {
        press.drags ||= Math.hypot(spot[0] - press.from[0], spot[1] - press.from[1]) > DRAG;
        if (press.drags) this.dragTip(panel.value(spot.map((x, k) => x + press.grip[k])));
        return;
      }
      if (isCSpace && press?.holds && event.pointerType === 'mouse') {
        press.drags ||= Math.hypot(spot[0] - press.from[0], spot[1] - press.from[1]) > DRAG;
        if (press.drags) this.place(panel.value(spot));
        return;
      }
      if (!isCSpace && event.pointerType === 'mouse' && this.isAtTip(spot, event)) canvas.style.cursor = 'grab';
      else if (!isCSpace && !this.tool) canvas.style.cursor = '';
      if (!panel.contains(spot)) return;
      if (!isCSpace) this.hover(panel, event);
      else if (event.pointerType === 'mouse' ? !this.pinned : press?.holds) this.examine(panel.value(spot));
    });
    canvas.addEventListener('pointerup', (event) => {
      taken = false;
      if (asTool('up', event) || !press) return;
      const spot = panel.spot(event);
      const { from, holds, drags } = press;
      press = null;
      if (drags || Math.hypot(spot[0] - from[0], spot[1] - from[1]) >= TAP) return;
      const isMouse = event.pointerType === 'mouse';
      if (!isMouse) this.tool?.tap(panel);
      if (!isCSpace || !panel.contains(spot)) return;
      this.pinned = isMouse ? !this.pinned : !holds;
      this.examine(holds && !isMouse ? null : panel.value(spot));
    });
    canvas.addEventListener('pointercancel', (event) => {
      [press, taken] = [null, false];
      asTool('up', event);
    });
    canvas.addEventListener('pointerleave', () => {
      if (isCSpace && !this.pinned) this.examine(null);
      if (!isCSpace) this.hover(panel, null);
    });
    // A touch that begins on a handle does not scroll the page. Nor do two fingers, or one finger in a magnified
    // picture.
    const takes = ({ clientX, clientY }) => {
      const touch = { clientX, clientY, pointerType: 'touch' };
      return panel.times > 1 || asTool('grasps', touch) || (isCSpace ? this.isAtDot(panel.spot(touch), touch) : this.isAtTip(panel.spot(touch), touch));
    };
    const between = ([a, b]) => ({
      apart: Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY),
      spot: panel.spot({ clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2 }),
    });
    canvas.addEventListener('touchstart', (event) => {
      const { touches } = event;
      if (touches.length === 1 ? takes(touches[0]) : touches.length === 2) event.preventDefault();
      pinch = touches.length === 2 && !taken ? between(touches) : null;
      if (pinch) press = null;
    }, { passive: false });
    canvas.addEventListener('touchmove', (event) => {
      if (!pinch || event.touches.length !== 2) return;
      event.preventDefault();
      const now = between(event.touches);
      panel.move(now.spot[0] - pinch.spot[0], now.spot[1] - pinch.spot[1]);
      panel.magnify(now.apart / pinch.apart, now.spot);
      pinch = now;
    }, { passive: false });
    for (const end of ['touchend', 'touchcancel']) canvas.addEventListener(end, () => (pinch = null));
  }

  /** Magnifies by wheel and double click. */
  magnifies(panel) {
    const { canvas } = panel;
    let scrolled = -Infinity;
    document.addEventListener('scroll', () => (scrolled = performance.now()), { passive: true });
    canvas.addEventListener('wheel', (event) => {
      const spot = panel.spot(event);
      const leaves = panel.times === 1 && (event.deltaY > 0 || (!event.ctrlKey && performance.now() - scrolled < SCROLLING));
      if (leaves || !panel.contains(spot)) {
        // Otherwise, a pinch on a touchpad would magnify the page.
        if (event.ctrlKey) event.preventDefault();
        return;
      }
      event.preventDefault();
      const pixels = event.deltaY * (event.deltaMode === 1 ? 30 : 1) * (event.ctrlKey ? 4 : 1);
      panel.magnify(Math.exp(-A_PIXEL * Math.min(400, Math.max(-400, pixels))), spot);
    }, { passive: false });
    canvas.addEventListener('dblclick', (event) => {
      const takes = this.tool?.grasps(panel, panel.value(panel.spot(event)), event);
      if (panel.times > 1 && !takes) panel.reset();
    });
  }

  /** Magnifies about the cross or the middle. */
  magnify(panel, factor) {
    const { rect } = panel;
    const at = panel === this.panels.cspace && this.probe ? panel.at(this.probe.q) : null;
    panel.magnify(factor, at && panel.contains(at) ? at : [rect.x + rect.width / 2, rect.y + rect.height / 2]);
  }

  buttons(name, label) {
    const button = (sign, what, act) => element('button', { type: 'button', class: 'button', 'aria-label': `${what}: ${label}`, title: what, onclick: () => act(this.panels[name]) }, icon(sign));
    return element(
      'span',
      { class: 'zoom' },
      button('plus', 'zoom in', (panel) => this.magnify(panel, MAGNIFIES)),
      button('minus', 'zoom out', (panel) => this.magnify(panel, 1 / MAGNIFIES)),
      button('reset', 'show all', (panel) => panel.reset()),
    );
  }

  /** Shows the name of the obstacle under the pointer, if obstacles have numbers or no label. */
  hover(panel, event) {
    const index = event && !this.named ? Workspace.found(this, panel.value(panel.spot(event))) : null;
    if (index === null && !this.hovered) return;
    const [x, y] = event ? panel.spot(event) : [0, 0];
    this.hovered = index === null ? null : [`${index + 1} ${this.world.obstacles[index].name}`, x, y - 14];
    panel.draw();
  }

  /** Returns the spot of the tip of the examined arm, or of the current one. */
  get tipSpot() {
    return this.panels.workspace.at(Geometry.tipAt(this.model.arm, this.probe?.q ?? this.q));
  }

  /** Returns true if a pointer at this spot takes the tip of the arm. */
  isAtTip([x, y], { pointerType }) {
    if (this.mode === 'learn') return false;
    const [u, v] = this.tipSpot;
    return Math.hypot(u - x, v - y) < (pointerType === 'mouse' ? NEAR_MOUSE : NEAR);
  }

  /**
   * Returns true if a pointer at this spot takes the dot of the arm in the configuration space: the cross that is kept
   * there or, for a mouse, also that of the current arm. A finger that begins elsewhere scrolls the page.
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
    if (this.mode === 'learn' && q) {
      // A slice is chosen by a click, not by every move of the mouse.
      if (this.pinned && this.learn.isSlice) this.learn.goTo(q);
      this.pinned = false;
      return;
    }
    this.probe = q && { q, contacts: Geometry.contacts(this.model.arm, this.world, q) };
    if (!q) this.pinned = false;
    this.report();
    if (q) this.follow(q);
    for (const panel of Object.values(this.panels)) panel.draw();
  }

  /** Returns the arm whose contacts are shown: the examined one or, on a page without a motion, the only one. */
  get examined() {
    if (this.probe || this.isMotion || this.mode === 'learn') return this.probe;
    const { q } = this;
    const contacts = Geometry.contacts(this.model.arm, this.world, q);
    return contacts.length ? { q, contacts } : null;
  }

  /** Describes the examined arm below the pictures. */
  report() {
    const { examined } = this;
    const text = examined ? `${this.valued(examined.q)}: ${this.touched(examined.contacts)}` : '';
    if (this.parts.probe.textContent !== text) this.parts.probe.textContent = text;
    this.parts.probe.title = examined ? Numbers.exact(this.model.arm.joints, examined.q) : '';
    this.parts.probe.dataset.free = examined ? String(!(examined.contacts[0]?.distance <= 0)) : '';
  }

  /** On a small screen, moves the description above the finger, as far as there is room. */
  follow(q) {
    const { canvas } = this.panels.cspace;
    const [x, y] = this.panels.cspace.at(q);
    const { style } = this.parts.probe;
    style.setProperty('--x', `${Math.round(canvas.offsetParent.offsetLeft + canvas.offsetLeft + x)}px`);
    style.setProperty('--y', `${Math.round(canvas.offsetParent.offsetTop + canvas.offsetTop + y)}px`);
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

  // Keys.

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches?.('input:not([type=checkbox]):not([type=range]), textarea, select')) return;
    const panel = Object.values(this.panels).find(({ canvas }) => event.target === canvas);
    if (panel && (this.zooms(panel, event) || (panel === this.panels.cspace ? this.nudge(event) : this.nudgeTip(event)))) return;
    const control = event.target.matches?.('button, input, a, summary');
    const step = event.shiftKey ? 0.5 : 0.05;
    const keys = {
      ' ': () => !control && this.toggle(),
      k: () => this.toggle(),
      ArrowRight: () => !control && this.seek(this.time + step),
      ArrowLeft: () => !control && this.seek(this.time - step),
      Home: () => !control && this.seek(0),
      End: () => !control && this.seek(this.duration),
      t: () => this.switchTo(this.mode === 'think' ? 'move' : 'think'),
      l: () => this.switchTo(this.mode === 'learn' ? 'move' : 'learn'),
      '+': () => this.setSpeed(SPEEDS[Math.min(SPEEDS.length - 1, SPEEDS.indexOf(this.speed) + 1)]),
      '-': () => this.setSpeed(SPEEDS[Math.max(0, SPEEDS.indexOf(this.speed) - 1)]),
      0: () => Object.values(this.panels).forEach((panel) => panel.reset()),
      Escape: () => this.examine(null),
    };
    if (/^[^ ]$/u.test(event.key) && !Settings.hasShortcuts) return;
    const done = keys[event.key]?.();
    if (done !== undefined && done !== false) event.preventDefault();
    else if (keys[event.key] && !control) event.preventDefault();
  }

  /**
   * Handles keys that magnify a panel or move the magnified part. In the configuration space, the visible part follows
   * the cross.
   */
  zooms(panel, event) {
    const direction = DIRECTIONS[event.key];
    const keys = { '+': () => this.magnify(panel, MAGNIFIES), '=': () => this.magnify(panel, MAGNIFIES), '-': () => this.magnify(panel, 1 / MAGNIFIES), 0: () => panel.reset() };
    const pans = direction && event.shiftKey && panel.times > 1 && panel === this.panels.workspace;
    if (pans) panel.move(-PAN * direction[0], PAN * direction[1]);
    else if (keys[event.key]) keys[event.key]();
    else return false;
    event.preventDefault();
    return true;
  }

  /** Handles arrow keys, which move the cross in the configuration space; by smaller steps if it is magnified. */
  nudge(event) {
    const direction = DIRECTIONS[event.key];
    if (!direction) return false;
    const from = this.probe?.q ?? this.q;
    const { joints } = this.model.arm;
    const step = (joint) => (joint.unit === 'rad' ? Math.PI / 180 : (joint.domain[1] - joint.domain[0]) / 200) * (event.shiftKey ? 10 : 1) / this.panels.cspace.times;
    this.place(joints.map((joint, k) => from[k] + direction[k] * step(joint)));
    this.panels.cspace.reveal(this.probe.q);
    event.preventDefault();
    return true;
  }

  /** Handles Enter in the workspace, which takes the arm, and then arrow keys, which move its tip. */
  nudgeTip(event) {
    const direction = DIRECTIONS[event.key];
    if (this.mode === 'learn' || !(direction ? this.probe : event.key === 'Enter')) return false;
    const { arm } = this.model;
    if (!direction) this.place(this.q);
    else {
      const step = ((this.model.frame[0][1] - this.model.frame[0][0]) / 200) * (event.shiftKey ? 10 : 1);
      this.dragTip(Geometry.tipAt(arm, this.probe.q).map((x, k) => x + direction[k] * step));
    }
    event.preventDefault();
    return true;
  }
}

/** Returns the part of the page that explains keys and pointer. */
function help(view) {
  const rows = [
    ['drag the tip of the arm', 'the arm follows; contacts are red'],
    ['Enter in the workspace, then arrow keys', 'the same by keys (with Shift in larger steps)'],
    ['point into the configuration space', 'shows the arm in that configuration, and its contacts'],
    ['click, tap', 'keeps it there, or releases it'],
    ['arrow keys in the configuration space', 'move the cross by a degree (with Shift by ten)'],
    ['Space or k', 'play, pause'],
    ['arrow keys elsewhere', 'back and forth in time (with Shift further)'],
    ['Home, End', 'to the start, to the end'],
    ['t', 'the motion, or how it was found'],
    ['l', 'lessons: contact angles, the two tests of penetration, Minkowski differences'],
    ['+, \u2212', 'faster, slower; in a panel that was clicked: zoom'],
    ['wheel, two fingers, then drag', 'zoom at the pointer, and move the visible part'],
    ['Shift and arrow keys in a magnified workspace', 'move the visible part'],
    ['0, double click', 'shows all again'],
    ['Escape', 'removes the examined arm'],
  ];
  const list = element('dl', {}, ...rows.flatMap(([keys, effect]) => [element('dt', {}, keys), element('dd', {}, effect)]));
  const box = element('input', { type: 'checkbox', checked: Settings.hasShortcuts, onchange: (event) => (Settings.hasShortcuts = event.target.checked) });
  const choice = element('p', {}, element('label', {}, box, ' Keys of a single character (k, t, l, +, \u2212, 0) act on the page'));
  const tour = element('button', { type: 'button', class: 'button', onclick: () => view.tour.start() }, 'Show the tour');
  return element('details', { class: 'help' }, element('summary', {}, 'Keys and pointer'), list, choice, tour);
}
