// The live page: the user edits a world, and its plan follows.
'use strict';

/**
 * Formats a positive number with a few digits. `Math.floor` or `Math.ceil` as `round` makes sure that a proven bound
 * also holds for the displayed number.
 */
const roundedSafely = (value, digits, round) => {
  const unit = 10 ** (Math.floor(Math.log10(value)) + 1 - digits);
  return value > 0 ? String(+(round(value / unit) * unit).toPrecision(digits)) : '0';
};

/** Screens on which the panels stand one above the other, as in the style sheet. */
const SMALL_SCREEN = matchMedia('(max-width: 51.25rem)');
/** Shortest time between two changes of the figures during a drag, in milliseconds. */
const FIGURES_INTERVAL = 200;
/** Time of waiting for a plan after which the picture turns pale, in milliseconds. */
const NOTICED = 150;

class Live {
  constructor(root) {
    this.root = root;
    this.waiting = element('p', { class: 'waiting', role: 'status' }, 'Connecting\u2026');
    this.connectionBar = element(
      'div', { class: 'connection', role: 'alert', hidden: true }, element('span', {}),
      element('button', { type: 'button', class: 'button', onclick: () => this.link.retry() }, 'Try now'),
    );
    root.append(this.waiting, this.connectionBar);
    this.frames = new Frames();
    /** Times of the answers during a drag. */
    this.answerTimes = [];
    /** Number of the page's current state. Each change increases it. */
    this.edition = 1;
    /** The answer in the picture: the edition, whether it is complete, and its outcome. `null` if there is no connection. */
    /** @type {?{ edition: number, final: boolean, ending?: string, status?: string, error: ?string }} */
    this.shown = null;
    this.notices = new Notices();
    /** The edited world. @type {?Scene} */
    this.scene = null;
    /** The first world that was opened, and its origin: robot and text. @type {any} */
    this.first = null;
    /** @type {?string} */
    this.origin = null;
    /** @type {View} */
    this.view = null;
    /** State for scripts that observe the page, such as tests. */
    this.answered = { id: 0, verdict: null, certified: false, final: false, error: null };
    /** Worlds to open. */
    this.gallery = new Gallery(this);
    this.link = new Link({
      openSocket: () => this.gallery.openSocket(),
      receive: (message, about) => this.receive(message, about),
      file: (head, content) => this.saveFile(head, content),
      state: (isUp) => this.connectionChanged(isUp),
    });
    window.addEventListener('pagehide', () => this.keepEdits());
  }

  /** Returns the number of answers per second during a drag. */
  get updatesPerSecond() {
    const now = performance.now();
    this.answerTimes = this.answerTimes.filter((time) => now - time < 1000);
    return this.answerTimes.length;
  }

  // Elements of the page. They are built with the first answer.

  build(model) {
    this.waiting.remove();
    this.view = new View(this.root, model, () => this.plan(true));
    this.view.judged = true;
    this.editor = new Editor(this.view, {
      changed: (final) => this.changed(final),
      selected: () => this.controls?.updateSelection(),
      configurations: () => ({ start: this.places?.start, goals: this.places?.goals ?? [] }),
      blocked: () => this.blocked ?? [],
      frames: this.frames,
      isDrawn: ({ shape }) => this.root.classList.contains('behind') || this.shown?.error ? Boolean(this.drawn?.has(shape)) : true,
    });
    this.controls = new Controls(this);
    this.cards = element('dl', { class: 'cards', 'aria-label': 'Key figures', hidden: true });
    this.figures = element('p', { class: 'figures' });
    this.figuresShown = -Infinity;
    for (const panel of Object.values(this.view.panels)) this.speedUp(panel);
    this.lastVerdict = element('p', { class: 'last' });
    const { status } = this.view.parts;
    const verdicts = element('div', { class: 'verdicts' });
    status.before(verdicts);
    this.why = new Why(this);
    verdicts.append(status, element('div', { class: 'aside' }, this.lastVerdict, this.why.button));
    this.spoken = element('p', { class: 'spoken', 'aria-live': 'polite' });
    const { places } = this.notices;
    this.outcome = element('div', { class: 'outcome' }, this.cards, this.figures, places.picture, places.files, this.controls.remarks);
    this.root.querySelector('.transport').after(this.spoken, this.controls.inspector.root);
    this.arrange();
    SMALL_SCREEN.addEventListener('change', () => this.arrange());
    this.root.querySelector('.help').before(this.controls.commandLine, this.controls.world);
    this.root.querySelector('.help dl').prepend(...[
      ['drag an obstacle, the start\u2019s tip (ring) or the goal (target)', 'the configuration space follows at once, the plan when you let go'],
      ['drag start (ring) or goal (diamond) in the configuration space', 'the same, by joint values'],
      ['click an obstacle, then drag a corner or the rim', 'changes the shape; a double click on a side adds a corner (on touch screens, choose \u201cdrag corners\u201d first)'],
      ['arrow keys with something selected', 'move it (with Shift further)'],
      ['c in the workspace', 'selects the next corner'],
      ['Delete in the workspace', 'deletes the corner or the obstacle'],
      ['Ctrl+Z, Ctrl+Y', 'undo, redo'],
    ].flatMap(([keys, what]) => [element('dt', {}, keys), element('dd', {}, what)]));
    document.addEventListener('keydown', (event) => this.key(event));
    this.showWorld();
  }

  /** Leaves out transparency while something is dragged: it needs two more copies of the whole picture for each arm. */
  speedUp(panel) {
    panel.faded = (context, alpha, draw) => {
      if (this.view.light) draw(context);
      else Panel.prototype.faded.call(panel, context, alpha, draw);
    };
  }

  /** Puts tools, choices and the outcome above the pictures; on a small screen below them, because there the pictures come first. */
  arrange() {
    const [header, stage, panels] = ['header', '.stage', '.panels'].map((name) => this.root.querySelector(name));
    const { controls: { toolbar, root, files, inspector }, gallery, outcome, notices: { places } } = this;
    const { transport } = this.view.parts;
    if (SMALL_SCREEN.matches) {
      panels.after(outcome, gallery.task, toolbar, inspector.root);
      toolbar.append(files);
      // Above the pictures, where its cards and the pictures are in sight together.
      panels.before(this.view.explain.root);
      stage.after(gallery.root, root, places.options);
    } else {
      toolbar.append(root);
      header.firstChild.after(gallery.root, files);
      header.after(gallery.task, toolbar, places.options, outcome);
      transport.after(this.view.explain.root, inspector.root);
    }
  }

  key(event) {
    if (event.target.matches?.('textarea, input:not([type=checkbox]):not([type=range])')) return;
    if (event.target === document.body && this.editor.deletes(event)) return;
    if (!(event.ctrlKey || event.metaKey)) return;
    const key = event.key.toLowerCase();
    if (key !== 'z' && key !== 'y') return;
    event.preventDefault();
    this.stepHistory(key === 'y' || event.shiftKey ? 'redo' : 'undo');
  }

  /** Starts with a world, or with the edits of it that were kept. */
  startEditing(record = null) {
    this.scene = new Scene(this.world);
    if (record) this.scene.restore(record);
    this.changedSince = this.scene.isChanged;
    this.edition += 1;
    if (this.view) this.showWorld();
  }

  /** Shows the world in the controls. */
  showWorld() {
    this.controls.showWorld(this.world, this.scene);
    this.controls.showText(this.world.toml);
    this.editor.editScene(this.scene);
    for (const place of ['picture', 'options', 'text', 'files']) this.notices.show(place, null);
  }

  // Edits that survive the page and the server.

  /** Returns the record to keep: the text that the edits refer to, and the edits. */
  get record() {
    return { text: this.world.toml, words: this.words, ...this.scene.record };
  }

  keepEdits() {
    if (!this.scene) return;
    const isOther = this.scene.isChanged || this.world.toml !== this.first.toml || this.words !== this.first.options;
    if (isOther) Keep.write(this.origin, this.record);
    else Keep.forget(this.origin);
  }

  /** Handles an opened world, after a new connection or for another address. */
  worldOpened(world) {
    const origin = `${world.robot}\n${world.toml}`;
    if (origin !== this.origin) {
      const hadAnother = Boolean(this.origin && this.scene?.isChanged);
      [this.origin, this.first] = [origin, world];
      const record = Keep.read(origin);
      this.words = record?.words ?? world.options;
      this.continueWith(world, record);
      if (record) this.remark('Your last edits are back.');
      else if (hadAnother && !this.gallery.hasMoved) this.remark('cplan now serves another world. Your edits of the previous world come back when cplan serves that world again.');
    } else if (this.scene) {
      // Send edits that were made without a connection.
      this.continued = true;
      this.continueWith(world, this.record);
    }
  }

  /** Continues with edits of the server's initial world, or loads the edited text. */
  continueWith(world, record) {
    if (record && record.text !== world.toml) {
      this.restoring = record;
      this.fallback = world;
      this.link.load(record.text, record.words);
      return;
    }
    this.useWorld(world, record);
    this.plan(true);
  }

  /** Uses a world of the server as the one that the page changes. */
  useWorld(world, record) {
    this.world = world;
    this.toml = world.toml;
    if (record && this.continued && this.scene) {
      this.scene.world = world;
      this.continued = false;
      return;
    }
    this.continued = false;
    this.places = { start: world.start, goals: [] };
    this.startEditing(record);
  }

  /** Shows a remark beside the files. */
  remark(text) {
    this.remarked = text;
    this.controls?.remark(text);
  }

  // Messages from the server.

  receive(message, about) {
    if (message.kind === 'world') this.receiveWorld(message);
    else if (message.kind === 'explanation') this.why.receive(message, about);
    else if (message.kind === 'failed') this.fail(message, about);
    else if (about.isAwaited) {
      clearTimeout(this.previewTimer);
      if (!message.done) this.previewTimer = setTimeout(() => this.preview(message, about), NOTICED);
      else if (message.final || !this.view) this.show(message, about);
      else this.showSoon(message, about);
    }
    this.updateState();
  }

  receiveWorld(world) {
    if (world.options !== null) {
      this.worldOpened(world);
      return;
    }
    const record = this.restoring;
    this.restoring = null;
    this.useWorld(world, record);
    // The plan that follows is that of the loaded text.
    if (this.link.awaited?.id === world.id) Object.assign(this.link.awaited, this.about);
    if (record) this.plan(true);
    this.notices.show('text', null);
    this.notices.show('files', null);
    if (!record) this.keepEdits();
  }

  /** Handles a failed request; the page keeps its state. */
  fail({ id, error }, about) {
    this.answered = { ...this.answered, id, error };
    if (about.kind === 'open' && !this.gallery.isOwn) {
      this.link.open(this.gallery.ownWithRemark());
      return;
    }
    if (about.kind === 'load') {
      if (this.restoring) {
        // This server cannot use the edits that were kept.
        this.restoring = null;
        this.useWorld(this.fallback, null);
        this.remark('Your last edits are lost, because they do not fit this world any more.');
        this.plan(true);
      } else this.notices.show(this.opened ? 'files' : 'text', error);
    } else if (about.kind === 'download' || about.kind === 'explain') this.notices.show('files', error);
    else {
      this.shown = { edition: about.edition, final: true, error: 'not planned' };
      this.isOutdated = true;
      this.showError('picture', error);
    }
    if (this.link.isPlanDue) this.plan(true);
  }

  /** Shows the configuration space before the plan, if that takes long. */
  preview(message, about) {
    this.draw(message, about.shapes);
  }

  /** Draws the latest answer with the next picture of the screen. */
  showSoon(message, about) {
    this.frames.request('answer', () => {
      this.show(message, about);
      this.updateState();
    });
  }

  show(message, { since, edition, shapes }) {
    this.frames.drop('answer');
    if (!message.final) this.answerTimes.push(performance.now());
    this.took = performance.now() - since;
    this.draw(message, shapes);
    const { id, verdict, certified, error } = message;
    this.answered = { id, verdict, certified, final: message.final, error, figures: message.figures };
    this.shown = { edition, final: message.final, error: error && Live.errorInBrief(message), ...Live.ending(message) };
    /** Subject of the error: start, goal, world or options. */
    this.refused = message.about;
    if (message.toml) {
      this.toml = message.toml;
      this.controls?.showText(message.toml);
    }
    this.showError(message.about === 'options' ? 'options' : 'picture', error, message.about);
    this.showFigures(message);
    /** True if the picture still shows an older answer, because there is none to the last request. */
    this.isOutdated = Boolean(error) && !message.view;
  }

  /** Returns the outcome for the badge: certified only if the server says so of the whole motion. */
  static ending({ verdict, certified, view }) {
    if (verdict === 'found' && certified) return { ending: 'found', status: view?.status ?? 'found, certified' };
    if (verdict === 'infeasible') return { ending: 'infeasible', status: view?.status ?? 'infeasible: proven' };
    return { ending: 'unknown', status: 'unknown' };
  }

  /** Describes an error in a word or two. */
  static errorInBrief({ about, blocked }) {
    const places = { start: 'start', goal: 'goal' };
    if (places[about]) return blocked?.some(({ hits }) => hits.length) ? `${places[about]} blocked` : `${places[about]} not possible`;
    return 'not planned';
  }

  /** Shows the error of a plan at one of two places. A blocked start or goal (`about`) can be moved away. */
  showError(place, error, about = null) {
    const canMove = error && this.blocked?.length && ['start', 'goal'].includes(about) && !this.world.has_steps;
    const action = canMove ? { label: `Move ${about} to nearest free`, run: () => this.moveToNearestFree(about) } : null;
    for (const one of ['picture', 'options']) this.notices.show(one, one === place ? error : null, one === place ? action : null);
    this.controls?.markInvalid(place === 'options' && Boolean(error));
    if (!this.view && error) this.waiting.textContent = error;
  }

  /** Moves the blocked start or goal to the nearest free configuration. */
  moveToNearestFree(kind) {
    const { model, world } = this.view;
    const found = NearestFree.find(model.arm, world, this.blocked.map(({ at }) => at), this.world.reach);
    if (found) {
      this.editor.select({ kind });
      this.editor.setConfiguration(kind, found.map(rounded4));
    } else this.remark(`No free configuration was found near the ${kind}.`);
  }

  /** Draws an answer. */
  draw(message, shapes) {
    this.take(message);
    if (message.view) this.drawn = shapes;
  }

  /** Makes an answer the visible one. */
  take(message) {
    if (message.start) {
      // With a blocked start, the answer has no goals, and the previous ones remain.
      const goals = message.about === 'start' ? this.places?.goals ?? [] : message.goals;
      this.places = { start: message.start, goals };
      // After a drag, the start is the configuration that the tip was dragged to.
      const { scene } = this;
      if (scene?.start?.tip && message.final && message.done && !this.editor?.held) {
        scene.start = { joints: message.start };
        scene.kept = scene.snapshot();
      }
    }
    this.blocked = message.blocked ?? [];
    if (!message.view) {
      this.editor?.redraw();
      return;
    }
    const light = !message.final || !message.done;
    const structure = light && Live.structure(message.view);
    if (!this.view) this.build(message.view);
    else if (light && structure === this.structure && this.view.mode === 'move') this.follow(message.view);
    else {
      // Facts of intermediate states would jump. They are updated only when all of them are known.
      if (!message.view.facts.length) message.view.facts = this.view.model.facts;
      this.view.light = light;
      this.root.classList.toggle('light', light);
      this.view.update(message.view);
    }
    this.structure = structure;
    this.controls.updateSelection();
  }

  /**
   * Returns a text that is equal for models that need the same elements of the page: the same ranges, obstacles and
   * layers.
   */
  static structure({ frame, worlds, paths, goals, title }) {
    const parts = ({ obstacles, movers, trace, proof, c_obstacles: shapes, scale }) => [obstacles.map(({ name, color }) => [name, color]), movers, trace?.kind, proof.length > 0, shapes.length > 0, scale];
    return JSON.stringify([frame, worlds.map(parts), paths.length, goals.length > 0, title]);
  }

  /** Shows the next model during a drag: it differs in shapes alone, so only the panels are drawn again. */
  follow(model) {
    const { view } = this;
    Object.assign(model, { facts: view.model.facts });
    Object.assign(view, { model, traces: null });
    const panels = Object.values(view.panels);
    for (const panel of panels) panel.dirty = true;
    this.frames.draw(...panels);
  }

  /** Shows the key figures as cards, and the others in a line. */
  showFigures({ figures, reason, final, verdict, certified, error, view }) {
    if (!this.figures) return;
    if (error) {
      this.figures.textContent = '';
      View.fillCards(this.cards, []);
      this.lastFigures = null;
      if (final) this.spoken.textContent = '';
      return;
    }
    // Numbers that change with every picture could not be read, and each change costs time.
    const now = performance.now();
    if (!final && now - this.figuresShown < FIGURES_INTERVAL) return;
    this.figuresShown = final ? -Infinity : now;
    const { length, length_unit: unit, lower_bound: bound, clearance, duration, size, milliseconds } = figures;
    const verdicts = { found: certified ? 'found and certified' : 'found', infeasible: 'infeasible', unknown: 'unknown' };
    const measure = length && `length ${length.toFixed(4)} ${unit}`;
    const parts = [
      final ? verdicts[verdict] : 'following',
      measure,
      bound && `at most ${roundedSafely(100 * (length / bound - 1), 2, Math.ceil)} % longer than the shortest`,
      final && clearance && `clearance ${roundedSafely(1000 * clearance, 3, Math.floor)} mm proven`,
      duration && `motion ${duration.toFixed(3)} s`,
      final && verdict !== 'found' && reason,
    ].filter(Boolean);
    const details = [
      size,
      `${final ? 'planned' : 'answered'} in ${milliseconds.toFixed(milliseconds < 10 ? 1 : 0)} ms`,
      !final && `${this.updatesPerSecond} updates/s`,
    ].filter(Boolean);
    const separated = (texts) => texts.join(' \u00b7 ');
    const own = { duration: duration ?? undefined, gap: bound ? length / bound - 1 : undefined, clearance: clearance ?? undefined };
    const known = final && view?.figures?.duration ? view.figures : own;
    let cards = final && verdict === 'found' && known.duration ? View.cards({ figures: known, arm: this.view.model.arm }) : [];
    // The cards keep their places while something is dragged, with the values that are known then.
    if (!final && !this.cards.hidden) {
      const now = new Map(View.cards({ figures: { duration: own.duration, gap: own.gap } }).map((card) => [card[0], card]));
      cards = ['time', 'over the optimum', 'clearance'].map((name) => (name === 'over the optimum' && own.gap === undefined ? null : now.get(name)) ?? [name, '\u2026', 'computed when you let go']);
    }
    View.fillCards(this.cards, cards);
    const line = cards.length ? [parts[0], measure].filter(Boolean) : parts;
    this.figures.replaceChildren(separated(line), element('span', { class: 'detail' }, ` \u00b7 ${separated(details)}`));
    if (final) this.lastFigures = [...this.figures.childNodes];
    if (final) this.spoken.textContent = parts.slice(0, 5).join(', ');
  }

  connectionChanged(isUp) {
    this.isUp = isUp;
    // The next connection may be to another server.
    this.shown = null;
    clearTimeout(this.previewTimer);
    this.frames.drop('answer');
    this.connectionBar.hidden = isUp || !this.view;
    const lost = 'The connection to cplan is lost. You can go on editing: the page keeps your changes, and sends them when cplan answers again.';
    this.connectionBar.firstChild.textContent = this.connectionBar.hidden ? '' : lost;
    if (!this.view) this.waiting.textContent = isUp ? 'Connecting\u2026' : 'cplan does not answer; trying again\u2026';
    if (isUp) this.gallery.open();
    this.updateState();
  }

  // State of the picture.

  /** Returns true if the picture shows the final answer for the current state. */
  get isCurrent() {
    return Boolean(this.isUp && this.shown?.final && this.shown.edition === this.edition && !['open', 'load'].includes(this.link.awaited?.kind) && !this.restoring);
  }

  /** Returns colour and text of the badge. */
  get badge() {
    if (!this.isUp) return ['unknown', 'no connection'];
    if (!this.isCurrent) return ['waiting', 'planning\u2026'];
    const { error, ending, status } = this.shown;
    return error ? ['infeasible', error] : [ending, status];
  }

  /** Updates the badge at once. An outdated picture turns pale only after a while, so that it does not flicker. */
  updateState() {
    if (!this.view) return;
    clearTimeout(this.paleTimer);
    this.gallery.showTask();
    this.view.say(...this.badge);
    this.why.update();
    const { classList } = this.root;
    const { isCurrent } = this;
    classList.toggle('known', isCurrent && !this.shown.error);
    classList.toggle('lost', !this.isUp);
    // During a drag, the picture is up to date except for requests in progress.
    const isFollowing = Boolean(this.isUp && this.editor.held && this.updatesPerSecond);
    classList.toggle('following', isFollowing);
    this.showLastVerdict(isCurrent, isFollowing);
    const isBehind = isCurrent ? Boolean(this.isOutdated) : !isFollowing;
    const show = (behind) => {
      if (classList.contains('behind') === behind) return;
      classList.toggle('behind', behind);
      this.editor.redraw();
    };
    if (isBehind && this.isUp) this.paleTimer = setTimeout(() => show(true), NOTICED);
    else show(isBehind);
  }

  /** Keeps the last verdict and its figures in sight, dimmed and named as such, until there is another one. */
  showLastVerdict(isCurrent, isFollowing) {
    if (isCurrent) this.verdict = this.badge;
    const [, words] = this.verdict ?? [];
    const text = isCurrent || !words ? '' : `last: ${words}`;
    if (this.lastVerdict.textContent !== text) this.lastVerdict.textContent = text;
    if (!isCurrent && !isFollowing && this.lastFigures) this.figures.replaceChildren(...this.lastFigures);
  }

  // Requests to the server.

  /** Returns the state that an answer to a request made now is about. */
  get about() {
    return { edition: this.edition, shapes: new Set(this.scene.obstacles.map(({ shape }) => shape)) };
  }

  get body() {
    const state = this.changedSince && !this.world.has_steps ? this.scene.request() : null;
    return { base: this.world.base, state, options: this.words, think: this.view?.chosen === 'think' };
  }

  plan(final) {
    this.link.plan(() => ({ body: this.body, about: this.about }), final);
    this.updateState();
  }

  changed(final) {
    this.changedSince = true;
    this.edition += 1;
    if (final) {
      this.scene.settle();
      this.keepEdits();
    }
    // The user continues, so a text or file with errors is no longer relevant.
    for (const place of ['text', 'files']) this.notices.show(place, null);
    this.controls.updateSelection();
    this.plan(final);
  }

  /** Sets other options. */
  choose(words) {
    if (words === this.words) return;
    this.words = words;
    this.edition += 1;
    this.keepEdits();
    this.plan(true);
  }

  /** Sets the clearance to keep, in metres. */
  setClearance(clearance) {
    this.scene.clearance = clearance;
    this.changed(true);
  }

  /** Undoes or redoes the last change. */
  stepHistory(step) {
    if (!this.scene[step]()) return;
    this.changedSince = true;
    this.edition += 1;
    this.keepEdits();
    this.controls.showClearance(this.scene);
    this.editor.select(null);
    this.plan(true);
  }

  /** Loads a text as the world, from a file or from the page. */
  load(text, opened = false) {
    this.opened = opened;
    this.remark('');
    if (!this.isUp) {
      this.notices.show(opened ? 'files' : 'text', 'No connection to cplan. Try again when the connection is back.');
      return;
    }
    this.link.load(text, this.words);
    this.updateState();
  }

  /** Returns to the program's initial world. This step can be undone, unless another text has been loaded. */
  reset() {
    this.remark('');
    if (this.world.toml !== this.first.toml) {
      this.load(this.first.toml);
      return;
    }
    this.scene.reset();
    this.controls.showClearance(this.scene);
    this.editor.select(null);
    this.changed(true);
  }

  save(format) {
    this.notices.show('files', null);
    if (!this.isUp) {
      this.notices.show('files', 'No connection to cplan. Save when the connection is back.');
      return;
    }
    this.link.download(this.body, format);
    this.updateState();
  }

  saveFile({ name }, content) {
    const address = URL.createObjectURL(new Blob([content]));
    element('a', { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
    if (this.link.isPlanDue) this.plan(true);
    this.updateState();
  }
}

window.cplan = new Live(document.querySelector('main'));
